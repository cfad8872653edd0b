// Rows of four or eight doubles in memory, one per particle or pair, as blocks of lanes and back; and the
// combination of the records of eight pairs.
#pragma once

#include "simd/lanes.hpp"
#include "simd/records.hpp"

namespace sandlane::simd {

// ---- a force and its reaction

template <class Arch, int dimension, int fields> struct ForceRow {
    static SANDLANE_INLINE void add(double* to, const double* row) {
        for (int f = 0; f < fields; ++f) to[f] += row[f];
    }
    static SANDLANE_INLINE void add_mirrored(double* to, const double* row) {
        for (int f = 0; f < fields; ++f) to[f] = is_mirrored(dimension, f) ? to[f] - row[f] : to[f] + row[f];
    }
};
#if defined(__AVX2__)
// Minus zero where the field is mirrored.
template <int dimension, int first> SANDLANE_INLINE __m256d mirror_signs() {
    const auto sign = [](int f) { return is_mirrored(dimension, first + f) ? -0.0 : 0.0; };
    return _mm256_setr_pd(sign(0), sign(1), sign(2), sign(3));
}
template <class Arch, int dimension, int fields> struct WideForceRow {
    static SANDLANE_INLINE void add(double* to, const double* row) {
        for (int f = 0; f < fields; f += 4)
            _mm256_storeu_pd(to + f, _mm256_add_pd(_mm256_loadu_pd(to + f), _mm256_loadu_pd(row + f)));
    }
    template <int first> static SANDLANE_INLINE void add_part(double* to, const double* row) {
        const __m256d other = _mm256_xor_pd(mirror_signs<dimension, first>(), _mm256_loadu_pd(row + first));
        _mm256_storeu_pd(to + first, _mm256_add_pd(_mm256_loadu_pd(to + first), other));
    }
    static SANDLANE_INLINE void add_mirrored(double* to, const double* row) {
        add_part<0>(to, row);
        if constexpr (fields > 4) add_part<4>(to, row);
        if constexpr (fields > 8) add_part<8>(to, row);
    }
};
template <int dimension, int fields>
struct ForceRow<xsimd::avx2, dimension, fields> : WideForceRow<xsimd::avx2, dimension, fields> {};
#if defined(__AVX512F__)
template <int dimension, int fields>
struct ForceRow<xsimd::avx512bw, dimension, fields> : WideForceRow<xsimd::avx512bw, dimension, fields> {};
template <int dimension> struct ForceRow<xsimd::avx512bw, dimension, 8> {
    static SANDLANE_INLINE void add(double* to, const double* row) {
        _mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), _mm512_loadu_pd(row)));
    }
    static SANDLANE_INLINE void add_mirrored(double* to, const double* row) {
        const __m256d low = mirror_signs<dimension, 0>(), high = mirror_signs<dimension, 4>();
        const __m512d signs = _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
        const __m512d other = _mm512_xor_pd(signs, _mm512_loadu_pd(row));
        _mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), other));
    }
};
#endif
#endif

// ---- forces of contacts in the order of their first grains

