// A grain that slides along walls across a periodic side keeps its contact.
#include "support/space_system.hpp"

#include <gtest/gtest.h>

using namespace sandlane;

namespace {

scene::Scene floor_scene(int dimension) {
    scene::Scene s = test::lattice_scene();
    s.domain.dimension = dimension;
    s.domain.lower = {0, 0, 0};
    s.domain.upper = {40, 30, dimension == 3 ? 30.0 : 0.0};
    s.domain.periodic = {true, false, false};
    s.domain.gravity = {0, -1, 0};
    s.md.tangential = scene::TangentialLaw::none;
    if (dimension == 3) s.md.inertia = scene::Inertia::sphere;
    s.md.dt = 1e-3;
    scene::Wall w;
    w.name = "floor";
    if (dimension == 3) {
        w.kind = scene::WallKind::plane;
        w.points = {{0, 1, 0}};
        w.normal = {0, 1, 0};
        s.walls = {w};
        return s;
    }
    w.kind = scene::WallKind::segment;
    w.points = {{-10, 1, 0}, {20, 1, 0}};
    s.walls.push_back(w);
    w.points = {{20, 1, 0}, {50, 1, 0}};
    s.walls.push_back(w);
    return s;
}

} // namespace

TEST(WallAtPeriodicSide, HoldsWhatSlidesAcross) {
    for (const int dimension : {2, 3}) {
        const scene::Scene s = floor_scene(dimension);
        scene::GrainState g;
        g.radius = 1;
        g.mass = 1;
        g.velocity = {1, 0, 0};
        g.position = {38, 2 - 1 / s.materials[0].stiffness,
                      dimension == 3 ? 15.0 : 0.0}; // at rest on the floor
        for (const simd::Isa isa : {simd::Isa::scalar, simd::available_isas().back()}) {
            md::Simulation sim = test::make_simulation(s, {g}, isa);
            for (int part = 0; part < 400; ++part) {
                sim.run(10);
                ASSERT_EQ(sim.observe().wall_contacts, 1) << sim.time();
                ASSERT_NEAR(sim.snapshot().y[0], g.position.y, 1e-12);
            }
            EXPECT_LT(sim.snapshot().x[0], 10);
        }
    }
}
