// Single events against the numbers of the specification (12.5 to 12.8, 12.12, 12.16), and what must not
// happen.
#include "core/error.hpp"
#include "edmd/support.hpp"

#include <gtest/gtest.h>

#include <functional>

using namespace sandlane;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// An empty box, walls far away.
edmd::Setup wide(int dimension) {
    edmd::Setup s;
    s.dimension = dimension;
    for (int d = 0; d < 3; ++d) {
        s.lower[d] = -1000;
        s.upper[d] = 1000;
        s.periodic[d] = false;
    }
    return s;
}

edmd::Particle at(std::uint32_t id, std::array<double, 3> place, std::array<double, 3> velocity,
                  std::array<double, 3> spin = {}, std::uint32_t kind = 0) {
    edmd::Particle p;
    p.id = id;
    p.kind = kind;
    p.place = place;
    p.velocity = velocity;
    p.spin = spin;
    return p;
}

// By both algorithms.
void with_both(const edmd::Setup& s, const std::vector<edmd::Particle>& particles,
               const std::function<void(edmd::Algorithm&)>& body) {
    {
        SCOPED_TRACE("simple");
        edmd::SimpleAlgorithm simple(s, particles);
        body(simple);
    }
    for (const simd::Isa isa : simd::available_isas()) {
        SCOPED_TRACE(std::string(simd::isa_name(isa)));
        edmd::Simulation improved(s, particles, isa, 1);
        body(improved);
    }
}

void expect_near(const std::array<double, 3>& a, std::array<double, 3> b) {
    for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(a[d], b[d], 2e-10);
}

struct Pair {
    edmd::Setup setup;
    edmd::Particle i, j;
    double time;
    std::array<double, 3> v_i, v_j, w_i{}, w_j{};
    double loss;
};

void check(const Pair& p) {
    with_both(p.setup, {p.i, p.j}, [&](edmd::Algorithm& run) {
        const double before = edmd::observe(run.setup(), run.particles()).energy;
        ASSERT_EQ(run.run(1), 1);
        EXPECT_NEAR(run.time(), p.time, 2e-12 * p.time);
        const auto after = run.particles();
        expect_near(after[0].velocity, p.v_i);
        expect_near(after[1].velocity, p.v_j);
        expect_near(after[0].spin, p.w_i);
        expect_near(after[1].spin, p.w_j);
        EXPECT_NEAR(edmd::observe(run.setup(), after).energy - before, p.loss, 1e-11);
    });
}

double fall(double h, double v, double g) {
    return laws::flat_wall_time(h, v, g);
}

} // namespace

TEST(EdmdEvents, CollisionsOfTheSpecification) {
    edmd::Setup s = wide(2);
    s.restitution.eps = 0.8;
    check({s,
           at(0, {0, 0, 0}, {1, 0, 0}),
           at(1, {3, 0, 0}, {-1, 0, 0}),
           1,
           {-0.8, 0, 0},
           {0.8, 0, 0},
           {},
           {},
           -0.36});
    s.restitution.eps = 0.9;
    s.rough = true;
    s.tangential = 0.3;
    s.classes = {{0.5, 1, 0.5}, {0.75, 2, 0.5}};
    check({s,
           at(0, {0, 0, 0}, {1, 0.25, 0}, {0, 0, 2}),
           at(1, {2, 0.6, 0}, {-0.5, 0, 0}, {0, 0, -1}, 1),
           0.558572698383,
           {-0.7547318462, -0.4333867005, 0},
           {0.3773659231, 0.3416933503, 0},
           {0, 0, 2.0435555556},
           {0, 0, -0.9854814815},
           -0.140468444444});
    s.classes = {{0.5, 1, 0.5}};
    s.restitution.eps = 1;
    s.tangential = -1;
    check({s,
           at(0, {0, 0, 0}, {1, 0, 0}),
           at(1, {2, 0.5, 0}, {0, 0, 0}),
           1.133974596216,
           {1.0 / 6, -0.2886751346, 0},
           {5.0 / 6, 0.2886751346, 0},
           {0, 0, 2.0 / 3},
           {0, 0, 2.0 / 3},
           0});
    s = wide(3);
    s.restitution.eps = 0.85;
    s.rough = true;
    s.tangential = -0.4;
    s.classes = {{0.5, 1, 0.4}, {0.6, 1.5, 0.4}};
    check({s,
           at(0, {0, 0, 0}, {1, 0.2, -0.1}, {0.5, -1, 2}),
           at(1, {1.5, 0.4, 0.3}, {-0.3, 0, 0.2}, {0, 1, -0.5}, 1),
           0.412157174229,
           {-0.0976393816, -0.2438401292, -0.3867274339},
           {0.4317595877, 0.2958934194, 0.3911516226},
           {0.9407999409, -1.8570474863, 1.6392137782},
           {0.2448888561, 0.5238625076, -0.7004367899},
           -0.150359464143});
    s = wide(3);
    s.restitution.eps = 0.9;
    check({s,
           at(0, {0, 0, 0}, {1, 0.2, -0.1}),
           at(1, {1.5, 0.4, 0.3}, {-0.3, 0, 0.2}),
           0.507329009796,
           {0.1882482123, -0.0883327298, -0.5367462331},
           {0.5117517877, 0.2883327298, 0.6367462331},
           {},
           {},
           -0.049096});
}

