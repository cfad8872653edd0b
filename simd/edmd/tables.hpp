// The door between src/edmd and simd/edmd: particles of event-driven dynamics in memory, and the search of
// the next contacts of one of them, one table of functions per instruction set. The reference is
// src/edmd/reference.
#pragma once

#include "core/real.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <limits>

namespace sandlane::simd {

inline constexpr double never_meets = std::numeric_limits<double>::infinity();

// What the flight of a particle is known by, in one line of the cache: place and velocity at `time`, which
// stay as they are until its next event. In the plane the third components are zero. word: faces of the box
// crossed since the place was folded into it, 16 bits for each direction from the lowest, plus image_zero;
// the class of the particle in the upper 16.
struct HardState {
    double place[3], velocity[3]; // m, m/s
    double time;                  // s
    std::uint64_t word;
};
inline constexpr std::uint64_t image_zero = 0x4000, image_mask = 0xffff;
inline constexpr std::int64_t most_images = 0x1fff; // of a particle between two events
[[nodiscard]] SANDLANE_INLINE std::int64_t image_of(const HardState& s, int d) {
    return static_cast<std::int64_t>((s.word >> 16 * d) & image_mask) - static_cast<std::int64_t>(image_zero);
}

// What a particle does next.
struct HardEvents {
    // The first two contacts found since the last complete search, the earlier first.
    double first_time, second_time;
    double crossing_time; // of a face of its cell
    std::uint32_t first, second;
    std::uint32_t bucket; // of the queue
    std::uint32_t id;
    std::uint32_t last; // partner of the last change of velocity
    std::uint32_t hits; // of heated walls
    double last_time;   // of the last change of velocity
    std::uint16_t cell[3];
    std::uint8_t crossing; // 2 axis + 1 upwards
    std::uint8_t missed;   // contacts were found that found no place in the two above
};
// A line of the cache each: columns begin with one.
static_assert(sizeof(HardState) == 64 && sizeof(HardEvents) == 64);

// Three numbers of particles, 0 where there are fewer, and the way to more of them. meta: how many, and
// cell_slots + 1 times the number of the next one; 0: none.
inline constexpr std::uint32_t cell_slots = 3;
struct HardCell {
    std::uint32_t particle[cell_slots];
    std::uint32_t meta;

    [[nodiscard]] std::uint32_t size() const { return meta % (cell_slots + 1); }
    [[nodiscard]] std::uint32_t next() const { return meta / (cell_slots + 1); }
    void link(std::uint32_t to) { meta = size() + to * (cell_slots + 1); }
};

// Partners that are none.
inline constexpr std::uint32_t no_partner = 0xffffffff;
inline constexpr std::uint32_t first_wall = 0xffffff00; // + side, 2 axis + upper; then curved ones
[[nodiscard]] constexpr bool is_wall(std::uint32_t partner) {
    return partner >= first_wall;
}

struct HardSearch {
    const HardState* state;
    const HardEvents* events;
    const HardCell* cells;
    std::int32_t count[3]; // cells
    bool periodic[3];
    double length[3];     // of periodic directions, else 0
    const double* radius; // of the classes
    double gravity[3];
    double scale, growth; // of the radii
    // Of a sheared gas: the box above is offset + speed t further along x, by so many whole cells now.
    double offset, speed;
    std::int64_t columns;
};

// Columns that a cell may touch in a row beyond a side of a sheared gas, which stands `columns` cells and a
// part of one further along x: from this one to that, as seen from its own.
struct FacingColumns {
    std::int64_t from, to;
};
[[nodiscard]] SANDLANE_INLINE FacingColumns facing_columns(const HardSearch& view, std::int64_t up) {
    return up > 0 ? FacingColumns{-2 - view.columns, 1 - view.columns}
                  : FacingColumns{-1 + view.columns, 2 + view.columns};
}
// Of a box so many columns wide: which box a column is in.
[[nodiscard]] SANDLANE_INLINE std::int64_t box_of(std::int64_t column, std::int64_t count) {
    return column >= 0 ? column / count : -((count - 1 - column) / count);
}

struct HardFound {
    double first_time, second_time;
    std::uint32_t first, second;
    bool missed;
};

// Contacts of particle i with those of its own cell and the cells around it (layer < 0), or of the cells that
// are new to it after it came through face `layer` = 2 axis + upwards. Adds to `found`; does not see
// `excluded`.
using HardSearchNear = void (*)(const HardSearch&, std::uint32_t i, int layer, std::uint32_t excluded,
                                HardFound& found);

struct EdmdKernels {
    HardSearchNear plain[2];   // [space] particles of one radius, without gravity
    HardSearchNear general[2]; // [space]
    HardSearchNear growing[2]; // [space] radii grow; without gravity
    HardSearchNear sheared[2]; // [space] boxes above and below glide along x; without gravity
};
[[nodiscard]] const EdmdKernels& edmd_kernels(Isa isa);

// Puts a contact into the list; ties go by identity.
inline void add_contact(HardFound& f, double time, std::uint32_t j, const HardEvents* events) {
    if (j == f.first && time == f.first_time) return; // seen before
    const auto before = [&](double t, std::uint32_t other) {
        if (time != t) return time < t;
        if (is_wall(other) || is_wall(j)) return is_wall(j) && (!is_wall(other) || j < other);
        return events[j].id < events[other].id;
    };
    // With one contact left of a list that missed some, those come before any that is later than the one
    // left.
    const bool closed = f.missed && f.second == no_partner && f.first != no_partner;
    if (!before(f.second_time, f.second) || (closed && !before(f.first_time, f.first))) {
        f.missed = true;
        return;
    }
    if (f.second != no_partner) f.missed = true;
    if (before(f.first_time, f.first)) {
        f.second_time = f.first_time;
        f.second = f.first;
        f.first_time = time;
        f.first = j;
    } else {
        f.second_time = time;
        f.second = j;
    }
}

} // namespace sandlane::simd
