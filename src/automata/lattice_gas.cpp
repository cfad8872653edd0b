// The lattice gas of a scene: obstacles, and particles in equilibrium.
#include "automata/equilibrium.hpp"
#include "automata/gas.hpp"
#include "core/error.hpp"

#include <cmath>

namespace sandlane::automata {

namespace {

// Of the random numbers of the start; those of steps are below 1024.
constexpr std::uint32_t start_stream = 1 << 20;

void put_obstacles(GasLattice& lattice, const std::vector<scene::Obstacle>& obstacles, bool square) {
    const double row_height = square ? 1 : std::sqrt(0.75);
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x)
            for (const scene::Obstacle& o : obstacles) {
                const double dx = x + (square ? 0 : 0.5 * (y & 1)) - o.centre.x;
                const double dy = (y - o.centre.y) * row_height;
                const bool inside = o.kind == scene::ObstacleKind::disc
                                        ? dx * dx + dy * dy <= o.radius * o.radius
                                        : std::abs(dx) <= o.size.x / 2 && std::abs(dy) <= o.size.y / 2;
                if (inside) lattice.make_solid(x, y);
            }
}

void fill(GasLattice& lattice, const GasRules& rules, const std::array<double, 7>& occupation) {
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x) {
            if (lattice.is_solid(x, y)) continue;
            for (int i = 0; i < rules.planes(); ++i) {
                const PhiloxCounter r = philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                                static_cast<std::uint32_t>(i), start_stream},
                                               rules.seed);
                if (r[0] * 0x1p-32 < occupation[static_cast<std::size_t>(i)]) lattice.set(i, x, y, true);
            }
        }
}

} // namespace

std::unique_ptr<Model> make_lattice_gas(const scene::Scene& scene, const Means& means) {
    const scene::LatticeGas& s = scene.lattice_gas;
    GasRules rules;
    constexpr GasModel models[] = {GasModel::hpp, GasModel::fhp1, GasModel::fhp2, GasModel::fhp3};
    rules.model = models[static_cast<int>(s.rule)];
    rules.alternating = s.chirality == scene::GasChirality::alternating;
    rules.closed = s.sides != scene::GasSides::periodic;
    rules.gravity = sixteenths(s.drive);
    rules.roughness = s.sides == scene::GasSides::no_slip ? 1U << simd::probability_bits : 0;
    const auto seed = static_cast<std::uint64_t>(scene.seed);
    rules.seed = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
    GasLattice lattice(static_cast<std::int32_t>(s.columns), static_cast<std::int32_t>(s.rows));
    put_obstacles(lattice, scene.obstacles, rules.directions() == 4);
    const double particles = s.density * rules.planes();
    const auto occupied =
        fermi_dirac(particles, particles * s.velocity.x, particles * s.velocity.y, rules.planes());
    if (std::isnan(occupied[0]))
        fail(Exit::invalid_input,
             "lattice_gas.velocity: {} at a density of {} is more than the particles of one site can have; "
             "take a lower velocity, or a density nearer to 0.5",
             std::hypot(s.velocity.x, s.velocity.y), s.density);
    fill(lattice, rules, occupied);
    return std::make_unique<GasFlow>(std::move(lattice), rules, means, s.active_tiles);
}

} // namespace sandlane::automata
