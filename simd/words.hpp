// Registers of 64-bit words, and blocks of eight words beside the blocks of eight doubles of lanes.hpp:
// counter-based random numbers in lanes, and the exponents of doubles.
#pragma once

#include "simd/lanes.hpp"

#include <bit>
#include <cstdint>

namespace sandlane::simd {

// One register of words.
template <class Arch> using WordBatch = xsimd::batch<std::uint64_t, Arch>;

// Product of the lower halves of the lanes.
template <class Arch>
SANDLANE_INLINE WordBatch<Arch> multiply_low(const WordBatch<Arch>& a, const WordBatch<Arch>& b) {
    const WordBatch<Arch> low(0xffffffffULL);
    return (a & low) * (b & low);
}
#if defined(__AVX512F__)
SANDLANE_INLINE WordBatch<xsimd::avx512bw> multiply_low(const WordBatch<xsimd::avx512bw>& a,
                                                        const WordBatch<xsimd::avx512bw>& b) {
    return _mm512_mul_epu32(a.data, b.data);
}
#elif defined(__AVX2__)
SANDLANE_INLINE WordBatch<xsimd::avx2> multiply_low(const WordBatch<xsimd::avx2>& a,
                                                    const WordBatch<xsimd::avx2>& b) {
    return _mm256_mul_epu32(a.data, b.data);
}
#elif defined(__SSE4_2__)
SANDLANE_INLINE WordBatch<xsimd::sse4_2> multiply_low(const WordBatch<xsimd::sse4_2>& a,
                                                      const WordBatch<xsimd::sse4_2>& b) {
    return _mm_mul_epu32(a.data, b.data);
}
#endif

// The constants of Philox4x32 (core/rng.hpp): multipliers, and what is added to the key in each round.
inline constexpr std::uint64_t philox_multiplier[] = {0xD2511F53u, 0xCD9E8D57u};
inline constexpr std::uint32_t philox_increment[] = {0x9E3779B9u, 0xBB67AE85u};

// Eight words.
template <class Arch> struct Words {
    using Batch = WordBatch<Arch>;
    static constexpr int lanes = static_cast<int>(Batch::size);
    static constexpr int parts = width / lanes;
    Batch p[parts];

    Words() = default;
    SANDLANE_INLINE Words(std::uint64_t value) { // NOLINT: as for blocks
        for (int i = 0; i < parts; ++i) p[i] = Batch(value);
    }
    static SANDLANE_INLINE Words load(const std::uint64_t* from) { // unaligned
        Words r;
        for (int i = 0; i < parts; ++i) r.p[i] = Batch::load_unaligned(from + i * lanes);
        return r;
    }
    SANDLANE_INLINE void store(std::uint64_t* to) const {
        for (int i = 0; i < parts; ++i) p[i].store_unaligned(to + i * lanes);
    }
};

#define SANDLANE_WORDS(name, result)                                                                         \
    template <class A> SANDLANE_INLINE Words<A> name(const Words<A>& a, const Words<A>& b) {                 \
        Words<A> r;                                                                                          \
        for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = result;                                           \
        return r;                                                                                            \
    }
SANDLANE_WORDS(operator+, a.p[i] + b.p[i])
SANDLANE_WORDS(operator-, a.p[i] - b.p[i])
SANDLANE_WORDS(operator^, a.p[i] ^ b.p[i])
SANDLANE_WORDS(operator&, a.p[i] & b.p[i])
SANDLANE_WORDS(product, multiply_low(a.p[i], b.p[i])) // of the lower 32 bits of each
#undef SANDLANE_WORDS
// Shifts by constants.
template <int n, class A> SANDLANE_INLINE Words<A> right(const Words<A>& a) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = a.p[i] >> n;
    return r;
}
template <int n, class A> SANDLANE_INLINE Words<A> left(const Words<A>& a) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = a.p[i] << n;
    return r;
}

// The bits of doubles as words and back.
template <class A> SANDLANE_INLINE Words<A> words_of(const Block<A>& b) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = xsimd::bitwise_cast<WordBatch<A>>(b.p[i]);
    return r;
}
template <class A> SANDLANE_INLINE Block<A> block_of(const Words<A>& w) {
    Block<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = xsimd::bitwise_cast<typename Block<A>::Batch>(w.p[i]);
    return r;
}

