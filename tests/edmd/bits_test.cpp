// The same events, bit for bit: simple and improved algorithm, all instruction sets, cells of any size, any
// number of threads, any division of a run, and after a checkpoint.
#include "core/error.hpp"
#include "edmd/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;

namespace {

struct Case {
    std::string name;
    edmd::Setup setup;
    edmd::Amounts amounts;
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
    s.pairs.assign(9, s.restitution);
    s.pairs[1].eps = s.pairs[3].eps = 0.5;
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

void compare_algorithms(std::int64_t events) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto particles = particles_of(c);
        edmd::SimpleAlgorithm simple(c.setup, particles);
        const auto expected = test::events_of(simple, events);
        ASSERT_EQ(static_cast<std::int64_t>(expected.size()), events);
        for (const simd::Isa isa : simd::available_isas()) {
            SCOPED_TRACE(std::string(simd::isa_name(isa)));
            edmd::Simulation improved(c.setup, particles, isa, 1);
            expect_same(expected, test::events_of(improved, events));
            EXPECT_EQ(simple.log().hash(), improved.log().hash());
            EXPECT_EQ(simple.time(), improved.time());
            EXPECT_EQ(simple.tally().virial, improved.tally().virial);
            EXPECT_EQ(simple.tally().wall_energy, improved.tally().wall_energy);
            EXPECT_EQ(simple.tally().lost, improved.tally().lost);
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

} // namespace

TEST(EdmdBits, SimpleAndImprovedAlgorithm) {
    compare_algorithms(2000);
}
TEST(EdmdBits, SimpleAndImprovedAlgorithmSlow) {
    compare_algorithms(10000);
}

TEST(EdmdBits, CellsThreadsAndDivisionOfTheRun) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto particles = particles_of(c);
        const simd::Isa isa = simd::available_isas().back();
        edmd::Simulation once(c.setup, particles, isa, 1);
        once.run(3000);
        for (const double factor : {1.0, 1.7}) {
            edmd::Setup other = c.setup;
            other.cell_edge = factor * 2 * other.largest_radius();
            bool fits = true;
            for (int d = 0; d < other.dimension; ++d)
                fits = fits && (!other.periodic[d] || other.length(d) > 3.01 * other.cell_edge);
            if (!fits) continue;
            edmd::Simulation same(other, particles, isa, factor > 1 ? 7 : 2);
            for (std::int64_t n = 0; n < 3000; n += 250) same.run(250);
            EXPECT_EQ(once.log().hash(), same.log().hash());
            EXPECT_EQ(once.state_hash(), same.state_hash());
        }
    }
}

TEST(EdmdBits, StopsByTimeLeaveNoTrace) {
    const Case c = cases()[1];
    const auto particles = particles_of(c);
    edmd::Simulation once(c.setup, particles, simd::Isa::scalar, 1);
    once.run(5000);
    edmd::Simulation stopped(c.setup, particles, simd::Isa::scalar, 1);
    for (int k = 1; k <= 7; ++k) {
        stopped.run(1000000, once.time() * k / 8);
        EXPECT_NEAR(stopped.time(), once.time() * k / 8, 1e-12 * once.time());
        (void)stopped.particles();
    }
    stopped.run(5000 - static_cast<std::int64_t>(stopped.log().count()));
    EXPECT_EQ(once.log().hash(), stopped.log().hash());
    EXPECT_EQ(once.state_hash(), stopped.state_hash());
}

TEST(EdmdBits, GoesOnAfterACheckpoint) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const auto particles = particles_of(c);
        const simd::Isa isa = simd::available_isas().back();
        edmd::Simulation once(c.setup, particles, isa, 1), resumed(c.setup, particles, isa, 1);
        edmd::SimpleAlgorithm simple(c.setup, particles), simple_resumed(c.setup, particles);
        once.run(1300);
        simple.run(1300);
        resumed.restore(once.serialise());
        simple_resumed.restore(simple.serialise());
        EXPECT_EQ(once.state_hash(), resumed.state_hash());
        EXPECT_EQ(once.state_hash(), simple.state_hash());
        once.run(1300);
        resumed.run(1300);
        simple_resumed.run(1300);
        EXPECT_EQ(once.state_hash(), resumed.state_hash());
        EXPECT_EQ(once.state_hash(), simple_resumed.state_hash());
        EXPECT_EQ(once.tally().virial, resumed.tally().virial);
    }
}

TEST(EdmdBits, StatesOfSomethingElseAreRefused) {
    const Case c = cases()[0];
    edmd::Simulation gas(c.setup, particles_of(c), simd::Isa::scalar, 1);
    std::string state = gas.serialise();
    edmd::Setup other = c.setup;
    other.upper[0] += 0.5;
    edmd::Simulation different(other, particles_of(c), simd::Isa::scalar, 1);
    EXPECT_THROW(different.restore(state), Error);
    EXPECT_THROW(gas.restore(state.substr(0, state.size() / 2)), Error);
    edmd::SimpleAlgorithm simple(c.setup, particles_of(c));
    EXPECT_THROW(simple.restore(state), Error);
    simple.restore(edmd::SimpleAlgorithm(c.setup, particles_of(c)).serialise());
    EXPECT_THROW(simple.restore(edmd::SimpleAlgorithm(other, particles_of(c)).serialise()), Error);
    // Kicks are counted: at other intervals the count would mean another time.
    edmd::Setup heated = c.setup;
    heated.kicks = 0.1;
    heated.kick_interval = 0.5;
    edmd::Setup often = heated;
    often.kick_interval = 0.25;
    const std::string kicked = edmd::SimpleAlgorithm(often, particles_of(c)).serialise();
    EXPECT_THROW(simple.restore(kicked), Error);
    EXPECT_THROW(edmd::SimpleAlgorithm(heated, particles_of(c)).restore(kicked), Error);
}

// Rows of discs that move alike: all crossings and many contacts fall on the same times.
TEST(EdmdBits, ManyEventsAtOnce) {
    edmd::Setup s;
    s.dimension = 2;
    s.upper[0] = s.upper[1] = 16;
    std::vector<edmd::Particle> particles(64);
    for (std::uint32_t n = 0; n < 64; ++n) {
        edmd::Particle& p = particles[n];
        p.id = n;
        p.place = {2.0 * (n % 8) + 0.5, 2.0 * (n / 8) + 0.5, 0};
        p.velocity = {n % 2 == 0 ? 1.0 : -1.0, n / 8 % 2 == 0 ? 0.5 : -0.5, 0};
    }
    edmd::SimpleAlgorithm simple(s, particles);
    const auto expected = test::events_of(simple, 4000);
    for (const simd::Isa isa : simd::available_isas()) {
        edmd::Simulation improved(s, particles, isa, 1);
        expect_same(expected, test::events_of(improved, 4000));
        EXPECT_EQ(simple.state_hash(), improved.state_hash());
    }
}
