// The tables of event-driven kernels by instruction set.
#include "simd/edmd/tables.hpp"

namespace sandlane::simd {

const EdmdKernels& edmd_kernels_scalar();

#define ISA(name) const EdmdKernels& edmd_kernels_##name();
#include "isas.def"
#undef ISA

const EdmdKernels& edmd_kernels(Isa isa) {
    switch (isa) {
#define ISA(name)                                                                                            \
    case Isa::name:                                                                                          \
        return edmd_kernels_##name();
#include "isas.def"
#undef ISA
    default:
        return edmd_kernels_scalar();
    }
}

} // namespace sandlane::simd
