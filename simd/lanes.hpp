// The one wrapper over xsimd: blocks of eight doubles on every instruction set (one AVX-512, two AVX2, four
// SSE registers), so that the grouping of operations, and with it every bit, is the same everywhere.
// Operations that xsimd 8.1 lacks (bit masks, compress, transposes) have a specialisation per instruction set
// and a portable fallback.
#pragma once

#include "core/real.hpp"

#include <xsimd/xsimd.hpp>

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

inline constexpr int width = 8;

template <class Arch> struct Block {
    using Batch = xsimd::batch<double, Arch>;
    static constexpr int lanes = static_cast<int>(Batch::size);
    static constexpr int parts = width / lanes;
    Batch p[parts];

    Block() = default;
    SANDLANE_INLINE Block(double value) { // NOLINT: formulas write R(0.5)
        for (int i = 0; i < parts; ++i) p[i] = Batch(value);
    }
};

template <class Arch> struct Mask { xsimd::batch_bool<double, Arch> p[Block<Arch>::parts]; };

#define SANDLANE_BINARY(op)                                                                                  \
    template <class A> SANDLANE_INLINE Block<A> operator op(const Block<A>& a, const Block<A>& b) {          \
        Block<A> r;                                                                                          \
        for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = a.p[i] op b.p[i];                                 \
        return r;                                                                                            \
    }
SANDLANE_BINARY(+)
SANDLANE_BINARY(-)
SANDLANE_BINARY(*)
SANDLANE_BINARY(/)
#undef SANDLANE_BINARY

#define SANDLANE_COMPARE(op)                                                                                 \
    template <class A> SANDLANE_INLINE Mask<A> operator op(const Block<A>& a, const Block<A>& b) {           \
        Mask<A> r;                                                                                           \
        for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = a.p[i] op b.p[i];                                 \
        return r;                                                                                            \
    }
SANDLANE_COMPARE(<)
SANDLANE_COMPARE(>)
SANDLANE_COMPARE(>=)
#undef SANDLANE_COMPARE

template <class A> SANDLANE_INLINE Block<A> operator-(const Block<A>& a) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = a.p[i] ^ typename Block<A>::Batch(-0.0);
    return r;
}
template <class A> SANDLANE_INLINE Mask<A> operator&(const Mask<A>& a, const Mask<A>& b) {
    Mask<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = a.p[i] & b.p[i];
    return r;
}
template <class A> SANDLANE_INLINE Block<A> sqrt(const Block<A>& a) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = xsimd::sqrt(a.p[i]);
    return r;
}
template <class A> SANDLANE_INLINE Block<A> floor(const Block<A>& a) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = xsimd::floor(a.p[i]);
    return r;
}
template <class A> SANDLANE_INLINE Block<A> max(const Block<A>& a, const Block<A>& b) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = xsimd::max(a.p[i], b.p[i]);
    return r;
}
template <class A> SANDLANE_INLINE Block<A> min(const Block<A>& a, const Block<A>& b) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = xsimd::min(a.p[i], b.p[i]);
    return r;
}
template <class A>
SANDLANE_INLINE Block<A> select(const Mask<A>& m, const Block<A>& yes, const Block<A>& no) {
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i) r.p[i] = xsimd::select(m.p[i], yes.p[i], no.p[i]);
    return r;
}

template <class A> SANDLANE_INLINE Block<A> load(const double* from) { // unaligned
    Block<A> r;
    for (int i = 0; i < Block<A>::parts; ++i)
        r.p[i] = Block<A>::Batch::load_unaligned(from + i * Block<A>::lanes);
    return r;
}
template <class A> SANDLANE_INLINE void store(double* to, const Block<A>& b) { // unaligned
    for (int i = 0; i < Block<A>::parts; ++i) b.p[i].store_unaligned(to + i * Block<A>::lanes);
}

// ---- bit masks: bit l of the result is lane l

