// Registers of 64-bit words, one bit per site, and the random words of a lattice (spec 3.3).
#pragma once

#include "core/real.hpp"

#include <xsimd/xsimd.hpp>

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

template <class Arch> using Words = xsimd::batch<std::uint64_t, Arch>;

template <class Arch> SANDLANE_INLINE Words<Arch> load_words(const std::uint64_t* from) {
    return Words<Arch>::load_unaligned(from);
}

// 0, 1, 2, ... in the lanes.
template <class Arch> SANDLANE_INLINE Words<Arch> lane_numbers() {
    alignas(64) std::uint64_t n[Words<Arch>::size];
    for (std::size_t i = 0; i < Words<Arch>::size; ++i) n[i] = i;
    return Words<Arch>::load_aligned(n);
}

// Product of the lower halves of the lanes.
template <class Arch> SANDLANE_INLINE Words<Arch> multiply_low(const Words<Arch>& a, const Words<Arch>& b) {
    const Words<Arch> low(0xffffffffULL);
    return (a & low) * (b & low);
}
#if defined(__AVX512F__)
SANDLANE_INLINE Words<xsimd::avx512bw> multiply_low(const Words<xsimd::avx512bw>& a,
                                                    const Words<xsimd::avx512bw>& b) {
    return _mm512_mul_epu32(a.data, b.data);
}
#elif defined(__AVX2__)
SANDLANE_INLINE Words<xsimd::avx2> multiply_low(const Words<xsimd::avx2>& a, const Words<xsimd::avx2>& b) {
    return _mm256_mul_epu32(a.data, b.data);
}
#elif defined(__SSE4_2__)
SANDLANE_INLINE Words<xsimd::sse4_2> multiply_low(const Words<xsimd::sse4_2>& a,
                                                  const Words<xsimd::sse4_2>& b) {
    return _mm_mul_epu32(a.data, b.data);
}
#endif

// Shifts of whole lanes by constants.
template <int n, class Arch> SANDLANE_INLINE Words<Arch> left(const Words<Arch>& a) {
    return a << n;
}
template <int n, class Arch> SANDLANE_INLINE Words<Arch> right(const Words<Arch>& a) {
    return a >> n;
}

struct WordSource {
    std::uint32_t key[2], row, step;
};

// Philox4x32-10 with one counter per lane, (word index, row, step, stream): out0 | out1 << 32. Only the lower
// halves of the lanes count until the end.
template <class Arch>
SANDLANE_INLINE Words<Arch> random_words(const Words<Arch>& index, const WordSource& source,
                                         std::uint32_t stream) {
    using W = Words<Arch>;
    const W m0(0xD2511F53ULL), m1(0xCD9E8D57ULL);
    W c0 = index, c1(std::uint64_t{source.row}), c2(std::uint64_t{source.step}), c3(std::uint64_t{stream});
    std::uint32_t k0 = source.key[0], k1 = source.key[1];
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
        const W p0 = multiply_low(c0, m0), p1 = multiply_low(c2, m1);
        c0 = right<32>(p1) ^ c1 ^ W(std::uint64_t{k0});
        c2 = right<32>(p0) ^ c3 ^ W(std::uint64_t{k1});
        c1 = p1;
        c3 = p0;
        k0 += 0x9E3779B9U;
        k1 += 0xBB67AE85U;
    }
    return (c0 & W(0xffffffffULL)) | left<32>(c1);
}

// The same with counters and keys of their own in all lanes.
template <class Arch>
SANDLANE_INLINE Words<Arch> random_words(Words<Arch> c0, Words<Arch> c1, Words<Arch> c2, Words<Arch> c3,
                                         Words<Arch> k0, Words<Arch> k1) {
    using W = Words<Arch>;
    const W m0(0xD2511F53ULL), m1(0xCD9E8D57ULL);
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
        const W p0 = multiply_low(c0, m0), p1 = multiply_low(c2, m1);
        c0 = right<32>(p1) ^ c1 ^ k0;
        c2 = right<32>(p0) ^ c3 ^ k1;
        c1 = p1;
        c3 = p0;
        k0 = k0 + W(0x9E3779B9ULL);
        k1 = k1 + W(0xBB67AE85ULL);
    }
    return (c0 & W(0xffffffffULL)) | left<32>(c1);
}

// ---- whole numbers and doubles

// Whole numbers below 2^51 and doubles, exactly: the bits of 1.5 2^52 plus the number.
template <class Arch> SANDLANE_INLINE xsimd::batch<double, Arch> to_double(const Words<Arch>& whole) {
    using D = xsimd::batch<double, Arch>;
    return xsimd::bitwise_cast<D>(whole + Words<Arch>(0x4338000000000000ULL)) - D(0x1.8p52);
}
template <class Arch> SANDLANE_INLINE Words<Arch> to_whole(const xsimd::batch<double, Arch>& value) {
    using D = xsimd::batch<double, Arch>;
    return xsimd::bitwise_cast<Words<Arch>>(value + D(0x1.8p52)) - Words<Arch>(0x4338000000000000ULL);
}
// Uniform in [0, 1) with 53 bits, of random words: the first word is the upper one.
template <class Arch> SANDLANE_INLINE xsimd::batch<double, Arch> to_unit(const Words<Arch>& random) {
    using D = xsimd::batch<double, Arch>;
    const Words<Arch> bits = right<11>(left<32>(random) | right<32>(random));
    return (to_double<Arch>(right<32>(bits)) * D(0x1p32) +
            to_double<Arch>(bits & Words<Arch>(0xffffffffULL))) *
           D(0x1p-53);
}

// Bits that are 1 with probability P/2^16, P not 0 and not 2^16: from the lowest set bit of P upwards.
template <class Arch>
SANDLANE_INLINE Words<Arch> bernoulli_words(const Words<Arch>& index, const WordSource& source,
                                            std::uint32_t stream, std::uint32_t probability) {
    using W = Words<Arch>;
    W x(std::uint64_t{0});
    for (std::uint32_t bit = static_cast<std::uint32_t>(__builtin_ctz(probability)); bit < 16; ++bit) {
        const W w = random_words<Arch>(index, source, stream * 64 + bit);
        const W set(std::uint64_t{0} - (probability >> bit & 1U));
        x = (w & x) | (set & (w | x));
    }
    return x;
}

} // namespace sandlane::simd
