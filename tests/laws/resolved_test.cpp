// Head-on collisions whose begin and end are resolved inside a step (docs/physics.md 7): error of the
// restitution coefficient over moments within a step, its order, and the share of friction.
#include "laws/contact.hpp"
#include "laws/restitution.hpp"
#include "motion/gear.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

using namespace sandlane;

namespace {

using Coefficients = laws::PairCoefficients<double>;
constexpr int phases = 16;
constexpr double uncut = -std::numeric_limits<double>::infinity();

template <class Law> double force(const Coefficients& c, double overlap, double rate, double step) {
    if (overlap <= 0) return 0;
    double memory[1] = {};
    return laws::normal_force<Law>(overlap, rate, c, 1.0, memory, step).force;
}

// Rate of the overlap after a collision of unit reduced mass and radius at unit speed that begins `begin` of
// a step after a step.
template <class Law, int scheme>
double rebound(const Coefficients& c, double step, double begin, double duration) {
    double x[motion::values_of(scheme)] = {-(1 + begin) * step, step};
    for (double time = 0; time < 1.5 * duration + 5 * step; time += step) {
        motion::predict<scheme>(x);
        motion::correct<scheme>(x, -force<Law>(c, x[0], x[1] / step, step), 0.5 * step * step);
    }
    return -x[1] / step;
}

template <class Law, int scheme = motion::verlet_with_slope>
double error(const Coefficients& c, double duration, double restitution, double steps) {
    double square = 0;
    for (int n = 0; n < phases; ++n) {
        const double e = rebound<Law, scheme>(c, duration / steps, (n + 0.5) / phases, duration);
        square += (e - restitution) * (e - restitution) / phases;
    }
    return std::sqrt(square);
}

struct Collision {
    const char* name;
    std::function<double(double steps)> error;
    double at_10, at_50; // bounds at t_c/10.37 and t_c/50.37
    double least_order;  // from t_c/50.37 to t_c/200.37
    friend void PrintTo(const Collision& c, std::ostream* stream) { *stream << c.name; }
};

// The dashpot of damping ratio z.
template <int scheme = motion::verlet_with_slope>
std::function<double(double)> dashpot(double z, double least) {
    Coefficients c{1, 2 * z, 0, 0};
    c.least = least;
    const double swing = std::sqrt(1 - z * z);
    const double duration = (least == 0 ? 2 * std::acos(z) : std::numbers::pi) / swing;
    return [=](double steps) {
        return error<laws::Resolved<laws::LinearDashpot>, scheme>(c, duration, std::exp(-z * duration),
                                                                  steps);
    };
}
// K = 1, dissipation A.
std::function<double(double)> viscoelastic(double a, double least, double restitution) {
    Coefficients c{1, a, 0, 0};
    c.least = least;
    return [=](double steps) {
        return error<laws::Resolved<laws::Viscoelastic>>(c, 3.2180654597, restitution, steps);
    };
}

class Resolved : public testing::TestWithParam<Collision> {};

} // namespace

TEST_P(Resolved, SecondOrderAndWithinItsError) {
    const Collision& c = GetParam();
    const double at_50 = c.error(50.37), at_200 = c.error(200.37);
    EXPECT_LT(c.error(10.37), c.at_10);
    EXPECT_LT(at_50, c.at_50);
    EXPECT_GT(std::log(at_50 / at_200) / std::log(200.37 / 50.37), c.least_order);
}

// Bounds: what is measured, and a quarter. Restitution coefficients of A = 0.1: tests/md/balance_test.cpp.
INSTANTIATE_TEST_SUITE_P(
    All, Resolved,
    testing::Values(Collision{"dashpot", dashpot(0.0424, 0), 9e-4, 2e-5, 1.5},
                    Collision{"damped_dashpot", dashpot(0.2553, 0), 3e-3, 2.2e-4, 1.9},
                    Collision{"spring", dashpot(0, 0), 6e-4, 1.5e-6, 3.5},
                    Collision{"uncut_dashpot", dashpot(0.0407, uncut), 1.1e-3, 2e-5, 1.5},
                    Collision{"gear", dashpot<5>(0.0424, 0), 1.5e-3, 5e-6, 2.5},
                    Collision{"viscoelastic", viscoelastic(0.1, 0, 0.89285888), 2.2e-3, 2e-5, 1.7},
                    Collision{"uncut_viscoelastic", viscoelastic(0.1, uncut, 0.89214759), 2.5e-3, 6e-5, 1.7},
                    Collision{"hertz", viscoelastic(0, 0, 1), 4e-4, 1e-7, 3.5}),
    [](const auto& instance) { return std::string(instance.param.name); });

// Friction that slides takes mu times what the normal force takes, in steps with a begin or an end, too; away
// from both nothing changes.
TEST(ResolvedFriction, GoesWithTheNormalForce) {
    const auto check = [](auto law, double young, double damping) {
        using Law = decltype(law);
        double none[1] = {};
        Coefficients c{young, damping, 1e9, 0.3};
        for (double overlap = 1e-4; overlap < 1e-2; overlap *= 1.1)
            for (double rate = -1; rate < 1; rate += 0.03) {
                laws::PairState<double> s{2 - overlap, 0, -rate, 0.2, 0, 2, 2};
                const auto f = laws::pair_force<laws::Resolved<Law>, laws::HaffWerner>(s, c, none, 0.0, 1e-3);
                EXPECT_NEAR(std::abs(f.tangential), 0.3 * std::abs(f.x), 1e-12 * std::abs(f.x))
                    << overlap << rate;
                const auto plain = laws::pair_force<Law, laws::HaffWerner>(s, c);
                const bool inside = overlap > 2.001e-3 * std::abs(rate); // the cut is at half of that
                if (inside) {
                    EXPECT_EQ(f.x, plain.x);
                }
            }
    };
    check(laws::LinearDashpot{}, 1e4, 10);
    check(laws::Viscoelastic{}, 1e6, 1e-3);
}

// The spring of a contact that begins is stretched since the touch.
TEST(ResolvedFriction, SpringSinceTheTouch) {
    Coefficients c{1e4, 1, 0, 0.5, 1e3};
    laws::PairState<double> s{2 - 4e-4, 0, -1, 0.2, 0, 2, 2};
    double zeta[1] = {laws::no_contact};
    (void)laws::pair_force<laws::Resolved<laws::LinearDashpot>, laws::CundallStrack>(s, c, zeta, 1e-3, 1e-3);
    EXPECT_NEAR(std::abs(zeta[0]), 0.2 * 4e-4, 1e-12);
    zeta[0] = laws::no_contact;
    (void)laws::pair_force<laws::LinearDashpot, laws::CundallStrack>(s, c, zeta, 1e-3);
    EXPECT_EQ(zeta[0], 0);
}
