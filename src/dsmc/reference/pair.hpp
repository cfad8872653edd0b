// One pair of the reference: relative velocity and collision.
#pragma once

#include "core/rng.hpp"
#include "laws/collision.hpp"
#include "simd/dsmc/tables.hpp"

#include <array>
#include <cstring>

namespace sandlane::simd::reference {

inline PhiloxCounter draw(const GasRandom& random, std::uint32_t k, std::uint32_t cell, GasStream stream) {
    return philox({k, cell, random.step, random.last_word(stream)}, {random.key[0], random.key[1]});
}

inline Vector<double> velocity_of(const double* rows, std::int32_t i) {
    const double* row = rows + std::ptrdiff_t{i} * gas_row;
    return {row[0], row[1], row[2]};
}
inline void add_to(double* rows, std::int32_t i, const Vector<double>& v) {
    double* row = rows + std::ptrdiff_t{i} * gas_row;
    row[0] += v.x;
    row[1] += v.y;
    row[2] += v.z;
}
inline Vector<double> minus(const Vector<double>& v) {
    return {-v.x, -v.y, -v.z};
}

// Tells who listens what became of a candidate, a pair of rows.
inline void tell(const GasCollisionView& view, std::uint32_t cell, std::uint32_t k, std::int32_t i,
                 std::int32_t j, bool accepted) {
    if (view.listener.hear == nullptr) return;
    const auto identity = [&](std::int32_t row) {
        std::uint32_t id = 0;
        std::memcpy(&id, view.rows.place + std::ptrdiff_t{row} * gas_row + 3, sizeof id);
        return id;
    };
    view.listener.hear(view.listener.to, {cell, k, identity(i), identity(j), accepted});
}

// Number of one of n particles that is not i.
inline std::int32_t other_than(std::int32_t i, std::uint32_t word, std::int32_t n) {
    const auto j = static_cast<std::int32_t>(std::uint64_t{word} * static_cast<std::uint64_t>(n - 1) >> 32);
    return j >= i ? j + 1 : j;
}
// Number of the first of two different particles of n, and of the second.
inline std::array<std::int32_t, 2> pair_of(const PhiloxCounter& w, std::int32_t n) {
    const auto i = static_cast<std::int32_t>(std::uint64_t{w[0]} * static_cast<std::uint64_t>(n) >> 32);
    return {i, other_than(i, w[1], n)};
}

// Number of the second of candidate k: of the one drawn and of more, the nearest to the first.
inline std::int32_t nearest_partner(const GasCollisionView& view, std::uint32_t k, std::uint32_t cell,
                                    std::int32_t begin, std::int32_t n,
                                    const std::array<std::int32_t, 2>& pair) {
    if (view.partners == 1) return pair[1];
    const PhiloxCounter w = draw(view.random, k, cell, GasStream::partner);
    const auto square_to = [&](std::int32_t other) {
        const double* x = view.rows.place + std::ptrdiff_t{begin + pair[0]} * gas_row;
        const double* y = view.rows.place + std::ptrdiff_t{begin + other} * gas_row;
        double sum = 0;
        for (int d = 0; d < 3; ++d) sum += view.near_axis[d] * ((x[d] - y[d]) * (x[d] - y[d]));
        return sum;
    };
    std::int32_t best = pair[1];
    for (std::size_t more = 0; more + 1 < static_cast<std::size_t>(view.partners); ++more) {
        const std::int32_t other = other_than(pair[0], w[more], n);
        if (square_to(other) < square_to(best)) best = other;
    }
    return best;
}

// Direction e of candidate k of a cell, of density |g.e|.
template <int dimension>
Vector<double> direction(const GasCollisionView& view, std::uint32_t k, std::uint32_t cell,
                         const Vector<double>& g, double speed) {
    const PhiloxCounter w = draw(view.random, k, cell, GasStream::geometry);
    const double u = unit_number(w[0], w[1]);
    if (dimension == 2) return laws::direction_in_plane(g, speed, u);
    double sine = 0, cosine = 0;
    laws::sine_cosine_of_turn(unit_number(w[2], w[3]), sine, cosine);
    return laws::direction_in_space(g, speed, u, sine, cosine);
}

// Of a mixture.
inline std::size_t kind_of(const double* velocity) {
    std::uint64_t word = 0;
    std::memcpy(&word, velocity + 3, sizeof word);
    return static_cast<std::size_t>(word >> 60);
}
inline std::size_t kind_of(const GasCollisionView& view, std::int32_t i) {
    return kind_of(view.rows.velocity + std::ptrdiff_t{i} * gas_row);
}
inline std::size_t kinds_of(const GasCollisionView& view, std::int32_t i, std::int32_t j) {
    return most_kinds * kind_of(view, i) + kind_of(view, j);
}

// How crowded a cell is: what the pair correlation at contact is made of.
struct Crowding {
    double factor = 1; // the part that all pairs share
    double h = 0;      // of a mixture: h of laws::contact_of_pair
    double most = 1;   // of a mixture: the part of the pair that has the largest
};
inline Crowding crowding(int dimension, const GasCollisionView& view, std::int32_t begin, std::int32_t n) {
    Crowding c;
    if (view.mixture == nullptr) {
        if (view.packing > 0) c.factor = laws::contact_correlation(dimension, view.packing * (n - 2));
        return c;
    }
    double lower = 0, upper = 0;
    for (std::int32_t i = begin; i < begin + n && view.mixture->dense; ++i) {
        lower += view.mixture->lower_moment[kind_of(view, i)];
        upper += view.mixture->upper_moment[kind_of(view, i)];
    }
    const double others = (n - 2.0) / n;
    const double free = 1 - min(upper * others, laws::freezing_fraction[dimension - 2]);
    c.h = lower * others / free;
    c.most = laws::contact_of_pair(dimension, view.mixture->largest_contact * c.h);
    c.factor = 1 / free;
    return c;
}
// How often a pair collides, over the pairs of the largest cross-section of a dilute gas: factor of its
// speed.
inline double frequency(int dimension, const GasCollisionView& view, const Crowding& c, std::int32_t i,
                        std::int32_t j) {
    if (view.mixture == nullptr) return 1;
    const std::size_t pair = kinds_of(view, i, j);
    return view.mixture->section[pair] * laws::contact_of_pair(dimension, view.mixture->contact[pair] * c.h);
}

// Impulse per reduced mass of rough particles whose surfaces meet with this velocity; friction limits how
// much of the tangential restitution there can be.
inline Vector<double> rough_impulse(const GasCollisionView& view, const Vector<double>& contact,
                                    const Vector<double>& e, double eps) {
    double tangential = view.tangential;
    if (view.friction > 0) {
        const double along = dot(contact, e);
        const Vector<double> across = contact - along * e;
        tangential = laws::sliding_restitution(tangential, view.friction, eps, view.mass_ratio, -along,
                                               std::sqrt(dot(across, across)));
    }
    return laws::impulse(contact, e, eps, tangential, view.mass_ratio);
}

// Collision of rows i and j of different kinds along e.
template <bool rough>
void collide_kinds(const GasCollisionView& view, std::int32_t i, std::int32_t j, const Vector<double>& e) {
    const GasMixture& mixture = *view.mixture;
    const std::size_t a = kind_of(view, i), b = kind_of(view, j), pair = kinds_of(view, i, j);
    const double share_i = mixture.share[pair], share_j = mixture.share[kinds_of(view, j, i)];
    const Vector<double> g = velocity_of(view.rows.velocity, i) - velocity_of(view.rows.velocity, j);
    const double normal = dot(g, e);
    const double eps = laws::restitution_of_pair(view.restitution, mixture.coefficient[pair], -normal);
    Vector<double> push = laws::smooth_impulse(normal, e, eps);
    if (rough) {
        const Vector<double> contact = g - cross(mixture.radius[a] * velocity_of(view.rows.spin, i) +
                                                     mixture.radius[b] * velocity_of(view.rows.spin, j),
                                                 e);
        push = rough_impulse(view, contact, e, eps);
        const Vector<double> turn = cross(e, push);
        add_to(view.rows.spin, i, minus((share_i / (view.inertia * mixture.radius[a])) * turn));
        add_to(view.rows.spin, j, minus((share_j / (view.inertia * mixture.radius[b])) * turn));
    }
    add_to(view.rows.velocity, i, share_i * push);
    add_to(view.rows.velocity, j, minus(share_j * push));
}

// Collision of rows i and j along e.
template <bool rough>
void collide(const GasCollisionView& view, std::int32_t i, std::int32_t j, const Vector<double>& e) {
    if (view.mixture != nullptr) return collide_kinds<rough>(view, i, j, e);
    const Vector<double> g = velocity_of(view.rows.velocity, i) - velocity_of(view.rows.velocity, j);
    const double normal = dot(g, e);
    const double eps = laws::restitution(view.restitution, -normal);
    Vector<double> push = laws::smooth_impulse(normal, e, eps);
    if (rough) {
        const Vector<double> spins = velocity_of(view.rows.spin, i) + velocity_of(view.rows.spin, j);
        const Vector<double> contact = g - cross(view.radius * spins, e);
        push = rough_impulse(view, contact, e, eps);
        const Vector<double> turn = (0.5 / (view.inertia * view.radius)) * cross(e, push);
        add_to(view.rows.spin, i, minus(turn));
        add_to(view.rows.spin, j, minus(turn));
    }
    add_to(view.rows.velocity, i, 0.5 * push);
    add_to(view.rows.velocity, j, minus(0.5 * push));
}

} // namespace sandlane::simd::reference
