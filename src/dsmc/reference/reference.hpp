// The reference of the Monte Carlo kernels: one particle, one cell, one pair after the other.
#pragma once

#include "simd/dsmc/tables.hpp"

namespace sandlane::simd::reference {

[[nodiscard]] std::int32_t sort_gas(const SortView& view);
template <int dimension, bool rough> [[nodiscard]] GasCollisions collide_gas(const GasCollisionView& view);
template <int dimension> [[nodiscard]] GasFlight fly_gas(const GasFlightView& view);

// The other schemes, which serve as oracles: the same for every instruction set.
[[nodiscard]] GasCollisions collide_by_scheme(int dimension, bool rough, const GasCollisionView& view);

} // namespace sandlane::simd::reference
