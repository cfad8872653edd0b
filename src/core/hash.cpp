#include "core/hash.hpp"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace sandlane {

std::string Hash128::hex() const {
    return fmt::format("{:016x}{:016x}", high, low);
}

Hash128 hash_bytes(const void* data, std::size_t size) {
    const XXH128_hash_t h = XXH3_128bits(data, size);
    return {h.high64, h.low64};
}

Hash128 hash_pieces(std::initializer_list<std::string_view> pieces) {
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    for (const std::string_view piece : pieces) XXH3_128bits_update(&state, piece.data(), piece.size());
    const XXH128_hash_t h = XXH3_128bits_digest(&state);
    return {h.high64, h.low64};
}

} // namespace sandlane
