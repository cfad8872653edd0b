// 128-bit content hashes (XXH3) for state comparison and checkpoint integrity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

namespace sandlane {

struct Hash128 {
    std::uint64_t high = 0, low = 0;
    friend bool operator==(const Hash128&, const Hash128&) = default;
    [[nodiscard]] std::string hex() const; // 32 lower-case hexadecimal digits
};

[[nodiscard]] Hash128 hash_bytes(const void* data, std::size_t size);
// Of the pieces one after the other.
[[nodiscard]] Hash128 hash_pieces(std::initializer_list<std::string_view> pieces);

} // namespace sandlane
