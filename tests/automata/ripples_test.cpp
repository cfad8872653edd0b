// Ripples: growth factors of linear theory, the numbers of the specification (C11 to C14), exact
// conservation, and kernels of every instruction set and thread count against the reference.
#include "automata/reference/ripples.hpp"
#include "automata/spectrum.hpp"
#include "core/error.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <numeric>

namespace sandlane::automata {

namespace {

using Complex = std::complex<double>;

RippleRules rules(double q, double b, double length, double creep) {
    RippleRules r;
    r.transport = q;
    r.wind = b;
    r.length = length;
    r.creep = creep;
    return r;
}

double wave(std::int64_t mode, std::int64_t x, std::int64_t n) {
    return 2 * std::numbers::pi * static_cast<double>(mode * x % n) / static_cast<double>(n);
}

Complex amplitude(const std::vector<double>& h, std::int64_t mode) {
    const auto n = static_cast<std::int64_t>(h.size());
    Complex sum;
    for (std::int64_t x = 0; x < n; ++x)
        sum += h[static_cast<std::size_t>(x)] * std::polar(1.0, -wave(mode, x, n));
    return sum;
}

// [1 + q b (exp(-ik(n+1)) - exp(-ikn))] c(k).
Complex growth(const RippleRules& r, double k, double creep_factor) {
    const double n = std::floor(r.length);
    const auto turn = [&](double cells) { return std::polar(1.0, -k * cells); };
    return (1.0 + r.transport * r.wind * (turn(n + 1) - turn(n))) * creep_factor;
}

double rms(const std::vector<double>& h) {
    const double n = static_cast<double>(h.size()), mean = std::accumulate(h.begin(), h.end(), 0.0) / n;
    double sum = 0;
    for (const double x : h) sum += (x - mean) * (x - mean);
    return std::sqrt(sum / n);
}

TEST(Ripples, GrowthFactorsOfSmallWaves) {
    constexpr std::int64_t n = 256;
    const RippleRules r = rules(.1, 1, 10.5, .4);
    const std::pair<std::int64_t, Complex> expected[] = {{10, {.9750716282, .0204358718}},
                                                         {18, {1.0036189071, .0030998167}},
                                                         {19, {1.0007802529, -.0080973022}},
                                                         {40, {.8821511895, .0491776142}}};
    for (const auto& [mode, factor] : expected) {
        std::vector<double> h(n);
        for (std::int64_t x = 0; x < n; ++x)
            h[static_cast<std::size_t>(x)] = 1e-6 * std::cos(wave(mode, x, n));
        const Complex before = amplitude(h, mode);
        reference::step(h, n, 1, r, 0);
        const Complex found = amplitude(h, mode) / before;
        EXPECT_NEAR(found.real(), factor.real(), 1e-9) << mode;
        EXPECT_NEAR(found.imag(), factor.imag(), 1e-9) << mode;
        const double k = wave(mode, 1, n);
        EXPECT_NEAR(std::abs(growth(r, k, 1 + r.creep * (std::cos(k) - 1)) - factor), 0, 1e-9);
    }
}

TEST(Ripples, GrowthFactorsInThePlane) {
    constexpr std::int64_t n = 40, rows = 24;
    const RippleRules r = rules(.2, .5, 7.3, .6);
    for (const auto& [mx, my] : {std::pair{4, 0}, {4, 3}, {0, 5}, {9, 7}}) {
        std::vector<double> h(n * rows);
        const auto phase = [&, mx = mx, my = my](std::int64_t x, std::int64_t y) {
            return wave(mx, x, n) + wave(my, y, rows);
        };
        const auto sum = [&] {
            Complex s;
            for (std::int64_t y = 0; y < rows; ++y)
                for (std::int64_t x = 0; x < n; ++x)
                    s += h[static_cast<std::size_t>(y * n + x)] * std::polar(1.0, -phase(x, y));
            return s;
        };
        for (std::int64_t y = 0; y < rows; ++y)
            for (std::int64_t x = 0; x < n; ++x)
                h[static_cast<std::size_t>(y * n + x)] = 1e-6 * std::cos(phase(x, y));
        const Complex before = sum();
        reference::step(h, n, rows, r, 0);
        const double kx = wave(mx, 1, n), ky = wave(my, 1, rows);
        const double creep =
            1 + r.creep * ((std::cos(kx) + std::cos(ky)) / 3 + std::cos(kx) * std::cos(ky) / 3 - 1);
        EXPECT_NEAR(std::abs(sum() / before - growth(r, kx, creep)), 0, 1e-9) << mx << " " << my;
    }
}

TEST(Ripples, FastestModes) {
    struct Expected {
        RippleRules rules;
        std::int64_t columns, mode;
        double size;
        bool plane;
    };
    const Expected all[] = {{rules(.1, 1, 10.5, .4), 256, 18, 1.0036236942, false},
                            {rules(.1, 2, 7.5, .6), 256, 24, .9992195998, false},
                            {rules(.6, 2, 7.3, .8), 100, 10, 1.56424143, true}};
    for (const Expected& e : all) {
        double best = 0;
        std::int64_t mode = 0;
        for (std::int64_t m = 1; m <= e.columns / 2; ++m) {
            const double k = wave(m, 1, e.columns);
            const double creep = e.plane ? 1 + e.rules.creep * (2 * (std::cos(k) - 1) / 3)
                                         : 1 + e.rules.creep * (std::cos(k) - 1);
            if (const double g = std::abs(growth(e.rules, k, creep)); g > best) {
                best = g;
                mode = m;
            }
        }
        EXPECT_EQ(mode, e.mode);
        EXPECT_NEAR(best, e.size, 1e-8);
    }
    // A flat bed that stays flat.
    const RippleRules stable = rules(.05, .5, 20.5, .4);
    for (std::int64_t m = 1; m <= 128; ++m) {
        const double k = wave(m, 1, 256);
        EXPECT_LT(std::abs(growth(stable, k, 1 + stable.creep * (std::cos(k) - 1))), 1);
    }
}

TEST(Ripples, WavelengthThatWins) {
    constexpr std::int64_t n = 256;
    std::vector<double> h(n);
    for (std::int64_t x = 0; x < n; ++x)
        h[static_cast<std::size_t>(x)] =
            1e-3 * std::cos(2 * std::numbers::pi * static_cast<double>(37 * x * x % n) / n);
    const double mean = std::accumulate(h.begin(), h.end(), 0.0) / n;
    for (double& x : h) x -= mean;
    const RippleRules r = rules(.1, 1, 10.5, .4);
    const std::pair<int, double> expected[] = {
        {50, 2.345558e-4}, {100, 2.156338e-4}, {200, 2.406142e-4}, {400, 4.292781e-4}};
    int t = 0;
    for (const auto& [until, size] : expected) {
        for (; t < until; ++t) reference::step(h, n, 1, r, static_cast<std::uint32_t>(t));
        EXPECT_NEAR(rms(h), size, 1e-5 * size) << t;
        const std::vector<double> powers = mode_powers(h, n, 1);
        EXPECT_EQ(std::max_element(powers.begin(), powers.end()) - powers.begin() + 1, 18);
    }
}

// Also where the number of columns is odd, no multiple of four, or prime.
TEST(Ripples, PowersOfModesOfAllLengths) {
    for (const std::int32_t n : {1, 2, 3, 6, 7, 10, 13, 74, 101}) {
        std::vector<double> h;
        for (std::int32_t x = 0; x < 2 * n; ++x) h.push_back(std::sin(1.0 + x * x));
        const std::vector<double> powers = mode_powers(h, n, 2);
        ASSERT_EQ(powers.size(), static_cast<std::size_t>(n / 2));
        for (std::int32_t m = 1; m <= n / 2; ++m) {
            double expected = 0;
            for (std::int32_t row = 0; row < 2; ++row) {
                std::complex<double> sum = 0;
                for (std::int32_t x = 0; x < n; ++x)
                    sum += h[static_cast<std::size_t>(row * n + x)] *
                           std::polar(1.0, -2 * std::numbers::pi * (m * x % n) / n);
                expected += std::norm(sum);
            }
            EXPECT_NEAR(powers[static_cast<std::size_t>(m - 1)], expected, 1e-10 * n * n) << n << ' ' << m;
        }
    }
}

std::vector<double> plane_start() {
    std::vector<double> h(100 * 50);
    for (std::int64_t j = 0; j < 50; ++j)
        for (std::int64_t i = 0; i < 100; ++i)
            h[static_cast<std::size_t>(j * 100 + i)] =
                .01 * (static_cast<double>((7919 * i + 104729 * j) % 1009) / 1009 - .5);
    return h;
}

TEST(Ripples, GrowInThePlane) {
    std::vector<double> h = plane_start();
    const double start = std::accumulate(h.begin(), h.end(), 0.0);
    const RippleRules r = rules(.6, 2, 7.3, .8);
    for (std::uint32_t t = 0; t < 150; ++t) {
        reference::step(h, 100, 50, r, t);
        if (t + 1 == 1) {
            EXPECT_NEAR(rms(h), .001171, 1e-3 * .001171);
        }
        if (t + 1 == 10) {
            EXPECT_NEAR(rms(h), .007635, 1e-3 * .007635);
        }
    }
    EXPECT_NEAR(rms(h), 1.8, 0.18);
    EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), start, 1e-12 * 5000 * 0.6 * 150);
}

