// 128-bit content hashes (XXH3) for state comparison and checkpoint integrity.
#pragma once

#include <cstddef>
#include <cstdint>
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

// Of pieces one after the other: the hash of the whole.
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;
    void add(std::string_view piece);
    [[nodiscard]] Hash128 result() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace sandlane
