#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "core/io/mesh_entities.h"

namespace curvewright {

/// Gathers the elements of an MSH 2 file, where each line names a physical group and an elementary entity, into blocks
/// and entities. An element that stands there once per group (Gmsh writes them so, with tags of their own) becomes one;
/// an elementary entity whose elements are of different groups is split.
class Msh2Elements {
  public:
    enum class Outcome { added, merged, conflict };

    /// physical 0 = none, elementary 0 = none; nodes in this program's order. Conflict: the tag was used for another
    /// element of the same dimension, or for the same one in the same group.
    Outcome add(ElementType type, ElementTag tag, int physical, int elementary, const std::vector<Index>& nodes) {
        const int dim = dimension(type.shape);
        highest_[dim] = std::max(highest_[dim], elementary);
        const auto [twin, is_new] = rows_by_tag_[dim].try_emplace(tag, rows_.size());
        if (!is_new) {
            Row& row = rows_[twin->second];
            const bool is_same = row.type == type && row.elementary == elementary &&
                                 std::equal(nodes.begin(), nodes.end(), nodes_of(row));
            const auto& present = sets_[row.physicals];
            if (!is_same || physical == 0 || std::find(present.begin(), present.end(), physical) != present.end())
                return Outcome::conflict;
            row.physicals = extended(row.physicals, physical);
            return Outcome::merged;
        }
        rows_.push_back({type, tag, elementary, set_of(physical), nodes_.size()});
        nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
        return Outcome::added;
    }

    /// Number of elements that stood under several tags, once per group, and were joined.
    std::size_t join_copies() {
        std::map<EntityKey, std::set<std::size_t>> sets_on;
        for (const Row& row : rows_) sets_on[key_of(row)].insert(row.physicals);
        std::map<std::pair<EntityKey, std::vector<Index>>, std::size_t> first;
        std::vector<Row> kept;
        for (const Row& row : rows_) {
            if (sets_on[key_of(row)].size() > 1) {
                const std::vector<Index> nodes(nodes_of(row), nodes_of(row) + node_count(row.type));
                const auto [found, is_new] = first.try_emplace({key_of(row), nodes}, kept.size());
                if (!is_new && kept[found->second].physicals != row.physicals) {
                    for (const int physical : sets_[row.physicals])
                        kept[found->second].physicals = extended(kept[found->second].physicals, physical);
                    continue;
                }
            }
            kept.push_back(row);
        }
        const std::size_t joined = rows_.size() - kept.size();
        rows_ = std::move(kept);
        return joined;
    }

    /// Appends blocks and entities (with physical tags, without boxes). Returns the number of entities that were split.
    std::size_t move_to(MeshData& data) {
        std::map<std::pair<EntityKey, std::size_t>, int> tags;
        std::set<EntityKey> used, split;
        for (const Row& row : rows_) {
            const EntityKey key = key_of(row);
            const auto [place, is_new] = tags.try_emplace({key, row.physicals}, row.elementary);
            if (is_new && (row.elementary != 0 || !sets_[row.physicals].empty())) {
                const bool is_taken = !used.insert(key).second;
                if (is_taken) split.insert(key);
                if (is_taken || row.elementary == 0) place->second = ++highest_[key.first];
                data.entities.push_back({key.first, place->second, sets_[row.physicals], {}, {}});
            }
            ElementBlock& block = block_for(data.blocks, row.type, place->second);
            block.tags.push_back(row.tag);
            block.nodes.insert(block.nodes.end(), nodes_of(row), nodes_of(row) + node_count(row.type));
        }
        return split.size();
    }

  private:
    struct Row {
        ElementType type;
        ElementTag tag;
        int elementary = 0;
        std::size_t physicals = 0;  ///< position in sets_
        std::size_t first_node = 0;
    };

    static EntityKey key_of(const Row& row) { return {dimension(row.type.shape), row.elementary}; }
    std::vector<Index>::const_iterator nodes_of(const Row& row) const {
        return nodes_.begin() + static_cast<std::ptrdiff_t>(row.first_node);
    }
    std::size_t intern(const std::vector<int>& set) {
        const auto [place, is_new] = set_places_.try_emplace(set, sets_.size());
        if (is_new) sets_.push_back(set);
        return place->second;
    }
    std::size_t set_of(int physical) { return intern(physical == 0 ? std::vector<int>{} : std::vector<int>{physical}); }
    std::size_t extended(std::size_t set, int physical) {
        std::vector<int> result = sets_[set];
        if (std::find(result.begin(), result.end(), physical) == result.end()) result.push_back(physical);
        return intern(result);
    }

    std::vector<Row> rows_;
    std::vector<Index> nodes_;
    std::vector<std::vector<int>> sets_;  ///< each set of physical tags once, in the order of the file
    std::map<std::vector<int>, std::size_t> set_places_;
    std::array<std::unordered_map<ElementTag, std::size_t>, 4> rows_by_tag_;
    std::array<int, 4> highest_{};  ///< per dimension: highest elementary tag
};

}  // namespace curvewright
