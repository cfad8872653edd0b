// Gear predictor-corrector: measured errors and orders of docs/physics.md 7, exactness for constant
// acceleration.
#include "motion/gear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace sandlane;

// One period of x'' = -x - 2 zeta x' from x = 1, v = 0 with exact starting derivatives; distance to the exact
// solution.
template <int order> double oscillator_error(double zeta, int steps) {
    const double period = 2 * std::numbers::pi, dt = period / steps;
    double x[order];
    double derivative[order];
    derivative[0] = 1;
    derivative[1] = 0;
    for (int k = 2; k < order; ++k) derivative[k] = -derivative[k - 2] - 2 * zeta * derivative[k - 1];
    double scale = 1;
    for (int k = 0; k < order; ++k) {
        if (k > 0) scale *= dt / k;
        x[k] = derivative[k] * scale;
    }
    for (int n = 0; n < steps; ++n) {
        motion::gear_predict(x);
        const double acceleration = -x[0] - 2 * zeta * x[1] / dt;
        motion::gear_correct(x, acceleration, 0.5 * dt * dt);
    }
    const double w = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * period);
    const double exact_x = decay * (std::cos(w * period) + zeta / w * std::sin(w * period));
    const double exact_v = -decay / w * std::sin(w * period);
    return std::hypot(x[0] - exact_x, x[1] / dt - exact_v);
}

} // namespace

// Values of the table to its three digits, and orders +-0.2.
TEST(Gear, UndampedErrors) {
    EXPECT_NEAR(oscillator_error<4>(0, 100), 1.41e-5, 0.01e-5);
    EXPECT_NEAR(oscillator_error<5>(0, 100), 1.30e-6, 0.01e-6);
    EXPECT_NEAR(oscillator_error<6>(0, 100), 6.71e-8, 0.01e-8);
    EXPECT_NEAR(std::log2(oscillator_error<4>(0, 200) / oscillator_error<4>(0, 400)), 3.1, 0.2);
    EXPECT_NEAR(std::log2(oscillator_error<5>(0, 200) / oscillator_error<5>(0, 400)), 4.0, 0.2);
    EXPECT_NEAR(std::log2(oscillator_error<6>(0, 200) / oscillator_error<6>(0, 400)), 5.0, 0.2);
}

TEST(Gear, DampedErrors) {
    EXPECT_NEAR(oscillator_error<4>(0.1, 100), 3.74e-5, 0.01e-5);
    EXPECT_NEAR(oscillator_error<5>(0.1, 100), 2.33e-6, 0.01e-6);
    EXPECT_NEAR(oscillator_error<6>(0.1, 100), 1.23e-7, 0.01e-7);
    EXPECT_NEAR(std::log2(oscillator_error<5>(0.1, 100) / oscillator_error<5>(0.1, 400)) / 2, 4.0, 0.2);
}

TEST(VelocityVerlet, Errors) {
    EXPECT_NEAR(oscillator_error<3>(0, 100), 1.03e-3, 0.01e-3);
    EXPECT_NEAR(oscillator_error<3>(0.1, 100), 7.33e-4, 0.01e-4);
    EXPECT_NEAR(std::log2(oscillator_error<3>(0, 200) / oscillator_error<3>(0, 400)), 2.0, 0.2);
    EXPECT_NEAR(std::log2(oscillator_error<3>(0.1, 100) / oscillator_error<3>(0.1, 400)) / 2, 2.0, 0.2);
}

TEST(Gear, ConstantAccelerationIsExact) {
    const double g = -9.81, dt = 1e-3;
    double x[5] = {2.0, 3.0 * dt, 0.5 * g * dt * dt, 0, 0};
    for (int n = 1; n <= 1000; ++n) {
        motion::gear_predict(x);
        motion::gear_correct(x, g, 0.5 * dt * dt);
    }
    EXPECT_NEAR(x[0], 2.0 + 3.0 + 0.5 * g, 1e-12);
    EXPECT_NEAR(x[1] / dt, 3.0 + g, 1e-12);
}
