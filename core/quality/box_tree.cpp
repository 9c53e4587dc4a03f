#include "core/quality/box_tree.h"

#include <numeric>

namespace curvewright {
namespace {

constexpr int leaf_size = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (boxes_.empty()) return;
    nodes_.push_back({boxes_[0], -1, 0, static_cast<int>(boxes_.size())});
    std::vector<int> open{0};
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        build(node);
        if (nodes_[static_cast<std::size_t>(node)].left < 0) continue;
        open.push_back(nodes_[static_cast<std::size_t>(node)].left);
        open.push_back(nodes_[static_cast<std::size_t>(node)].left + 1);
    }
}

void BoxTree::build(int index) {
    const int begin = nodes_[static_cast<std::size_t>(index)].begin, end = nodes_[static_cast<std::size_t>(index)].end;
    const auto box_at = [&](int k) -> const Box& {
        return boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])];
    };
    Box all = box_at(begin);
    Eigen::Vector3d low = all.low + all.high, high = low;
    for (int k = begin; k < end; ++k) {
        const Box& box = box_at(k);
        all.low = all.low.cwiseMin(box.low);
        all.high = all.high.cwiseMax(box.high);
        low = low.cwiseMin(box.low + box.high);
        high = high.cwiseMax(box.low + box.high);
    }
    nodes_[static_cast<std::size_t>(index)].box = all;
    if (end - begin <= leaf_size) return;
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
        const Box &f = boxes_[static_cast<std::size_t>(a)], &g = boxes_[static_cast<std::size_t>(b)];
        return std::pair(f.low[axis] + f.high[axis], a) < std::pair(g.low[axis] + g.high[axis], b);
    });
    nodes_[static_cast<std::size_t>(index)].left = static_cast<int>(nodes_.size());
    nodes_.push_back({all, -1, begin, middle});
    nodes_.push_back({all, -1, middle, end});
}

}  // namespace curvewright
