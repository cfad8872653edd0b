// The method without a time counter, one cell after the other, candidates in order.
#include "dsmc/reference/pair.hpp"
#include "dsmc/reference/reference.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::simd::reference {

namespace {

// Diagonal of the box that holds the velocities of a cell: no two differ by more.
double extent(const double* velocity, std::int32_t n) {
    double diagonal2 = 0;
    for (int d = 0; d < 3; ++d) {
        double low = velocity[d], high = velocity[d];
        for (std::int32_t i = 1; i < n; ++i) {
            const double v = velocity[std::ptrdiff_t{i} * gas_row + d];
            low = std::min(low, v);
            high = std::max(high, v);
        }
        diagonal2 += (high - low) * (high - low);
    }
    return std::sqrt(diagonal2);
}

} // namespace

template <int dimension, bool rough> GasCollisions collide_gas(const GasCollisionView& view) {
    if (view.scheme != laws::CollisionScheme::no_time_counter &&
        view.scheme != laws::CollisionScheme::maxwell)
        return collide_by_scheme(dimension, rough, view);
    GasCollisions result;
    for (std::int32_t c = 0; c < view.cells; ++c) {
        const std::int32_t begin = view.start[c], n = view.start[c + 1] - begin;
        if (n < 2) continue;
        const auto cell = static_cast<std::uint32_t>(view.first_cell + c);
        const Crowding crowd = crowding(dimension, view, begin, n);
        const double fastest = view.margin * extent(view.rows.velocity + std::ptrdiff_t{begin} * gas_row, n);
        const bool maxwell = view.maxwell > 0; // all candidates collide
        const double majorant = maxwell ? 0 : fastest * crowd.most;
        const double mean = maxwell
                                ? view.maxwell * n
                                : view.rate * (static_cast<double>(n) * (n - 1)) * majorant * crowd.factor;
        const PhiloxCounter rounding = draw(view.random, 0, cell, GasStream::rounding);
        const double wanted = std::floor(mean + unit_number(rounding[0], rounding[1]));
        if (!(wanted < most_candidates)) {
            ++result.overflows;
            continue;
        }
        const auto candidates = static_cast<std::uint32_t>(wanted);
        result.candidates += candidates;
        for (std::uint32_t k = 0; k < candidates; ++k) {
            const PhiloxCounter w = draw(view.random, k, cell, GasStream::candidate);
            const auto drawn = pair_of(w, n);
            const std::int32_t i = begin + drawn[0],
                               j = begin + nearest_partner(view, k, cell, begin, n, drawn);
            const Vector<double> g = velocity_of(view.rows.velocity, i) - velocity_of(view.rows.velocity, j);
            const double speed = std::sqrt(dot(g, g));
            const double counts = frequency(dimension, view, crowd, i, j) * speed;
            if (!maxwell && counts > majorant) ++result.violations;
            const bool accepted = unit_number(w[2], w[3]) * majorant < counts;
            tell(view, cell, k, i, j, accepted);
            if (!accepted) continue;
            collide<rough>(view, i, j, direction<dimension>(view, k, cell, g, speed));
            ++result.collisions;
        }
    }
    return result;
}

template GasCollisions collide_gas<2, false>(const GasCollisionView&);
template GasCollisions collide_gas<2, true>(const GasCollisionView&);
template GasCollisions collide_gas<3, false>(const GasCollisionView&);
template GasCollisions collide_gas<3, true>(const GasCollisionView&);

} // namespace sandlane::simd::reference
