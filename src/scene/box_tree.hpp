// Bounding boxes in a binary tree: which of many things are near a point. The same tree for the same boxes.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::scene {

struct Bounds {
    Vec lower, upper;

    [[nodiscard]] Vec centre() const { return 0.5 * (lower + upper); }
    void include(const Bounds& other);
    // Square of the distance of p from the box, 0 inside.
    [[nodiscard]] double distance2(Vec p) const;
};

class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<Bounds>& boxes);

    // Calls body(n) for the boxes closer than `reach` to p, in no particular order.
    template <class Body> void for_near(Vec p, double reach, const Body& body) const {
        if (!nodes_.empty()) visit(0, p, reach * reach, body);
    }

private:
    // A leaf holds entries [begin, end) of order_; else its children are the next node and `right`.
    struct Node {
        Bounds bounds;
        std::uint32_t begin = 0, end = 0, right = 0;
    };

    std::uint32_t build(const std::vector<Bounds>& boxes, std::uint32_t begin, std::uint32_t end);
    template <class Body> void visit(std::uint32_t n, Vec p, double reach2, const Body& body) const {
        const Node& node = nodes_[n];
        if (!(node.bounds.distance2(p) < reach2)) return;
        for (std::uint32_t k = node.begin; k < node.end; ++k)
            if (boxes_[k].distance2(p) < reach2) body(order_[k]);
        if (node.right == 0) return;
        visit(n + 1, p, reach2, body);
        visit(node.right, p, reach2, body);
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Bounds> boxes_; // in that order
};

} // namespace sandlane::scene
