// Stress, packing fraction and contact number against closed forms and md-spheres 9.8.
#include "analysis/stress.hpp"

#include "analysis/support.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace sandlane;
using namespace sandlane::analysis;

namespace {
constexpr double pi = std::numbers::pi;
}

TEST(GrainStress, TwoOppositeForcesOnADisc) {
    Hand h({10, 10, 0});
    const auto i = h.add({5, 5, 0}, 1);
    h.touch(i, -1, {1, 0, 0});
    h.touch(i, -1, {-1, 0, 0});
    const Tensor t = grain_stress(h.frame()).at(0);
    EXPECT_NEAR(t.xx, 0.6366197724, 1e-10); // the number of the specification, 2/pi
    EXPECT_NEAR(t.pressure(), 0.3183098862, 1e-10);
    EXPECT_EQ(t.yy, 0);
    EXPECT_EQ(t.xy, 0);
}

TEST(GrainStress, BothPartnersFeelTheContact) {
    Hand h;
    const auto i = h.add({0.4, 0.5, 0}, 0.1), j = h.add({0.7, 0.5, 0}, 0.2);
    h.touch(i, j, {1, 0, 0}, 3);
    const std::vector<Tensor> t = grain_stress(h.frame());
    EXPECT_NEAR(t[0].xx, 3 / (pi * 0.1), 1e-12);
    EXPECT_NEAR(t[1].xx, 3 / (pi * 0.2), 1e-12);
}

TEST(GrainStress, TheAntisymmetricPartIsTheTorque) {
    Hand h;
    const double radius = 0.1, f_t = 0.7;
    const auto i = h.add({0.5, 0.5, 0}, radius);
    h.touch(i, -1, {0.6, 0.8, 0}, 2, f_t);
    const Tensor t = grain_stress(h.frame()).at(0);
    EXPECT_NEAR(t.rotation().z, -radius * f_t / (pi * radius * radius), 1e-12);
    h.touch(i, -1, {-0.6, -0.8, 0}, 2, -f_t); // turns it back
    EXPECT_NEAR(grain_stress(h.frame()).at(0).rotation().z, 0, 1e-12);
}

// Columns of the lattice carry a force, each spread over one lattice constant.
TEST(ContactStress, ASquareLattice) {
    const int n = 4;
    const double a = 0.25, along_x = 3, along_y = 5;
    Hand h;
    h.grains.periodic_x = h.grains.periodic_y = true;
    for (int k = 0; k < n * n; ++k) h.add({(k % n + 0.5) * a, (k / n + 0.5) * a, 0}, a / 2);
    for (int k = 0; k < n * n; ++k) {
        h.touch(k, k / n * n + (k + 1) % n, {1, 0, 0}, along_x);
        h.touch(k, (k + n) % (n * n), {0, 1, 0}, along_y);
    }
    const Region box{{0, 0, 0}, {1, 1, 0}};
    const Tensor t = contact_stress(h.frame(), box);
    EXPECT_NEAR(t.xx, along_x / a, 1e-12);
    EXPECT_NEAR(t.yy, along_y / a, 1e-12);
    EXPECT_NEAR(t.xy, 0, 1e-12);
    EXPECT_EQ(contact_number(h.frame(), box), 4);
    EXPECT_NEAR(packing_fraction(h.grains, box), pi / 4, 1e-12);
    // Any window of whole cells sees the same.
    EXPECT_NEAR(contact_stress(h.frame(), {{0.125, 0.125, 0}, {0.625, 0.625, 0}}).xx, along_x / a, 1e-12);
}

// A disc between two plates: the mean over the space between them is force over the height of the plates.
TEST(ContactStress, BetweenTwoWalls) {
    Hand h({0.2, 1, 0});
    const auto i = h.add({0.1, 0.5, 0}, 0.1);
    h.touch(i, -1, {-1, 0, 0}, 6);
    h.touch(i, -1, {1, 0, 0}, 6);
    EXPECT_NEAR(contact_stress(h.frame(), {{-0.01, 0, 0}, {0.21, 1, 0}}).xx, 6 * 0.2 / 0.22, 1e-12);
}

