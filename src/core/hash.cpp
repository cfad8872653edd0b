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

struct Hasher::State {
    XXH3_state_t stream;
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
    XXH3_128bits_reset(&state_->stream);
}

Hasher::~Hasher() = default;

void Hasher::add(std::string_view piece) {
    XXH3_128bits_update(&state_->stream, piece.data(), piece.size());
}

Hash128 Hasher::result() const {
    const XXH128_hash_t h = XXH3_128bits_digest(&state_->stream);
    return {h.high64, h.low64};
}

} // namespace sandlane