// Adds rows to the grains of a tile. The sum of the grain added to last stays in registers, so that no
// addition waits for the store before it, and nothing branches on where the next grain begins: its row is
// read from memory, that of the same grain from nowhere (`row` is as good as any).
template <class Arch, int dimension, int fields> class RunningRow {
public:
    SANDLANE_INLINE explicit RunningRow(double* force) : force_(force) {}
    SANDLANE_INLINE void add(std::ptrdiff_t grain, const double* row) {
        ForceRow<Arch, dimension, fields>::add(force_ + grain * fields, row);
    }

private:
    double* force_;
};
#if defined(__AVX2__)
// `same`: all bits or none.
SANDLANE_INLINE const double* where(std::uintptr_t same, const double* row, const double* other) {
    const auto a = reinterpret_cast<std::uintptr_t>(other), b = reinterpret_cast<std::uintptr_t>(row);
    return reinterpret_cast<const double*>(a ^ ((a ^ b) & same));
}
template <int fields> class WideRunningRow {
public:
    SANDLANE_INLINE explicit WideRunningRow(double* force) : force_(force) {
        for (__m256d& s : sum_) s = _mm256_setzero_pd();
    }
    SANDLANE_INLINE void add(std::ptrdiff_t grain, const double* row) {
        double* const to = force_ + grain * fields;
        const std::uintptr_t same = -static_cast<std::uintptr_t>(grain == last_);
        const double* const from = where(same, row, to);
        const __m256d lasts = _mm256_castsi256_pd(_mm256_set1_epi64x(static_cast<long long>(same)));
        for (int p = 0; p < parts; ++p) {
            const __m256d before = _mm256_blendv_pd(_mm256_loadu_pd(from + 4 * p), sum_[p], lasts);
            sum_[p] = _mm256_add_pd(before, _mm256_loadu_pd(row + 4 * p));
            _mm256_storeu_pd(to + 4 * p, sum_[p]);
        }
        last_ = grain;
    }

private:
    static constexpr int parts = fields / 4;
    double* force_;
    std::ptrdiff_t last_ = -1;
    __m256d sum_[parts];
};
template <int dimension, int fields>
class RunningRow<xsimd::avx2, dimension, fields> : public WideRunningRow<fields> {
    using WideRunningRow<fields>::WideRunningRow;
};
#if defined(__AVX512F__)
template <int dimension, int fields>
class RunningRow<xsimd::avx512bw, dimension, fields> : public WideRunningRow<fields> {
    using WideRunningRow<fields>::WideRunningRow;
};
template <int dimension> class RunningRow<xsimd::avx512bw, dimension, 8> {
public:
    SANDLANE_INLINE explicit RunningRow(double* force) : force_(force), sum_(_mm512_setzero_pd()) {}
    SANDLANE_INLINE void add(std::ptrdiff_t grain, const double* row) {
        double* const to = force_ + grain * 8;
        const std::uintptr_t same = -static_cast<std::uintptr_t>(grain == last_);
        const __m512d old = _mm512_loadu_pd(where(same, row, to));
        sum_ =
            _mm512_add_pd(_mm512_mask_mov_pd(old, static_cast<__mmask8>(same), sum_), _mm512_loadu_pd(row));
        _mm512_storeu_pd(to, sum_);
        last_ = grain;
    }

private:
    double* force_;
    std::ptrdiff_t last_ = -1;
    __m512d sum_;
};
#endif
#endif

// ---- transposes of eight rows of a few fields, without gaps or wherever they stand

