#include "simd/automata/tables.hpp"

#include "core/error.hpp"

namespace sandlane::simd {

#define ISA(name) const AutomataKernels& automata_kernels_##name();
#include "isas.def"
#undef ISA

const AutomataKernels& automata_kernels(Isa isa) {
    switch (isa) {
#define ISA(name)                                                                                            \
    case Isa::name:                                                                                          \
        return automata_kernels_##name();
#include "isas.def"
#undef ISA
    default:
        fail(Exit::internal, "kernels of an instruction set that this build lacks");
    }
}

} // namespace sandlane::simd
