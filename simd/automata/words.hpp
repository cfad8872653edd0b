// Registers of 64-bit words, one bit per site, and the random words of a lattice (spec 3.3).
#pragma once

#include "simd/words.hpp"

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

template <class Arch> SANDLANE_INLINE WordBatch<Arch> load_words(const std::uint64_t* from) {
    return WordBatch<Arch>::load_unaligned(from);
}

// 0, 1, 2, ... in the lanes.
template <class Arch> SANDLANE_INLINE WordBatch<Arch> lane_numbers() {
    alignas(64) std::uint64_t n[WordBatch<Arch>::size];
    for (std::size_t i = 0; i < WordBatch<Arch>::size; ++i) n[i] = i;
    return WordBatch<Arch>::load_aligned(n);
}

// Shifts of whole lanes by constants.
template <int n, class Arch> SANDLANE_INLINE WordBatch<Arch> left(const WordBatch<Arch>& a) {
    return a << n;
}
template <int n, class Arch> SANDLANE_INLINE WordBatch<Arch> right(const WordBatch<Arch>& a) {
    return a >> n;
}

struct WordSource {
    std::uint32_t key[2], row, step;
};

// Philox4x32-10 with one counter per lane, (word index, row, step, stream): out0 | out1 << 32. Only the lower
// halves of the lanes count until the end.
template <class Arch>
SANDLANE_INLINE WordBatch<Arch> random_words(const WordBatch<Arch>& index, const WordSource& source,
                                             std::uint32_t stream) {
    using W = WordBatch<Arch>;
    const W m0(philox_multiplier[0]), m1(philox_multiplier[1]);
    W c0 = index, c1(std::uint64_t{source.row}), c2(std::uint64_t{source.step}), c3(std::uint64_t{stream});
    std::uint32_t k0 = source.key[0], k1 = source.key[1];
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
        const W p0 = multiply_low(c0, m0), p1 = multiply_low(c2, m1);
        c0 = right<32>(p1) ^ c1 ^ W(std::uint64_t{k0});
        c2 = right<32>(p0) ^ c3 ^ W(std::uint64_t{k1});
        c1 = p1;
        c3 = p0;
        k0 += philox_increment[0];
        k1 += philox_increment[1];
    }
    return (c0 & W(0xffffffffULL)) | left<32>(c1);
}

// The same with counters and keys of their own in all lanes.
template <class Arch>
SANDLANE_INLINE WordBatch<Arch> random_words(WordBatch<Arch> c0, WordBatch<Arch> c1, WordBatch<Arch> c2,
                                             WordBatch<Arch> c3, WordBatch<Arch> k0, WordBatch<Arch> k1) {
    using W = WordBatch<Arch>;
    const W m0(philox_multiplier[0]), m1(philox_multiplier[1]);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
        const W p0 = multiply_low(c0, m0), p1 = multiply_low(c2, m1);
        c0 = right<32>(p1) ^ c1 ^ k0;
        c2 = right<32>(p0) ^ c3 ^ k1;
        c1 = p1;
        c3 = p0;
        k0 = k0 + W(std::uint64_t{philox_increment[0]});
        k1 = k1 + W(std::uint64_t{philox_increment[1]});
    }
    return (c0 & W(0xffffffffULL)) | left<32>(c1);
}

// ---- whole numbers and doubles

// Whole numbers below 2^51 and doubles, exactly: the bits of 1.5 2^52 plus the number.
template <class Arch> SANDLANE_INLINE xsimd::batch<double, Arch> to_double(const WordBatch<Arch>& whole) {
    using D = xsimd::batch<double, Arch>;
    return xsimd::bitwise_cast<D>(whole + WordBatch<Arch>(0x4338000000000000ULL)) - D(0x1.8p52);
}
template <class Arch> SANDLANE_INLINE WordBatch<Arch> to_whole(const xsimd::batch<double, Arch>& value) {
    using D = xsimd::batch<double, Arch>;
    return xsimd::bitwise_cast<WordBatch<Arch>>(value + D(0x1.8p52)) - WordBatch<Arch>(0x4338000000000000ULL);
}
// Uniform in [0, 1) with 53 bits, of random words: the first word is the upper one.
template <class Arch> SANDLANE_INLINE xsimd::batch<double, Arch> to_unit(const WordBatch<Arch>& random) {
    using D = xsimd::batch<double, Arch>;
    const WordBatch<Arch> bits = right<11>(left<32>(random) | right<32>(random));
    return (to_double<Arch>(right<32>(bits)) * D(0x1p32) +
            to_double<Arch>(bits & WordBatch<Arch>(0xffffffffULL))) *
           D(0x1p-53);
}

// Bits that are 1 with probability P/2^16, P not 0 and not 2^16: from the lowest set bit of P upwards.
template <class Arch>
SANDLANE_INLINE WordBatch<Arch> bernoulli_words(const WordBatch<Arch>& index, const WordSource& source,
                                                std::uint32_t stream, std::uint32_t probability) {
    using W = WordBatch<Arch>;
    W x(std::uint64_t{0});
    for (std::uint32_t bit = static_cast<std::uint32_t>(__builtin_ctz(probability)); bit < 16; ++bit) {
        const W w = random_words<Arch>(index, source, stream * 64 + bit);
        const W set(std::uint64_t{0} - (probability >> bit & 1U));
        x = (w & x) | (set & (w | x));
    }
    return x;
}

} // namespace sandlane::simd