TEST(EdmdEvents, ThreeDiscsInARow) {
    edmd::Setup s = wide(2);
    s.restitution.eps = 0.8;
    with_both(s, {at(0, {0, 0, 0}, {1, 0, 0}), at(1, {3, 0, 0}, {}), at(2, {6, 0, 0}, {})},
              [](edmd::Algorithm& run) {
                  for (const double t : {2.0, 38.0 / 9, 182.0}) {
                      ASSERT_EQ(run.run(1), 1);
                      EXPECT_NEAR(run.time(), t, 1e-10);
                  }
                  const auto after = run.particles();
                  EXPECT_NEAR(after[0].velocity[0], 0.091, 1e-14);
                  EXPECT_NEAR(after[1].velocity[0], 0.099, 1e-14);
                  EXPECT_NEAR(after[2].velocity[0], 0.81, 1e-14);
              });
}

TEST(EdmdEvents, GrazingPairs) {
    const Vector<double> v{-1, 0, 0};
    const auto time = [&](double eta) { return laws::meeting<2>({10, 1 - eta, 0}, v, 1.0, never); };
    EXPECT_NEAR(time(1e-2), 9.858932640203, 1e-11);
    EXPECT_NEAR(time(1e-6), 9.998585786791, 1e-11);
    EXPECT_NEAR(time(1e-10), 9.999985857864, 1e-11);
    EXPECT_NEAR(time(1e-14), 9.9999998586, 1e-9); // what 1 - eta is rounded by
    EXPECT_EQ(time(-1e-10), never);
    // A discriminant of zero is an event or none, and a harmless one.
    for (const double t : {time(0), laws::meeting<3>({10, 1, 0}, v, 1.0, never)})
        EXPECT_TRUE(t == never || std::abs(t - 10) < 1e-7);
}

TEST(EdmdEvents, TouchingPairs) {
    const auto time = [](double x, double v) { return laws::meeting<2>({x, 0, 0}, {v, 0, 0}, 1.0, never); };
    EXPECT_EQ(time(1, -1), 0);
    EXPECT_EQ(time(1, 1), never);
    EXPECT_EQ(time(1 - 1e-15, -1), 0); // overlap by rounding
    EXPECT_EQ(time(1 - 1e-15, 1), never);
    EXPECT_EQ(time(2, 0), never);
}

TEST(EdmdEvents, WallTimes) {
    EXPECT_NEAR(fall(1, 0, -9.81), 0.451523640986, 1e-12);
    EXPECT_NEAR(fall(1, 3, -9.81), 0.851148455661, 1e-12);
    EXPECT_NEAR(fall(1, -3, -9.81), 0.239527660554, 1e-12);
    EXPECT_NEAR(fall(1, -5, 9.81), 0.273243353624, 1e-12);
    EXPECT_EQ(fall(1, -4, 9.81), never);
    EXPECT_NEAR(fall(0, 2, -9.81), 0.407747196738, 1e-12);
}

