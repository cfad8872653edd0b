#include "scene/box_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sandlane::scene {

namespace {

constexpr std::uint32_t leaf_size = 4;

double outside(double x, double lower, double upper) {
    return std::max({lower - x, x - upper, 0.0});
}

} // namespace

void Bounds::include(const Bounds& other) {
    lower = {std::min(lower.x, other.lower.x), std::min(lower.y, other.lower.y),
             std::min(lower.z, other.lower.z)};
    upper = {std::max(upper.x, other.upper.x), std::max(upper.y, other.upper.y),
             std::max(upper.z, other.upper.z)};
}

double Bounds::distance2(Vec p) const {
    const Vec d{outside(p.x, lower.x, upper.x), outside(p.y, lower.y, upper.y),
                outside(p.z, lower.z, upper.z)};
    return dot(d, d);
}

BoxTree::BoxTree(const std::vector<Bounds>& boxes) : order_(boxes.size()) {
    if (boxes.empty()) return;
    std::iota(order_.begin(), order_.end(), 0U);
    build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
    boxes_.reserve(boxes.size());
    for (const std::uint32_t n : order_) boxes_.push_back(boxes[n]);
}

// Halves along the longest side of the bounds.
std::uint32_t BoxTree::build(const std::vector<Bounds>& boxes, std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    node.bounds = boxes[order_[begin]];
    for (std::uint32_t k = begin; k < end; ++k) node.bounds.include(boxes[order_[k]]);
    nodes_.push_back(node);
    if (end - begin <= leaf_size) {
        nodes_[index].begin = begin;
        nodes_[index].end = end;
        return index;
    }
    const Vec size = node.bounds.upper - node.bounds.lower;
    const auto axis = size.x >= size.y && size.x >= size.z ? &Vec::x : size.y >= size.z ? &Vec::y : &Vec::z;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(boxes[a].centre().*axis, a) < std::pair(boxes[b].centre().*axis, b);
                     });
    build(boxes, begin, middle);
    const std::uint32_t right = build(boxes, middle, end);
    nodes_[index].right = right;
    return index;
}

} // namespace sandlane::scene
