// Logarithm, exponential, powers, sine and cosine by sums, products and quotients alone, so that a number and
// every lane of every instruction set give the same bits. Errors are a few units in the last place.
#pragma once

#include "core/real.hpp"

#include <bit>
#include <cstdint>

namespace sandlane::laws {

// Exponent and fraction of a normal number x > 0: x = fraction 2^exponent, fraction in [1, 2). A block of
// lanes brings its own overloads (simd/words.hpp), as for floor and power_of_two.
[[nodiscard]] SANDLANE_INLINE double exponent_of(double x) {
    return static_cast<double>(static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x) >> 52) - 1023);
}
[[nodiscard]] SANDLANE_INLINE double fraction_of(double x) {
    constexpr std::uint64_t digits = (std::uint64_t{1} << 52) - 1, one = std::uint64_t{1023} << 52;
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(x) & digits) | one);
}
// 2^n for a whole number n in [-1022, 1023].
[[nodiscard]] SANDLANE_INLINE double power_of_two(double n) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(static_cast<std::int64_t>(n) + 1023) << 52);
}
[[nodiscard]] SANDLANE_INLINE double whole(double x) {
    return std::floor(x);
}

// Natural logarithm of a normal number x > 0: 2 artanh((f - 1)/(f + 1)) of the fraction f in [sqrt(1/2),
// sqrt(2)).
template <class R> SANDLANE_INLINE R logarithm(const R& x) {
    const R given = fraction_of(x);
    const auto upper = given > R(1.4142135623730951);
    const R f = select(upper, given * R(0.5), given);
    const R e = exponent_of(x) + select(upper, R(1.0), R(0.0));
    const R s = (f - R(1.0)) / (f + R(1.0)), s2 = s * s;
    R sum(1.0 / 23);
    for (int n = 21; n >= 1; n -= 2) sum = sum * s2 + R(1.0 / n);
    return e * R(0.69314718055994531) + (s + s) * sum;
}

// e^x for |x| < 700, by the series of the rest after whole powers of two.
template <class R> SANDLANE_INLINE R exponential(const R& x) {
    const R n = whole(x * R(1.4426950408889634) + R(0.5));
    // ln 2 in two parts, so that the product of the first with n is exact.
    const R r = (x - n * R(0.693147180369123816490)) - n * R(1.90821492927058770002e-10);
    R sum(1.0);
    for (int k = 14; k >= 1; --k) sum = R(1.0) + sum * r * R(1.0 / k);
    return sum * power_of_two(n);
}

// x^p for x >= 0 and p > 0, with the logarithm of the result below 700; zero where it is below -700.
template <class R> SANDLANE_INLINE R power(const R& x, const R& p) {
    constexpr double least = 2.2250738585072014e-308; // the smallest normal number
    const R exponent = p * logarithm(max(x, R(least)));
    const R result = exponential(max(exponent, R(-700.0)));
    return select(exponent > R(-700.0), select(x > R(least), result, R(0.0)), R(0.0));
}

// Sine and cosine of 2 pi u for u in [0, 1).
template <class R> SANDLANE_INLINE void sine_cosine_of_turn(const R& u, R& sine, R& cosine) {
    const R quarter = whole(u * R(4.0) + R(0.5));                                  // 0 .. 4
    const R a = (u - quarter * R(0.25)) * R(6.2831853071795865), minus = -(a * a); // a in [-pi/4, pi/4]
    R s(1.0), c(1.0);
    for (int n = 16; n >= 2; n -= 2) {
        s = R(1.0) + s * minus * R(1.0 / (n * (n + 1)));
        c = R(1.0) + c * minus * R(1.0 / (n * (n - 1)));
    }
    s = s * a;
    const R half = quarter - R(2.0);                                  // -2 .. 2
    const auto odd = (half * half < R(1.5)) & (half * half > R(0.5)); // quarters 1 and 3
    const R first = select(odd, c, s), second = select(odd, s, c);
    const auto lower_half = (quarter > R(1.5)) & (quarter < R(3.5)); // the sine has the other sign
    const auto left_half = (quarter > R(0.5)) & (quarter < R(2.5));  // so has the cosine
    sine = select(lower_half, -first, first);
    cosine = select(left_half, -second, second);
}

} // namespace sandlane::laws
