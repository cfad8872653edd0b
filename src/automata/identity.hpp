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

    // What took place, one or two sweeps: those without a toppling are not counted.
    struct Progress {
        std::int64_t sweeps = 0;
        std::uint64_t topplings = 0;
    };
    // At most so many sweeps, at least 1. Nothing is done once the search is finished.
    Progress sweep(std::int64_t most);
    [[nodiscard]] bool finished() const { return finished_; } // the state is the identity
    [[nodiscard]] const PileLattice& lattice() const { return lattice_; }
    // w of the present state.
    [[nodiscard]] Potential potential() const;

    // All but the potential, for a search that is made of it anew.
    void save(ByteWriter& bytes) const;
    void load(ByteReader& bytes);

private:
    void go_on();
    void burn();
    void collect_odometer();

    Potential guess_; // w of the present state, without the topplings in the odometer and beta
    PileLattice lattice_;
    PileSweeper sweeper_;
    Column<std::uint8_t> odometer_, before_; // topplings since collected, heights before beta was added
    int uncollected_ = 0;                    // sweeps
    std::int64_t burned_ = 0, round_ = 1, rounds_ = 0;
    bool burning_ = false, finished_ = false;
};

} // namespace sandlane::automata
