#include "simd/automata/tables.hpp"

#include "core/error.hpp"

namespace sandlane::simd {

#if defined(SANDLANE_ISA_sse4_2)
const AutomataKernels& automata_kernels_sse4_2();
#endif
#if defined(SANDLANE_ISA_avx2)
const AutomataKernels& automata_kernels_avx2();
#endif
#if defined(SANDLANE_ISA_avx512)
const AutomataKernels& automata_kernels_avx512();
#endif

const AutomataKernels& automata_kernels(Isa isa) {
    switch (isa) {
#if defined(SANDLANE_ISA_sse4_2)
    case Isa::sse4_2:
        return automata_kernels_sse4_2();
#endif
#if defined(SANDLANE_ISA_avx2)
    case Isa::avx2:
        return automata_kernels_avx2();
#endif
#if defined(SANDLANE_ISA_avx512)
    case Isa::avx512:
        return automata_kernels_avx512();
#endif
    default:
        fail(Exit::internal, "kernels of an instruction set that this build lacks");
    }
}

} // namespace sandlane::simd
