// The pipe whose sites hold any number of rest particles (variant P2, spec 3.4.4): a lattice gas of bit
// planes, and lists of the few sites where several rest.
#pragma once

#include "automata/gas.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata {

// Plane 6: sites where particles rest; those beyond the first are counted.
struct CountedPipe {
    GasLattice lattice;
    Column<std::uint16_t> beyond;  // [rows][columns]
    Column<std::uint64_t> several; // laid out as a plane: beyond > 0

    CountedPipe(std::int32_t columns, std::int32_t rows);
    [[nodiscard]] std::int64_t resting(std::int32_t x, std::int32_t y) const {
        return (lattice.get(6, x, y) ? 1 : 0) + beyond[site(x, y)];
    }
    void set_resting(std::int32_t x, std::int32_t y, std::int64_t count);
    [[nodiscard]] std::int64_t moving() const;
    [[nodiscard]] std::int64_t particles() const;

    [[nodiscard]] std::size_t site(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(lattice.columns) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] std::size_t word(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(lattice.stride) +
               static_cast<std::size_t>(x >> 6);
    }
};

class CountedStepper {
public:
    CountedStepper(const CountedPipe& pipe, const GasRules& rules, const Means& means);
    // Collision, gravity, hops of resting particles, propagation. Returns the number of sites that still have
    // several resting particles after the last round of hops.
    std::int64_t step(CountedPipe& pipe, std::uint32_t t);

private:
    using Sites = std::vector<std::uint64_t>; // x | y << 32

    // Sites of a tile of rows where several rest, and where particles hop to in the tiles below and above.
    struct Hops {
        Sites crowded, arrived, below, above;
        std::vector<std::uint64_t> directions;
    };

    void find_crowded(CountedPipe& pipe, std::size_t tile);
    void send(CountedPipe& pipe, std::size_t tile, std::uint32_t t, std::uint32_t round);
    void receive(CountedPipe& pipe, std::size_t tile);
    std::int64_t hop_apart(CountedPipe& pipe, std::uint32_t t);

    GasRules rules_;
    Means means_;
    GasStepper stepper_;
    Column<std::uint64_t> one_, two_, less_; // what collisions do to `beyond`
    std::vector<Hops> hops_;                 // by tile
};

} // namespace sandlane::automata
