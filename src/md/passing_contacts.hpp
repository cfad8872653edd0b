// What becomes of the memory of a contact that passes from one piece of a wall to the next: from triangle to
// triangle in space, along a polyline in the plane (docs/physics.md 6).
#pragma once

#include "md/records.hpp"
#include "md/walls.hpp"

#include <algorithm>

namespace sandlane::md {

// Candidates of one grain, by element, and what their contacts remember: number f of candidate n at
// memory[f * stride + n].
struct WallCandidates {
    const NearWall *begin, *end;
    double* memory;
    std::ptrdiff_t stride;

    [[nodiscard]] double* of(std::uint32_t element) const {
        const NearWall* n = std::lower_bound(
            begin, end, element, [](const NearWall& near, std::uint32_t e) { return near.element < e; });
        return memory + (n - begin);
    }
    void forget(double* contact, int fields) const {
        for (int f = 0; f < fields; ++f) contact[f * stride] = laws::no_contact;
    }
};

inline bool remembers(const double* memory) {
    return *memory < 0.5 * laws::no_contact;
}

// A contact moves less than this within a step, in units of the grain's radius: what begins farther from one
// that ended is new.
inline constexpr double passage = 0.25;

// The contact that begins on `element` at `point` goes on as the one on a piece of the same wall that the
// grain does not touch any more and that ends nearest to it. touches(element): whether the grain does.
template <class Touches>
void take_over(const Walls& walls, const RecordedGrain& g, const WallCandidates& candidates,
               std::uint32_t element, Vec point, const Touches& touches) {
    double nearest = passage * g.radius;
    double* old = nullptr;
    for (const NearWall* n = candidates.begin; n != candidates.end; ++n) {
        double* const other = candidates.memory + (n - candidates.begin);
        if (!remembers(other) || !walls.of_one_surface(n->element, element) || touches(n->element)) continue;
        const double distance = norm(walls.closest_point(n->element, g.position) - point);
        if (distance >= nearest) continue;
        nearest = distance;
        old = other;
    }
    if (old == nullptr) return;
    double* const own = candidates.of(element);
    for (int f = 0; f < walls.fields(); ++f) own[f * candidates.stride] = old[f * candidates.stride];
    candidates.forget(old, walls.fields());
}

template <class Touches>
void forget_ended(const Walls& walls, const WallCandidates& candidates, const Touches& touches) {
    for (const NearWall* n = candidates.begin; n != candidates.end; ++n) {
        double* const contact = candidates.memory + (n - candidates.begin);
        if (remembers(contact) && !touches(n->element)) candidates.forget(contact, walls.fields());
    }
}

} // namespace sandlane::md
