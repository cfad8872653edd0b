// Blocks of eight 64-bit words beside the blocks of eight doubles of lanes.hpp: counter-based random numbers
// in lanes, and the exponents of doubles.
#pragma once

#include "simd/lanes.hpp"

#include <bit>
#include <cstdint>

namespace sandlane::simd {

// One register of words; this one is the portable form.
template <class Arch> struct WordRegister {
    static constexpr int lanes = 8;
    struct T {
        std::uint64_t w[lanes];
    };
    template <class F> static SANDLANE_INLINE T each(const F& f) {
        T r;
        for (int l = 0; l < lanes; ++l) r.w[l] = f(l);
        return r;
    }
    static SANDLANE_INLINE T set(std::uint64_t v) {
        return each([&](int) { return v; });
    }
    static SANDLANE_INLINE T load(const std::uint64_t* from) {
        return each([&](int l) { return from[l]; });
    }
    static SANDLANE_INLINE void store(std::uint64_t* to, const T& a) {
        for (int l = 0; l < lanes; ++l) to[l] = a.w[l];
    }
    static SANDLANE_INLINE T add(const T& a, const T& b) {
        return each([&](int l) { return a.w[l] + b.w[l]; });
    }
    static SANDLANE_INLINE T subtract(const T& a, const T& b) {
        return each([&](int l) { return a.w[l] - b.w[l]; });
    }
    static SANDLANE_INLINE T exclusive(const T& a, const T& b) {
        return each([&](int l) { return a.w[l] ^ b.w[l]; });
    }
    static SANDLANE_INLINE T both(const T& a, const T& b) {
        return each([&](int l) { return a.w[l] & b.w[l]; });
    }
    static SANDLANE_INLINE T product(const T& a, const T& b) { // of the lower halves
        return each([&](int l) { return (a.w[l] & 0xffffffffu) * (b.w[l] & 0xffffffffu); });
    }
    template <int n> static SANDLANE_INLINE T right(const T& a) {
        return each([&](int l) { return a.w[l] >> n; });
    }
    template <int n> static SANDLANE_INLINE T left(const T& a) {
        return each([&](int l) { return a.w[l] << n; });
    }
};

#if defined(__AVX512F__)
template <> struct WordRegister<xsimd::avx512bw> {
    using T = __m512i;
    static constexpr int lanes = 8;
    static SANDLANE_INLINE T set(std::uint64_t v) { return _mm512_set1_epi64(static_cast<long long>(v)); }
    static SANDLANE_INLINE T load(const std::uint64_t* from) { return _mm512_loadu_si512(from); }
    static SANDLANE_INLINE void store(std::uint64_t* to, T a) { _mm512_storeu_si512(to, a); }
    static SANDLANE_INLINE T add(T a, T b) { return _mm512_add_epi64(a, b); }
    static SANDLANE_INLINE T subtract(T a, T b) { return _mm512_sub_epi64(a, b); }
    static SANDLANE_INLINE T exclusive(T a, T b) { return _mm512_xor_si512(a, b); }
    static SANDLANE_INLINE T both(T a, T b) { return _mm512_and_si512(a, b); }
    static SANDLANE_INLINE T product(T a, T b) { return _mm512_mul_epu32(a, b); }
    template <int n> static SANDLANE_INLINE T right(T a) { return _mm512_srli_epi64(a, n); }
    template <int n> static SANDLANE_INLINE T left(T a) { return _mm512_slli_epi64(a, n); }
    static SANDLANE_INLINE T from(__m512d a) { return _mm512_castpd_si512(a); }
    static SANDLANE_INLINE __m512d to_double(T a) { return _mm512_castsi512_pd(a); }
};
#elif defined(__AVX2__)
template <> struct WordRegister<xsimd::avx2> {
    using T = __m256i;
    static constexpr int lanes = 4;
    static SANDLANE_INLINE T set(std::uint64_t v) { return _mm256_set1_epi64x(static_cast<long long>(v)); }
    static SANDLANE_INLINE T load(const std::uint64_t* from) {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    }
    static SANDLANE_INLINE void store(std::uint64_t* to, T a) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a);
    }
    static SANDLANE_INLINE T add(T a, T b) { return _mm256_add_epi64(a, b); }
    static SANDLANE_INLINE T subtract(T a, T b) { return _mm256_sub_epi64(a, b); }
    static SANDLANE_INLINE T exclusive(T a, T b) { return _mm256_xor_si256(a, b); }
    static SANDLANE_INLINE T both(T a, T b) { return _mm256_and_si256(a, b); }
    static SANDLANE_INLINE T product(T a, T b) { return _mm256_mul_epu32(a, b); }
    template <int n> static SANDLANE_INLINE T right(T a) { return _mm256_srli_epi64(a, n); }
    template <int n> static SANDLANE_INLINE T left(T a) { return _mm256_slli_epi64(a, n); }
    static SANDLANE_INLINE T from(__m256d a) { return _mm256_castpd_si256(a); }
    static SANDLANE_INLINE __m256d to_double(T a) { return _mm256_castsi256_pd(a); }
};
#elif defined(__SSE4_2__)
template <> struct WordRegister<xsimd::sse4_2> {
    using T = __m128i;
    static constexpr int lanes = 2;
    static SANDLANE_INLINE T set(std::uint64_t v) { return _mm_set1_epi64x(static_cast<long long>(v)); }
    static SANDLANE_INLINE T load(const std::uint64_t* from) {
        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    }
    static SANDLANE_INLINE void store(std::uint64_t* to, T a) {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), a);
    }
    static SANDLANE_INLINE T add(T a, T b) { return _mm_add_epi64(a, b); }
    static SANDLANE_INLINE T subtract(T a, T b) { return _mm_sub_epi64(a, b); }
    static SANDLANE_INLINE T exclusive(T a, T b) { return _mm_xor_si128(a, b); }
    static SANDLANE_INLINE T both(T a, T b) { return _mm_and_si128(a, b); }
    static SANDLANE_INLINE T product(T a, T b) { return _mm_mul_epu32(a, b); }
    template <int n> static SANDLANE_INLINE T right(T a) { return _mm_srli_epi64(a, n); }
    template <int n> static SANDLANE_INLINE T left(T a) { return _mm_slli_epi64(a, n); }
    static SANDLANE_INLINE T from(__m128d a) { return _mm_castpd_si128(a); }
    static SANDLANE_INLINE __m128d to_double(T a) { return _mm_castsi128_pd(a); }
};
#endif

