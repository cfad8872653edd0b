// XXH3-128, seed 0, against published values of the reference implementation.
#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <string>

namespace sandlane {

namespace {

std::string hash_of(const std::string& text) {
    return hash_bytes(text.data(), text.size()).hex();
}

TEST(Hash, KnownAnswers) {
    EXPECT_EQ(hash_of(""), "99aa06d3014798d86001c324468d497f");
    EXPECT_EQ(hash_of("a"), "a96faf705af16834e6c632b61e964e1f");
    EXPECT_EQ(hash_of("abc"), "06b05ab6733a618578af5f94892f3950");
    EXPECT_EQ(hash_of("hello world"), "df8d09e93f874900a99b8775cc15b6c7");
    EXPECT_EQ(hash_of("The quick brown fox jumps over the lazy dog"), "ddd650205ca3e7fa24a1cc2e3a8a7651");
    EXPECT_EQ(hash_of(std::string(1000, 'x')), "50a1af5a5f2dcf01c0a4877b962cba82");
}

TEST(Hash, HexKeepsLeadingZeros) {
    EXPECT_EQ((Hash128{0x1, 0xabc}).hex(), "00000000000000010000000000000abc");
}

} // namespace

} // namespace sandlane
