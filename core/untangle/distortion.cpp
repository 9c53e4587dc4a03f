#include "core/untangle/distortion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/node_ordering.h"

namespace curvewright {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Derivatives of the shape functions at points: (points · dimension) × nodes, directions of a point below each other.
RowMatrix gradient_table(ElementType type, const Eigen::MatrixX3d& points) {
    const int dim = dimension(type.shape);
    const BasisTable basis = lagrange_basis(type, points);
    RowMatrix table(points.rows() * dim, node_count(type));
    for (Eigen::Index q = 0; q < points.rows(); ++q)
        for (int k = 0; k < dim; ++k) table.row(q * dim + k) = basis.gradients[static_cast<std::size_t>(k)].row(q);
    return table;
}

/// Samples on the lattice of the degree that J has (as far as the tables go): it includes the corners, where curved
/// simplices tangle first.
const RowMatrix& lattice_gradients(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, RowMatrix> tables;
    const std::lock_guard lock(mutex);
    const auto [entry, is_new] = tables.try_emplace(type);
    if (is_new) {
        const int degree = std::clamp(dimension(type.shape) * (type.order - 1), 1, max_order);
        entry->second = gradient_table(type, reference_nodes({type.shape, degree}));
    }
    return entry->second;
}

template <int Dim>
using Square = Eigen::Matrix<double, Dim, Dim, Eigen::RowMajor>;

template <int Dim>
Square<Dim> cofactors(const Square<Dim>& t) {
    Square<Dim> c;
    if constexpr (Dim == 2) {
        c << t(1, 1), -t(1, 0), -t(0, 1), t(0, 0);
    } else {
        c.row(0) = t.row(1).cross(t.row(2));
        c.row(1) = t.row(2).cross(t.row(0));
        c.row(2) = t.row(0).cross(t.row(1));
    }
    return c;
}

}  // namespace

class PatchObjective::Implementation {
  public:
    virtual ~Implementation() = default;
    virtual double evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options,
                            Eigen::VectorXd& gradient) = 0;
    virtual void add_sample(std::size_t element, const std::array<double, 3>& point) = 0;

    FreePatch patch;
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    double size = 1.0;
    int dim = 2;
    double least_determinant = 0.0;
};

namespace {

template <int Dim>
class PatchObjectiveOf final : public PatchObjective::Implementation {
  public:
    PatchObjectiveOf(const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal, double sign,
                     FreePatch given) {
        patch = std::move(given);
        dim = Dim;
        Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (const Index element : patch.elements)
            for (const Index node : topology.element_nodes(element)) {
                low = low.cwiseMin(x.row(node));
                high = high.cwiseMax(x.row(node));
            }
        center = 0.5 * (low + high);
        size = std::max((high - low).maxCoeff(), std::numeric_limits<double>::min());
        place_nodes(topology, x);
        set_ideals(topology, ideal, sign);
        collect_uses();
        least_.resize(elements_.size());
        values_.resize(elements_.size());
        evenness_.resize(elements_.size());
    }