template <class Arch> SANDLANE_INLINE unsigned register_bits(const xsimd::batch_bool<double, Arch>& m) {
    bool lanes[Block<Arch>::lanes];
    m.store_unaligned(lanes);
    unsigned bits = 0;
    for (int i = 0; i < Block<Arch>::lanes; ++i) bits |= static_cast<unsigned>(lanes[i]) << i;
    return bits;
}
#if defined(__AVX512F__)
SANDLANE_INLINE unsigned register_bits(const xsimd::batch_bool<double, xsimd::avx512bw>& m) {
    return m.data;
}
#elif defined(__AVX2__)
SANDLANE_INLINE unsigned register_bits(const xsimd::batch_bool<double, xsimd::avx2>& m) {
    return static_cast<unsigned>(_mm256_movemask_pd(m.data));
}
#elif defined(__SSE4_2__)
SANDLANE_INLINE unsigned register_bits(const xsimd::batch_bool<double, xsimd::sse4_2>& m) {
    return static_cast<unsigned>(_mm_movemask_pd(m.data));
}
#endif

template <class A> SANDLANE_INLINE unsigned bits(const Mask<A>& m) {
    unsigned r = 0;
    for (int i = 0; i < Block<A>::parts; ++i) r |= register_bits(m.p[i]) << (i * Block<A>::lanes);
    return r;
}

// Largest lane; exact, so the order does not matter. The block must hold no NaN.
template <class A> SANDLANE_INLINE double largest(const Block<A>& b) {
    double lanes[width];
    store(lanes, b);
    double r = lanes[0];
    for (int i = 1; i < width; ++i) r = lanes[i] > r ? lanes[i] : r;
    return r;
}

// ---- groups of sixteen floats for the distance stage of the lattice

inline constexpr int group_width = 16;

template <class Arch> struct Group {
    using Batch = xsimd::batch<float, Arch>;
    static constexpr int lanes = static_cast<int>(Batch::size);
    static constexpr int parts = group_width / lanes;
    Batch p[parts];

    Group() = default;
    explicit SANDLANE_INLINE Group(float value) {
        for (int i = 0; i < parts; ++i) p[i] = Batch(value);
    }
    static SANDLANE_INLINE Group load(const float* from) { // unaligned
        Group r;
        for (int i = 0; i < parts; ++i) r.p[i] = Batch::load_unaligned(from + i * lanes);
        return r;
    }
};
#define SANDLANE_GROUP(op)                                                                                   \
    template <class A> SANDLANE_INLINE Group<A> operator op(const Group<A>& a, const Group<A>& b) {          \
        Group<A> r;                                                                                          \
        for (int i = 0; i < Group<A>::parts; ++i) r.p[i] = a.p[i] op b.p[i];                                 \
        return r;                                                                                            \
    }
SANDLANE_GROUP(+)
SANDLANE_GROUP(-)
SANDLANE_GROUP(*)
#undef SANDLANE_GROUP

template <class Arch>
SANDLANE_INLINE unsigned less_bits(const xsimd::batch<float, Arch>& a, const xsimd::batch<float, Arch>& b) {
    bool lanes[Group<Arch>::lanes];
    (a < b).store_unaligned(lanes);
    unsigned r = 0;
    for (int i = 0; i < Group<Arch>::lanes; ++i) r |= static_cast<unsigned>(lanes[i]) << i;
    return r;
}
#if defined(__AVX512F__)
SANDLANE_INLINE unsigned less_bits(const xsimd::batch<float, xsimd::avx512bw>& a,
                                   const xsimd::batch<float, xsimd::avx512bw>& b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
#elif defined(__AVX2__)
SANDLANE_INLINE unsigned less_bits(const xsimd::batch<float, xsimd::avx2>& a,
                                   const xsimd::batch<float, xsimd::avx2>& b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
}
#elif defined(__SSE4_2__)
SANDLANE_INLINE unsigned less_bits(const xsimd::batch<float, xsimd::sse4_2>& a,
                                   const xsimd::batch<float, xsimd::sse4_2>& b) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
}
#endif
// Bit l: a < b in lane l.
template <class A> SANDLANE_INLINE unsigned less(const Group<A>& a, const Group<A>& b) {
    unsigned r = 0;
    for (int i = 0; i < Group<A>::parts; ++i) r |= less_bits(a.p[i], b.p[i]) << (i * Group<A>::lanes);
    return r;
}

