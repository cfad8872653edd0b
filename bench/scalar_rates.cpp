// Rate kernels of the scalar reference: one number at a time, compiled without the vectoriser.
#include "simd/bench/rates.ipp"

#include <cmath>

namespace sandlane::simd {

namespace {

template <class V> struct Lanes {
    using Number = V;
    static constexpr std::int64_t count = 1;
    static double first(V v) { return static_cast<double>(v); }
    static V load(const V* from) { return *from; }
    static void store(V* to, V v) { *to = v; }
    static V square_root(V v) { return std::sqrt(v); }
    static V multiply_add(V a, V b, V c) { return a * b + c; }
};

} // namespace

const RateKernels& rate_kernels_scalar();
const RateKernels& rate_kernels_scalar() {
    static const RateKernels table = rate_table<Lanes, double, float>();
    return table;
}

} // namespace sandlane::simd
