// Bodies of the rate kernels: V is double (scalar) or a register of the instruction set.
#pragma once

#include "simd/bench/rates.hpp"

namespace sandlane::simd {

// Enough independent chains to hide the latency of a multiplication and an addition, few enough for sixteen
// registers.
inline constexpr int rate_chains = 12;

template <class V, class Lanes, class Step>
std::int64_t chains(std::int64_t rounds, double* sink, int operations, const Step& step) {
    V x[rate_chains];
    for (int c = 0; c < rate_chains; ++c) x[c] = V(static_cast<typename Lanes::Number>(1.5 + 0.25 * c));
    for (std::int64_t r = 0; r < rounds; ++r)
        for (int c = 0; c < rate_chains; ++c) x[c] = step(x[c]);
    V sum = x[0];
    for (int c = 1; c < rate_chains; ++c) sum = sum + x[c];
    *sink = Lanes::first(sum);
    return rounds * rate_chains * Lanes::count * operations;
}

// Lanes<V>: Number, count, first(v), load, store, square_root, multiply_add.
template <template <class> class Lanes, class Double, class Single> RateKernels rate_table() {
    using D = Lanes<Double>;
    using S = Lanes<Single>;
    RateKernels t{};
    t.arithmetic = [](std::int64_t rounds, double* sink) {
        const Double a(0.999), b(0.0015);
        return chains<Double, D>(rounds, sink, 2, [&](const Double& x) { return x * a + b; });
    };
    t.single_arithmetic = [](std::int64_t rounds, double* sink) {
        const Single a(0.999F), b(0.0015F);
        return chains<Single, S>(rounds, sink, 2, [&](const Single& x) { return x * a + b; });
    };
    t.multiply_add = [](std::int64_t rounds, double* sink) {
        const Double a(0.999), b(0.0015);
        return chains<Double, D>(rounds, sink, 1, [&](const Double& x) { return D::multiply_add(x, a, b); });
    };
    t.divide = [](std::int64_t rounds, double* sink) {
        const Double a(3.1);
        return chains<Double, D>(rounds, sink, 1, [&](const Double& x) { return a / x; });
    };
    t.square_root = [](std::int64_t rounds, double* sink) {
        const Double a(1.7);
        return chains<Double, D>(rounds, sink, 1, [&](const Double& x) { return D::square_root(x + a); });
    };
    t.in_place = [](double* x, std::size_t n) {
        const Double a(0.999), b(1.0);
        for (std::size_t i = 0; i < n; i += D::count) D::store(x + i, D::load(x + i) * a + b);
    };
    return t;
}

} // namespace sandlane::simd
