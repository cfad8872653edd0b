// Grains in square or cubic cells: neighbour search for start states. Plain and serial; the engines have
// their own.
#pragma once

#include "core/vec.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandlane::scene {

// The domain as a metric space: minimum image across periodic sides. In a plane z is 0. With a seam (Lees and
// Edwards) the image beyond the upper y side stands `seam` further along x.
struct Box {
    std::int64_t dimension;
    Vec lower, upper;
    std::array<bool, 3> periodic;
    double seam = 0; // m

    explicit Box(const Domain& domain)
        : dimension(domain.dimension), lower(domain.lower), upper(domain.upper), periodic(domain.periodic) {}

    [[nodiscard]] Vec size() const { return upper - lower; }
    // From a to b.
    [[nodiscard]] Vec separation(Vec a, Vec b) const {
        Vec d = b - a;
        d.x -= seam * crossings(a, b);
        if (periodic[0]) d.x -= size().x * std::nearbyint(d.x / size().x);
        if (periodic[1]) d.y -= size().y * std::nearbyint(d.y / size().y);
        if (periodic[2]) d.z -= size().z * std::nearbyint(d.z / size().z);
        return d;
    }
    // How many periods along y the nearest image of b stands below b, seen from a.
    [[nodiscard]] double crossings(Vec a, Vec b) const {
        return periodic[1] ? std::nearbyint((b.y - a.y) / size().y) : 0.0;
    }
    // Into [lower, upper) along periodic sides.
    [[nodiscard]] Vec wrapped(Vec p) const {
        if (periodic[1]) p.x -= seam * std::floor((p.y - lower.y) / size().y);
        if (periodic[0]) p.x = wrap(p.x, lower.x, upper.x);
        if (periodic[1]) p.y = wrap(p.y, lower.y, upper.y);
        if (periodic[2]) p.z = wrap(p.z, lower.z, upper.z);
        return p;
    }

private:
    static double wrap(double x, double low, double high) {
        x -= (high - low) * std::floor((x - low) / (high - low));
        return x < high ? x : low; // rounding may land on the upper side
    }
};

class CellGrid {
public:
    // Finds every pair of points closer than `reach`.
    CellGrid(const Box& box, double reach, std::size_t points) : box_(box) {
        next_.reserve(points);
        // Far more cells than points cost memory and find nothing.
        const double n = static_cast<double>(points);
        const double most = 2 + 2 * (box.dimension == 3 ? std::cbrt(n) : std::sqrt(n));
        const auto cells = [&](double length) {
            return static_cast<std::int64_t>(std::clamp(std::floor(length / reach), 1.0, most));
        };
        columns_ = cells(box.size().x);
        rows_ = cells(box.size().y);
        if (box.dimension == 3) layers_ = cells(box.size().z);
        head_.assign(static_cast<std::size_t>(columns_ * rows_ * layers_), -1);
    }

    // Points are numbered in the order of insertion.
    void insert(Vec p) {
        std::int64_t& head = head_[cell(column(p), row(p), layer(p))];
        next_.push_back(head);
        head = static_cast<std::int64_t>(next_.size()) - 1;
    }

    // Calls body(number) for the points of the cell of p and of the cells around it, each once.
    template <class Body> void for_near(Vec p, const Body& body) const { for_cells(p, 1, 1, 1, body); }

    // Calls body(number) once for every point closer than `reach` to p, and for others.
    template <class Body> void for_within(Vec p, double reach, const Body& body) const {
        const auto cells = [&](std::int64_t count, double length) {
            // A reach of just the width of a cell is not to be rounded to two.
            const double most = std::ceil((1 - 1e-12) * reach * static_cast<double>(count) / length);
            return static_cast<std::int64_t>(std::clamp(most, 1.0, static_cast<double>(count)));
        };
        const Vec size = box_.size();
        for_cells(p, cells(columns_, size.x), cells(rows_, size.y), layers_ == 1 ? 1 : cells(layers_, size.z),
                  body);
    }

private:
    // Up to so many cells away along each axis. Across a seam columns are not neighbours any more: whole rows
    // are looked at.
    template <class Body>
    void for_cells(Vec p, std::int64_t across, std::int64_t up, std::int64_t deep, const Body& body) const {
        const std::int64_t own_row = row(p);
        const bool beside_seam = box_.seam != 0 && (own_row < up || own_row >= rows_ - up);
        const auto [left, width] =
            beside_seam ? Span{0, columns_} : span(column(p), across, columns_, box_.periodic[0]);
        const auto [bottom, height] = span(own_row, up, rows_, box_.periodic[1]);
        const auto [front, depth] = span(layer(p), deep, layers_, box_.periodic[2]);
        for (std::int64_t l = front; l < front + depth; ++l)
            for (std::int64_t r = bottom; r < bottom + height; ++r)
                for (std::int64_t c = left; c < left + width; ++c)
                    for (std::int64_t n = head_[wrapped_cell(c, r, l)]; n >= 0;
                         n = next_[static_cast<std::size_t>(n)])
                        body(static_cast<std::size_t>(n));
    }

    struct Span {
        std::int64_t first, count;
    };
    static Span span(std::int64_t at, std::int64_t away, std::int64_t cells, bool periodic) {
        if (periodic) return cells < 2 * away + 1 ? Span{0, cells} : Span{at - away + cells, 2 * away + 1};
        const std::int64_t first = std::max<std::int64_t>(at - away, 0);
        return {first, std::min(at + away, cells - 1) - first + 1};
    }
    [[nodiscard]] std::size_t cell(std::int64_t c, std::int64_t r, std::int64_t l) const {
        return static_cast<std::size_t>((l * rows_ + r) * columns_ + c);
    }
    [[nodiscard]] std::size_t wrapped_cell(std::int64_t c, std::int64_t r, std::int64_t l) const {
        return cell(c % columns_, r % rows_, layers_ == 1 ? 0 : l % layers_);
    }
    // Points outside an open box count to its outermost cells, which keeps neighbours together.
    static std::int64_t index(double x, double low, double high, std::int64_t cells) {
        const double at = std::floor((x - low) / (high - low) * static_cast<double>(cells));
        return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(cells - 1)));
    }
    [[nodiscard]] std::int64_t column(Vec p) const {
        return index(box_.wrapped(p).x, box_.lower.x, box_.upper.x, columns_);
    }
    [[nodiscard]] std::int64_t row(Vec p) const {
        return index(box_.wrapped(p).y, box_.lower.y, box_.upper.y, rows_);
    }
    [[nodiscard]] std::int64_t layer(Vec p) const {
        return layers_ == 1 ? 0 : index(box_.wrapped(p).z, box_.lower.z, box_.upper.z, layers_);
    }

    Box box_;
    std::int64_t columns_ = 1, rows_ = 1, layers_ = 1;
    std::vector<std::int64_t> head_, next_;
};

} // namespace sandlane::scene
