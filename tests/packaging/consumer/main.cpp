#include <simd/tables.hpp>

#include <cstdio>

int main() {
    for (const sandlane::simd::Isa isa : sandlane::simd::available_isas()) {
        const auto name = sandlane::simd::isa_name(isa);
        std::printf("%.*s\n", static_cast<int>(name.size()), name.data());
    }
    return sandlane::simd::available_isas().empty() ? 1 : 0;
}
