// Picks the table of kernels once. xsimd's own detection never asks the operating system; the compiler's
// does.
#include "simd/tables.hpp"

#include "core/error.hpp"

#include <cstdlib>

namespace sandlane::simd {

const MdKernels& md_kernels_scalar();

#define ISA(name) const MdKernels& md_kernels_##name();
#include "isas.def"
#undef ISA

const MdKernels& md_kernels(Isa isa) {
    switch (isa) {
#define ISA(name)                                                                                            \
    case Isa::name:                                                                                          \
        return md_kernels_##name();
#include "isas.def"
#undef ISA
    default:
        return md_kernels_scalar();
    }
}

std::string_view isa_name(Isa isa) {
    switch (isa) {
    case Isa::scalar:
        return "scalar";
    case Isa::sse4_2:
        return "sse4.2";
    case Isa::avx2:
        return "avx2";
    case Isa::avx512:
        return "avx512";
    }
    return "scalar";
}

std::optional<Isa> isa_from_name(std::string_view name) {
    for (const Isa isa : {Isa::scalar, Isa::sse4_2, Isa::avx2, Isa::avx512})
        if (name == isa_name(isa)) return isa;
    return std::nullopt;
}

bool isa_built(Isa isa) {
    return isa == Isa::scalar || &md_kernels(isa) != &md_kernels_scalar();
}

bool isa_supported(Isa isa) {
    if (!isa_built(isa)) return false;
#if defined(__x86_64__)
    switch (isa) {
    case Isa::scalar:
        return true;
    case Isa::sse4_2:
        return __builtin_cpu_supports("sse4.2") != 0;
    case Isa::avx2:
        return __builtin_cpu_supports("avx2") != 0;
    case Isa::avx512:
        return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
               __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
               __builtin_cpu_supports("avx512vl") != 0;
    }
#endif
    return isa == Isa::scalar;
}

std::vector<Isa> available_isas() {
    std::vector<Isa> found;
    for (const Isa isa : {Isa::scalar, Isa::sse4_2, Isa::avx2, Isa::avx512})
        if (isa_supported(isa)) found.push_back(isa);
    return found;
}

Isa choose_isa(std::string_view name) {
    std::string_view source = "--isa";
    if (name == "auto") {
        const char* forced = std::getenv("SANDLANE_ISA");
        if (forced == nullptr || *forced == '\0') return available_isas().back();
        name = forced;
        source = "SANDLANE_ISA";
        if (name == "auto") return available_isas().back();
    }
    const auto isa = isa_from_name(name);
    if (!isa)
        fail(Exit::invalid_input,
             "{}={}: unknown instruction set; allowed: auto, scalar, sse4.2, avx2, avx512", source, name);
    if (!isa_supported(*isa))
        fail(Exit::unavailable, "{}={}: this machine or this build lacks it; best available: {}", source,
             name, isa_name(available_isas().back()));
    return *isa;
}

} // namespace sandlane::simd