// ---- compress: packs the 32-bit integers whose bit is set to the front
// Writes at least the chosen integers and at most `count`; the
// caller advances by the number of bits. On the cores measured, compressing in a register and storing the
// whole is 6 cycles where a compressing store costs 61.

// `count` integers, 8 or 16, that are loaded once and compressed several times.
template <class Arch, int count> struct Integers {
    const std::int32_t* from;
    explicit SANDLANE_INLINE Integers(const std::int32_t* source) : from(source) {}
    SANDLANE_INLINE void compress(unsigned mask, std::int32_t* to) const {
        for (int n = 0; mask != 0; mask &= mask - 1) to[n++] = from[__builtin_ctz(mask)];
    }
};
#if defined(__AVX512VL__)
template <> struct Integers<xsimd::avx512bw, 8> {
    __m256i value;
    explicit SANDLANE_INLINE Integers(const std::int32_t* from)
        : value(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))) {}
    SANDLANE_INLINE void compress(unsigned mask, std::int32_t* to) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_maskz_compress_epi32(static_cast<__mmask8>(mask), value));
    }
};
template <> struct Integers<xsimd::avx512bw, 16> {
    __m512i value;
    explicit SANDLANE_INLINE Integers(const std::int32_t* from) : value(_mm512_loadu_si512(from)) {}
    SANDLANE_INLINE void compress(unsigned mask, std::int32_t* to) const {
        const __m512i packed = _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), value);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_castsi512_si256(packed));
        // More than eight of sixteen are rare: half the store traffic is worth the branch.
        if (__builtin_popcount(mask) > 8)
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 8), _mm512_extracti64x4_epi64(packed, 1));
    }
};
#elif defined(__AVX2__)
// Entry m holds, one byte each, the positions of the set bits of m.
struct CompressTable {
    std::uint64_t entry[256];
    constexpr CompressTable() : entry{} {
        for (unsigned m = 0; m < 256; ++m) {
            unsigned n = 0;
            for (unsigned bit = 0; bit < 8; ++bit)
                if ((m >> bit & 1u) != 0) entry[m] |= std::uint64_t{bit} << (8 * n++);
        }
    }
};
constexpr CompressTable compress_table; // internal linkage: no symbol of a wide instruction set escapes
template <int count> struct Integers<xsimd::avx2, count> {
    __m256i value[count / 8];
    explicit SANDLANE_INLINE Integers(const std::int32_t* from) {
        for (int part = 0; part < count / 8; ++part)
            value[part] = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 8 * part));
    }
    SANDLANE_INLINE void compress(unsigned mask, std::int32_t* to) const {
        for (int part = 0; part < count / 8; ++part) {
            const unsigned byte = mask >> (8 * part) & 0xffu;
            const __m128i bytes = _mm_cvtsi64_si128(static_cast<long long>(compress_table.entry[byte]));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                                _mm256_permutevar8x32_epi32(value[part], _mm256_cvtepu8_epi32(bytes)));
            to += __builtin_popcount(byte);
        }
    }
};
#endif

