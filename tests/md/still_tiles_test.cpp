// Tiles of grains at rest are stepped over, and nothing tells: the same bits with and without.
#include "md/support.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <string>

using namespace sandlane;
using namespace sandlane::test;

namespace {

struct Field {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
};

// Grains at rest that do not touch, in a box of walls, and one that flies through them: what it hits wakes
// up.
Field field(int dimension, scene::TangentialLaw tangential) {
    Field f;
    const int side = dimension == 3 ? 14 : 56;
    f.scene = lattice_scene();
    f.scene.domain.dimension = dimension;
    const double edge = 2.5 * side;
    f.scene.domain.upper = {edge, edge, dimension == 3 ? edge : 0.0};
    f.scene.domain.periodic = {};
    f.scene.md.tangential = tangential;
    f.scene.md.max_speed = 20;
    f.scene.md.freeze = true;
    f.scene.materials[0].tangential_stiffness = 200;
    f.scene.walls = {floor_plane()};
    f.scene.walls[0].material = "";
    const int layers = dimension == 3 ? side : 1;
    for (int n = 0; n < side * side * layers; ++n) {
        scene::GrainState g =
            grain(n, {1.25 + 2.5 * (n % side), 1.25 + 2.5 * (n / side % side), 0}, {}, 1, 1);
        if (dimension == 3) g.position.z = 1.25 + 2.5 * (n / (side * side));
        if (n == side / 2) g.velocity = {3, 15, dimension == 3 ? 1.0 : 0.0};
        f.grains.push_back(g);
    }
    return f;
}

md::Simulation make(Field f, bool freeze, simd::Isa isa, int threads) {
    f.scene.md.freeze = freeze;
    return make_simulation(f.scene, f.grains, isa, threads);
}

} // namespace

TEST(StillTiles, SameBitsWithAndWithout) {
    for (const int dimension : {2, 3})
        for (const auto law : {scene::TangentialLaw::none, scene::TangentialLaw::cundall_strack}) {
            const Field f = field(dimension, law);
            md::Simulation plain = make(f, false, simd::available_isas().back(), 1);
            std::vector<std::string> expected;
            for (int part = 0; part < 4; ++part) {
                plain.run(150);
                expected.push_back(plain.state_hash().hex());
                EXPECT_EQ(plain.still_tiles(), 0U);
            }
            EXPECT_GT(plain.observe().kinetic, 10);
            for (const simd::Isa isa : simd::available_isas())
                for (const int threads : {1, 3}) {
                    if (isa == simd::Isa::scalar && threads > 1) continue;
                    md::Simulation still = make(f, true, isa, threads);
                    for (int part = 0; part < 4; ++part) {
                        still.run(150);
                        EXPECT_EQ(still.state_hash().hex(), expected[static_cast<std::size_t>(part)])
                            << dimension << simd::isa_name(isa) << threads << ' ' << part;
                    }
                    EXPECT_GT(still.still_tiles(), 0U);
                    EXPECT_LT(still.still_tiles(), still.state().tiles());
                }
        }
}

// A tile lies still until the wall comes.
TEST(StillTiles, WallsThatComeWakeThem) {
    Field f = field(2, scene::TangentialLaw::cundall_strack);
    f.grains[28].velocity = {};
    scene::Motion up;
    up.name = "up";
    up.kind = scene::MotionKind::linear;
    up.velocity = {0, 2, 0};
    f.scene.motions = {up};
    f.scene.walls[0].motion = "up";
    md::Simulation plain = make(f, false, simd::available_isas().back(), 1);
    md::Simulation still = make(f, true, simd::available_isas().back(), 2);
    still.run(50); // nothing touches anything yet
    EXPECT_GT(still.still_tiles(), 0U);
    still.run(950);
    plain.run(1000);
    EXPECT_GT(plain.wall_work(), 0.1);
    EXPECT_EQ(still.state_hash(), plain.state_hash());
    EXPECT_EQ(still.wall_work(), plain.wall_work());
}