TEST(EdmdEvents, VibratingWall) {
    const double pi = std::numbers::pi;
    struct Row {
        double z, v, g, amplitude, omega, time, after;
    };
    // The particle is a point in the table: the wall stands one radius lower.
    for (const Row& r : {Row{1, 0, -1, 0.1, 10, 1.354338788432, 2.281949617564},
                         Row{0.3, 0, -1, 0.1, 10, 0.692739044945, 2.142662165644},
                         Row{0.2, -0.2, -1, 0.15, 4, 0.240409821490, 1.048649851938}}) {
        edmd::Setup s = wide(2);
        s.lower[1] = -0.5;
        s.gravity[1] = r.g;
        s.side[1][0].motion = {r.amplitude, r.omega / (2 * pi), 0};
        s.side[1][0].eps_n = 0.9;
        with_both(s, {at(0, {0, r.z, 0}, {0, r.v, 0})}, [&](edmd::Algorithm& run) {
            ASSERT_EQ(run.run(1), 1);
            EXPECT_NEAR(run.time(), r.time, 1e-10);
            EXPECT_NEAR(run.particles()[0].velocity[1], r.after, 1e-9);
        });
    }
    // It leaves the wall where it stands.
    EXPECT_NEAR(laws::oscillating_wall_time(0, 2, -1, {0.1, 10 / (2 * pi), 0}, 0, never), 3.950806240323,
                1e-10);
}

// Without gravity what has left the wall never meets it again, and that is found at once.
TEST(EdmdEvents, VibratingWallOutOfReach) {
    EXPECT_EQ(laws::oscillating_wall_time(1, 0.5, 0, {0.1, 1, 0}, 0, never), never);
    EXPECT_EQ(laws::oscillating_wall_time(1, 0, 0, {0.1, 1, 0}, 0, never), never);
    const double t = laws::oscillating_wall_time(1000, -1, 0, {0.1, 1, 0}, 0, never);
    EXPECT_NEAR(1000 - t, 0.1 * std::sin(2 * std::numbers::pi * t), 1e-9);
}

// The bouncing ball: without a rule the bounces accumulate at t = 20, and the run says so; with a contact
// time exactly 51 of them lose energy.
TEST(EdmdEvents, BouncingBall) {
    edmd::Setup s = wide(2);
    s.lower[1] = -0.5;
    s.gravity[1] = -1;
    s.side[1][0].eps_n = 0.9;
    const std::vector<edmd::Particle> ball = {at(0, {0, 0, 0}, {0, 1, 0})};
    with_both(s, ball, [](edmd::Algorithm& run) {
        try {
            run.run(1000000, 100);
            FAIL() << "the collapse was not seen";
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Exit::unstable);
            EXPECT_NEAR(run.time(), 20, 1e-9);
        }
    });
    s.contact_time = 0.01;
    with_both(s, ball, [](edmd::Algorithm& run) {
        run.run(2000);
        EXPECT_EQ(run.tally().wall_hits - run.tally().elastic, 51);
        // At the wall, right after a bounce.
        EXPECT_NEAR(run.particles()[0].velocity[1], 0.004638397687, 1e-9);
    });
}

TEST(EdmdEvents, NothingHappens) {
    edmd::Setup s = test::hard_gas(2, 0.1, 0.9, 16);
    with_both(s, {}, [](edmd::Algorithm& run) {
        EXPECT_EQ(run.run(10, 5), 0);
        EXPECT_EQ(run.time(), 5);
    });
    with_both(s, {at(0, {1, 1, 0}, {0, 0, 0}), at(1, {3, 3, 0}, {0, 0, 0})}, [](edmd::Algorithm& run) {
        EXPECT_EQ(run.run(10, 5), 0);
        EXPECT_EQ(run.time(), 5);
        EXPECT_EQ(run.run(10), 0); // no end, and no endless loop
    });
}

// A million times through the box, exactly: all numbers are dyadic.
TEST(EdmdEvents, WrapsExactly) {
    edmd::Setup s;
    s.dimension = 2;
    s.upper[0] = s.upper[1] = 8;
    edmd::Simulation run(s, {at(0, {1, 1, 0}, {1, -0.5, 0})}, simd::available_isas().back(), 1);
    run.run(1, 8e6 + 0.25);
    const edmd::Particle p = run.particles()[0];
    EXPECT_EQ(p.place[0], 1.25);
    EXPECT_EQ(p.image[0], 1000000);
    EXPECT_EQ(p.place[1], 0.875);
    EXPECT_EQ(p.image[1], -500000);
}

// Two alone in a periodic box meet again from the other side.
TEST(EdmdEvents, TheSamePairThroughTheBox) {
    edmd::Setup s;
    s.dimension = 2;
    s.upper[0] = s.upper[1] = 9;
    with_both(s, {at(0, {1, 4, 0}, {1, 0, 0}), at(1, {5, 4, 0}, {-1, 0, 0})}, [](edmd::Algorithm& run) {
        for (int k = 0; k < 40; ++k) {
            ASSERT_EQ(run.run(1, 1e6), 1);
            EXPECT_NEAR(run.time(), 1.5 + 3.5 * k, 1e-11);
        }
        EXPECT_GT(run.tally().smallest_gap, -1e-13);
    });
}

