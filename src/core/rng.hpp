// Counter-based random numbers: Philox4x32-10 (Salmon et al., SC'11). A value is a pure function of
// (seed, stream, index), so results do not depend on threads, lanes or the order of calls.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sandlane {

// One tag for each use of random numbers, so that two users never share a sequence.
enum class Stream : std::uint32_t {
    radius = 1,
    position = 2,
    velocity = 3,
    jitter = 4,
    pour = 5,
    factory = 6,
    watch = 7,
};

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

[[nodiscard]] constexpr PhiloxCounter philox(PhiloxCounter c, PhiloxKey k) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * c[0];
        const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * c[2];
        c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
             static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
        k = {k[0] + 0x9E3779B9u, k[1] + 0xBB67AE85u};
    }
    return c;
}

// The number in [0, 1) that the upper 53 of 64 bits stand for.
[[nodiscard]] constexpr double unit_number(std::uint32_t high, std::uint32_t low) {
    const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 11;
    return static_cast<double>(bits) * 0x1p-53;
}

// Random numbers of one stream, e.g. one grain population; `group` separates populations.
class Random {
public:
    Random(std::uint64_t seed, Stream stream, std::uint32_t group = 0)
        : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
          stream_(static_cast<std::uint32_t>(stream)), group_(group) {}

    // Two uniform doubles in [0, 1) with 53 random bits, number `index` of the stream.
    [[nodiscard]] std::array<double, 2> uniform2(std::uint64_t index) const {
        const PhiloxCounter r = philox(
            {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), stream_, group_},
            key_);
        return {unit_number(r[0], r[1]), unit_number(r[2], r[3])};
    }
    [[nodiscard]] double uniform(std::uint64_t index) const { return uniform2(index)[0]; }

    // Three of them, for indices below 2^63; the first two are those of uniform2.
    [[nodiscard]] std::array<double, 3> uniform3(std::uint64_t index) const {
        const auto [u, w] = uniform2(index);
        return {u, w, uniform(index | upper_half)};
    }

    // Two independent standard normal deviates (Box-Muller).
    [[nodiscard]] std::array<double, 2> normal2(std::uint64_t index) const {
        const auto [u, w] = uniform2(index);
        const double radius = std::sqrt(-2.0 * std::log1p(-u));
        const double angle = 2.0 * std::numbers::pi * w;
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }
    // Three of them, for indices below 2^63; the first two are those of normal2.
    [[nodiscard]] std::array<double, 3> normal3(std::uint64_t index) const {
        const auto [x, y] = normal2(index);
        return {x, y, normal2(index | upper_half)[0]};
    }

private:
    static constexpr std::uint64_t upper_half = std::uint64_t{1} << 63;

    PhiloxKey key_;
    std::uint32_t stream_;
    std::uint32_t group_;
};

} // namespace sandlane
