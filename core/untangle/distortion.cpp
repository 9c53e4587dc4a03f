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
#include "core/basis/quadrature.h"
#include "core/quality/jacobian_bounds.h"

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

/// Degree of the lattice of samples that an element begins with; it includes the corners, where curved elements tangle
/// first. In 2D and on tetrahedra that of J, on hexahedra and prisms less, as J has a degree there (3 p - 1 in each
/// direction) that would cost too much; what the samples miss is added when a certificate finds it.
int lattice_degree(ElementType type) {
    const int p = type.order;
    const int degree = is_simplex(type.shape)               ? dimension(type.shape) * (p - 1)
                       : type.shape == Shape::quadrilateral ? 2 * p - 1
                                                            : 2 * p;
    return std::clamp(degree, 1, max_order);
}

struct Lattice {
    RowMatrix gradients;        ///< of the element's shape functions
    RowMatrix ideal_gradients;  ///< of the straight-sided element's
    double measure = 1.0;       ///< of the reference element
};

const Lattice& lattice_of(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, Lattice> tables;
    const std::lock_guard lock(mutex);
    const auto [entry, is_new] = tables.try_emplace(type);
    if (is_new) {
        const Eigen::MatrixX3d points = reference_nodes({type.shape, lattice_degree(type)});
        entry->second = {gradient_table(type, points), gradient_table({type.shape, 1}, points),
                         quadrature(type.shape, 0).weights.sum()};
    }
    return entry->second;
}

