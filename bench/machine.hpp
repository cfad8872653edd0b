// What this machine can do at the moment, measured once per program and kept: the roofs of the rooflines.
#pragma once

#include "simd/tables.hpp"

#include <cstddef>

namespace sandlane::bench {

// Scalar operations per second of all threads together.
struct Rates {
    double arithmetic = 0;        // double precision multiplications and additions
    double single_arithmetic = 0; // single precision
    double multiply_add = 0;      // fused where the instruction set has it
    double divide = 0, square_root = 0;
};
[[nodiscard]] const Rates& rates(simd::Isa isa, int threads);

// Bytes per second, reads plus writes, of an in-place pass over a working set of this size.
[[nodiscard]] double bandwidth(simd::Isa isa, int threads, std::size_t working_set);

// Seconds per dependent load that jumps about in a working set of this size.
[[nodiscard]] double load_latency(std::size_t working_set);

// Cycles per second of one core that is busy.
[[nodiscard]] double clock_rate();

} // namespace sandlane::bench
