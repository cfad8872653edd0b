// Rows of four doubles that follow each other, as the particles of a gas do.
#pragma once

#include "simd/rows.hpp"

#include <cstring>

namespace sandlane::simd {

template <class Arch> SANDLANE_INLINE void copy_row(double* to, const double* from) {
    std::memcpy(to, from, 4 * sizeof(double));
}
// Eight rows as they are.
template <class Arch> SANDLANE_INLINE void copy_rows(double* to, const double* from) {
    Block<Arch> rows[4];
    for (int r = 0; r < 4; ++r) rows[r] = load<Arch>(from + r * width);
    for (int r = 0; r < 4; ++r) store(to + r * width, rows[r]);
}

// Four blocks as eight rows.
template <class Arch> SANDLANE_INLINE void store_rows(const Block<Arch> (&field)[4], double* rows) {
    Rows<Arch, 4>::store(field, rows);
}
#if defined(__AVX512F__)
SANDLANE_INLINE void store_rows(const Block<xsimd::avx512bw> (&field)[4], double* rows) {
    const __m512d a = _mm512_shuffle_f64x2(field[0].p[0], field[1].p[0], 0x44); // x0-3 y0-3
    const __m512d b = _mm512_shuffle_f64x2(field[0].p[0], field[1].p[0], 0xee); // x4-7 y4-7
    const __m512d c = _mm512_shuffle_f64x2(field[2].p[0], field[3].p[0], 0x44);
    const __m512d d = _mm512_shuffle_f64x2(field[2].p[0], field[3].p[0], 0xee);
    const __m512i first = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13);
    const __m512i second = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
    _mm512_storeu_pd(rows, _mm512_permutex2var_pd(a, first, c));
    _mm512_storeu_pd(rows + 8, _mm512_permutex2var_pd(a, second, c));
    _mm512_storeu_pd(rows + 16, _mm512_permutex2var_pd(b, first, d));
    _mm512_storeu_pd(rows + 24, _mm512_permutex2var_pd(b, second, d));
}
#endif

// Eight rows at byte offsets, and back for the first `lanes` of them.
template <class Arch>
SANDLANE_INLINE void gather_rows(const double* base, const std::uint64_t* offset, Block<Arch> (&field)[4]) {
    alignas(64) double rows[4 * width];
    for (int l = 0; l < width; ++l)
        std::memcpy(rows + 4 * l, reinterpret_cast<const char*>(base) + offset[l], 4 * sizeof(double));
    Rows<Arch, 4>::load(rows, field);
}
#if defined(__AVX512F__)
SANDLANE_INLINE void gather_rows(const double* base, const std::uint64_t* offset,
                                 Block<xsimd::avx512bw> (&field)[4]) {
    const auto row = [&](int l) {
        return _mm256_loadu_pd(
            reinterpret_cast<const double*>(reinterpret_cast<const char*>(base) + offset[l]));
    };
    __m512d r[4];
    for (int n = 0; n < 4; ++n)
        r[n] = _mm512_insertf64x4(_mm512_castpd256_pd512(row(2 * n)), row(2 * n + 1), 1);
    Rows<xsimd::avx512bw, 4>::columns(r, field);
}
#endif
template <class Arch>
SANDLANE_INLINE void scatter_rows(const Block<Arch> (&field)[4], double* base, const std::uint64_t* offset,
                                  int lanes) {
    alignas(64) double rows[4 * width];
    store_rows(field, rows);
    for (int l = 0; l < lanes; ++l)
        std::memcpy(reinterpret_cast<char*>(base) + offset[l], rows + 4 * l, 4 * sizeof(double));
}

// Of pairs of rows in two blocks: largest of the first less smallest of the second, by column.
template <class Arch>
SANDLANE_INLINE void store_extent(const Block<Arch>& high, const Block<Arch>& low, double* row) {
    constexpr int half = Block<Arch>::parts / 2;
    for (int p = 0; p < half; ++p)
        (xsimd::max(high.p[p], high.p[p + half]) - xsimd::min(low.p[p], low.p[p + half]))
            .store_unaligned(row + p * Block<Arch>::lanes);
}
#if defined(__AVX512F__)
SANDLANE_INLINE void store_extent(const Block<xsimd::avx512bw>& high, const Block<xsimd::avx512bw>& low,
                                  double* row) {
    const __m256d most =
        _mm256_max_pd(_mm512_castpd512_pd256(high.p[0]), _mm512_extractf64x4_pd(high.p[0], 1));
    const __m256d least =
        _mm256_min_pd(_mm512_castpd512_pd256(low.p[0]), _mm512_extractf64x4_pd(low.p[0], 1));
    _mm256_storeu_pd(row, _mm256_sub_pd(most, least));
}
#endif

} // namespace sandlane::simd
