// Other ways to choose the pairs that collide, with the same statistics: oracles for the method without a
// time counter, and for short steps.
#include "dsmc/reference/pair.hpp"
#include "dsmc/reference/reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sandlane::simd::reference {

namespace {

struct Cell {
    std::uint32_t number;
    std::int32_t begin, n;
    double majorant;
    double rate; // F S g2 dt/(2 V), s/m
    Crowding crowd;
};

// Relative speed times what the kinds of a mixture collide more or less often than the majorant says.
double weighted(int dimension, const GasCollisionView& view, const Cell& cell, std::int32_t i, std::int32_t j,
                double speed) {
    return frequency(dimension, view, cell.crowd, i, j) * speed;
}

Vector<double> relative(const GasCollisionView& view, std::int32_t i, std::int32_t j) {
    return velocity_of(view.rows.velocity, i) - velocity_of(view.rows.velocity, j);
}

template <int dimension, bool rough>
void collide_along(const GasCollisionView& view, const Cell& cell, std::uint32_t k, std::int32_t i,
                   std::int32_t j, const Vector<double>& g) {
    collide<rough>(view, i, j, direction<dimension>(view, k, cell.number, g, std::sqrt(dot(g, g))));
}

// Unit vector of a candidate, uniform, pointing against g.
template <int dimension>
Vector<double> folded_direction(const GasCollisionView& view, std::uint32_t k, const Cell& cell,
                                const Vector<double>& g) {
    const PhiloxCounter w = draw(view.random, k, cell.number, GasStream::geometry);
    double sine = 0, cosine = 0;
    Vector<double> e{0, 0, 0};
    if (dimension == 2) {
        laws::sine_cosine_of_turn(unit_number(w[0], w[1]), sine, cosine);
        e = {cosine, sine, 0};
    } else {
        e.z = 1 - 2 * unit_number(w[0], w[1]);
        laws::sine_cosine_of_turn(unit_number(w[2], w[3]), sine, cosine);
        const double across = std::sqrt(1 - e.z * e.z);
        e.x = across * cosine;
        e.y = across * sine;
    }
    return dot(g, e) > 0 ? minus(e) : e;
}

// Pair and direction are chosen at once, accepted with |g.e|/g_max: more candidates, no basis.
template <int dimension, bool rough>
void direction_first(const GasCollisionView& view, const Cell& cell, GasCollisions& result) {
    // S' = 2 pi s^2 of pi s^2, pi s of 2 s.
    const double more = dimension == 3 ? 2.0 : std::numbers::pi / 2;
    const double mean = more * cell.rate * cell.n * (cell.n - 1) * cell.majorant;
    const PhiloxCounter rounding = draw(view.random, 0, cell.number, GasStream::rounding);
    const auto candidates = static_cast<std::uint32_t>(mean + unit_number(rounding[0], rounding[1]));
    for (std::uint32_t k = 0; k < candidates; ++k) {
        ++result.candidates;
        const PhiloxCounter w = draw(view.random, k, cell.number, GasStream::candidate);
        const auto [first, second] = pair_of(w, cell.n);
        const std::int32_t i = cell.begin + first, j = cell.begin + second;
        const Vector<double> g = relative(view, i, j);
        const Vector<double> e = folded_direction<dimension>(view, k, cell, g);
        const double speed = weighted(dimension, view, cell, i, j, std::abs(dot(g, e)));
        if (speed > cell.majorant) ++result.violations;
        const bool accepted = unit_number(w[2], w[3]) * cell.majorant < speed;
        tell(view, cell.number, k, i, j, accepted);
        if (!accepted) continue;
        collide<rough>(view, i, j, e);
        ++result.collisions;
    }
}

// A random matching of the particles; each of its pairs collides with its own probability.
template <int dimension, bool rough>
void nanbu_babovsky(const GasCollisionView& view, const Cell& cell, GasCollisions& result) {
    std::vector<std::int32_t> order(static_cast<std::size_t>(cell.n));
    for (std::int32_t i = 0; i < cell.n; ++i) order[static_cast<std::size_t>(i)] = cell.begin + i;
    const auto pairs = static_cast<std::uint32_t>(cell.n / 2);
    // Fisher and Yates as far as it is needed; candidate k takes the next two.
    const double partners = cell.n % 2 == 0 ? cell.n - 1 : cell.n;
    for (std::uint32_t k = 0; k < pairs; ++k) {
        ++result.candidates;
        const PhiloxCounter w = draw(view.random, k, cell.number, GasStream::candidate);
        for (std::uint32_t half = 0; half < 2; ++half) {
            const std::uint32_t at = 2 * k + half;
            const std::uint64_t rest = static_cast<std::uint64_t>(cell.n) - at;
            std::swap(order[at], order[at + (std::uint64_t{w[half]} * rest >> 32)]);
        }
        const std::int32_t i = order[2 * k], j = order[2 * k + 1];
        const Vector<double> g = relative(view, i, j);
        const double speed = weighted(dimension, view, cell, i, j, std::sqrt(dot(g, g)));
        const double probability = 2 * partners * cell.rate * speed;
        if (probability > 1) ++result.violations;
        const bool accepted = unit_number(w[2], w[3]) < probability;
        tell(view, cell.number, k, i, j, accepted);
        if (!accepted) continue;
        collide_along<dimension, rough>(view, cell, k, i, j, g);
        ++result.collisions;
    }
}

// The exact process: exponential waiting times until the step is used up.
template <int dimension, bool rough>
void majorant_frequency(const GasCollisionView& view, const Cell& cell, GasCollisions& result) {
    const double mean = cell.rate * cell.n * (cell.n - 1) * cell.majorant; // candidates per step
    double time = 0;                                                       // in steps
    for (std::uint32_t k = 0;; ++k) {
        const PhiloxCounter wait = draw(view.random, k, cell.number, GasStream::rounding);
        time += -laws::logarithm(1.0 - unit_number(wait[0], wait[1])) / mean;
        if (!(time < 1)) return;
        ++result.candidates;
        const PhiloxCounter w = draw(view.random, k, cell.number, GasStream::candidate);
        const auto [first, second] = pair_of(w, cell.n);
        const std::int32_t i = cell.begin + first, j = cell.begin + second;
        const Vector<double> g = relative(view, i, j);
        const double speed = weighted(dimension, view, cell, i, j, std::sqrt(dot(g, g)));
        if (speed > cell.majorant) ++result.violations;
        const bool accepted = unit_number(w[2], w[3]) * cell.majorant < speed;
        tell(view, cell.number, k, i, j, accepted);
        if (!accepted) continue;
        collide_along<dimension, rough>(view, cell, k, i, j, g);
        ++result.collisions;
    }
}

// Every pair once, with its probability, which must be small.
template <int dimension, bool rough>
void bernoulli(const GasCollisionView& view, const Cell& cell, GasCollisions& result) {
    std::uint32_t k = 0;
    for (std::int32_t a = 0; a < cell.n; ++a)
        for (std::int32_t b = a + 1; b < cell.n; ++b, ++k) {
            ++result.candidates;
            const std::int32_t i = cell.begin + a, j = cell.begin + b;
            const PhiloxCounter w = draw(view.random, k, cell.number, GasStream::candidate);
            const Vector<double> g = relative(view, i, j);
            const double speed = weighted(dimension, view, cell, i, j, std::sqrt(dot(g, g)));
            const double probability = 2 * cell.rate * speed;
            if (probability > 1) ++result.violations;
            const bool accepted = unit_number(w[2], w[3]) < probability;
            tell(view, cell.number, k, i, j, accepted);
            if (!accepted) continue;
            collide_along<dimension, rough>(view, cell, k, i, j, g);
            ++result.collisions;
        }
}

template <int dimension, bool rough> GasCollisions all_cells(const GasCollisionView& view) {
    GasCollisions result;
    for (std::int32_t c = 0; c < view.cells; ++c) {
        Cell cell{static_cast<std::uint32_t>(view.first_cell + c),
                  view.start[c],
                  view.start[c + 1] - view.start[c],
                  0,
                  view.rate,
                  crowding(dimension, view, view.start[c], view.start[c + 1] - view.start[c])};
        if (cell.n < 2) continue;
        Vector<double> low = velocity_of(view.rows.velocity, cell.begin), high = low;
        for (std::int32_t i = 1; i < cell.n; ++i) {
            const Vector<double> v = velocity_of(view.rows.velocity, cell.begin + i);
            low = {min(low.x, v.x), min(low.y, v.y), min(low.z, v.z)};
            high = {max(high.x, v.x), max(high.y, v.y), max(high.z, v.z)};
        }
        const Vector<double> extent = high - low;
        cell.majorant = view.margin * std::sqrt(dot(extent, extent)) * cell.crowd.most;
        cell.rate *= cell.crowd.factor;
        if (!(cell.majorant > 0)) continue;
        const double pairs = 0.5 * cell.n * (cell.n - 1.0);
        if (!(4 * cell.rate * pairs * cell.majorant < most_candidates) ||
            (view.scheme == laws::CollisionScheme::bernoulli && !(pairs < most_candidates))) {
            ++result.overflows;
            continue;
        }
        switch (view.scheme) {
        case laws::CollisionScheme::direction_first:
            direction_first<dimension, rough>(view, cell, result);
            break;
        case laws::CollisionScheme::nanbu_babovsky:
            nanbu_babovsky<dimension, rough>(view, cell, result);
            break;
        case laws::CollisionScheme::majorant_frequency:
            majorant_frequency<dimension, rough>(view, cell, result);
            break;
        case laws::CollisionScheme::bernoulli:
            bernoulli<dimension, rough>(view, cell, result);
            break;
        case laws::CollisionScheme::no_time_counter:
        case laws::CollisionScheme::maxwell:
            break;
        }
    }
    return result;
}

} // namespace

GasCollisions collide_by_scheme(int dimension, bool rough, const GasCollisionView& view) {
    if (dimension == 3) return rough ? all_cells<3, true>(view) : all_cells<3, false>(view);
    return rough ? all_cells<2, true>(view) : all_cells<2, false>(view);
}

} // namespace sandlane::simd::reference
