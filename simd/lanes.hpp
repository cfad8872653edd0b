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

template <class A> SANDLANE_INLINE bool any(const Mask<A>& m) {
    return bits(m) != 0;
}

// Largest lane; exact, so the order does not matter. The block must hold no NaN.
template <class A> SANDLANE_INLINE double largest(const Block<A>& b) {
    double lanes[width];
    store(lanes, b);
    double r = lanes[0];
    for (int i = 1; i < width; ++i) r = lanes[i] > r ? lanes[i] : r;
    return r;
}

} // namespace sandlane::simd