    double evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options,
                    Eigen::VectorXd& gradient) override {
        const bool has_evenness = options.sharpness > 0.0;
        parallel_for(elements_.size(), 64, {}, {}, [&](std::size_t begin, std::size_t end) {
            for (std::size_t e = begin; e < end; ++e) evaluate_element(e, variables, options);
        });
        const double count = static_cast<double>(elements_.size());
        double energy = 0.0;
        least_determinant = std::numeric_limits<double>::infinity();
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            energy += values_[e];
            least_determinant = std::min(least_determinant, least_[e]);
        }
        double value = options.energy_weight * (energy - count);
        // Soft minimum over the elements of their evenness; its derivatives are the elements' shares.
        if (has_evenness) {
            double lowest = std::numeric_limits<double>::infinity(), sum = 0.0;
            for (const double r : evenness_) {
                lowest = std::min(lowest, r);
                value += options.mean_weight * (1.0 - r);
            }
            for (double& r : evenness_) sum += r = std::exp(-options.sharpness * (r - lowest));
            value += options.least_weight * (std::log(sum) / options.sharpness - lowest);
            for (double& r : evenness_) r = -options.least_weight * r / sum - options.mean_weight;
        }
        gradient.resize(variables.size());
        parallel_for(patch.nodes.size(), 512, {}, {}, [&](std::size_t begin, std::size_t end) {
            for (std::size_t node = begin; node < end; ++node) {
                Eigen::Matrix<double, Dim, 1> sum = Eigen::Matrix<double, Dim, 1>::Zero();
                for (std::size_t u = use_offsets_[node]; u < use_offsets_[node + 1]; ++u) {
                    const Use& use = uses_[u];
                    const double* of = gradients_.data() + use.position;
                    for (int d = 0; d < Dim; ++d) {
                        sum[d] += options.energy_weight * of[d];
                        if (has_evenness) sum[d] += evenness_[use.element] * of[gradients_.size() / 2 + d];
                    }
                }
                gradient.segment<Dim>(static_cast<Eigen::Index>(node) * Dim) = sum;
            }
        });
        return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
    }

    void add_sample(std::size_t e, const std::array<double, 3>& point) override {
        Element& element = elements_[e];
        Eigen::MatrixX3d points(1, 3);
        points << point[0], point[1], point[2];
        const RowMatrix extra = gradient_table(element.type, points);
        auto table = std::make_shared<RowMatrix>(element.gradients->rows() + Dim, element.gradients->cols());
        *table << *element.gradients, extra;
        element.own_gradients = table;
        element.gradients = table.get();
    }

  private:
    struct Element {
        ElementType type;
        const RowMatrix* gradients = nullptr;
        std::shared_ptr<RowMatrix> own_gradients;
        Square<Dim> inverse_ideal = Square<Dim>::Identity();  ///< W^-1, in units of the patch's size
        std::size_t first = 0;                                ///< of its nodes in node_of_ and start_
    };
    struct Use {
        std::size_t element, position;
    };

    void place_nodes(const MeshTopology& topology, const Coordinates& x) {
        for (const Index index : patch.elements) {
            Element element;
            element.type = topology.element_type(index);
            element.gradients = &lattice_gradients(element.type);
            element.first = variable_of_.size();
            for (const Index node : topology.element_nodes(index)) {
                const auto found = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), node);
                const bool is_free = found != patch.nodes.end() && *found == node;
                variable_of_.push_back(is_free ? static_cast<Index>(found - patch.nodes.begin()) : -1);
                for (int d = 0; d < Dim; ++d) start_.push_back((x(node, d) - center[d]) / size);
            }
            elements_.push_back(std::move(element));
        }
        gradients_.resize(2 * start_.size());
    }

    void set_ideals(const MeshTopology& topology, const Coordinates& ideal, double sign) {
        std::vector<Square<Dim>> ideals(elements_.size());
        double volume = 0.0;
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const auto nodes = topology.element_nodes(patch.elements[e]);
            for (int k = 0; k < Dim; ++k)
                ideals[e].row(k) =
                    (ideal.row(nodes[static_cast<std::size_t>(k) + 1]) - ideal.row(nodes[0])).template head<Dim>() /
                    size;
            volume += std::abs(ideals[e].determinant());
        }
        volume /= static_cast<double>(std::max<std::size_t>(1, elements_.size()));
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            Square<Dim>& w = ideals[e];
            const double extent = w.cwiseAbs().maxCoeff();
            if (!(sign * w.determinant() > 1e-9 * std::pow(extent, Dim))) {
                if constexpr (Dim == 2)
                    w << 1.0, 0.0, 0.5, std::sqrt(0.75);
                else
                    w << 1.0, 0.0, 0.0, 0.5, std::sqrt(0.75), 0.0, 0.5, std::sqrt(1.0 / 12.0), std::sqrt(2.0 / 3.0);
                w *= std::pow(volume / w.determinant(), 1.0 / Dim);
                if (sign < 0.0) w.row(0).swap(w.row(1));
            }
            elements_[e].inverse_ideal = w.inverse();
        }
    }

    void collect_uses() {
        std::vector<std::vector<Use>> uses(patch.nodes.size());
        for (std::size_t e = 0; e < elements_.size(); ++e)
            for (Eigen::Index i = 0; i < elements_[e].gradients->cols(); ++i) {
                const std::size_t at = elements_[e].first + static_cast<std::size_t>(i);
                if (variable_of_[at] >= 0) uses[variable_of_[at]].push_back({e, at * Dim});
            }
        use_offsets_.assign(1, 0);
        for (const auto& list : uses) {
            uses_.insert(uses_.end(), list.begin(), list.end());
            use_offsets_.push_back(uses_.size());
        }
    }

    void evaluate_element(std::size_t e, const Eigen::VectorXd& variables, const DistortionOptions& options) {
        const Element& element = elements_[e];
        const RowMatrix& table = *element.gradients;
        const Eigen::Index nodes = table.cols(), samples = table.rows() / Dim;
        thread_local std::vector<double> buffer;
        const std::size_t rows = static_cast<std::size_t>(table.rows());
        buffer.resize(static_cast<std::size_t>(nodes) * Dim + 3 * rows * Dim + 3 * static_cast<std::size_t>(samples));
        using Tall = Eigen::Matrix<double, Eigen::Dynamic, Dim, Eigen::RowMajor>;
        Eigen::Map<Tall> x(buffer.data(), nodes, Dim);
        Eigen::Map<Tall> jacobian(x.data() + nodes * Dim, table.rows(), Dim);
        Eigen::Map<Tall> energy_force(jacobian.data() + table.rows() * Dim, table.rows(), Dim);
        Eigen::Map<Tall> cofactor(energy_force.data() + table.rows() * Dim, table.rows(), Dim);
        double* determinant = cofactor.data() + table.rows() * Dim;
        double* low = determinant + samples;
        double* high = low + samples;
        for (Eigen::Index i = 0; i < nodes; ++i) {
            const std::size_t at = element.first + static_cast<std::size_t>(i);
            const Index variable = variable_of_[at];
            for (int d = 0; d < Dim; ++d)
                x(i, d) = variable >= 0 ? variables[static_cast<Eigen::Index>(variable) * Dim + d]
                                        : start_[at * Dim + static_cast<std::size_t>(d)];
        }
        jacobian.noalias() = table * x;
        const double share = 1.0 / static_cast<double>(samples);
        double energy = 0.0, least = std::numeric_limits<double>::infinity();
        for (Eigen::Index q = 0; q < samples; ++q) {
            const Square<Dim> t = element.inverse_ideal * jacobian.template middleRows<Dim>(q * Dim);
            const Square<Dim> c = cofactors<Dim>(t);
            const double d = t.row(0).dot(c.row(0)), norm = t.squaredNorm();
            const double root = std::sqrt(options.eps * options.eps + d * d);
            // (d + root) / 2 without cancellation for negative d
            const double chi = d > 0.0 ? 0.5 * (d + root) : 0.5 * options.eps * options.eps / (root - d);
            const double chi_slope = chi / root;
            const double power = Dim == 2 ? 1.0 / chi : 1.0 / std::cbrt(chi * chi);
            const double shape = norm * power / Dim, volume = 0.5 * (d * d + 1.0) / chi;
            energy += (1.0 - options.theta) * shape + options.theta * volume;
            const double by_d = -(1.0 - options.theta) * shape * (2.0 / Dim) / chi * chi_slope +
                                options.theta * (d / chi - volume / chi * chi_slope);
            const Square<Dim> by_t = (2.0 * (1.0 - options.theta) * power / Dim) * t + by_d * c;
            energy_force.template middleRows<Dim>(q * Dim).noalias() = share * element.inverse_ideal.transpose() * by_t;
            cofactor.template middleRows<Dim>(q * Dim).noalias() = element.inverse_ideal.transpose() * c;
            determinant[q] = d;
            least = std::min(least, d);
        }
        values_[e] = energy * share;
        least_[e] = least;
        Eigen::Map<Tall>(gradients_.data() + element.first * Dim, nodes, Dim).noalias() =
            table.transpose() * energy_force;
        if (!(options.sharpness > 0.0)) return;

        // Evenness: soft minimum over soft maximum of the determinants divided by their mean.
        double mean = 0.0, highest = -std::numeric_limits<double>::infinity();
        for (Eigen::Index q = 0; q < samples; ++q) {
            mean += determinant[q] * share;
            highest = std::max(highest, determinant[q]);
        }
        if (!(mean > 0.0)) {
            values_[e] = std::numeric_limits<double>::infinity();
            evenness_[e] = 0.0;
            return;
        }
        const double s = options.sharpness;
        double low_sum = 0.0, high_sum = 0.0;
        for (Eigen::Index q = 0; q < samples; ++q) {
            low_sum += low[q] = std::exp(-s * (determinant[q] - least) / mean);
            high_sum += high[q] = std::exp(s * (determinant[q] - highest) / mean);
        }
        const double soft_low = least / mean - std::log(low_sum * share) / s;
        const double soft_high = highest / mean + std::log(high_sum * share) / s;
        evenness_[e] = soft_low / soft_high;
        // Derivative by the scaled determinants, then by the determinants themselves.
        double inner = 0.0;
        for (Eigen::Index q = 0; q < samples; ++q) {
            low[q] = low[q] / low_sum / soft_high - soft_low / (soft_high * soft_high) * high[q] / high_sum;
            inner += low[q] * determinant[q];
        }
        for (Eigen::Index q = 0; q < samples; ++q)
            cofactor.template middleRows<Dim>(q * Dim) *= low[q] / mean - inner * share / (mean * mean);
        Eigen::Map<Tall>(gradients_.data() + gradients_.size() / 2 + element.first * Dim, nodes, Dim).noalias() =
            table.transpose() * cofactor;
    }

    std::vector<Element> elements_;
    std::vector<Index> variable_of_;  ///< per node of each element; -1 = stays
    std::vector<double> start_;       ///< its position, Dim each
    std::vector<double> gradients_;   ///< of the energy, then of the evenness, per node of each element
    std::vector<double> values_, least_, evenness_;
    std::vector<std::size_t> use_offsets_;
    std::vector<Use> uses_;
};

}  // namespace