template <class Arch> struct Words {
    using Register = WordRegister<Arch>;
    static constexpr int lanes = Register::lanes;
    static constexpr int parts = width / lanes;
    typename Register::T p[parts];

    Words() = default;
    SANDLANE_INLINE Words(std::uint64_t value) { // NOLINT: as for blocks
        for (int i = 0; i < parts; ++i) p[i] = Register::set(value);
    }
    static SANDLANE_INLINE Words load(const std::uint64_t* from) { // unaligned
        Words r;
        for (int i = 0; i < parts; ++i) r.p[i] = Register::load(from + i * lanes);
        return r;
    }
    SANDLANE_INLINE void store(std::uint64_t* to) const {
        for (int i = 0; i < parts; ++i) Register::store(to + i * lanes, p[i]);
    }
};

#define SANDLANE_WORDS(name, call)                                                                           \
    template <class A> SANDLANE_INLINE Words<A> name(const Words<A>& a, const Words<A>& b) {                 \
        Words<A> r;                                                                                          \
        for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = WordRegister<A>::call(a.p[i], b.p[i]);            \
        return r;                                                                                            \
    }
SANDLANE_WORDS(operator+, add)
SANDLANE_WORDS(operator-, subtract)
SANDLANE_WORDS(operator^, exclusive)
SANDLANE_WORDS(operator&, both)
SANDLANE_WORDS(product, product) // of the lower 32 bits of each
#undef SANDLANE_WORDS
template <int n, class A> SANDLANE_INLINE Words<A> right(const Words<A>& a) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = WordRegister<A>::template right<n>(a.p[i]);
    return r;
}
template <int n, class A> SANDLANE_INLINE Words<A> left(const Words<A>& a) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = WordRegister<A>::template left<n>(a.p[i]);
    return r;
}

// The bits of doubles as words and back.
template <class A> SANDLANE_INLINE Words<A> words_of(const Block<A>& b) {
    Words<A> r;
    for (int i = 0; i < Words<A>::parts; ++i) r.p[i] = WordRegister<A>::from(b.p[i].data);
    return r;
}
template <class A> SANDLANE_INLINE Block<A> block_of(const Words<A>& w) {
    Block<A> r;
    for (int i = 0; i < Words<A>::parts; ++i)
        r.p[i] = typename Block<A>::Batch(WordRegister<A>::to_double(w.p[i]));
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
            k0 += 0x9E3779B9u;
            k1 += 0xBB67AE85u;
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
    static constexpr std::uint64_t m0 = 0xD2511F53u, m1 = 0xCD9E8D57u;
    static SANDLANE_INLINE std::uint64_t high(std::uint64_t p) { return p >> 32; }
    static SANDLANE_INLINE std::uint64_t low(std::uint64_t p) { return p & 0xffffffffu; }

    std::uint64_t key_[rounds][2], first_, second_, third_, high_, low_;
};

// The number in [0, 1) of 53 bits of two words, as unit_number of core/rng.hpp.
template <class A> SANDLANE_INLINE Block<A> unit_number(const Words<A>& high, const Words<A>& low) {
    return (number_of(high) * Block<A>(0x1p21) + number_of(right<11>(low))) * Block<A>(0x1p-53);
}

} // namespace sandlane::simd
