// Collisions in one instant: the cases of the specification of event-driven dynamics (12.1, 12.5),
// invariants, the distribution of directions, and the elementary functions.
#include "laws/collision.hpp"
#include "laws/elementary.hpp"
#include "laws/restitution_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;

namespace {

using V = Vector<double>;

struct Body {
    V place, velocity, spin;
    double mass, radius, inertia; // J = inertia m R^2
};

// Moves both to contact and collides them, after the rule of the specification with its general masses.
void collide(Body& i, Body& j, double time, double eps_n, double eps_t) {
    i.place = i.place + time * i.velocity;
    j.place = j.place + time * j.velocity;
    const V r = i.place - j.place;
    const V e = (1 / std::sqrt(dot(r, r))) * r;
    const V g = i.velocity - j.velocity - cross(i.radius * i.spin + j.radius * j.spin, e);
    const double q = i.inertia, reduced = i.mass * j.mass / (i.mass + j.mass);
    const V push = reduced * laws::impulse(g, e, eps_n, eps_t, q / (1 + q));
    i.velocity = i.velocity + (1 / i.mass) * push;
    j.velocity = j.velocity - (1 / j.mass) * push;
    i.spin = i.spin - (1 / (q * i.mass * i.radius)) * cross(e, push);
    j.spin = j.spin - (1 / (q * j.mass * j.radius)) * cross(e, push);
}

void expect_near(const V& a, const V& b) {
    EXPECT_NEAR(a.x, b.x, 1e-9);
    EXPECT_NEAR(a.y, b.y, 1e-9);
    EXPECT_NEAR(a.z, b.z, 1e-9);
}

} // namespace

TEST(Collision, PairsOfTheSpecification) {
    Body a{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, 1, .5, .5}, b{{3, 0, 0}, {-1, 0, 0}, {0, 0, 0}, 1, .5, .5}; // D1
    collide(a, b, 1, .8, 1);
    expect_near(a.velocity, {-.8, 0, 0});
    expect_near(b.velocity, {.8, 0, 0});
    a = {{0, 0, 0}, {1, .25, 0}, {0, 0, 2}, 1, .5, .5}; // D2
    b = {{2, .6, 0}, {-.5, 0, 0}, {0, 0, -1}, 2, .75, .5};
    collide(a, b, 0.558572698383, .9, .3);
    expect_near(a.velocity, {-0.7547318462, -0.4333867005, 0});
    expect_near(b.velocity, {0.3773659231, 0.3416933503, 0});
    expect_near(a.spin, {0, 0, 2.0435555556});
    expect_near(b.spin, {0, 0, -0.9854814815});
    a = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, 1, .5, .5}; // D3
    b = {{2, .5, 0}, {0, 0, 0}, {0, 0, 0}, 1, .5, .5};
    collide(a, b, 1.133974596216, 1, -1);
    expect_near(a.velocity, {1.0 / 6, -0.2886751346, 0});
    expect_near(b.spin, {0, 0, 2.0 / 3});
    a = {{0, 0, 0}, {1, .2, -.1}, {.5, -1, 2}, 1, .5, .4}; // S1
    b = {{1.5, .4, .3}, {-.3, 0, .2}, {0, 1, -.5}, 1.5, .6, .4};
    collide(a, b, 0.412157174229, .85, -.4);
    expect_near(a.velocity, {-0.0976393816, -0.2438401292, -0.3867274339});
    expect_near(b.velocity, {0.4317595877, 0.2958934194, 0.3911516226});
    expect_near(a.spin, {0.9407999409, -1.8570474863, 1.6392137782});
    expect_near(b.spin, {0.2448888561, 0.5238625076, -0.7004367899});
}

// Pure sliding: the tangential impulse is mu times the normal one.
TEST(Collision, FrictionBoundsTheTangentialImpulse) {
    const V e{1, 0, 0}, g{-1, 3, 0};
    const double ratio = 2.0 / 7, mu = 0.2;
    const double eps_t = laws::sliding_restitution(-0.5, mu, 0.8, ratio, 1.0, 3.0);
    const V push = laws::impulse(g, e, 0.8, eps_t, ratio);
    EXPECT_NEAR(std::abs(push.y) / push.x, mu, 1e-14);
    EXPECT_EQ(laws::sliding_restitution(-0.5, 10.0, 0.8, ratio, 1.0, 3.0), -0.5); // sticks
    EXPECT_EQ(laws::sliding_restitution(-0.5, mu, 0.8, ratio, 1.0, 0.0), -0.5);
}

