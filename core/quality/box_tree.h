#pragma once

#include <algorithm>
#include <vector>

#include "core/quality/facet_form.h"

namespace curvewright {

/// A binary tree of boxes, for finding those that something touches.
class BoxTree {
  public:
    explicit BoxTree(std::vector<Box> boxes);

    /// Calls visit(i) for boxes i whose box, and those of all groups that it is in, hits(box) holds for. In an order
    /// that depends on the boxes only.
    template <class Hits, class Visit>
    void visit(const Hits& hits, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::vector<int> stack{0};
        while (!stack.empty()) {
            const Node& node = nodes_[static_cast<std::size_t>(stack.back())];
            stack.pop_back();
            if (!hits(node.box)) continue;
            if (node.left < 0) {
                for (int k = node.begin; k < node.end; ++k)
                    if (hits(boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])]))
                        visit(order_[static_cast<std::size_t>(k)]);
                continue;
            }
            stack.push_back(node.left + 1);
            stack.push_back(node.left);
        }
    }

  private:
    struct Node {
        Box box;
        int left = -1;  ///< the right one follows; -1: a leaf
        int begin = 0, end = 0;
    };
    void build(int node);

    std::vector<Box> boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace curvewright
