// The identity of the group of recurrent sandpiles of large lattices, from that of half the size
// (docs/automata.md 1).
//
// Every state Delta w, w a whole number per site, is equivalent to the empty one (Delta: the toppling
// matrix); the only recurrent one of them is the identity. The w of half the lattice, stretched, gives a
// state that is the identity but for small scales. Adding the burning state beta = Delta 1, one grain per
// open side, until that changes nothing, makes it recurrent: the identity, exactly.
#pragma once

#include "automata/sandpile.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata {

// Delta w.
[[nodiscard]] std::vector<std::int32_t> toppling_matrix(const Potential& potential);

// A potential on a lattice of about twice the size, times the square of the ratio; zero if it is empty.
[[nodiscard]] Potential stretched(const Potential& coarse, std::int32_t columns, std::int32_t rows,
                                  int threads);

// Delta w >= 0 is made of it by toppling backwards where it is negative.
class IdentitySearch {
public:
    IdentitySearch(Potential guess, const Means& means, bool active_tiles);

    // One sweep; false when the state is the identity.
    bool sweep();
    [[nodiscard]] const PileLattice& lattice() const { return lattice_; }
    [[nodiscard]] std::uint64_t topplings() const { return topplings_; }
    [[nodiscard]] std::int64_t burned() const { return burned_; } // times that beta was added
    [[nodiscard]] double visited() const { return sweeper_.visited(); }
    // w of the present state.
    [[nodiscard]] Potential potential();

private:
    void burn();
    void collect_odometer();

    Potential guess_;
    PileLattice lattice_;
    PileSweeper sweeper_;
    Column<std::uint8_t> odometer_, before_; // topplings since collected, heights before beta was added
    int uncollected_ = 0;                    // sweeps
    std::int64_t burned_ = 0, round_ = 1, rounds_ = 0;
    std::uint64_t topplings_ = 0;
    bool burning_ = false;
};

} // namespace sandlane::automata