/// Corners of a regular element of measure 1: edges of one length and, but for triangles, right angles.
Eigen::MatrixX3d regular_corners(Shape shape) {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // images of the reference axes
    if (shape == Shape::triangle || shape == Shape::prism) axes.row(1) << 0.5, std::sqrt(0.75), 0.0;
    if (shape == Shape::tetrahedron)
        axes << 1.0, 0.0, 0.0, 0.5, std::sqrt(0.75), 0.0, 0.5, std::sqrt(1.0 / 12.0), std::sqrt(2.0 / 3.0);
    const double measure = axes.determinant() * quadrature(shape, 0).weights.sum();
    return reference_nodes({shape, 1}) * axes / std::pow(measure, 1.0 / dimension(shape));
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
    PatchObjectiveOf(const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal,
                     const OrientationSigns& signs, FreePatch given) {
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
        set_ideals(topology, ideal, signs);
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
        double value = options.energy_weight * (energy - count), energy_share = options.energy_weight;
        if (options.power > 1.0) {
            value = options.energy_weight * std::log(energy / count) / options.power;
            energy_share = options.energy_weight / (options.power * energy);
        }
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
                        sum[d] += energy_share * of[d];
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
        if (!element.is_ideal_affine())
            add_ideals(element, gradient_table({element.type.shape, 1}, points), element.ideal_corners);
    }

  private:
    using Tall = Eigen::Matrix<double, Eigen::Dynamic, Dim, Eigen::RowMajor>;

    /// The Jacobian W of the ideal element at a sample.
    struct Ideal {
        Square<Dim> inverse = Square<Dim>::Identity();  ///< W^-1, in units of the patch's size
        double determinant = 1.0;                       ///< |det W|, likewise
    };
    struct Element {
        ElementType type;
        const RowMatrix* gradients = nullptr;
        std::shared_ptr<RowMatrix> own_gradients;
        std::vector<Ideal> ideals;  ///< one per sample, or a single one where W is the same everywhere
        Tall ideal_corners;         ///< in units of the patch's size; not kept where W is the same everywhere
        std::size_t first = 0;      ///< of its nodes in variable_of_ and start_
        bool is_ideal_affine() const { return ideals.size() == 1; }
        const Ideal& ideal(Eigen::Index sample) const {
            return ideals[is_ideal_affine() ? 0 : static_cast<std::size_t>(sample)];
        }
    };
    struct Use {
        std::size_t element, position;
    };

    void place_nodes(const MeshTopology& topology, const Coordinates& x) {
        for (const Index index : patch.elements) {
            Element element;
            element.type = topology.element_type(index);
            element.gradients = &lattice_of(element.type).gradients;
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

    void set_ideals(const MeshTopology& topology, const Coordinates& ideal, const OrientationSigns& signs) {
        double volume = 0.0;
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            Element& element = elements_[e];
            const Lattice& lattice = lattice_of(element.type);
            const auto nodes = topology.element_nodes(patch.elements[e]);
            element.ideal_corners.resize(corner_count(element.type.shape), Dim);
            for (Eigen::Index c = 0; c < element.ideal_corners.rows(); ++c)
                element.ideal_corners.row(c) =
                    (ideal.row(nodes[static_cast<std::size_t>(c)]) - ideal.row(nodes[0])).template head<Dim>() / size;
            const Tall w = lattice.ideal_gradients * element.ideal_corners;
            const Eigen::Index samples = w.rows() / Dim;
            double sum = 0.0;
            for (Eigen::Index q = 0; q < samples; ++q)
                sum += Square<Dim>(w.template middleRows<Dim>(q * Dim)).determinant();
            volume += lattice.measure * std::abs(sum) / static_cast<double>(samples);
        }
        volume /= static_cast<double>(std::max<std::size_t>(1, elements_.size()));
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            Element& element = elements_[e];
            const double sign = signs.of_element(topology, patch.elements[e]);
            const RowMatrix& gradients = lattice_of(element.type).ideal_gradients;
            const bool is_simplicial = is_simplex(element.type.shape);
            const bool is_own = is_usable(element, sign);
            if (!is_own) {
                element.ideal_corners =
                    std::pow(volume, 1.0 / Dim) * regular_corners(element.type.shape).template leftCols<Dim>();
                if (sign < 0.0) element.ideal_corners.col(0) *= -1.0;
            }
            if (is_own && !is_simplicial) {
                add_ideals(element, gradients, element.ideal_corners);
            } else {
                add_ideals(element, gradients.topRows(Dim), element.ideal_corners);
                element.ideal_corners.resize(0, Dim);
            }
        }
    }

    /// Whether the ideal element has volume of the given sign everywhere: at the samples with some margin, and between
    /// them, where more samples may come, by certificate.
    static bool is_usable(const Element& element, double sign) {
        const Tall w = lattice_of(element.type).ideal_gradients * element.ideal_corners;
        const double extent = w.cwiseAbs().maxCoeff();
        for (Eigen::Index q = 0; q < w.rows() / Dim; ++q)
            if (!(sign * Square<Dim>(w.template middleRows<Dim>(q * Dim)).determinant() > 1e-9 * std::pow(extent, Dim)))
                return false;
        if (is_simplex(element.type.shape)) return true;
        Eigen::MatrixX3d corners = Eigen::MatrixX3d::Zero(element.ideal_corners.rows(), 3);
        corners.leftCols<Dim>() = element.ideal_corners;
        return JacobianBounds({element.type.shape, 1}).bound(corners, sign, {}).validity == Validity::valid;
    }

    /// gradients: those of the straight-sided element at further samples.
    static void add_ideals(Element& element, const RowMatrix& gradients, const Tall& corners) {
        const Tall w = gradients * corners;
        for (Eigen::Index q = 0; q < w.rows() / Dim; ++q) {
            const Square<Dim> at_sample = w.template middleRows<Dim>(q * Dim);
            element.ideals.push_back({at_sample.inverse(), std::abs(at_sample.determinant())});
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
            const Square<Dim>& inverse = element.ideal(q).inverse;
            const Square<Dim> t = inverse * jacobian.template middleRows<Dim>(q * Dim);
            const Square<Dim> c = cofactors<Dim>(t);
            const double d = t.row(0).dot(c.row(0)), norm = t.squaredNorm();
            const double root = std::sqrt(options.eps * options.eps + d * d);
            // (d + root) / 2 without cancellation for negative d
            const double chi = d > 0.0 ? 0.5 * (d + root) : 0.5 * options.eps * options.eps / (root - d);
            const double chi_slope = chi / root;
            const double power = Dim == 2 ? 1.0 / chi : 1.0 / std::cbrt(chi * chi);
            const double shape = norm * power / Dim, volume = 0.5 * (d * d + 1.0) / chi;
            const double term = (1.0 - options.theta) * shape + options.theta * volume;
            double factor = share;
            if (options.power > 1.0) {
                const double ratio = term / options.reference, raised = std::pow(ratio, options.power);
                energy += raised;
                factor *= options.power * raised / term;
            } else {
                energy += term;
            }
            const double by_d = -(1.0 - options.theta) * shape * (2.0 / Dim) / chi * chi_slope +
                                options.theta * (d / chi - volume / chi * chi_slope);
            const Square<Dim> by_t = (2.0 * (1.0 - options.theta) * power / Dim) * t + by_d * c;
            energy_force.template middleRows<Dim>(q * Dim).noalias() = factor * inverse.transpose() * by_t;
            cofactor.template middleRows<Dim>(q * Dim).noalias() = inverse.transpose() * c;
            determinant[q] = d;
            least = std::min(least, d);
        }
        values_[e] = energy * share;
        least_[e] = least;
        Eigen::Map<Tall>(gradients_.data() + element.first * Dim, nodes, Dim).noalias() =
            table.transpose() * energy_force;
        if (!(options.sharpness > 0.0)) return;

        // Evenness: soft minimum over soft maximum of det J divided by its mean. Where W is constant D will do for det
        // J.
        if (!element.is_ideal_affine()) {
            least = std::numeric_limits<double>::infinity();
            for (Eigen::Index q = 0; q < samples; ++q) {
                const double ideal = element.ideal(q).determinant;
                determinant[q] *= ideal;
                cofactor.template middleRows<Dim>(q * Dim) *= ideal;
                least = std::min(least, determinant[q]);
            }
        }
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
                               const OrientationSigns& signs, FreePatch patch) {
    for (const Index element : patch.elements) {
        const ElementType type = topology.element_type(element);
        if (simplex_factors(type.shape).empty())
            throw Unsupported("The distortion of a " + name(type) +
                              " is not measured; expected triangles, quadrilaterals, tetrahedra, hexahedra or prisms.");
    }
    if (topology.dimension() == 2)
        implementation_ = std::make_unique<PatchObjectiveOf<2>>(topology, x, ideal, signs, std::move(patch));
    else
        implementation_ = std::make_unique<PatchObjectiveOf<3>>(topology, x, ideal, signs, std::move(patch));
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