// Packs the doubles whose bit is set to the front. Writes whole registers: up to eight doubles.
template <class Arch> SANDLANE_INLINE void compress(const Block<Arch>& b, unsigned mask, double* to) {
    double lanes[width];
    store(lanes, b);
    for (int n = 0; mask != 0; mask &= mask - 1) to[n++] = lanes[__builtin_ctz(mask)];
}
#if defined(__AVX512F__)
SANDLANE_INLINE void compress(const Block<xsimd::avx512bw>& b, unsigned mask, double* to) {
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(static_cast<__mmask8>(mask), b.p[0]));
}
#elif defined(__AVX2__)
// Entry m holds, one byte each, the halves of the doubles whose bit is set in m.
struct CompressDoubles {
    std::uint64_t entry[16];
    constexpr CompressDoubles() : entry{} {
        for (unsigned m = 0; m < 16; ++m) {
            unsigned n = 0;
            for (unsigned bit = 0; bit < 4; ++bit)
                if ((m >> bit & 1u) != 0) {
                    entry[m] |= std::uint64_t{2 * bit + 256 * (2 * bit + 1)} << (16 * n);
                    ++n;
                }
        }
    }
};
constexpr CompressDoubles compress_doubles;
SANDLANE_INLINE void compress(const Block<xsimd::avx2>& b, unsigned mask, double* to) {
    for (int part = 0; part < 2; ++part) {
        const unsigned half = mask >> (4 * part) & 15u;
        const __m128i bytes = _mm_cvtsi64_si128(static_cast<long long>(compress_doubles.entry[half]));
        const __m256i halves = _mm256_castpd_si256(b.p[part]);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_permutevar8x32_epi32(halves, _mm256_cvtepu8_epi32(bytes)));
        to += __builtin_popcount(half);
    }
}
#endif

// ---- rows of four doubles: a force and its reaction, which has the same fourth and third field (equal
// torque signs, docs/physics.md 2)

template <class Arch> SANDLANE_INLINE void add_row(double* to, const double* row) {
    to[0] += row[0];
    to[1] += row[1];
    to[2] += row[2];
}
template <class Arch> SANDLANE_INLINE void add_mirrored_row(double* to, const double* row) {
    to[0] -= row[0];
    to[1] -= row[1];
    to[2] += row[2];
}
#if defined(__AVX2__)
template <> SANDLANE_INLINE void add_row<xsimd::avx2>(double* to, const double* row) {
    _mm256_storeu_pd(to, _mm256_add_pd(_mm256_loadu_pd(to), _mm256_loadu_pd(row)));
}
template <> SANDLANE_INLINE void add_mirrored_row<xsimd::avx2>(double* to, const double* row) {
    const __m256d signs = _mm256_setr_pd(-0.0, -0.0, 0.0, 0.0);
    _mm256_storeu_pd(to, _mm256_add_pd(_mm256_loadu_pd(to), _mm256_xor_pd(signs, _mm256_loadu_pd(row))));
}
#endif
#if defined(__AVX512F__)
template <> SANDLANE_INLINE void add_row<xsimd::avx512bw>(double* to, const double* row) {
    _mm256_storeu_pd(to, _mm256_add_pd(_mm256_loadu_pd(to), _mm256_loadu_pd(row)));
}
template <> SANDLANE_INLINE void add_mirrored_row<xsimd::avx512bw>(double* to, const double* row) {
    const __m256d signs = _mm256_setr_pd(-0.0, -0.0, 0.0, 0.0);
    _mm256_storeu_pd(to, _mm256_add_pd(_mm256_loadu_pd(to), _mm256_xor_pd(signs, _mm256_loadu_pd(row))));
}
#endif

// ---- transposes

// field[f] lane l = rows[l][f] for f < 4 of (j - i) and f >= 4 of (j + i): the combined records of eight
// pairs.
template <class Arch> struct CombinePairs {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<Arch> (&field)[8]) {
        alignas(64) double transposed[8][width];
        for (int l = 0; l < width; ++l) {
            const double* a = records + std::ptrdiff_t{i[l]} * 8;
            const double* b = records + std::ptrdiff_t{j[l]} * 8;
            for (int f = 0; f < 4; ++f) transposed[f][l] = b[f] - a[f];
            for (int f = 4; f < 8; ++f) transposed[f][l] = b[f] + a[f];
        }
        for (int f = 0; f < 8; ++f) field[f] = load<Arch>(transposed[f]);
    }
};

// Row l of `rows`, `stride` doubles apart, gets (x, y, z, w) of lane l.
template <class Arch> struct StoreRows {
    static SANDLANE_INLINE void apply(const Block<Arch>& x, const Block<Arch>& y, const Block<Arch>& z,
                                      const Block<Arch>& w, double* rows, std::ptrdiff_t stride) {
        double lanes[4][width];
        store(lanes[0], x);
        store(lanes[1], y);
        store(lanes[2], z);
        store(lanes[3], w);
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < 4; ++f) rows[stride * l + f] = lanes[f][l];
    }
};