template <class Arch, int fields> struct Rows {
    static SANDLANE_INLINE void load(const double* rows, Block<Arch> (&field)[fields]) {
        alignas(64) double lanes[fields][width];
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < fields; ++f) lanes[f][l] = rows[fields * l + f];
        for (int f = 0; f < fields; ++f) field[f] = simd::load<Arch>(lanes[f]);
    }
    static SANDLANE_INLINE void store(const Block<Arch> (&field)[fields], double* rows) {
        alignas(64) double lanes[fields][width];
        for (int f = 0; f < fields; ++f) simd::store(lanes[f], field[f]);
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < fields; ++f) rows[fields * l + f] = lanes[f][l];
    }
    // The same for rows at[0], at[1], ... of `base`.
    static SANDLANE_INLINE void gather(const double* base, const std::int32_t* at,
                                       Block<Arch> (&field)[fields]) {
        alignas(64) double rows[fields * width];
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < fields; ++f) rows[fields * l + f] = base[std::ptrdiff_t{at[l]} * fields + f];
        load(rows, field);
    }
    static SANDLANE_INLINE void scatter(const Block<Arch> (&field)[fields], double* base,
                                        const std::int32_t* at) {
        alignas(64) double rows[fields * width];
        store(field, rows);
        for (int l = 0; l < width; ++l)
            for (int f = 0; f < fields; ++f) base[std::ptrdiff_t{at[l]} * fields + f] = rows[fields * l + f];
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
template <int fields> struct RowsOfFours {
    using Lanes = Block<xsimd::avx2>;
    template <class Row> static SANDLANE_INLINE void load_rows(const Row& row, Lanes (&field)[fields]) {
        for (int part = 0; part < 2; ++part)
            for (int f = 0; f < fields; f += 4) {
                __m256d a = _mm256_loadu_pd(row(4 * part) + f), b = _mm256_loadu_pd(row(4 * part + 1) + f);
                __m256d c = _mm256_loadu_pd(row(4 * part + 2) + f),
                        d = _mm256_loadu_pd(row(4 * part + 3) + f);
                transpose4(a, b, c, d);
                field[f].p[part] = a;
                field[f + 1].p[part] = b;
                field[f + 2].p[part] = c;
                field[f + 3].p[part] = d;
            }
    }
    template <class Row>
    static SANDLANE_INLINE void store_rows(const Lanes (&field)[fields], const Row& row) {
        for (int part = 0; part < 2; ++part)
            for (int f = 0; f < fields; f += 4) {
                __m256d a = field[f].p[part], b = field[f + 1].p[part];
                __m256d c = field[f + 2].p[part], d = field[f + 3].p[part];
                transpose4(a, b, c, d);
                _mm256_storeu_pd(row(4 * part) + f, a);
                _mm256_storeu_pd(row(4 * part + 1) + f, b);
                _mm256_storeu_pd(row(4 * part + 2) + f, c);
                _mm256_storeu_pd(row(4 * part + 3) + f, d);
            }
    }
    static SANDLANE_INLINE void load(const double* rows, Lanes (&field)[fields]) {
        load_rows([&](int l) { return rows + fields * l; }, field);
    }
    static SANDLANE_INLINE void store(const Lanes (&field)[fields], double* rows) {
        store_rows(field, [&](int l) { return rows + fields * l; });
    }
    static SANDLANE_INLINE void gather(const double* base, const std::int32_t* at, Lanes (&field)[fields]) {
        load_rows([&](int l) { return base + std::ptrdiff_t{at[l]} * fields; }, field);
    }
    static SANDLANE_INLINE void scatter(const Lanes (&field)[fields], double* base, const std::int32_t* at) {
        store_rows(field, [&](int l) { return base + std::ptrdiff_t{at[l]} * fields; });
    }
};
template <int fields> struct Rows<xsimd::avx2, fields> : RowsOfFours<fields> {};
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
template <> struct Rows<xsimd::avx512bw, 8> {
    using Lanes = Block<xsimd::avx512bw>;
    template <class Row> static SANDLANE_INLINE void load_rows(const Row& at, Lanes (&field)[8]) {
        __m512d row[8];
        for (int l = 0; l < width; ++l) row[l] = _mm512_loadu_pd(at(l));
        transpose8(row);
        for (int f = 0; f < 8; ++f) field[f].p[0] = row[f];
    }
    template <class Row> static SANDLANE_INLINE void store_rows(const Lanes (&field)[8], const Row& at) {
        __m512d row[8];
        for (int f = 0; f < 8; ++f) row[f] = field[f].p[0];
        transpose8(row);
        for (int l = 0; l < width; ++l) _mm512_storeu_pd(at(l), row[l]);
    }
    static SANDLANE_INLINE void load(const double* rows, Lanes (&field)[8]) {
        load_rows([&](int l) { return rows + 8 * l; }, field);
    }
    static SANDLANE_INLINE void store(const Lanes (&field)[8], double* rows) {
        store_rows(field, [&](int l) { return rows + 8 * l; });
    }
    static SANDLANE_INLINE void gather(const double* base, const std::int32_t* at, Lanes (&field)[8]) {
        load_rows([&](int l) { return base + std::ptrdiff_t{at[l]} * 8; }, field);
    }
    static SANDLANE_INLINE void scatter(const Lanes (&field)[8], double* base, const std::int32_t* at) {
        store_rows(field, [&](int l) { return base + std::ptrdiff_t{at[l]} * 8; });
    }
};
template <> struct Rows<xsimd::avx512bw, 4> {
    using Lanes = Block<xsimd::avx512bw>;
    // Rows 0 and 1, 2 and 3, ... side by side.
    static SANDLANE_INLINE void columns(const __m512d (&r)[4], Lanes (&field)[4]) {
        const __m512i xy = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13);
        const __m512i zw = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
        const __m512d a = _mm512_permutex2var_pd(r[0], xy, r[1]), b = _mm512_permutex2var_pd(r[2], xy, r[3]);
        const __m512d c = _mm512_permutex2var_pd(r[0], zw, r[1]), d = _mm512_permutex2var_pd(r[2], zw, r[3]);
        field[0].p[0] = _mm512_shuffle_f64x2(a, b, 0x44);
        field[1].p[0] = _mm512_shuffle_f64x2(a, b, 0xee);
        field[2].p[0] = _mm512_shuffle_f64x2(c, d, 0x44);
        field[3].p[0] = _mm512_shuffle_f64x2(c, d, 0xee);
    }
    static SANDLANE_INLINE void load(const double* rows, Lanes (&field)[4]) {
        const __m512d r[4] = {_mm512_loadu_pd(rows), _mm512_loadu_pd(rows + 8), _mm512_loadu_pd(rows + 16),
                              _mm512_loadu_pd(rows + 24)};
        columns(r, field);
    }
    static SANDLANE_INLINE void gather(const double* base, const std::int32_t* at, Lanes (&field)[4]) {
        __m512d r[4];
        for (int n = 0; n < 4; ++n)
            r[n] = _mm512_insertf64x4(
                _mm512_castpd256_pd512(_mm256_loadu_pd(base + std::ptrdiff_t{at[2 * n]} * 4)),
                _mm256_loadu_pd(base + std::ptrdiff_t{at[2 * n + 1]} * 4), 1);
        columns(r, field);
    }
    template <class Row> static SANDLANE_INLINE void store_rows(const Lanes (&field)[4], const Row& row) {
        const __m512d a[2] = {_mm512_unpacklo_pd(field[0].p[0], field[1].p[0]),
                              _mm512_unpackhi_pd(field[0].p[0], field[1].p[0])};
        const __m512d b[2] = {_mm512_unpacklo_pd(field[2].p[0], field[3].p[0]),
                              _mm512_unpackhi_pd(field[2].p[0], field[3].p[0])};
        const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
        const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
        for (int odd = 0; odd < 2; ++odd) {
            const __m512d first = _mm512_permutex2var_pd(a[odd], low, b[odd]);   // lanes odd, odd + 2
            const __m512d second = _mm512_permutex2var_pd(a[odd], high, b[odd]); // lanes odd + 4, odd + 6
            _mm256_storeu_pd(row(odd), _mm512_castpd512_pd256(first));
            _mm256_storeu_pd(row(odd + 2), _mm512_extractf64x4_pd(first, 1));
            _mm256_storeu_pd(row(odd + 4), _mm512_castpd512_pd256(second));
            _mm256_storeu_pd(row(odd + 6), _mm512_extractf64x4_pd(second, 1));
        }
    }
    static SANDLANE_INLINE void store(const Lanes (&field)[4], double* rows) {
        store_rows(field, [&](int l) { return rows + 4 * l; });
    }
    static SANDLANE_INLINE void scatter(const Lanes (&field)[4], double* base, const std::int32_t* at) {
        store_rows(field, [&](int l) { return base + std::ptrdiff_t{at[l]} * 4; });
    }
};
#endif

