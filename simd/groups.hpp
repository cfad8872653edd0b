// Groups of sixteen floats for the distance stage of the lattice.
#pragma once

#include "simd/lanes.hpp"

namespace sandlane::simd {

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

} // namespace sandlane::simd
