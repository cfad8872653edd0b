// What a scene needs, and the coefficients of its pairs of materials.
#include "md/law_traits.hpp"
#include "md/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::md {

using scene::Scene;

std::vector<double> pair_table(const Scene& scene) {
    const std::size_t n = scene.materials.size();
    std::vector<double> table(n * n * laws::pair_coefficients);
    with_traits(scene, [&](auto traits) {
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b) {
                const scene::Material &p = scene.materials[a], &q = scene.materials[b];
                double* c = table.data() + (a * n + b) * laws::pair_coefficients;
                const laws::PairCoefficients<double> mixed{
                    traits.elastic(p, q),
                    traits.dissipative(p, q),
                    std::min(p.tangential_damping, q.tangential_damping),
                    std::min(p.friction, q.friction),
                    std::min(p.tangential_stiffness, q.tangential_stiffness),
                    std::min(p.cohesion, q.cohesion),
                    std::min(p.rolling_friction, q.rolling_friction),
                    std::min(p.rolling_damping, q.rolling_damping),
                    std::min(p.rolling_stiffness, q.rolling_stiffness),
                    scene.md.cut ? 0.0 : -std::numeric_limits<double>::infinity(),
                    scene.md.lever_arm == scene::LeverArm::plane ? 1.0 : 0.0};
                const double values[] = {mixed.elastic,
                                         mixed.dissipative,
                                         mixed.tangential_damping,
                                         mixed.friction,
                                         mixed.tangential_stiffness,
                                         mixed.cohesion,
                                         mixed.rolling_friction,
                                         mixed.rolling_damping,
                                         mixed.rolling_stiffness,
                                         mixed.least,
                                         mixed.lever};
                static_assert(std::size(values) == laws::pair_coefficients);
                std::copy_n(values, laws::pair_coefficients, c);
                for (const scene::MaterialPair& pair : scene.pairs) {
                    const bool here = (pair.first == p.name && pair.second == q.name) ||
                                      (pair.first == q.name && pair.second == p.name);
                    if (!here) continue;
                    const double given[] = {
                        traits.elastic(pair),  traits.dissipative(pair),  pair.tangential_damping,
                        pair.friction,         pair.tangential_stiffness, pair.cohesion,
                        pair.rolling_friction, pair.rolling_damping,      pair.rolling_stiffness};
                    for (std::size_t k = 0; k < std::size(given); ++k)
                        if (given[k] >= 0) c[k] = given[k];
                }
                if (scene.md.tangential == scene::TangentialLaw::none)
                    c[2] = c[3] = c[4] = c[6] = c[7] = c[8] = 0;
            }
    });
    return table;
}

namespace {

// Area or volume of a grain and of the domain.
double content(const Scene& scene, double radius) {
    const double area = std::numbers::pi * radius * radius;
    return scene.domain.dimension == 3 ? 4.0 / 3.0 * area * radius : area;
}
double content(const Scene& scene) {
    const Vec size = scene.domain.upper - scene.domain.lower;
    return size.x * size.y * (scene.domain.dimension == 3 ? size.z : 1.0);
}

// Of radii; one, where several would cost more than they save. Grains are taken to fill half of the room that
// they are in.
std::vector<scene::SizeClass> useful_classes(const Scene& scene, const Needs& needs,
                                             const std::vector<scene::GrainState>& grains) {
    std::vector<scene::SizeClass> classes =
        scene::size_classes(grains.size(), [&](std::size_t i) { return grains[i].radius; });
    if (classes.size() < 2) return classes;
    const double room = content(scene) * std::min(1.0, 2 * needs.packing_fraction);
    const double cell = std::pow(2 * needs.radius_max, static_cast<double>(scene.domain.dimension));
    const double per_cell = static_cast<double>(grains.size()) * std::min(1.0, cell / room);
    if (per_cell > scene::grains_per_class * static_cast<double>(classes.size())) return classes;
    return {{needs.radius_max, grains.size()}};
}

} // namespace

Needs analyse(const Scene& scene, const std::vector<scene::GrainState>& grains) {
    Needs needs;
    needs.radius_min = needs.mass_min = std::numeric_limits<double>::infinity();
    double covered = 0;
    for (const scene::GrainState& g : grains) {
        const bool later = g.insert_at > -std::numeric_limits<double>::infinity();
        (later ? needs.poured : needs.grains) += 1;
        needs.radius_min = std::min(needs.radius_min, g.radius);
        needs.radius_max = std::max(needs.radius_max, g.radius);
        needs.mass_min = std::min(needs.mass_min, g.mass);
        needs.mass_max = std::max(needs.mass_max, g.mass);
        if (g.material != grains.front().material) needs.many_materials = true;
        needs.spinning = needs.spinning || g.omega != 0 || norm(g.angular_velocity) > 0;
        covered += content(scene, g.radius);
    }
    if (grains.empty()) needs.radius_min = needs.radius_max = needs.mass_min = needs.mass_max = 0;
    needs.many_radii = needs.radius_min != needs.radius_max;
    const std::vector<double> table = pair_table(scene);
    if (scene.md.tangential != scene::TangentialLaw::none)
        for (std::size_t p = 0; p < table.size(); p += laws::pair_coefficients) {
            const laws::PairCoefficients<double> c = laws::coefficients_from<double>(table.data() + p);
            const bool surfaces = c.friction > 0 && (c.tangential_damping > 0 || c.tangential_stiffness > 0);
            needs.friction = needs.friction || surfaces;
            const bool rolling = c.rolling_friction > 0 && (c.rolling_damping > 0 || c.rolling_stiffness > 0);
            if (rolling || (surfaces && c.lever > 0))
                needs.couples = std::max(needs.couples, laws::Couples::damped);
            if (rolling && c.rolling_stiffness > 0) needs.couples = laws::Couples::sprung;
        }
    needs.memory = needs.friction && has_spring(scene.md.tangential);
    needs.memory = needs.memory || needs.couples == laws::Couples::sprung;
    needs.walls = !scene.walls.empty();
    for (const scene::Wall& w : scene.walls) needs.moving_walls = needs.moving_walls || !w.motion.empty();
    needs.gravity = norm(scene.domain.gravity) > 0;
    needs.packing_fraction = covered / content(scene);
    needs.sizes = useful_classes(scene, needs, grains);
    return needs;
}

} // namespace sandlane::md