// ---- pairs

// field[f] lane l: f of (j - i) before the sums of the record, f of (j + i) from there on.
template <class Arch, int dimension> struct CombinePairs {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<Arch> (&field)[record_fields]) {
        alignas(64) double rows[width * record_fields];
        for (int l = 0; l < width; ++l) {
            const double* a = records + std::ptrdiff_t{i[l]} * record_fields;
            const double* b = records + std::ptrdiff_t{j[l]} * record_fields;
            for (int f = 0; f < record_fields; ++f)
                rows[record_fields * l + f] = f < Record<dimension>::sums ? b[f] - a[f] : b[f] + a[f];
        }
        Rows<Arch, record_fields>::load(rows, field);
    }
};
#if defined(__AVX512F__)
template <int dimension> struct CombinePairs<xsimd::avx512bw, dimension> {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<xsimd::avx512bw> (&field)[record_fields]) {
        constexpr auto sums = static_cast<__mmask8>(0xff << Record<dimension>::sums);
        __m512d row[8];
        for (int l = 0; l < width; ++l) {
            const __m512d a = _mm512_loadu_pd(records + std::ptrdiff_t{i[l]} * record_fields);
            const __m512d b = _mm512_loadu_pd(records + std::ptrdiff_t{j[l]} * record_fields);
            row[l] = _mm512_mask_add_pd(_mm512_sub_pd(b, a), sums, b, a);
        }
        transpose8(row);
        for (int f = 0; f < record_fields; ++f) field[f].p[0] = row[f];
    }
};
#elif defined(__AVX2__)
template <int dimension> struct CombinePairs<xsimd::avx2, dimension> {
    static SANDLANE_INLINE void apply(const double* records, const std::int32_t* i, const std::int32_t* j,
                                      Block<xsimd::avx2> (&field)[record_fields]) {
        // b + (-a) is b - a to the last bit.
        const auto sign = [](int f) { return f < Record<dimension>::sums ? -0.0 : 0.0; };
        const __m256d signs = _mm256_setr_pd(sign(4), sign(5), sign(6), sign(7));
        for (int part = 0; part < 2; ++part) {
            __m256d low[4], high[4];
            for (int l = 0; l < 4; ++l) {
                const double* a = records + std::ptrdiff_t{i[4 * part + l]} * record_fields;
                const double* b = records + std::ptrdiff_t{j[4 * part + l]} * record_fields;
                low[l] = _mm256_sub_pd(_mm256_loadu_pd(b), _mm256_loadu_pd(a));
                high[l] = _mm256_add_pd(_mm256_loadu_pd(b + 4), _mm256_xor_pd(signs, _mm256_loadu_pd(a + 4)));
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
#endif

// omega_i + omega_j, omega_i - omega_j and R of both, times dt, where couples want them: lane by lane.
template <class Arch, int dimension> struct Turns {
    static constexpr int components = dimension == 3 ? 3 : 1;
    Block<Arch> turn[components], differ[components], first, second;

    SANDLANE_INLINE Turns(const double* records, const double* spins, const std::int32_t* i,
                          const std::int32_t* j) {
        double sum[components][width], difference[components][width], radius[2][width];
        for (int l = 0; l < width; ++l) {
            const double* a = records + std::ptrdiff_t{i[l]} * record_fields;
            const double* b = records + std::ptrdiff_t{j[l]} * record_fields;
            for (int c = 0; c < components; ++c) {
                const double wa = turn_of<dimension>(a, spins, i[l], c),
                             wb = turn_of<dimension>(b, spins, j[l], c);
                sum[c][l] = wb + wa;
                difference[c][l] = wa - wb;
            }
            radius[0][l] = a[Record<dimension>::radius];
            radius[1][l] = b[Record<dimension>::radius];
        }
        for (int c = 0; c < components; ++c) {
            turn[c] = load<Arch>(sum[c]);
            differ[c] = load<Arch>(difference[c]);
        }
        first = load<Arch>(radius[0]);
        second = load<Arch>(radius[1]);
    }
};

// spin = R_i omega_i + R_j omega_j and turn = omega_i + omega_j of the spin records of eight pairs, times dt.
template <class Arch> struct CombineSpins {
    static SANDLANE_INLINE void apply(const double* spins, const std::int32_t* i, const std::int32_t* j,
                                      Block<Arch> (&spin)[spin_fields], Block<Arch> (&turn)[spin_fields]) {
        alignas(64) double spin_rows[width * spin_fields], turn_rows[width * spin_fields];
        for (int l = 0; l < width; ++l) {
            const double* a = spins + std::ptrdiff_t{i[l]} * spin_fields;
            const double* b = spins + std::ptrdiff_t{j[l]} * spin_fields;
            for (int f = 0; f < spin_fields; ++f) {
                spin_rows[spin_fields * l + f] = b[3] * b[f] + a[3] * a[f];
                turn_rows[spin_fields * l + f] = b[f] + a[f];
            }
        }
        Rows<Arch, spin_fields>::load(spin_rows, spin);
        Rows<Arch, spin_fields>::load(turn_rows, turn);
    }
};
#if defined(__AVX2__)
SANDLANE_INLINE __m256d by_radius(__m256d row) {
    return _mm256_mul_pd(row, _mm256_permute4x64_pd(row, 0xff));
}
#if defined(__AVX512F__)
template <> struct CombineSpins<xsimd::avx512bw> {
    using Lanes = Block<xsimd::avx512bw>;
#else
template <> struct CombineSpins<xsimd::avx2> {
    using Lanes = Block<xsimd::avx2>;
#endif
    static SANDLANE_INLINE void apply(const double* spins, const std::int32_t* i, const std::int32_t* j,
                                      Lanes (&spin)[spin_fields], Lanes (&turn)[spin_fields]) {
        for (int half = 0; half < 2; ++half) {
            __m256d s[4], t[4];
            for (int l = 0; l < 4; ++l) {
                const __m256d a = _mm256_loadu_pd(spins + std::ptrdiff_t{i[4 * half + l]} * spin_fields);
                const __m256d b = _mm256_loadu_pd(spins + std::ptrdiff_t{j[4 * half + l]} * spin_fields);
                s[l] = _mm256_add_pd(by_radius(b), by_radius(a));
                t[l] = _mm256_add_pd(b, a);
            }
            transpose4(s[0], s[1], s[2], s[3]);
            transpose4(t[0], t[1], t[2], t[3]);
            for (int f = 0; f < spin_fields; ++f) {
                set_half(spin[f], half, s[f]);
                set_half(turn[f], half, t[f]);
            }
        }
    }

private:
#if defined(__AVX512F__)
    static SANDLANE_INLINE void set_half(Lanes& block, int half, __m256d value) {
        block.p[0] = half == 0 ? _mm512_castpd256_pd512(value) : _mm512_insertf64x4(block.p[0], value, 1);
    }
#else
    static SANDLANE_INLINE void set_half(Lanes& block, int half, __m256d value) {
        block.p[half] = value;
    }
#endif
};
#endif

} // namespace sandlane::simd
