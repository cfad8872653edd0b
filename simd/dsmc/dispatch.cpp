// The tables of Monte Carlo kernels by instruction set.
#include "simd/dsmc/tables.hpp"

namespace sandlane::simd {

const DsmcKernels& dsmc_kernels_scalar();
#if defined(SANDLANE_ISA_sse4_2)
const DsmcKernels& dsmc_kernels_sse4_2();
#endif
#if defined(SANDLANE_ISA_avx2)
const DsmcKernels& dsmc_kernels_avx2();
#endif
#if defined(SANDLANE_ISA_avx512)
const DsmcKernels& dsmc_kernels_avx512();
#endif

const DsmcKernels& dsmc_kernels(Isa isa) {
    switch (isa) {
#if defined(SANDLANE_ISA_sse4_2)
    case Isa::sse4_2:
        return dsmc_kernels_sse4_2();
#endif
#if defined(SANDLANE_ISA_avx2)
    case Isa::avx2:
        return dsmc_kernels_avx2();
#endif
#if defined(SANDLANE_ISA_avx512)
    case Isa::avx512:
        return dsmc_kernels_avx512();
#endif
    default:
        return dsmc_kernels_scalar();
    }
}

} // namespace sandlane::simd