// ---- fixed numbers

std::vector<std::int64_t> fixed(const std::vector<double>& heights) {
    std::vector<std::int64_t> result;
    for (const double h : heights) result.push_back(static_cast<std::int64_t>(std::floor(h * ripple_unit)));
    return result;
}

TEST(Ripples, FixedNumbersConserveTheSandExactly) {
    for (const auto landing : {scene::RippleLanding::interpolated, scene::RippleLanding::whole,
                               scene::RippleLanding::stochastic}) {
        std::vector<std::int64_t> h = fixed(plane_start());
        const std::int64_t start = std::accumulate(h.begin(), h.end(), std::int64_t{0});
        RippleRules r = rules(.6, 2, 7.3, .8);
        r.landing = landing;
        for (std::uint32_t t = 0; t < 60; ++t) reference::step(h, 100, 50, r, t);
        EXPECT_EQ(std::accumulate(h.begin(), h.end(), std::int64_t{0}), start);
    }
}

// Roundings of 2^-32 are damped or grow with the waves: small beside the heights for some steps.
TEST(Ripples, FixedNumbersFollowDoubles) {
    std::vector<double> h = plane_start();
    std::vector<std::int64_t> f = fixed(h);
    const RippleRules r = rules(.6, 2, 7.3, .8);
    for (std::uint32_t t = 0; t < 10; ++t) {
        reference::step(h, 100, 50, r, t);
        reference::step(f, 100, 50, r, t);
    }
    for (std::size_t i = 0; i < h.size(); ++i)
        EXPECT_NEAR(static_cast<double>(f[i]) / ripple_unit, h[i], 1e-7);
}

