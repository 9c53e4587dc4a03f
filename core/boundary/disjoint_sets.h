#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace curvewright {

/// Sets of 0 .. count - 1 that grow together (union-find). A set is known by its least member.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    int root(int i) {
        while (parent_[static_cast<std::size_t>(i)] != i)
            i = parent_[static_cast<std::size_t>(i)] =
                parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
        return i;
    }
    void join(int a, int b) {
        const int first = root(a), second = root(b);
        parent_[static_cast<std::size_t>(std::max(first, second))] = std::min(first, second);
    }
    /// Per member the number of its set, in the order of their first members; returns how many there are.
    int label(std::vector<int>& labels) {
        labels.assign(parent_.size(), -1);
        int count = 0;
        for (std::size_t i = 0; i < parent_.size(); ++i) {
            const auto first = static_cast<std::size_t>(root(static_cast<int>(i)));
            labels[i] = first == i ? count++ : labels[first];
        }
        return count;
    }

  private:
    std::vector<int> parent_;
};

}  // namespace curvewright
