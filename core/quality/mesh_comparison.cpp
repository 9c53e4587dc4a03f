#include "core/quality/mesh_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/base/error.h"

namespace curvewright {
namespace {

/// Sums up the motions of nodes one by one.
class MotionSum {
  public:
    void add(NodeTag tag, double distance, bool is_moved) {
        ++motion_.nodes;
        if (!is_moved) return;
        ++motion_.moved;
        sum_ += distance;
        squares_ += distance * distance;
        if (!motion_.farthest || distance > motion_.max) {
            motion_.max = distance;
            motion_.farthest = tag;
        }
    }
    NodeMotion finish() {
        if (motion_.nodes > 0) {
            motion_.mean = sum_ / motion_.nodes;
            motion_.rms = std::sqrt(squares_ / motion_.nodes);
        }
        return motion_;
    }

  private:
    NodeMotion motion_;
    double sum_ = 0.0, squares_ = 0.0;
};

class Comparison {
  public:
    Comparison(const CurvedMesh& before, const CurvedMesh& after)
        : before_(before), after_(after), a_(before.topology()), b_(after.topology()) {}

    MeshComparison run(const TaskContext& context) {
        const auto box = bounding_box(before_);
        result_.size = (box.row(1) - box.row(0)).norm();
        compare_nodes();
        context.check();
        compare_elements();
        compare_lower_cells();
        compare_groups();
        compare_quality(context);
        return std::move(result_);
    }

  private:
    void compare_nodes() {
        twin_.assign(static_cast<std::size_t>(a_.node_count()), -1);
        MotionSum all, boundary, interior;
        for (Index node = 0; node < a_.node_count(); ++node) {
            const auto found = b_.find_node(a_.node_tag(node));
            if (!found) {
                result_.nodes_removed.push_back(a_.node_tag(node));
                continue;
            }
            twin_[node] = *found;
            add(all, node);
            if (a_.is_boundary_node(node)) add(boundary, node);
            if (a_.is_interior_node(node)) add(interior, node);
        }
        for (Index node = 0; node < b_.node_count(); ++node)
            if (!a_.find_node(b_.node_tag(node))) result_.nodes_added.push_back(b_.node_tag(node));
        std::sort(result_.nodes_removed.begin(), result_.nodes_removed.end());
        std::sort(result_.nodes_added.begin(), result_.nodes_added.end());
        result_.all = all.finish();
        result_.boundary = boundary.finish();
        result_.interior = interior.finish();
    }
    bool is_moved(Index node) const { return before_.coordinates().row(node) != after_.coordinates().row(twin_[node]); }
    void add(MotionSum& sum, Index node) const {
        sum.add(a_.node_tag(node), (before_.coordinates().row(node) - after_.coordinates().row(twin_[node])).norm(),
                is_moved(node));
    }

    void compare_elements() {
        for (Index element = 0; element < a_.element_count(); ++element) {
            const ElementTag tag = a_.element_tag(element);
            const auto found = b_.find_element(tag);
            if (!found) {
                result_.elements_removed.push_back(tag);
                continue;
            }
            if (a_.element_entity(element) != b_.element_entity(*found)) result_.elements_reclassified.push_back(tag);
            const auto its = a_.element_nodes(element), others = b_.element_nodes(*found);
            bool is_same = a_.element_type(element) == b_.element_type(*found), moves = false;
            for (std::size_t i = 0; i < its.size() && is_same; ++i) {
                is_same = a_.node_tag(its[i]) == b_.node_tag(others[i]);
                moves = moves || (is_same && is_moved(its[i]));
            }
            if (!is_same)
                result_.elements_reconnected.push_back(tag);
            else if (moves)
                result_.elements_moved.push_back(tag);
        }
        for (Index element = 0; element < b_.element_count(); ++element)
            if (!a_.find_element(b_.element_tag(element))) result_.elements_added.push_back(b_.element_tag(element));
        for (auto* list : {&result_.elements_removed, &result_.elements_reclassified, &result_.elements_reconnected,
                           &result_.elements_moved, &result_.elements_added})
            std::sort(list->begin(), list->end());
    }