struct Bed {
    std::int32_t columns, rows;
    RippleRules rules;
};

void expect_same_bits(const Bed& bed, double noise, int steps) {
    const std::ptrdiff_t stride =
        static_cast<std::ptrdiff_t>(padded(static_cast<std::size_t>(bed.columns))) + 16;
    std::vector<std::int64_t> expected;
    for (std::int32_t k = 0; k < bed.columns * bed.rows; ++k)
        expected.push_back(static_cast<std::int64_t>(
            noise * ripple_unit *
            (static_cast<double>(philox({static_cast<std::uint32_t>(k), 0, 0, 0}, {3, 4})[0]) * 0x1p-32 -
             .5)));
    const std::vector<std::int64_t> start = expected;
    std::int64_t clamped = 0;
    for (int t = 0; t < steps; ++t)
        clamped += reference::step(expected, bed.columns, bed.rows, bed.rules, static_cast<std::uint32_t>(t));
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 2, 7}) {
            Column<std::int64_t> h(static_cast<std::size_t>(stride * bed.rows), 0);
            for (std::int32_t y = 0; y < bed.rows; ++y)
                std::copy_n(start.data() + std::ptrdiff_t{y} * bed.columns, bed.columns,
                            h.data() + y * stride + 8);
            RippleStepper stepper(bed.columns, bed.rows, bed.rules, {isa, threads});
            std::int64_t found = 0;
            for (int t = 0; t < steps; ++t) found += stepper.step(h, static_cast<std::uint32_t>(t));
            EXPECT_EQ(found, clamped);
            for (std::int32_t y = 0; y < bed.rows; ++y)
                EXPECT_TRUE(std::equal(expected.data() + std::ptrdiff_t{y} * bed.columns,
                                       expected.data() + std::ptrdiff_t{y + 1} * bed.columns,
                                       h.data() + y * stride + 8))
                    << simd::isa_name(isa) << " " << threads << " row " << y << " of " << bed.rows << " x "
                    << bed.columns;
        }
}

