// Hard discs and spheres once more, in long double and as simply as can be: every pair, every image and every
// wall after every event, all particles flown to it. What event-driven dynamics is compared with.
#pragma once

#include "edmd/algorithm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sandlane::bench {

using Long = long double;
using LongVector = std::array<Long, 3>;

struct LongParticle {
    LongVector place{}, velocity{};
    Long time = 0; // that the place belongs to
};

// What comes next: two particles, or one and wall 2 axis + upper.
struct LongEvent {
    Long time = std::numeric_limits<Long>::infinity();
    bool pair = false;
    std::size_t first = 0, second = 0;
    LongVector apart{}; // from second to first at the contact
};

// Elastic or constant restitution, one class of smooth particles, reflecting walls, gravity.
class HardReference {
public:
    HardReference(const edmd::Setup& setup, std::vector<LongParticle> particles)
        : setup_(setup), particles_(std::move(particles)) {}

    [[nodiscard]] LongEvent next() const {
        LongEvent first;
        for (std::size_t i = 0; i < particles_.size(); ++i) {
            for (std::size_t j = i + 1; j < particles_.size(); ++j) look_at_pair(i, j, first);
            for (int wall = 0; wall < 2 * setup_.dimension; ++wall) look_at_wall(i, wall, first);
        }
        return first;
    }

    void execute(const LongEvent& e) {
        for (LongParticle& p : particles_) fly(p, e.time);
        LongVector& v = particles_[e.first].velocity;
        const Long bounce = 1 + static_cast<Long>(setup_.restitution.eps);
        if (!e.pair) {
            v[e.second / 2] = -v[e.second / 2];
            return;
        }
        LongVector& w = particles_[e.second].velocity;
        const Long square = dot(e.apart, e.apart);
        LongVector relative{};
        for (std::size_t d = 0; d < 3; ++d) relative[d] = v[d] - w[d];
        const Long push = bounce / 2 * dot(relative, e.apart) / square;
        for (std::size_t d = 0; d < 3; ++d) {
            v[d] -= push * e.apart[d];
            w[d] += push * e.apart[d];
        }
    }

    // Kinetic and potential, of mass 1.
    [[nodiscard]] Long energy(Long now) const {
        Long sum = 0;
        for (LongParticle p : particles_) {
            fly(p, now);
            sum += dot(p.velocity, p.velocity) / 2;
            for (std::size_t d = 0; d < 3; ++d) sum -= static_cast<Long>(setup_.gravity[d]) * p.place[d];
        }
        return sum;
    }

private:
    static Long dot(const LongVector& a, const LongVector& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    void fly(LongParticle& p, Long to) const {
        const Long dt = to - p.time;
        for (std::size_t d = 0; d < 3; ++d) {
            const Long g = setup_.gravity[d];
            p.place[d] += (p.velocity[d] + g * dt / 2) * dt;
            p.velocity[d] += g * dt;
        }
        p.time = to;
    }

    void look_at_pair(std::size_t i, std::size_t j, LongEvent& first) const {
        LongParticle a = particles_[i], b = particles_[j];
        const Long base = std::max(a.time, b.time);
        fly(a, base);
        fly(b, base);
        LongVector r{}, v{}, images{};
        for (std::size_t d = 0; d < 3; ++d) {
            r[d] = a.place[d] - b.place[d];
            v[d] = a.velocity[d] - b.velocity[d];
            if (static_cast<int>(d) >= setup_.dimension || !setup_.periodic[d]) continue;
            const Long length = setup_.length(static_cast<int>(d));
            r[d] -= length * std::round(r[d] / length);
            images[d] = 1;
        }
        for (Long x = -images[0]; x <= images[0]; ++x)
            for (Long y = -images[1]; y <= images[1]; ++y)
                for (Long z = -images[2]; z <= images[2]; ++z) {
                    const LongVector at{r[0] + x * setup_.length(0), r[1] + y * setup_.length(1),
                                        r[2] + z * setup_.length(2)};
                    const Long time = base + meeting(at, v);
                    if (!(time < first.time)) continue;
                    first = {time, true, i, j, {}};
                    for (std::size_t d = 0; d < 3; ++d) first.apart[d] = at[d] + v[d] * (time - base);
                }
    }

    // Time until |r + v t| is the diameter.
    [[nodiscard]] Long meeting(const LongVector& r, const LongVector& v) const {
        const Long reach = 2 * static_cast<Long>(setup_.classes[0].radius);
        const Long a = dot(v, v), b = dot(r, v), c = dot(r, r) - reach * reach, under = b * b - a * c;
        if (!(b < 0) || under < 0) return std::numeric_limits<Long>::infinity();
        return std::max(c, Long{0}) / (std::sqrt(under) - b);
    }

    void look_at_wall(std::size_t i, int wall, LongEvent& first) const {
        const int axis = wall / 2;
        if (setup_.periodic[axis]) return;
        const Long sign = wall % 2 == 0 ? 1 : -1,
                   bound = wall % 2 == 0 ? setup_.lower[axis] : setup_.upper[axis];
        const LongParticle& p = particles_[i];
        const auto d = static_cast<std::size_t>(axis);
        const Long gap =
            std::max(sign * (p.place[d] - bound) - static_cast<Long>(setup_.classes[0].radius), Long{0});
        const Long v = sign * p.velocity[d], g = sign * static_cast<Long>(setup_.gravity[d]);
        const Long under = v * v - 2 * g * gap;
        Long time = std::numeric_limits<Long>::infinity();
        if (g < 0)
            time = v > 0 ? (v + std::sqrt(under)) / -g : 2 * gap / (std::sqrt(under) - v);
        else if (v < 0 && under >= 0)
            time = 2 * gap / (std::sqrt(under) - v);
        if (p.time + time < first.time) first = {p.time + time, false, i, static_cast<std::size_t>(wall), {}};
    }

    const edmd::Setup setup_;
    std::vector<LongParticle> particles_;
};

} // namespace sandlane::bench