// The approximant against the integrated contact that ends without force (12.1, rule B).
TEST(Collision, ViscoelasticRestitution) {
    const double table[][2] = {{0.001, 0.99884736}, {0.01, 0.98854744}, {0.1, 0.89285888},
                               {0.3, 0.72208544},   {0.5, 0.59525150},  {1, 0.39393060},
                               {2, 0.21164605},     {5, 0.06889966},    {10, 0.02509570}};
    for (const auto& [beta, eps] : table) {
        laws::Restitution law;
        law.model = laws::Restitution::Model::viscoelastic;
        law.dissipation = beta / std::pow(1.7, 0.2);
        EXPECT_NEAR(laws::restitution(law, 1.7), eps, 5e-5) << beta;
        EXPECT_EQ(laws::restitution(law, 0.0), 1);
    }
    laws::Restitution law{laws::Restitution::Model::saturating, 0.6, 0, 2, 0.5};
    EXPECT_EQ(laws::restitution(law, 0.0), 1);
    EXPECT_NEAR(laws::restitution(law, 0.5), 1 - 0.4 * 0.5, 1e-14);
    EXPECT_NEAR(laws::restitution(law, 2.0), 0.6, 1e-14);
    EXPECT_NEAR(laws::restitution(law, 9.0), 0.6, 1e-15);
}

// Directions are unit vectors against g; cos^2 of the angle is uniform in space, the sine in the plane: means
// by a lattice of numbers, exact but for its spacing.
TEST(Collision, DirectionsOfApproach) {
    const V gs[] = {{1, 2, -3}, {0, 0, 1}, {-1, 0, 0}, {1, 1, 1}, {1e-9, 1, 1e-9}};
    for (const V& g : gs) {
        const double speed = std::sqrt(dot(g, g));
        V mean{0, 0, 0};
        double normal = 0;
        constexpr int n = 64;
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) {
                double sine = 0, cosine = 0;
                laws::sine_cosine_of_turn((b + 0.5) / n, sine, cosine);
                const V e = laws::direction_in_space(g, speed, (a + 0.5) / n, sine, cosine);
                EXPECT_NEAR(dot(e, e), 1, 1e-14);
                EXPECT_LT(dot(g, e), 0);
                normal += dot(g, e) / speed / n / n;
                mean = mean + (1.0 / n / n) * e;
            }
        EXPECT_NEAR(normal, -2.0 / 3, 1e-3); // int sqrt(1 - u) du
        expect_near(mean, (normal / speed) * g);
    }
    const V g{0.3, -0.4, 0};
    double normal = 0;
    for (int a = 0; a < 1000; ++a) {
        const V e = laws::direction_in_plane(g, 0.5, (a + 0.5) / 1000);
        EXPECT_NEAR(dot(e, e), 1, 1e-14);
        EXPECT_LT(dot(g, e), 0);
        normal += dot(g, e) / 0.5 / 1000;
    }
    EXPECT_NEAR(normal, -std::numbers::pi / 4, 1e-4); // int sqrt(1 - s^2) ds/2
}

// Against the library, a few units in the last place.
TEST(Elementary, Functions) {
    for (double x = 1e-300; x < 1e300; x *= 1.37) {
        EXPECT_NEAR(laws::logarithm(x), std::log(x), 4e-16 * std::max(1.0, std::abs(std::log(x)))) << x;
        EXPECT_NEAR(laws::power(x, 0.1) / std::pow(x, 0.1), 1, 2e-14) << x;
    }
    for (double x = -600; x < 600; x += 0.37) EXPECT_NEAR(laws::exponential(x) / std::exp(x), 1, 1e-15) << x;
    EXPECT_EQ(laws::power(0.0, 0.1), 0);
    for (int n = 0; n < 4096; ++n) {
        const double u = n / 4096.0;
        double sine = 0, cosine = 0;
        laws::sine_cosine_of_turn(u, sine, cosine);
        EXPECT_NEAR(sine, std::sin(2 * std::numbers::pi * u), 1e-15) << u;
        EXPECT_NEAR(cosine, std::cos(2 * std::numbers::pi * u), 1e-15) << u;
    }
    double sine = 0, cosine = 0;
    laws::sine_cosine_of_turn(1 - 0x1p-53, sine, cosine);
    EXPECT_NEAR(sine, 0, 1e-15);
    EXPECT_NEAR(cosine, 1, 1e-15);
}

TEST(Collision, ContactCorrelation) {
    EXPECT_NEAR(laws::contact_correlation(3, 0.2), 1.7578125, 1e-12);
    EXPECT_NEAR(laws::contact_correlation(2, 0.3), 1.7729592, 1e-7);
}

// In a mixture of equals S_ij h = phi/2/(1 - phi), and every pair is one of the fluid of one kind.
TEST(Collision, ContactCorrelationOfAMixtureOfEquals) {
    for (const int dimension : {2, 3})
        for (const double phi : {0.0, 0.1, 0.3, 0.45})
            EXPECT_NEAR(laws::contact_of_pair(dimension, 0.5 * phi / (1 - phi)) / (1 - phi),
                        laws::contact_correlation(dimension, phi), 1e-14);
}
