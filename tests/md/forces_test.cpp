// Force sums of every pair-finding method, kernel and thread count against values computed independently.
#include "support/lattice_system.hpp"

#include <gtest/gtest.h>

#include <string>

using namespace sandlane;
using scene::NeighbourMethod;

namespace {

constexpr const char* method_names[] = {"auto", "brute", "cells", "lattice", "lattice_half", "verlet"};

struct Case {
    simd::Isa isa;
    NeighbourMethod method;
};

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const simd::Isa isa : simd::available_isas())
        for (const auto method :
             {NeighbourMethod::brute_force, NeighbourMethod::link_cells, NeighbourMethod::lattice,
              NeighbourMethod::lattice_half, NeighbourMethod::verlet})
            cases.push_back({isa, method});
    return cases;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
    std::string name =
        std::string(simd::isa_name(info.param.isa)) + "_" + method_names[static_cast<int>(info.param.method)];
    for (char& c : name)
        if (c == '.') c = '_';
    return name;
}

class ForceSum : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(ForceSum, MatchesTableOne) {
    const auto grains = test::lattice_grains();
    md::Simulation sim = test::make_simulation(test::lattice_scene(), grains, simd::Isa::scalar);
    const auto f = sim.forces(GetParam().isa, GetParam().method);
    double sum = 0, torque = 0;
    std::vector<std::size_t> place(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
        place[static_cast<std::size_t>(sim.state().id[i])] = i;
        sum += std::hypot(f[4 * i], f[4 * i + 1]);
        torque += std::abs(f[4 * i + 2] * sim.state().radius(i));
    }
    EXPECT_NEAR(sum, 2838.446713117929, 1e-9);
    EXPECT_NEAR(torque, 21.239234403941, 1e-10);
    const struct {
        std::size_t id;
        double x, y, torque;
    } expected[] = {{5, 5.027140981609, -96.123750753990, -0.631043066835},
                    {9, 34.057006908729, -28.503200988961, -0.050312157857},
                    {40, 101.697980497563, 65.486981359628, 1.058759837592},
                    {63, -8.457511738116, 46.359221501435, -0.144944119562}};
    for (const auto& e : expected) {
        const std::size_t i = place[e.id];
        EXPECT_NEAR(f[4 * i], e.x, 1e-11) << e.id;
        EXPECT_NEAR(f[4 * i + 1], e.y, 1e-11) << e.id;
        EXPECT_NEAR(f[4 * i + 2] * sim.state().radius(i), e.torque, 1e-11) << e.id;
    }
    for (const std::size_t id : {0U, 27U}) {
        EXPECT_EQ(f[4 * place[id]], 0.0);
        EXPECT_EQ(f[4 * place[id] + 1], 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ForceSum, testing::ValuesIn(all_cases()), case_name);

TEST(Contacts, CountAndElasticEnergyOfTableOne) {
    const md::Simulation sim =
        test::make_simulation(test::lattice_scene(), test::lattice_grains(), simd::Isa::scalar);
    const md::Observables o = sim.observe();
    EXPECT_EQ(o.contacts, 71);
    EXPECT_NEAR(o.elastic, 88.587838980631, 1e-10);
}

namespace {

struct Variant {
    NeighbourMethod method;
    scene::NormalLaw normal;
    scene::TangentialLaw tangential;
    bool equal_radii; // and two materials, on this half of the cases
};

std::vector<Variant> all_variants() {
    std::vector<Variant> variants;
    for (const bool equal_radii : {false, true})
        for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic})
            for (const auto tangential : {scene::TangentialLaw::none, scene::TangentialLaw::haff_werner})
                for (const auto method :
                     {NeighbourMethod::brute_force, NeighbourMethod::link_cells, NeighbourMethod::lattice,
                      NeighbourMethod::lattice_half, NeighbourMethod::verlet})
                    variants.push_back({method, normal, tangential, equal_radii});
    for (const bool equal_radii : {false, true})
        variants.push_back({NeighbourMethod::verlet, scene::NormalLaw::viscoelastic,
                            scene::TangentialLaw::cundall_strack, equal_radii});
    return variants;
}

std::string variant_name(const testing::TestParamInfo<Variant>& info) {
    const Variant& v = info.param;
    return std::string(method_names[static_cast<int>(v.method)]) +
           (v.normal == scene::NormalLaw::viscoelastic ? "_hertz" : "_linear") +
           (v.tangential == scene::TangentialLaw::none          ? ""
            : v.tangential == scene::TangentialLaw::haff_werner ? "_friction"
                                                                : "_springs") +
           (v.equal_radii ? "_equal_radii" : "");
}

class Determinism : public testing::TestWithParam<Variant> {};

} // namespace

TEST_P(Determinism, SameBitsForEveryIsaAndThreadCount) {
    const Variant& v = GetParam();
    const int rows = v.method == NeighbourMethod::brute_force ? 4 : 30; // all pairs: a smaller system will do
    scene::Scene s = test::lattice_scene(24, rows);
    auto grains = test::lattice_grains(24, rows, v.equal_radii);
    s.md.normal = v.normal;
    s.md.tangential = v.tangential;
    s.md.neighbours = v.method;
    s.materials[0].young = 1000;
    s.materials[0].dissipation = 1e-3;
    s.materials[0].tangential_stiffness = 200;
    if (v.tangential == scene::TangentialLaw::none)
        for (auto& g : grains) g.omega = 0;
    if (v.equal_radii) {
        s.materials.push_back(s.materials[0]);
        s.materials[1].name = "other";
        s.materials[1].stiffness = 800;
        for (std::size_t i = 0; i < grains.size(); i += 3) grains[i].material = 1;
    }
    std::string reference;
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 2, 3, 7}) {
            // Seven threads on few cores wait for each other a lot: one instruction set shows it.
            if (threads > 2 && isa != simd::available_isas().back()) continue;
            md::Simulation sim = test::make_simulation(s, grains, isa, threads);
            sim.run(300); // crosses a sort of the storage, at step 256
            const std::string hash = sim.state_hash().hex();
            if (reference.empty()) reference = hash;
            EXPECT_EQ(hash, reference) << simd::isa_name(isa) << " threads " << threads;
        }
}

INSTANTIATE_TEST_SUITE_P(All, Determinism, testing::ValuesIn(all_variants()), variant_name);
