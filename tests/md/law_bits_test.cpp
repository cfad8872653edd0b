// Every pair of laws in the plane and in space, with couples and several materials: the same bits for every
// instruction set and thread count and after a checkpoint, forces that no method of finding pairs changes,
// and no notice of where the box is cut.
#include "scene/schema.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace sandlane;
using scene::NeighbourMethod;
using scene::NormalLaw;
using scene::TangentialLaw;

namespace {

struct Choice {
    int dimension, normal, tangential;
    laws::Couples couples;
    bool two_materials, resolved = false;

    friend void PrintTo(const Choice& c, std::ostream* stream) { *stream << c.normal << ' ' << c.tangential; }
};

std::vector<Choice> all_choices() {
    std::vector<Choice> choices;
    for (const int dimension : {2, 3})
        for (int normal = 0; normal < laws::normal_laws; ++normal)
            for (int tangential = 0; tangential < laws::tangential_laws; ++tangential)
                for (const auto couples : {laws::Couples::none, laws::Couples::damped, laws::Couples::sprung})
                    for (const bool two : {false, true}) {
                        const auto law = static_cast<TangentialLaw>(tangential);
                        if (law == TangentialLaw::none && couples != laws::Couples::none) continue;
                        if (law == TangentialLaw::haff_werner && couples == laws::Couples::sprung) continue;
                        if (law == TangentialLaw::walton_braun && dimension == 3) continue;
                        choices.push_back({dimension, normal, tangential, couples, two});
                        const auto of_normal = static_cast<NormalLaw>(normal);
                        const bool resolves =
                            of_normal == NormalLaw::linear_dashpot || of_normal == NormalLaw::viscoelastic;
                        if (resolves && couples == laws::Couples::none)
                            choices.push_back({dimension, normal, tangential, couples, two, true});
                    }
    return choices;
}

std::string choice_name(const testing::TestParamInfo<Choice>& info) {
    const Choice& c = info.param;
    std::string name = (c.dimension == 2 ? "plane_" : "space_") +
                       std::string(scene::normal_choices()[static_cast<std::size_t>(c.normal)]) + "_" +
                       std::string(scene::tangential_choices()[static_cast<std::size_t>(c.tangential)]) +
                       (c.couples == laws::Couples::none     ? ""
                        : c.couples == laws::Couples::damped ? "_couples"
                                                             : "_rolling_springs") +
                       (c.two_materials ? "_two" : "") + (c.resolved ? "_resolved" : "");
    std::ranges::replace(name, '-', '_');
    return name;
}

void set_coefficients(scene::Material& m, double factor, laws::Couples couples) {
    m.stiffness = 1000 * factor;
    m.unloading_stiffness = 1500 * factor;
    m.young = 1000 * factor;
    m.dissipation = 1e-3 / factor;
    m.tangential_stiffness = 200 * factor;
    m.cohesion = 10 * factor;
    if (couples == laws::Couples::none) return;
    m.rolling_friction = 0.1 * factor;
    m.rolling_damping = 0.05;
    if (couples == laws::Couples::sprung) m.rolling_stiffness = 30 * factor;
}

// A system of a little more than one tile of grains.
class LawBits : public testing::TestWithParam<Choice> {
protected:
    LawBits() {
        const Choice c = GetParam();
        scene_ = c.dimension == 2 ? test::lattice_scene(37, 28) : test::space_scene(11);
        grains_ = c.dimension == 2 ? test::lattice_grains(37, 28) : test::space_grains(11);
        scene_.md.normal = static_cast<NormalLaw>(c.normal);
        scene_.md.tangential = static_cast<TangentialLaw>(c.tangential);
        scene_.md.neighbours = NeighbourMethod::verlet;
        scene_.md.cut = !c.two_materials;
        if (c.resolved) {
            scene_.md.integrator = scene::Integrator::velocity_verlet;
            scene_.md.contact_onset = scene::ContactOnset::resolved;
            scene_.md.dt = 5e-3; // t_c/14: many begins and ends
        }
        if (c.couples != laws::Couples::none) scene_.md.lever_arm = scene::LeverArm::plane;
        set_coefficients(scene_.materials[0], 1, c.couples);
        if (scene_.md.tangential == TangentialLaw::none)
            for (auto& g : grains_) g.omega = 0, g.angular_velocity = {};
        if (!c.two_materials) return;
        scene_.materials.push_back(scene_.materials[0]);
        scene_.materials[1].name = "other";
        scene_.materials[1].friction = 0.2;
        set_coefficients(scene_.materials[1], 0.8, c.couples);
        for (std::size_t i = 0; i < grains_.size(); i += 3) grains_[i].material = 1;
    }

    [[nodiscard]] md::Simulation make(simd::Isa isa, int threads = 1) const {
        return test::make_simulation(scene_, grains_, isa, threads);
    }

    scene::Scene scene_;
    std::vector<scene::GrainState> grains_;
    static constexpr int steps = 90; // the length of one collision, which is 70 to 110 of them, or of six
};

} // namespace

TEST_P(LawBits, SameForEveryIsaAndThreadCountAndAfterACheckpoint) {
    std::string reference;
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 3}) {
            if (isa == simd::Isa::scalar && threads > 1) continue;
            md::Simulation sim = make(isa, threads);
            sim.run(steps);
            const std::string hash = sim.state_hash().hex();
            if (reference.empty()) reference = hash;
            EXPECT_EQ(hash, reference) << simd::isa_name(isa) << " threads " << threads;
        }
    md::Simulation first = make(simd::available_isas().back());
    first.run(37);
    md::Simulation second = make(simd::available_isas().front());
    second.restore(first.serialise());
    second.run(steps - 37);
    EXPECT_EQ(second.state_hash().hex(), reference);
}

// Sums in another order: rounding of some ten forces of up to 1e3 N.
TEST_P(LawBits, MethodsOfFindingPairsAgree) {
    md::Simulation sim = make(simd::available_isas().back());
    if (sim.plan().memory > 0 || sim.plan().resolved) return; // these contacts have lists only
    sim.run(20);
    const std::vector<double> lists = sim.forces(simd::available_isas().back(), NeighbourMethod::verlet);
    for (const simd::Isa isa : {simd::Isa::scalar, simd::available_isas().back()}) {
        const std::vector<double> cells = sim.forces(isa, NeighbourMethod::link_cells);
        ASSERT_EQ(cells.size(), lists.size());
        double worst = 0;
        for (std::size_t n = 0; n < lists.size(); ++n) worst = std::max(worst, std::abs(cells[n] - lists[n]));
        EXPECT_LT(worst, 1e-11);
    }
}

TEST_P(LawBits, NothingChangesWhereTheBoxIsCut) {
    md::Simulation here = make(simd::available_isas().back());
    const Vec size = scene_.domain.upper;
    const auto shifted = [](double x, double length) {
        return x < 0.5 * length ? x + 0.5 * length : x - 0.5 * length;
    };
    for (auto& g : grains_)
        g.position = {shifted(g.position.x, size.x), shifted(g.position.y, size.y),
                      GetParam().dimension == 3 ? shifted(g.position.z, size.z) : 0};
    md::Simulation there = make(simd::available_isas().back());
    here.run(steps);
    there.run(steps);
    const analysis::Snapshot a = here.snapshot(), b = there.snapshot();
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        worst = std::max({worst, std::abs(a.vx[i] - b.vx[i]), std::abs(a.vy[i] - b.vy[i])});
    // Rounding of positions, 1e-14, grows a thousandfold in a collision; a lost memory would show at 1e-3.
    EXPECT_LT(worst, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, LawBits, testing::ValuesIn(all_choices()), choice_name);
