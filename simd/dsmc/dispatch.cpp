// The tables of Monte Carlo kernels by instruction set.
#include "simd/dsmc/tables.hpp"

namespace sandlane::simd {

const DsmcKernels& dsmc_kernels_scalar();

#define ISA(name) const DsmcKernels& dsmc_kernels_##name();
#include "isas.def"
#undef ISA

const DsmcKernels& dsmc_kernels(Isa isa) {
    switch (isa) {
#define ISA(name)                                                                                            \
    case Isa::name:                                                                                          \
        return dsmc_kernels_##name();
#include "isas.def"
#undef ISA
    default:
        return dsmc_kernels_scalar();
    }
}

} // namespace sandlane::simd