TEST(Ripples, KernelsAreTheReference) {
    for (const std::int32_t columns : {1, 5, 8, 15, 16, 63, 100})
        for (const std::int32_t rows : {1, 2, 3, 17, 34})
            expect_same_bits({columns, rows, rules(.6, 2, 7.3, .8)}, 4, 6);
}

// A height beyond 2^18 ends the run before the step, whatever computes it, and nothing has changed.
TEST(Ripples, HeightsBeyondTheNumbersOfKernelsAreRefusedAtTheSameStep) {
    constexpr std::int32_t columns = 19, rows = 18;
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(padded(std::size_t{columns})) + 16;
    constexpr auto limit = static_cast<std::int64_t>(0x1p50); // of 2^-32
    for (const simd::Isa isa : simd::available_isas())
        for (const std::int64_t height : {limit, limit + 1, -limit, -limit - 1})
            for (const std::int32_t row : {0, rows - 1}) {
                Column<std::int64_t> h(static_cast<std::size_t>(stride * rows), 0);
                h[static_cast<std::size_t>(row * stride + 8 + columns - 1)] = height;
                const Column<std::int64_t> before = h;
                RippleStepper stepper(columns, rows, rules(.6, 0, 7.3, .8), {isa, 2});
                if (std::abs(height) <= limit) {
                    stepper.step(h, 0);
                    continue;
                }
                try {
                    stepper.step(h, 0);
                    ADD_FAILURE() << simd::isa_name(isa) << ' ' << height;
                } catch (const Error& e) {
                    EXPECT_EQ(e.code(), Exit::unstable);
                }
                EXPECT_TRUE(std::equal(h.begin(), h.end(), before.begin()));
            }
}

TEST(Ripples, KernelsOfEveryRule) {
    for (const auto landing : {scene::RippleLanding::interpolated, scene::RippleLanding::whole,
                               scene::RippleLanding::stochastic}) {
        RippleRules wide = rules(.6, 2, 7.3, .8), far = rules(.3, 0, 250.25, 0), whole = rules(.1, 30, 4, 1);
        wide.landing = far.landing = whole.landing = landing;
        wide.seed = {8, 9};
        expect_same_bits({30, 20, wide}, 20, 8); // with lengths below 0
        expect_same_bits({30, 20, far}, 1, 8);   // several times around
        expect_same_bits({30, 20, whole}, 1, 8);
    }
}

TEST(Ripples, ContinuumLimit) {
    // The fastest wave of sigma = -q b k sin(k L0) - D_eff k^2 in the first band, from the growth factor of
    // long waves.
    const double length = 200.5, ratio = .1;
    RippleRules r = rules(1e-3, 1, length, 0);
    const double d_eff = ratio * r.transport * r.wind * length;
    double best = 0, at = 0;
    for (double u = 3.3; u < 6.2; u += 1e-5) {
        const double k = u / length;
        const double rate = std::log(std::abs(growth(r, k, 1))) - d_eff * k * k;
        if (rate > best) {
            best = rate;
            at = 2 * std::numbers::pi / u;
        }
    }
    EXPECT_NEAR(at, 1.33004003, 2e-4); // L0 is finite, (k/2)^2/6 = 1e-4
}

} // namespace

} // namespace sandlane::automata