    using LowerCell = std::tuple<ElementType, std::int64_t, int, std::vector<std::int64_t>>;
    static std::vector<LowerCell> lower_cells(const MeshTopology& topology) {
        std::vector<LowerCell> cells;
        for (const ElementBlock& block : topology.blocks()) {
            if (dimension(block.type.shape) >= topology.dimension()) continue;
            const auto per_cell = static_cast<std::size_t>(node_count(block.type));
            for (std::size_t i = 0; i < block.tags.size(); ++i) {
                std::vector<std::int64_t> nodes;
                for (std::size_t k = 0; k < per_cell; ++k)
                    nodes.push_back(topology.node_tag(block.nodes[i * per_cell + k]).value);
                cells.emplace_back(block.type, block.tags[i].value, block.entity_tag, std::move(nodes));
            }
        }
        std::sort(cells.begin(), cells.end());
        return cells;
    }
    void compare_lower_cells() {
        const std::vector<LowerCell> its = lower_cells(a_), others = lower_cells(b_);
        std::vector<LowerCell> only;
        std::set_difference(its.begin(), its.end(), others.begin(), others.end(), std::back_inserter(only));
        result_.lower_cells_removed = static_cast<Index>(only.size());
        only.clear();
        std::set_difference(others.begin(), others.end(), its.begin(), its.end(), std::back_inserter(only));
        result_.lower_cells_added = static_cast<Index>(only.size());
    }

    static std::set<std::string> group_names(const MeshTopology& topology) {
        std::set<std::string> names;
        for (const PhysicalGroup& group : topology.groups()) names.insert(MeshTopology::display_name(group));
        return names;
    }
    void compare_groups() {
        const std::set<std::string> its = group_names(a_), others = group_names(b_);
        for (const std::string& name : others)
            if (!its.contains(name)) result_.groups_added.push_back(name);
        for (const std::string& name : its) {
            if (!others.contains(name)) {
                result_.groups_removed.push_back(name);
                continue;
            }
            GroupMotion group{name, {}, 0, 0};
            std::vector<bool> is_in_b(static_cast<std::size_t>(b_.node_count()), false);
            const std::vector<Index> nodes_of_a = a_.find_group_nodes(name).value();
            const std::vector<Index> nodes_of_b = b_.find_group_nodes(name).value();
            for (const Index node : nodes_of_b) is_in_b[node] = true;
            MotionSum sum;
            for (const Index node : nodes_of_a) {
                if (twin_[node] >= 0 && is_in_b[twin_[node]])
                    add(sum, node);
                else
                    ++group.nodes_removed;
            }
            group.motion = sum.finish();
            group.nodes_added = static_cast<Index>(nodes_of_b.size()) - group.motion.nodes;
            result_.groups.push_back(std::move(group));
        }
    }

    void compare_quality(const TaskContext& context) {
        try {
            const QualityReport before = assess_quality(before_, {}, context);
            result_.quality_before = before.summary;
            QualityOptions options;
            options.orientation_sign = before.orientation_sign;
            const QualityReport after = assess_quality(after_, options, context);
            result_.quality_after = after.summary;
            compare_quality(before, after);
        } catch (const Unsupported&) {
            // There is no quality to be compared.
        }
    }
    void compare_quality(const QualityReport& before, const QualityReport& after) {
        double most = 0.0;
        for (Index element = 0; element < a_.element_count(); ++element) {
            const ElementTag tag = a_.element_tag(element);
            const auto found = b_.find_element(tag);
            if (!found) continue;
            const ElementQuality &was = before.elements[element], &is = after.elements[*found];
            if (was.validity == Validity::valid && is.validity == Validity::invalid)
                result_.became_invalid.push_back(tag);
            if (was.validity == Validity::invalid && is.validity == Validity::valid)
                result_.became_valid.push_back(tag);
            if (was.scaled_jacobian - is.scaled_jacobian > most) {
                most = was.scaled_jacobian - is.scaled_jacobian;
                result_.most_worsened = ElementQualityChange{tag, was.scaled_jacobian, is.scaled_jacobian};
            }
        }
        std::sort(result_.became_invalid.begin(), result_.became_invalid.end());
        std::sort(result_.became_valid.begin(), result_.became_valid.end());
    }

    const CurvedMesh &before_, &after_;
    const MeshTopology &a_, &b_;
    std::vector<Index> twin_;  ///< per node of A: the node of B with its tag, or -1
    MeshComparison result_;
};

}  // namespace

bool MeshComparison::is_structure_equal() const {
    bool is_equal = nodes_added.empty() && nodes_removed.empty() && elements_added.empty() &&
                    elements_removed.empty() && elements_reconnected.empty() && elements_reclassified.empty() &&
                    lower_cells_added == 0 && lower_cells_removed == 0 && groups_added.empty() &&
                    groups_removed.empty();
    for (const GroupMotion& group : groups) is_equal = is_equal && group.nodes_added == 0 && group.nodes_removed == 0;
    return is_equal;
}

double MeshComparison::relative_motion() const {
    return size > 0.0 ? all.max / size : all.max;
}

MeshComparison compare_meshes(const CurvedMesh& before, const CurvedMesh& after, const TaskContext& context) {
    return Comparison(before, after).run(context);
}

}  // namespace curvewright
