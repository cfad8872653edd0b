// Collision rules of lattice gases: conservation, counts and the Boltzmann viscosity of the tables (spec C15,
// C16, C18, C21), and the Boolean expressions against the tables.
#include "automata/reference/gas.hpp"
#include "simd/automata/collisions.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

namespace sandlane::automata {

namespace {

int states_of(GasModel model) {
    return model == GasModel::hpp ? 16 : model == GasModel::fhp1 ? 64 : 128;
}

constexpr GasModel triangular[] = {GasModel::fhp1, GasModel::fhp2, GasModel::fhp3, GasModel::pipe};

TEST(Collisions, ConserveMassAndMomentum) {
    for (const GasModel model : triangular)
        for (int s = 0; s < states_of(model); ++s)
            for (const bool xi : {false, true})
                for (const bool d : {false, true}) {
                    const int out = reference::collide(model, s, xi, d);
                    EXPECT_EQ(std::popcount(static_cast<unsigned>(out)),
                              std::popcount(static_cast<unsigned>(s)));
                    EXPECT_EQ(reference::momentum(out), reference::momentum(s)) << s;
                }
}

TEST(Collisions, NumbersOfActiveStates) {
    const auto active = [](GasModel model) {
        int count = 0;
        for (int s = 0; s < states_of(model); ++s)
            count += reference::collide(model, s, false, false) != s ? 1 : 0;
        return count;
    };
    EXPECT_EQ(active(GasModel::hpp), 2);
    EXPECT_EQ(active(GasModel::fhp1), 5);
    EXPECT_EQ(active(GasModel::fhp2), 22);
    EXPECT_EQ(active(GasModel::fhp3), 76);
}

TEST(Collisions, PairsTurnBothWays) {
    const auto both = [](int s) {
        return std::set<int>{reference::collide(GasModel::fhp1, s, false, false),
                             reference::collide(GasModel::fhp1, s, true, false)};
    };
    EXPECT_EQ(both(9), (std::set<int>{18, 36}));
    EXPECT_EQ(both(18), (std::set<int>{9, 36}));
    EXPECT_EQ(both(36), (std::set<int>{9, 18}));
    EXPECT_EQ(reference::collide(GasModel::fhp1, 9, true, false), 18); // by +60 degrees
}

TEST(Collisions, DissipationStopsAndElasticCollisionsSetGoing) {
    int stopped = 0, freed = 0;
    for (int s = 0; s < 128; ++s) {
        const auto movers = [](int state) { return std::popcount(static_cast<unsigned>(state & 63)); };
        stopped += movers(reference::collide(GasModel::pipe, s, false, true)) < movers(s) ? 1 : 0;
        freed += movers(reference::collide(GasModel::pipe, s, false, false)) > movers(s) ? 1 : 0;
    }
    EXPECT_EQ(stopped, 6);
    EXPECT_EQ(freed, 6);
}

// Each bit of a word is a site of another state.
TEST(Collisions, BooleanExpressionsAreTheTables) {
    const GasModel models[] = {GasModel::hpp, GasModel::fhp1, GasModel::fhp2, GasModel::fhp3, GasModel::pipe};
    for (const GasModel model : models)
        for (int first = 0; first < states_of(model); first += 64)
            for (const bool xi : {false, true})
                for (const bool d : {false, true}) {
                    std::uint64_t n[7] = {};
                    for (int site = 0; site < 64; ++site)
                        for (int i = 0; i < 7; ++i)
                            n[i] |= static_cast<std::uint64_t>((first + site) >> i & 1) << site;
                    const std::uint64_t all = ~std::uint64_t{0}, x = xi ? all : 0, join = d ? all : 0;
                    if (model == GasModel::hpp) simd::collide_hpp(n);
                    if (model == GasModel::fhp1) simd::collide_fhp1(n, x);
                    if (model == GasModel::fhp2) simd::collide_fhp2(n, x);
                    if (model == GasModel::fhp3) simd::collide_fhp3(n, x);
                    if (model == GasModel::pipe) simd::collide_with_rest(n, x, ~join, join);
                    for (int site = 0; site < 64 && first + site < states_of(model); ++site) {
                        int out = 0;
                        for (int i = 0; i < 7; ++i) out |= static_cast<int>(n[i] >> site & 1) << i;
                        EXPECT_EQ(out, reference::collide(model, first + site, xi, d)) << first + site;
                    }
                }
}

TEST(Collisions, TableOfBytesIsTheRule) {
    constexpr simd::StateTable table = simd::fhp3_table();
    for (int s = 0; s < 128; ++s)
        for (const bool xi : {false, true})
            EXPECT_EQ(table.to[xi ? 1 : 0][s], reference::collide(GasModel::fhp3, s, xi, false)) << s;
}

TEST(Collisions, GravityTurnsOneParticle) {
    int fixed = 0;
    for (int s = 0; s < 128; ++s) {
        std::uint64_t n[7];
        for (int i = 0; i < 7; ++i) n[i] = static_cast<std::uint64_t>(s >> i & 1);
        simd::turn_towards_x<true>(n, std::uint64_t{1});
        int out = 0;
        for (int i = 0; i < 7; ++i) out |= static_cast<int>(n[i] & 1) << i;
        const int expected = reference::turn_towards_x(s, true);
        EXPECT_EQ(out, expected) << s;
        EXPECT_EQ(std::popcount(static_cast<unsigned>(out)), std::popcount(static_cast<unsigned>(s)));
        EXPECT_GE(reference::momentum(out)[0], reference::momentum(s)[0]);
        fixed += expected == s ? 1 : 0;
    }
    EXPECT_EQ(fixed, 25);
}

// Kinematic viscosity (1/lambda - 1/2)/4, lambda: decay rate of the stress c_x c_y under the linearised
// collision operator at occupation d.
double viscosity(GasModel model, double d) {
    const int bits = model == GasModel::fhp1 ? 6 : 7;
    double stress[7] = {}, image[7] = {};
    for (int i = 0; i < 6; ++i) stress[i] = std::cos(M_PI * i / 3) * std::sin(M_PI * i / 3);
    for (int s = 0; s < 1 << bits; ++s)
        for (const bool xi : {false, true}) {
            const int out = reference::collide(model, s, xi, false);
            double weight = 0.5, slope = 0;
            for (int i = 0; i < bits; ++i) {
                const bool there = (s >> i & 1) != 0;
                weight *= there ? d : 1 - d;
                slope += stress[i] * (there ? 1 / d : -1 / (1 - d));
            }
            for (int i = 0; i < bits; ++i) image[i] += weight * slope * ((out >> i & 1) - (s >> i & 1));
        }
    double along = 0, norm = 0;
    for (int i = 0; i < bits; ++i) {
        along -= stress[i] * image[i];
        norm += stress[i] * stress[i];
    }
    return 0.25 * (norm / along - 0.5);
}

TEST(Collisions, ViscosityOfBoltzmann) {
    constexpr double d[] = {0.1, 0.2, 1.0 / 3, 0.5};
    constexpr double expected[3][4] = {{1.01811843, .68880208, .71875, 1.20833333},
                                       {.39459929, .26877520, .32169118, .675},
                                       {.31732130, .14816434, .09042553, .075}};
    const GasModel models[] = {GasModel::fhp1, GasModel::fhp2, GasModel::fhp3};
    for (int m = 0; m < 3; ++m)
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(viscosity(models[m], d[k]), expected[m][k], 1e-8);
}

} // namespace

} // namespace sandlane::automata