TEST(KineticStress, DoesNotSeeTheMeanFlow) {
    Hand h;
    h.add({0.2, 0.5, 0}, 0.1, 2, {7 + 1, -3, 0});
    h.add({0.8, 0.5, 0}, 0.1, 2, {7 - 1, -3, 0});
    const Tensor t = kinetic_stress(h.grains, {{0, 0, 0}, {1, 1, 0}});
    EXPECT_NEAR(t.xx, 2 * 2 * 1, 1e-12);
    EXPECT_NEAR(t.yy, 0, 1e-12);
    EXPECT_EQ(kinetic_stress(h.grains, {{0.4, 0, 0}, {0.6, 1, 0}}).xx, 0); // nobody there
}

TEST(Region, PartsOfADisc) {
    const auto area = [](Vec lower, Vec upper) { return disc_area_inside({0, 0, 0}, 2, {lower, upper}); };
    EXPECT_NEAR(area({-3, -3, 0}, {3, 3, 0}), 4 * pi, 1e-13);
    EXPECT_NEAR(area({0, -3, 0}, {3, 3, 0}), 2 * pi, 1e-13);
    EXPECT_NEAR(area({0, 0, 0}, {3, 3, 0}), pi, 1e-13);
    EXPECT_NEAR(area({-0.5, -0.5, 0}, {0.25, 0.5, 0}), 0.75, 1e-13); // inside the disc
    EXPECT_EQ(area({2, 0, 0}, {3, 3, 0}), 0);
    EXPECT_NEAR(area({1.5, 1.5, 0}, {3, 3, 0}), 0, 1e-13); // meets its box, not the disc
    // Segment beyond a chord at distance h: R^2 acos(h/R) - h sqrt(R^2 - h^2).
    const double segment = 4 * std::acos(0.5) - std::sqrt(3.0);
    EXPECT_NEAR(area({1, -3, 0}, {3, 3, 0}), segment, 1e-13);
    EXPECT_NEAR(area({-3, -3, 0}, {3, -1, 0}), segment, 1e-13);
    EXPECT_NEAR(area({-1, -3, 0}, {1, 3, 0}), 4 * pi - 2 * segment, 1e-13);
    // Four corners make the whole.
    const Vec corner{0.3, -0.7, 0};
    const double sum = area({-3, -3, 0}, corner) + area(corner, {3, 3, 0}) +
                       area({-3, corner.y, 0}, {corner.x, 3, 0}) + area({corner.x, -3, 0}, {3, corner.y, 0});
    EXPECT_NEAR(sum, 4 * pi, 1e-13);
}

TEST(Region, PackingFractionAcrossPeriodicSides) {
    Hand h;
    h.add({0.02, 0.97, 0}, 0.1);
    const Region box{{0, 0, 0}, {1, 1, 0}};
    EXPECT_LT(packing_fraction(h.grains, box), 0.5 * pi * 0.01);
    h.grains.periodic_x = h.grains.periodic_y = true;
    EXPECT_NEAR(packing_fraction(h.grains, box), pi * 0.01, 1e-13);
}

TEST(Region, ContactNumberOfARow) {
    Hand h;
    for (int k = 0; k < 3; ++k) h.add({0.3 + 0.2 * k, 0.5, 0}, 0.1);
    h.touch(0, 1, {1, 0, 0});
    h.touch(1, 2, {1, 0, 0});
    EXPECT_DOUBLE_EQ(contact_number(h.frame(), {{0, 0, 0}, {1, 1, 0}}), 4.0 / 3);
    h.touch(0, -1, {-1, 0, 0});
    EXPECT_DOUBLE_EQ(contact_number(h.frame(), {{0, 0, 0}, {1, 1, 0}}), 5.0 / 3);
    EXPECT_EQ(contact_number(h.frame(), {{0, 0, 0}, {0.1, 0.1, 0}}), 0);
}
