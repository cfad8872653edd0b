// The door between src/dsmc and simd/dsmc: what the kernels of direct simulation Monte Carlo read and write,
// and one table of them per instruction set. The reference is src/dsmc/reference.
#pragma once

#include "laws/cell_number.hpp"
#include "laws/collision.hpp"
#include "laws/restitution_models.hpp"
#include "simd/tables.hpp"

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

// Particles are rows of four doubles in two or three arrays:
//   place:    x, y, z, and a word: identity in its lower half, number of the cell in its upper half
//   velocity: vx, vy, vz, and a word: images crossed in x, y, z, 20 bits each from the lowest, then the kind
//   spin:     wx, wy, wz, unused; rough particles only
// In the plane z, vz, wx and wy are zero.
inline constexpr int gas_row = 4;
struct GasRows {
    double *place, *velocity, *spin; // spin: null for smooth particles
};

// What pairs of a mixture do, by the kinds of both, 16 first + second.
inline constexpr int most_kinds = 16;
struct GasMixture {
    static constexpr int pairs = most_kinds * most_kinds;
    double section[pairs];     // cross-section over the largest one
    double contact[pairs];     // s_i s_j/(s_i + s_j), m
    double share[pairs];       // m_j/(m_i + m_j): of the change of the relative velocity, what i gets
    double coefficient[pairs]; // of laws::restitution_of_pair
    double radius[most_kinds];
    double largest_contact;
    // Enskog: what a particle adds to x_{d-1} [1/m] and x_d of its cell (laws::contact_of_pair); 0: dilute.
    bool dense;
    double lower_moment[most_kinds], upper_moment[most_kinds];
};

// Tags of the uses of random numbers: the lowest 8 bits of the last word of the counter.
enum class GasStream : std::uint32_t {
    rounding = 0,  // of the number of candidates: (0, cell, step)
    candidate = 1, // (k, cell, step)
    geometry = 2,  // of candidate k
    kick = 3,      // of the thermostat: (block, id, step)
    wall = 4,      // (4 hit + block, id, step)
    start = 5,     // (block, id, 0)
    partner = 6,   // of candidate k, more that are looked at
};

// Key and step of random numbers; steps have 56 bits, the upper 24 stand beside the stream.
struct GasRandom {
    std::uint32_t key[2];
    std::uint32_t step, step_high;

    [[nodiscard]] std::uint32_t last_word(GasStream stream) const {
        return step_high << 8 | static_cast<std::uint32_t>(stream);
    }
};

// ---- sorting: the cells of a tile, numbered through from first_cell

// Rows in the order that particles of one cell keep.
struct GasSegment {
    const double *place, *velocity, *spin;
    std::int32_t count;
    // Of all rows only those that go to this tile.
    bool mixed;
};
struct SortView {
    const GasSegment* segments;
    std::int32_t segment_count;
    std::int32_t first_cell, cells;
    std::int32_t* start;   // [cells + 1], of the sorted rows
    std::int32_t* next[2]; // room for a number of each cell
    GasRows to;
};
// Counting sort, stable; returns the number of rows.
using GasSort = std::int32_t (*)(const SortView&);

// ---- collisions

// What became of a candidate, for those who compare runs.
struct GasDecision {
    std::uint32_t cell, candidate;
    std::uint32_t first, second; // identities of the pair
    bool accepted;
};
struct GasListener {
    void (*hear)(void* to, const GasDecision&) = nullptr; // null: nobody listens
    void* to = nullptr;
};

inline constexpr int gas_lists = 8;
struct GasCollisionView {
    GasRows rows; // sorted; eight more rows of velocity and spin may be read
    const std::int32_t* start;
    std::int32_t first_cell, cells;
    double* list[gas_lists]; // room for cells + 16 numbers each
    laws::CollisionScheme scheme;
    // F S dt/(2 V): mean number of candidates = rate N (N - 1) g_max; S = pi s^2 or 2 s, the largest one.
    double rate;
    double maxwell; // candidates per particle, all of which collide; 0: as `rate` says
    double margin;  // of the majorant over the diagonal of the extent of the velocities
    // Enskog: packing fraction that one particle makes in its cell; 0: dilute. A pair sees that of the other
    // N - 2: their mean is that of the gas, as the mean of N (N - 1) is its density squared.
    double packing;
    laws::Restitution restitution;
    // Rough particles: eps_t, m_t/m_eff = q/(1 + q), radius, q, and friction (0: none) that bounds eps_t.
    double tangential, mass_ratio, radius, inertia, friction;
    const GasMixture* mixture; // null: all particles are equal
    // Of so many partners drawn at random, up to most_partners, the nearest one is taken; distances are those
    // along directions with more than one cell, 1 against 0.
    std::int32_t partners;
    double near_axis[3];
    GasRandom random;
    GasListener listener;
};
inline constexpr std::int32_t most_partners = 5;
inline constexpr double most_candidates = 1e6; // of a cell in a step
struct GasCollisions {
    std::int64_t candidates = 0, collisions = 0;
    std::int64_t violations = 0; // candidates faster than the majorant
    std::int64_t overflows = 0;  // cells left alone because they wanted too many candidates
};
using GasCollide = GasCollisions (*)(const GasCollisionView&);

// ---- free flight

struct GasWalls; // src/dsmc/walls.hpp

struct GasFlightView {
    GasRows from;
    std::int32_t count;
    // Sorted rows: first the flight after the collisions, then the one before the next; 0: none.
    double durations[2];
    double gravity[3];
    bool falls;
    // Particles that start and end between these see no wall and no periodic side.
    double safe_lower[3], safe_upper[3];
    laws::CellAxis axis[3]; // the numbers of the directions add up
    // Cells of this tile. Rows that stay go to `stay`, those that leave to `leave`, in order.
    std::int32_t first_cell, cells;
    bool sort; // false: no cells are wanted, all stay
    GasRows stay, leave;
    // Kicks of the thermostat before the flight: standard deviation of each component, or 0.
    double kick;
    // Of the kinds over that of the first, by which squares of velocities count; null: all count alike.
    const double* mass;
    GasRandom random;
    const GasWalls* walls;
};
struct GasFlight {
    std::int32_t stay = 0, leave = 0;
    std::int64_t stuck = 0;     // particles that hit walls more than 64 times in one flight
    double square_sum = 0;      // of the velocities by mass, (m/s)^2, before the flight
    double wall_energy[2] = {}; // that walls gave in either flight, per mass
};
using GasFly = GasFlight (*)(const GasFlightView&);

// One particle at walls and periodic sides, for a duration; second: the flight before the next collisions.
// The same for every instruction set (src/dsmc/walls.cpp).
void fly_to_walls(const GasFlightView& view, double* place, double* velocity, double* spin, bool second,
                  GasFlight& result);

struct DsmcKernels {
    GasSort sort;
    GasCollide collide[2][2][2]; // [space][rough][mixture]
    GasFly fly[2];               // [space]
};
[[nodiscard]] const DsmcKernels& dsmc_kernels(Isa isa);

} // namespace sandlane::simd
