// The same events, bit for bit: simple and improved algorithm, all instruction sets, cells of any size, any
// number of threads, any division of a run, and after a checkpoint.
#include "edmd/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;

namespace {

struct Case {
    std::string name;
    edmd::Setup setup;
    edmd::Amounts amounts;
    std::int64_t events = 10000;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, const edmd::Setup& s, const edmd::Amounts& n) {
        all.push_back({name, s, n});
    };
    add("space", test::hard_gas(3, 0.2, 0.9, 64), {64});
    add("dense", test::hard_gas(3, 0.45, 1, 108), {108});
    add("plane", test::hard_gas(2, 0.3, 0.95, 64), {64});
    edmd::Setup s = test::hard_gas(3, 0.1, 1, 64);
    s.restitution.model = laws::Restitution::Model::viscoelastic;
    s.restitution.dissipation = 0.1;
    s.contact_time = 1e-3;
    add("viscoelastic", s, {64});
    s = test::hard_gas(3, 0.15, 0.8, 64);
    s.rough = true;
    s.tangential = -0.4;
    s.friction = 0.3;
    s.elastic_speed = 1e-3;
    add("rough", s, {64});
    s = test::hard_gas(2, 0.2, 0.9, 64);
    s.rough = true;
    s.classes[0].inertia = 0.5;
    s.tangential = 0.2;
    add("rough_plane", s, {64});
    s = test::hard_gas(2, 0.2, 0.9, 64);
    s.gravity[1] = -0.5;
    s.periodic[1] = false;
    s.side[1][0].eps_n = 0.9;
    s.side[1][0].motion = {0.2, 0.7, 0.1};
    add("vibrated", s, {64});
    s = test::hard_gas(3, 0.1, 0.9, 64);
    s.rough = true;
    s.tangential = 0.5;
    s.periodic[0] = s.periodic[2] = false;
    s.side[0][0].kind = s.side[0][1].kind = edmd::Side::Kind::heated;
    s.side[0][0].temperature = 2;
    s.side[0][1].temperature = 0.5;
    s.side[0][1].accommodation = 0.7;
    s.side[0][1].velocity[1] = 0.3;
    s.side[2][0].eps_t = -0.5;
    s.gravity[2] = -0.1;
    add("walls", s, {64});
    s = test::hard_gas(2, 0.1, 0.9, 80);
    s.classes = {{0.9, 2, 0.5}, {0.3, 0.3, 0.5}, {0.09, 0.1, 0.5}};
    add("mixture", s, {20, 30, 30});
    return all;
}

std::vector<edmd::Particle> particles_of(const Case& c) {
    return edmd::make_particles(c.setup, c.amounts, 1.0, c.setup.rough ? 0.5 : 0.0);
}

void expect_same(const std::vector<edmd::Event>& a, const std::vector<edmd::Event>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n)
        ASSERT_EQ(a[n], b[n]) << "event " << n << ": " << a[n].time << " (" << a[n].first << ", "
                              << a[n].second << ") and " << b[n].time << " (" << b[n].first << ", "
                              << b[n].second << ")";
}

} // namespace

TEST(EdmdBits, SimpleAndImprovedAlgorithm) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto particles = particles_of(c);
        edmd::SimpleAlgorithm simple(c.setup, particles);
        const auto expected = test::events_of(simple, c.events);
        ASSERT_EQ(static_cast<std::int64_t>(expected.size()), c.events);
        for (const simd::Isa isa : simd::available_isas()) {
            SCOPED_TRACE(std::string(simd::isa_name(isa)));
            edmd::Simulation improved(c.setup, particles, isa, 1);
            expect_same(expected, test::events_of(improved, c.events));
            EXPECT_EQ(simple.log().hash(), improved.log().hash());
            EXPECT_EQ(simple.time(), improved.time());
            EXPECT_EQ(simple.tally().virial, improved.tally().virial);
            EXPECT_EQ(simple.tally().wall_energy, improved.tally().wall_energy);
            const auto a = simple.particles(), b = improved.particles();
            for (std::size_t n = 0; n < a.size(); ++n) {
                EXPECT_EQ(a[n].place, b[n].place);
                EXPECT_EQ(a[n].velocity, b[n].velocity);
                EXPECT_EQ(a[n].spin, b[n].spin);
                EXPECT_EQ(a[n].image, b[n].image);
            }
        }
    }
}