// A gas so thin that a particle often meets the same one again, by way of the box.
TEST(EdmdEvents, ThinGasInASmallBox) {
    edmd::Setup s;
    s.dimension = 3;
    s.upper[0] = s.upper[1] = s.upper[2] = 12;
    s.restitution.eps = 0.5;
    const auto particles = edmd::make_particles(s, {20}, 1.0);
    std::uint64_t hash = 0;
    with_both(s, particles, [&](edmd::Algorithm& run) {
        EXPECT_EQ(run.run(600), 600);
        EXPECT_GT(run.tally().smallest_gap, -1e-12);
        if (hash == 0) hash = run.log().hash();
        EXPECT_EQ(run.log().hash(), hash);
    });
}

// A field along a periodic direction: ever faster through the box, 50 000 times.
TEST(EdmdEvents, FallsThroughThePeriodicBox) {
    edmd::Setup s;
    s.dimension = 2;
    s.upper[0] = s.upper[1] = 8;
    s.gravity[1] = -1;
    edmd::Simulation run(s, {at(0, {1, 1, 0}, {0, 0, 0})}, simd::available_isas().back(), 1);
    run.run(1, 894.5);
    const edmd::Particle p = run.particles()[0];
    EXPECT_NEAR(p.place[1] + 8 * static_cast<double>(p.image[1]), 1 - 0.5 * 894.5 * 894.5, 1e-6);
    EXPECT_LT(p.image[1], -49000);
}

// No restitution at all: pairs leave side by side and do not collide forever.
TEST(EdmdEvents, NoRestitution) {
    edmd::Setup s = test::hard_gas(2, 0.2, 0, 36);
    const auto particles = edmd::make_particles(s, {36}, 1.0);
    with_both(s, particles, [](edmd::Algorithm& run) {
        run.run(40);
        EXPECT_EQ(run.tally().collisions, 40);
        EXPECT_GT(run.time(), 0.5);
    });
}

TEST(EdmdEvents, SimultaneousContactsConserve) {
    edmd::Setup s = wide(2);
    const double h = std::sqrt(0.75);
    with_both(s, {at(0, {-2, 0, 0}, {1, 0, 0}), at(1, {h - 0.5, 0.5, 0}, {}), at(2, {h - 0.5, -0.5, 0}, {})},
              [](edmd::Algorithm& run) {
                  run.run(20, 10);
                  const auto after = run.particles();
                  double energy = 0, px = 0, py = 0;
                  for (const edmd::Particle& p : after) {
                      energy += 0.5 * (p.velocity[0] * p.velocity[0] + p.velocity[1] * p.velocity[1]);
                      px += p.velocity[0];
                      py += p.velocity[1];
                  }
                  EXPECT_NEAR(energy, 0.5, 1e-14);
                  EXPECT_NEAR(px, 1, 1e-14);
                  EXPECT_NEAR(py, 0, 1e-14);
              });
}

// Bernu and Mazighi: n points that fly towards a wall collapse below eps = tan^2(pi/4 (1 - 1/n)).
TEST(EdmdEvents, CollapseInOneDimension) {
    const int numbers[] = {2, 3, 4}, finite[] = {21, 39, 76};
    for (int k = 0; k < 3; ++k) {
        const int n = numbers[k];
        const double root = std::tan(std::numbers::pi / 4 * (1 - 1.0 / n));
        for (const double part : {0.97, 1.03}) {
            edmd::Setup s = wide(2);
            // Points of the specification at 1 .. n, spheres of a small radius here.
            const double radius = 1e-3;
            s.classes[0].radius = radius;
            s.lower[0] = -radius;
            s.restitution.eps = s.side[0][0].eps_n = part * root * root;
            std::vector<edmd::Particle> particles;
            for (int p = 0; p < n; ++p)
                particles.push_back(
                    at(static_cast<std::uint32_t>(p), {p + 1 + 2 * radius * p, 0, 0}, {-1, 0, 0}));
            edmd::SimpleAlgorithm run(s, particles);
            const std::int64_t events = run.run(501, 1e6);
            if (part > 1)
                EXPECT_EQ(events, finite[k]) << n;
            else
                EXPECT_EQ(events, 501) << n;
        }
    }
}