PatchObjective::PatchObjective(const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal,
                               double orientation_sign, FreePatch patch) {
    for (const Index element : patch.elements) {
        const ElementType type = topology.element_type(element);
        if (type.shape != Shape::triangle && type.shape != Shape::tetrahedron)
            throw Unsupported("The distortion of a " + name(type) +
                              " is not measured; expected triangles or tetrahedra.");
    }
    if (topology.dimension() == 2)
        implementation_ = std::make_unique<PatchObjectiveOf<2>>(topology, x, ideal, orientation_sign, std::move(patch));
    else
        implementation_ = std::make_unique<PatchObjectiveOf<3>>(topology, x, ideal, orientation_sign, std::move(patch));
}
PatchObjective::~PatchObjective() = default;
PatchObjective::PatchObjective(PatchObjective&&) noexcept = default;

const FreePatch& PatchObjective::patch() const {
    return implementation_->patch;
}
const Eigen::RowVector3d& PatchObjective::center() const {
    return implementation_->center;
}
double PatchObjective::size() const {
    return implementation_->size;
}
double PatchObjective::least_determinant() const {
    return implementation_->least_determinant;
}

Eigen::VectorXd PatchObjective::variables(const Coordinates& x) const {
    const int dim = implementation_->dim;
    Eigen::VectorXd result(static_cast<Eigen::Index>(patch().nodes.size()) * dim);
    for (std::size_t i = 0; i < patch().nodes.size(); ++i)
        for (int d = 0; d < dim; ++d)
            result[static_cast<Eigen::Index>(i) * dim + d] =
                (x(patch().nodes[i], d) - implementation_->center[d]) / implementation_->size;
    return result;
}

void PatchObjective::store(const Eigen::VectorXd& variables, Coordinates& x) const {
    const int dim = implementation_->dim;
    for (std::size_t i = 0; i < patch().nodes.size(); ++i)
        for (int d = 0; d < dim; ++d)
            x(patch().nodes[i], d) =
                implementation_->center[d] + implementation_->size * variables[static_cast<Eigen::Index>(i) * dim + d];
}

double PatchObjective::evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options,
                                Eigen::VectorXd& gradient) {
    return implementation_->evaluate(variables, options, gradient);
}

void PatchObjective::add_sample(std::size_t element, const std::array<double, 3>& point) {
    implementation_->add_sample(element, point);
}

}  // namespace curvewright
