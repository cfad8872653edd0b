// The same bits for every instruction set, number of threads and division of a run, and after a checkpoint.
#include "dsmc/support.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

using namespace sandlane;

namespace {

struct Case {
    std::string name;
    dsmc::Setup setup;
    std::uint32_t particles;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, const dsmc::Setup& s, std::uint32_t n) {
        all.push_back({name, s, n});
    };
    add("space", test::gas(3, 0.9, 6000, 12), 6000);
    add("plane", test::gas(2, 0.8, 5000, 30), 5000);
    dsmc::Setup near = test::gas(3, 0.9, 6000, 12);
    near.partners = 5;
    add("near", near, 6000);
    near = test::gas(2, 0.9, 5000, 20);
    near.cells[0] = 1;
    near.partners = 3;
    near.others = {{2, 1.3, 0.3}};
    add("near_mixture", near, 5000);
    dsmc::Setup s = test::gas(3, 1, 6000, 11);
    s.restitution.model = laws::Restitution::Model::viscoelastic;
    s.restitution.dissipation = 0.05;
    s.enskog = true;
    s.adaptive = true;
    add("viscoelastic", s, 6000);
    s.restitution = {laws::Restitution::Model::saturating, 0.6, 0, 1.5, 0.2};
    s.rough = true;
    s.tangential = -0.4;
    s.friction = 0.3;
    add("rough", s, 6000);
    s = test::gas(2, 0.9, 4000, 20);
    s.rough = true;
    s.inertia = 0.5;
    s.tangential = 0.3;
    s.kicks = 0.05;
    add("rough_plane", s, 4000);
    s = test::gas(3, 0.9, 6000, 12);
    s.gravity[2] = -0.3;
    s.gravity[0] = 0.05;
    s.walls.periodic[2] = false;
    s.walls.side[2][0].motion = {0.3, 0.4, 0.1};
    s.walls.side[2][1].eps_n = 0.8;
    s.walls.periodic[1] = false;
    s.walls.side[1][0].kind = s.walls.side[1][1].kind = simd::GasSide::Kind::heated;
    s.walls.side[1][0].thermal_speed = 1.5;
    s.walls.side[1][1].thermal_speed = 0.7;
    s.walls.side[1][1].accommodation = 0.8;
    s.kicks = 0.02;
    s.dt = 0.3;
    add("walls", s, 6000);
    s = test::gas(3, 0.9, 6000, 12);
    s.others = {{0.1, 0.6, 0.3}, {5, 1.7, 0.2}};
    s.pairs = {{0, 1, 0.7, 0}, {2, 2, 0.5, 0}};
    s.enskog = true;
    s.kicks = 0.01;
    add("mixture", s, 6000);
    s.kicks = 0;
    s.adaptive = true;
    add("adaptive_mixture", s, 6000);
    s = test::gas(2, 0.9, 4000, 20);
    s.others = {{3, 1.4, 0.4}};
    s.restitution.model = laws::Restitution::Model::viscoelastic;
    s.restitution.dissipation = 0.05;
    s.pairs = {{0, 1, 1, 0.2}};
    s.rough = true;
    s.tangential = -0.4;
    s.friction = 0.3;
    s.enskog = true;
    s.walls.periodic[1] = false;
    s.walls.side[1][0].kind = simd::GasSide::Kind::heated;
    s.walls.side[1][0].thermal_speed = 1.2;
    s.walls.side[1][1].eps_n = 0.9;
    s.walls.side[1][1].eps_t = 0.2;
    s.gravity[1] = -0.1;
    add("rough_mixture", s, 4000);
    s = test::gas(3, 0.9, 6000, 12);
    s.shear = 0.3;
    add("shear", s, 6000);
    s = test::gas(2, 0.9, 5000, 30);
    s.scheme = laws::CollisionScheme::maxwell;
    add("maxwell", s, 5000);
    s = test::gas(3, 0.9, 900, 30); // hardly any particles
    s.cells[1] = 1;
    s.dt = 20; // far beyond a tile
    add("thin", s, 900);
    return all;
}

} // namespace

TEST(Bits, EveryInstructionSetAndThreadCount) {
    for (const Case& c : cases()) {
        const auto start = dsmc::maxwellian(c.setup, c.particles, 1, c.setup.rough ? 0.5 : 0);
        dsmc::Simulation reference(c.setup, start, simd::Isa::scalar, 1);
        reference.run(6);
        EXPECT_GT(reference.counts().collisions, 0) << c.name;
        for (const simd::Isa isa : simd::available_isas())
            for (const int threads : {1, 7}) {
                dsmc::Simulation other(c.setup, start, isa, threads);
                other.run(6);
                EXPECT_EQ(other.state_hash(), reference.state_hash())
                    << c.name << " " << simd::isa_name(isa) << " " << threads;
                EXPECT_EQ(other.counts().candidates, reference.counts().candidates) << c.name;
                EXPECT_EQ(other.counts().violations, reference.counts().violations) << c.name;
                EXPECT_EQ(other.wall_energy(), reference.wall_energy()) << c.name;
            }
    }
}

