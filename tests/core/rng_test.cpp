// Philox4x32-10 against the known-answer vectors published with Random123, and the distributions made of it.
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using sandlane::philox;
using sandlane::PhiloxCounter;

TEST(Philox, KnownAnswers) {
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

namespace {

using sandlane::Random;
using sandlane::Stream;

struct Moments {
    double sum = 0, square = 0, fourth = 0, cross = 0;
    int count = 0;
    void add(double x, double y) {
        for (const double v : {x, y}) {
            sum += v;
            square += v * v;
            fourth += v * v * v * v;
            ++count;
        }
        cross += x * y;
    }
};

// Tolerances: five standard deviations of the mean of as many samples.
TEST(Random, UniformNumbersFillTheUnitInterval) {
    const Random random(7, Stream::radius);
    Moments m;
    double least = 1, most = 0;
    for (std::uint64_t n = 0; n < 50000; ++n) {
        const auto [u, w] = random.uniform2(n);
        least = std::min({least, u, w});
        most = std::max({most, u, w});
        m.add(u - 0.5, w - 0.5);
    }
    const double each = 5 / std::sqrt(m.count);
    EXPECT_GE(least, 0);
    EXPECT_LT(most, 1);
    EXPECT_LT(least, 1e-4); // probability of failing: exp(-10)
    EXPECT_GT(most, 1 - 1e-4);
    EXPECT_NEAR(m.sum / m.count, 0, each * std::sqrt(1.0 / 12));
    EXPECT_NEAR(m.square / m.count, 1.0 / 12, each * std::sqrt(1.0 / 80 - 1.0 / 144));
    EXPECT_NEAR(m.cross / (m.count / 2), 0, each * std::sqrt(2.0) / 12);
}

TEST(Random, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
    const Random random(7, Stream::velocity);
    Moments m;
    for (std::uint64_t n = 0; n < 50000; ++n) {
        const auto [x, y] = random.normal2(n);
        m.add(x, y);
    }
    const double each = 5 / std::sqrt(m.count);
    EXPECT_NEAR(m.sum / m.count, 0, each);
    EXPECT_NEAR(m.square / m.count, 1, each * std::sqrt(2.0));
    EXPECT_NEAR(m.fourth / m.count, 3, each * std::sqrt(96.0));
    EXPECT_NEAR(m.cross / (m.count / 2), 0, each * std::sqrt(2.0));
}

TEST(Random, ThirdNumbersAreIndependentOfTheFirstTwo) {
    const Random random(7, Stream::position);
    Moments uniform, normal;
    for (std::uint64_t n = 0; n < 50000; ++n) {
        const auto u = random.uniform3(n), x = random.normal3(n);
        EXPECT_EQ((std::array{u[0], u[1]}), random.uniform2(n));
        EXPECT_EQ((std::array{x[0], x[1]}), random.normal2(n));
        for (const std::size_t other : {0U, 1U}) {
            uniform.add(u[2] - 0.5, u.at(other) - 0.5);
            normal.add(x[2], x.at(other));
        }
    }
    const int pairs = normal.count / 2;
    EXPECT_NEAR(uniform.cross / pairs, 0, 5 / std::sqrt(pairs) / 12);
    EXPECT_NEAR(normal.cross / pairs, 0, 5 / std::sqrt(pairs));
    EXPECT_NEAR(uniform.square / uniform.count, 1.0 / 12,
                5 / std::sqrt(pairs) * std::sqrt(1.0 / 80 - 1.0 / 144));
    EXPECT_NEAR(normal.square / normal.count, 1, 5 / std::sqrt(pairs) * std::sqrt(2.0));
}

TEST(Random, SeedsStreamsGroupsAndIndicesAreDifferentNumbers) {
    std::set<double> seen;
    for (const std::uint64_t seed : {1ULL, 2ULL, 1ULL << 32})
        for (const Stream stream : {Stream::radius, Stream::position})
            for (const std::uint32_t group : {0U, 1U})
                for (const std::uint64_t index : {0ULL, 1ULL, 1ULL << 32})
                    seen.insert(Random(seed, stream, group).uniform(index));
    EXPECT_EQ(seen.size(), 3U * 2U * 2U * 3U);
    EXPECT_EQ(Random(3, Stream::pour, 2).uniform(9), Random(3, Stream::pour, 2).uniform2(9)[0]);
}

} // namespace