// Words below 2^52 as numbers: exact.
template <class A> SANDLANE_INLINE Block<A> number_of(const Words<A>& w) {
    return block_of(w ^ Words<A>(std::bit_cast<std::uint64_t>(0x1p52))) - Block<A>(0x1p52);
}
// Whole numbers of [0, 2^52) as words: exact.
template <class A> SANDLANE_INLINE Words<A> word_of(const Block<A>& b) {
    return words_of(b + Block<A>(0x1p52)) ^ Words<A>(std::bit_cast<std::uint64_t>(0x1p52));
}

// The operations of laws/elementary.hpp.
template <class A> SANDLANE_INLINE Block<A> exponent_of(const Block<A>& x) {
    return number_of(right<52>(words_of(x))) - Block<A>(1023.0);
}
template <class A> SANDLANE_INLINE Block<A> fraction_of(const Block<A>& x) {
    const Words<A> digits = words_of(x) & Words<A>((std::uint64_t{1} << 52) - 1);
    return block_of(digits ^ Words<A>(std::uint64_t{1023} << 52));
}
template <class A> SANDLANE_INLINE Block<A> power_of_two(const Block<A>& n) {
    return block_of(left<52>(word_of(n + Block<A>(1023.0))));
}
template <class A> SANDLANE_INLINE Block<A> whole(const Block<A>& x) {
    return floor(x);
}

// ---- Philox4x32-10 in eight lanes (core/rng.hpp): words below 2^32

template <class A> struct PhiloxLanes { Words<A> w[4]; };

// For counters (c0, lane, c2, c3): what does not depend on the lane is computed once.
class Philox {
public:
    SANDLANE_INLINE Philox(std::uint32_t c0, std::uint32_t c2, std::uint32_t c3, const std::uint32_t* key) {
        std::uint32_t k0 = key[0], k1 = key[1];
        for (int round = 0; round < rounds; ++round) {
            key_[round][0] = k0;
            key_[round][1] = k1;
            k0 += philox_increment[0];
            k1 += philox_increment[1];
        }
        set(c0, c2, c3);
    }
    // Other words of the counter, the same key.
    SANDLANE_INLINE void set(std::uint32_t c0, std::uint32_t c2, std::uint32_t c3) {
        const std::uint64_t p0 = m0 * c0, p1 = m1 * c2;
        // Of the first round the lane changes only the first word, of the second only the last two.
        first_ = high(p1) ^ key_[0][0];
        const std::uint64_t b = low(p1), c = high(p0) ^ c3 ^ key_[0][1], d = low(p0);
        const std::uint64_t q = m1 * c;
        const std::uint64_t a2 = high(q) ^ b ^ key_[1][0], b2 = low(q);
        third_ = d ^ key_[1][1];
        // Of the third round, its first product.
        const std::uint64_t r = m0 * a2;
        high_ = high(r) ^ key_[2][1];
        low_ = low(r);
        second_ = b2 ^ key_[2][0];
    }
    template <class A> SANDLANE_INLINE PhiloxLanes<A> operator()(const Words<A>& lane) const {
        using W = Words<A>;
        const W product0(m0), product1(m1), mask(0xffffffffu);
        const W p = product(product0, lane ^ W(first_)); // second round
        // What stands in the upper halves does not reach the products; it is cut off at the end.
        const W q = product(product1, right<32>(p) ^ W(third_)); // third round
        W a = right<32>(q) ^ W(second_), b = q, c = p ^ W(high_), d(low_);
        for (int round = 3; round < rounds; ++round) {
            const W p0 = product(product0, a), p1 = product(product1, c);
            a = right<32>(p1) ^ b ^ W(key_[round][0]);
            b = p1;
            c = right<32>(p0) ^ d ^ W(key_[round][1]);
            d = p0;
        }
        return {{a & mask, b & mask, c & mask, d & mask}};
    }

private:
    static constexpr int rounds = 10;
    static constexpr std::uint64_t m0 = philox_multiplier[0], m1 = philox_multiplier[1];
    static SANDLANE_INLINE std::uint64_t high(std::uint64_t p) { return p >> 32; }
    static SANDLANE_INLINE std::uint64_t low(std::uint64_t p) { return p & 0xffffffffu; }

    std::uint64_t key_[rounds][2], first_, second_, third_, high_, low_;
};

// The number in [0, 1) of 53 bits of two words, as unit_number of core/rng.hpp.
template <class A> SANDLANE_INLINE Block<A> unit_number(const Words<A>& high, const Words<A>& low) {
    return (number_of(high) * Block<A>(0x1p21) + number_of(right<11>(low))) * Block<A>(0x1p-53);
}

} // namespace sandlane::simd