// Which pairs are looked at and which collide: the same decisions in the same order.
TEST(Bits, Decisions) {
    for (const Case& c : cases()) {
        const auto start = dsmc::maxwellian(c.setup, c.particles, 1, c.setup.rough ? 0.5 : 0);
        dsmc::Simulation reference(c.setup, start, simd::Isa::scalar, 1);
        reference.keep_decisions();
        reference.run(4);
        const auto expected = reference.take_decisions();
        EXPECT_TRUE(reference.take_decisions().empty());
        ASSERT_EQ(static_cast<std::int64_t>(expected.size()), reference.counts().candidates) << c.name;
        std::int64_t accepted = 0;
        for (const auto& d : expected) accepted += d.of.accepted ? 1 : 0;
        EXPECT_EQ(accepted, reference.counts().collisions) << c.name;
        for (const simd::Isa isa : simd::available_isas()) {
            dsmc::Simulation other(c.setup, start, isa, 2);
            other.keep_decisions();
            other.run(4);
            const auto found = other.take_decisions();
            ASSERT_EQ(found.size(), expected.size()) << c.name;
            for (std::size_t n = 0; n < found.size(); ++n) {
                const simd::GasDecision &a = found[n].of, &b = expected[n].of;
                ASSERT_TRUE(found[n].step == expected[n].step && a.cell == b.cell &&
                            a.candidate == b.candidate && a.first == b.first && a.second == b.second &&
                            a.accepted == b.accepted)
                    << c.name << " " << simd::isa_name(isa) << " " << n;
            }
        }
    }
}

TEST(Bits, OneRunOrSeveralOrAfterACheckpoint) {
    for (const Case& c : cases()) {
        const auto start = dsmc::maxwellian(c.setup, c.particles, 1);
        dsmc::Simulation straight(c.setup, start, simd::available_isas().back(), 2);
        straight.run(9);
        dsmc::Simulation parts(c.setup, start, simd::available_isas().back(), 1);
        parts.run(1);
        parts.run(4);
        dsmc::Simulation later(c.setup, start, simd::available_isas().front(), 2);
        later.restore(parts.serialise());
        EXPECT_EQ(later.state_hash(), parts.state_hash()) << c.name;
        later.run(4);
        EXPECT_EQ(later.state_hash(), straight.state_hash()) << c.name;
        EXPECT_EQ(later.time(), straight.time()) << c.name;
        EXPECT_EQ(later.wall_energy(), straight.wall_energy()) << c.name;
        EXPECT_EQ(later.counts().collisions, straight.counts().collisions) << c.name;
    }
}

// States with a checksum that holds, but made up.
TEST(Bits, StatesThatCannotBe) {
    dsmc::Setup setup = test::gas(3, 0.9, 200, 12);
    setup.others = {{2, 1.5, 0.5}};
    const auto start = dsmc::maxwellian(setup, 200, 1);
    dsmc::Simulation gas(setup, start, simd::Isa::scalar, 1);
    const std::string good = gas.serialise();
    gas.restore(good);
    // The rows of the first tile stand behind the frame, the step, six sums, four counts and the number of
    // tiles.
    std::uint64_t frame = 0, numbers = 0;
    std::memcpy(&frame, good.data(), sizeof frame);
    const std::size_t places = 8 + frame + 8 + 6 * 8 + 4 * 8 + 8;
    std::memcpy(&numbers, good.data() + places, sizeof numbers);
    ASSERT_GE(numbers, 8U); // two particles
    const std::size_t place = places + 8, velocity = place + 8 * numbers + 8;
    const auto refused = [&](std::size_t at, std::uint64_t word) {
        std::string bytes = good;
        std::memcpy(bytes.data() + at, &word, sizeof word);
        EXPECT_THROW(gas.restore(bytes), Error) << at << " " << word;
    };
    std::uint64_t identity = 0, images = 0;
    std::memcpy(&identity, good.data() + place + 24, sizeof identity);
    std::memcpy(&images, good.data() + velocity + 24, sizeof images);
    refused(velocity + 24, (images & ~(std::uint64_t{15} << 60)) | std::uint64_t{2} << 60); // a third kind
    refused(velocity, std::bit_cast<std::uint64_t>(std::nan("")));
    refused(place, std::bit_cast<std::uint64_t>(std::nan("")));
    refused(place, std::bit_cast<std::uint64_t>(1e300));
    refused(place + 24, identity + 200); // nobody has this number
    refused(place + 32 + 24, identity);  // or two have it
    gas.restore(good);
}