// The first three values of eight rows of four doubles, one block each.
template <class Arch> struct LoadRows {
    static SANDLANE_INLINE void apply(const double* rows, Block<Arch>& x, Block<Arch>& y, Block<Arch>& z) {
        double lanes[3][width];
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < 3; ++f) lanes[f][l] = rows[4 * l + f];
        x = load<Arch>(lanes[0]);
        y = load<Arch>(lanes[1]);
        z = load<Arch>(lanes[2]);
    }
};

#if defined(__AVX2__)
SANDLANE_INLINE void transpose4(__m256d& a, __m256d& b, __m256d& c, __m256d& d) {
    const __m256d ab0 = _mm256_unpacklo_pd(a, b), ab1 = _mm256_unpackhi_pd(a, b);
    const __m256d cd0 = _mm256_unpacklo_pd(c, d), cd1 = _mm256_unpackhi_pd(c, d);
    a = _mm256_permute2f128_pd(ab0, cd0, 0x20);
    b = _mm256_permute2f128_pd(ab1, cd1, 0x20);
    c = _mm256_permute2f128_pd(ab0, cd0, 0x31);
    d = _mm256_permute2f128_pd(ab1, cd1, 0x31);
}
#endif

#if defined(__AVX512F__)
// 8x8 transpose of doubles in three rounds of pairwise exchanges.
SANDLANE_INLINE void transpose8(__m512d (&r)[8]) {
    __m512d t[8];
    for (int i = 0; i < 8; i += 2) {
        t[i] = _mm512_unpacklo_pd(r[i], r[i + 1]);
        t[i + 1] = _mm512_unpackhi_pd(r[i], r[i + 1]);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; ++k) {
            r[i + k] = _mm512_shuffle_f64x2(t[i + k], t[i + k + 2], 0x88);
            r[i + k + 2] = _mm512_shuffle_f64x2(t[i + k], t[i + k + 2], 0xdd);
        }
    for (int k = 0; k < 4; ++k) {
        t[k] = _mm512_shuffle_f64x2(r[k], r[k + 4], 0x88);
        t[k + 4] = _mm512_shuffle_f64x2(r[k], r[k + 4], 0xdd);
    }
    for (int i = 0; i < 8; ++i) r[i] = t[i];
}
template <> struct CombinePairs<xsimd::avx512bw> {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<xsimd::avx512bw> (&field)[8]) {
        __m512d row[8];
        for (int l = 0; l < width; ++l) {
            const __m512d a = _mm512_loadu_pd(records + std::ptrdiff_t{i[l]} * 8);
            const __m512d b = _mm512_loadu_pd(records + std::ptrdiff_t{j[l]} * 8);
            row[l] = _mm512_mask_add_pd(_mm512_sub_pd(b, a), 0xf0, b, a);
        }
        transpose8(row);
        for (int f = 0; f < 8; ++f) field[f].p[0] = row[f];
    }
};
template <> struct StoreRows<xsimd::avx512bw> {
    using Lanes = Block<xsimd::avx512bw>;
    static SANDLANE_INLINE void apply(const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& w,
                                      double* rows, std::ptrdiff_t stride) {
        const __m512d xy[2] = {_mm512_unpacklo_pd(x.p[0], y.p[0]), _mm512_unpackhi_pd(x.p[0], y.p[0])};
        const __m512d zw[2] = {_mm512_unpacklo_pd(z.p[0], w.p[0]), _mm512_unpackhi_pd(z.p[0], w.p[0])};
        const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
        const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
        for (int odd = 0; odd < 2; ++odd) {
            const __m512d first = _mm512_permutex2var_pd(xy[odd], low, zw[odd]);   // lanes odd, odd + 2
            const __m512d second = _mm512_permutex2var_pd(xy[odd], high, zw[odd]); // lanes odd + 4, odd + 6
            _mm256_storeu_pd(rows + stride * odd, _mm512_castpd512_pd256(first));
            _mm256_storeu_pd(rows + stride * (odd + 2), _mm512_extractf64x4_pd(first, 1));
            _mm256_storeu_pd(rows + stride * (odd + 4), _mm512_castpd512_pd256(second));
            _mm256_storeu_pd(rows + stride * (odd + 6), _mm512_extractf64x4_pd(second, 1));
        }
    }
};
template <> struct LoadRows<xsimd::avx512bw> {
    using Lanes = Block<xsimd::avx512bw>;
    static SANDLANE_INLINE void apply(const double* rows, Lanes& x, Lanes& y, Lanes& z) {
        const __m512d r0 = _mm512_loadu_pd(rows), r1 = _mm512_loadu_pd(rows + 8);
        const __m512d r2 = _mm512_loadu_pd(rows + 16), r3 = _mm512_loadu_pd(rows + 24);
        const __m512i xy = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13);
        const __m512i zw = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
        const __m512d a = _mm512_permutex2var_pd(r0, xy, r1), b = _mm512_permutex2var_pd(r2, xy, r3);
        x.p[0] = _mm512_shuffle_f64x2(a, b, 0x44);
        y.p[0] = _mm512_shuffle_f64x2(a, b, 0xee);
        z.p[0] = _mm512_shuffle_f64x2(_mm512_permutex2var_pd(r0, zw, r1), _mm512_permutex2var_pd(r2, zw, r3),
                                      0x44);
    }
};
#elif defined(__AVX2__)
template <> struct CombinePairs<xsimd::avx2> {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<xsimd::avx2> (&field)[8]) {
        for (int part = 0; part < 2; ++part) {
            __m256d low[4], high[4];
            for (int l = 0; l < 4; ++l) {
                const double* a = records + std::ptrdiff_t{i[4 * part + l]} * 8;
                const double* b = records + std::ptrdiff_t{j[4 * part + l]} * 8;
                low[l] = _mm256_sub_pd(_mm256_loadu_pd(b), _mm256_loadu_pd(a));
                high[l] = _mm256_add_pd(_mm256_loadu_pd(b + 4), _mm256_loadu_pd(a + 4));
            }
            transpose4(low[0], low[1], low[2], low[3]);
            transpose4(high[0], high[1], high[2], high[3]);
            for (int f = 0; f < 4; ++f) {
                field[f].p[part] = low[f];
                field[f + 4].p[part] = high[f];
            }
        }
    }
};
template <> struct StoreRows<xsimd::avx2> {
    using Lanes = Block<xsimd::avx2>;
    static SANDLANE_INLINE void apply(const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& w,
                                      double* rows, std::ptrdiff_t stride) {
        for (int part = 0; part < 2; ++part) {
            __m256d a = x.p[part], b = y.p[part], c = z.p[part], d = w.p[part];
            transpose4(a, b, c, d);
            double* to = rows + 4 * part * stride;
            _mm256_storeu_pd(to, a);
            _mm256_storeu_pd(to + stride, b);
            _mm256_storeu_pd(to + 2 * stride, c);
            _mm256_storeu_pd(to + 3 * stride, d);
        }
    }
};
template <> struct LoadRows<xsimd::avx2> {
    using Lanes = Block<xsimd::avx2>;
    static SANDLANE_INLINE void apply(const double* rows, Lanes& x, Lanes& y, Lanes& z) {
        for (int part = 0; part < 2; ++part) {
            const double* from = rows + 16 * part;
            __m256d a = _mm256_loadu_pd(from), b = _mm256_loadu_pd(from + 4);
            __m256d c = _mm256_loadu_pd(from + 8), d = _mm256_loadu_pd(from + 12);
            transpose4(a, b, c, d);
            x.p[part] = a;
            y.p[part] = b;
            z.p[part] = c;
        }
    }
};
#endif

} // namespace sandlane::simd
