// Kernels that bench/ times to learn what the machine can do with one instruction set: the roofs of its
// rooflines.
#pragma once

#include "simd/tables.hpp"

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

struct RateKernels {
    // Runs `rounds` rounds of independent operations on registers and returns how many scalar operations that
    // was; `sink` [16] receives values that depend on all of them.
    using Registers = std::int64_t (*)(std::int64_t rounds, double* sink);
    Registers arithmetic;        // double; half of them multiplications, half additions
    Registers single_arithmetic; // the same in single precision
    Registers multiply_add;      // double, one operation each; two where the instruction set has no fused one
    Registers divide, square_root;
    // Reads and writes x[0 .. n), n a multiple of 16.
    void (*in_place)(double* x, std::size_t n);
};

// The table of an instruction set that choose_isa() may return.
[[nodiscard]] const RateKernels& rate_kernels(Isa isa);

} // namespace sandlane::simd
