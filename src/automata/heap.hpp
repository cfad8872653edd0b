// Heaps of grains with energy, dissipation and sticking (docs/automata.md 2), many at once.
#pragma once

#include "automata/model.hpp"
#include "core/rng.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sandlane::automata {

struct HeapRules {
    double retained = 0.5, sticking = 1.5, start_energy = 0, roughness = 0; // r, U, E_0, delta
    std::int64_t steepest = 0;                                              // s_max; 0: no avalanches
    bool two_sided = false;
    PhiloxKey seed{};
};

// One heap. Columns 0, 1, ... go outwards from the wall, or from the middle, whose column 0 both sides share.
class HeapTable {
public:
    HeapTable(std::int64_t columns, const HeapRules& rules);

    void drop(std::uint32_t grain);
    // side 0: right, 1: left.
    [[nodiscard]] std::int32_t height(int side, std::int64_t x) const { return heights_[place(side, x)]; }
    [[nodiscard]] std::int64_t lost() const { return lost_; }
    [[nodiscard]] std::int64_t released() const { return released_; } // by avalanches
    [[nodiscard]] std::vector<std::int32_t>& heights() { return heights_; }
    [[nodiscard]] const std::vector<std::int32_t>& heights() const { return heights_; }
    [[nodiscard]] const HeapRules& rules() const { return rules_; }
    [[nodiscard]] std::int64_t columns() const { return columns_; }
    void set_counts(std::int64_t lost, std::int64_t released) {
        lost_ = lost;
        released_ = released;
    }

private:
    [[nodiscard]] std::size_t place(int side, std::int64_t x) const {
        return static_cast<std::size_t>(side == 1 && x > 0 ? columns_ - 1 + x : x);
    }
    bool roll(int side, std::int64_t x, double energy, std::uint32_t grain);
    void avalanche(std::uint32_t grain);
    [[nodiscard]] double threshold(std::size_t place, std::uint32_t grain);
    [[nodiscard]] int steeper_side(std::uint32_t grain);

    std::int64_t columns_;
    HeapRules rules_;
    std::vector<std::int32_t> heights_; // right side, then columns 1, 2, ... of the left one
    std::vector<std::uint32_t> visits_; // of the present grain
    std::vector<std::size_t> visited_;
    std::uint32_t choices_ = 0;
    std::int64_t lost_ = 0, released_ = 0;
};

// Drops grains first, first + 1, ... on up to eight heaps of the same rules but for the seed, by kernels.
void drop_on_lanes(std::span<HeapTable> heaps, simd::Isa isa, std::uint32_t first, std::int64_t grains);

// The foot of a heap, x measured from it: h = a + b x + c ln(x + x0), by least squares, x0 from a grid.
struct TailFit {
    double a = 0, b = 0, c = 0, x0 = 0, error = 0; // error: root of the mean square
};
[[nodiscard]] TailFit fit_tail(std::span<const double> x, std::span<const double> h);

[[nodiscard]] std::unique_ptr<Model> make_heap(const scene::Scene& scene, const Means& means);

} // namespace sandlane::automata
