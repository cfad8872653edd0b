// What one key of a gas cannot know alone.
#include "laws/collision.hpp"
#include "scene/schema.hpp"
#include "scene/space.hpp"
#include "scene/validator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sandlane::scene {

namespace {

constexpr const char* side_names[] = {"-x", "+x", "-y", "+y", "-z", "+z"};

struct GasValidator : Validator {
    // Of event-driven dynamics.
    void check_shear_without_walls() const {
        const Domain& d = scene.domain;
        if (d.shear_rate == 0) return;
        for (const AxisOfSpace& axis : axes(d.dimension))
            if (!d.periodic[axis.index])
                reject(
                    "domain.shear_rate: {} needs a domain that is periodic in all directions; add \"{}\" to "
                    "domain.periodic",
                    d.shear_rate, axis.name);
        if (d.gravity.x != 0 || d.gravity.y != 0 || (d.dimension == 3 && d.gravity.z != 0))
            reject("domain.shear_rate: {} and gravity: a sheared box would fall; leave out one",
                   d.shear_rate);
        if (scene.edmd.structure_every > 0)
            reject(
                "edmd.structure_every: waves and clusters across a sheared side are not followed; leave it "
                "out, or domain.shear_rate");
    }
    void check_sheared_gas() const {
        check_shear();
        if (scene.domain.shear_rate == 0) return;
        if (scene.dsmc.scheme == CollisionScheme::maxwell)
            reject("dsmc.scheme: the rate of Maxwell molecules is that of a gas at rest; take another "
                   "scheme, or leave out domain.shear_rate");
        if (scene.dsmc.structure_every > 0)
            reject("dsmc.structure_every: waves and clusters across a sheared side are not followed; leave "
                   "it out, or domain.shear_rate");
        if (scene.dsmc.adaptive)
            reject(
                "dsmc.adaptive: a sheared gas does not cool down; leave out adaptive or domain.shear_rate");
    }

    // most: largest packing fraction that the method can do, and why.
    void check_gas(double most, const char* why) const {
        const Gas& gas = scene.gas;
        if (gas.particles == 0) reject("gas: is missing; write [gas] with particles and temperature");
        const double volume = content(scene.domain.upper - scene.domain.lower, scene.domain.dimension);
        double packing = static_cast<double>(gas.particles) * gas.weight *
                         grain_content(0.5 * gas.diameter, scene.domain.dimension) / volume;
        for (const Species& more : scene.species)
            packing += static_cast<double>(more.particles) * gas.weight *
                       grain_content(0.5 * more.diameter, scene.domain.dimension) / volume;
        if (packing > most)
            reject(
                "gas: the packing fraction is {:.4g}; allowed: up to {}, {}. Take fewer particles, a smaller "
                "weight or diameter, or a larger domain",
                packing, most, why);
        if (gas.model == RestitutionModel::viscoelastic && scene.gas.dissipation == 0)
            reject("gas.dissipation: is missing; model = \"viscoelastic\" needs it, above 0");
        if (gas.tangential_restitution == 1 && gas.friction > 0)
            reject("gas.friction = {}: smooth particles have none; give tangential_restitution below 1",
                   gas.friction);
        if (gas.tangential_restitution == 1 && gas.spin_temperature > 0)
            reject("gas.spin_temperature = {}: smooth particles do not spin; give tangential_restitution "
                   "below 1",
                   gas.spin_temperature);
        if (scene.domain.dimension == 3 && (gas.body == GasBody::disc || gas.body == GasBody::ring))
            reject(
                "gas.body: discs and rings are for scenes in the plane; use \"sphere\" or \"hollow-sphere\"");
    }

    void check_side(std::size_t n) const {
        const GasSide& side = scene.sides[n];
        const auto axis = static_cast<std::size_t>(side.side) / 2;
        const char* name = side_names[static_cast<std::size_t>(side.side)];
        if (axis >= static_cast<std::size_t>(scene.domain.dimension))
            reject("sides[{}].side = \"{}\": a plane has no such side", n, name);
        if (scene.domain.periodic[axis])
            reject("sides[{}].side = \"{}\": this direction is periodic; take it out of domain.periodic", n,
                   name);
        for (std::size_t other = 0; other < n; ++other)
            if (scene.sides[other].side == side.side)
                reject("sides[{}].side = \"{}\": sides[{}] is the same side", n, name, other);
        if (side.kind == SideKind::heated && !(side.temperature > 0))
            reject("sides[{}].temperature = {}: a heated wall needs a temperature above 0 J", n,
                   side.temperature);
        if (side.kind == SideKind::reflecting && side.temperature > 0)
            reject("sides[{}].temperature = {}: a reflecting wall has none; write kind = \"heated\"", n,
                   side.temperature);
        const auto unused = [&](bool given, const char* key, const char* why) {
            if (given) reject("sides[{}].{}: has no effect here, {}; leave it out", n, key, why);
        };
        const bool heated = side.kind == SideKind::heated, smooth = scene.gas.tangential_restitution == 1;
        unused(heated && side.restitution != 1, "restitution", "the wall is heated");
        unused(heated && side.tangential_restitution != 1, "tangential_restitution", "the wall is heated");
        unused(!heated && side.accommodation != 1, "accommodation", "the wall is not heated");
        unused(!heated && smooth && side.tangential_restitution != 1, "tangential_restitution",
               "the particles are smooth");
        unused(!heated && smooth && norm(side.velocity) > 0, "velocity",
               "a reflecting wall does not drag smooth particles");
        const AxisOfSpace& direction = space_axes[axis];
        if (side.velocity.*direction.component != 0)
            reject("sides[{}].velocity: its {} component must be 0; a wall moves along itself", n,
                   direction.name);
        unused(side.amplitude == 0 && side.frequency == 0 && side.phase != 0, "phase",
               "the wall does not oscillate");
        if ((side.amplitude > 0) != (side.frequency > 0))
            reject("sides[{}]: an oscillation needs both amplitude and frequency above 0", n);
        const double length =
            scene.domain.upper.*direction.component - scene.domain.lower.*direction.component;
        if (side.amplitude > 0.25 * length)
            reject("sides[{}].amplitude = {} m: allowed: up to a quarter of the domain, {} m", n,
                   side.amplitude, 0.25 * length);
    }

    void check_piston(std::size_t n) const {
        const GasSide& side = scene.sides[n];
        if (side.speed == 0) return;
        if (side.amplitude > 0)
            reject(
                "sides[{}].speed = {} m/s: a side that oscillates does not move on as well; leave out one of "
                "them",
                n, side.speed);
        if (scene.edmd.duration == 0)
            reject("sides[{}].speed = {} m/s: a piston needs an end by time; give edmd.duration", n,
                   side.speed);
        const AxisOfSpace& axis = space_axes[static_cast<std::size_t>(side.side) / 2];
        const double before = scene.domain.upper.*axis.component - scene.domain.lower.*axis.component;
        double after = before, longest = scene.gas.diameter, particles = 0;
        for (const GasSide& other : scene.sides)
            if (static_cast<std::size_t>(other.side) / 2 == axis.index)
                after -= other.speed * scene.edmd.duration;
        particles = static_cast<double>(scene.gas.particles) *
                    grain_content(0.5 * scene.gas.diameter, scene.domain.dimension);
        for (const Species& more : scene.species) {
            longest = std::max(longest, more.diameter);
            particles += static_cast<double>(more.particles) *
                         grain_content(0.5 * more.diameter, scene.domain.dimension);
        }
        const double volume =
            content(scene.domain.upper - scene.domain.lower, scene.domain.dimension) * after / before;
        const double most = scene.domain.dimension == 3 ? 0.7405 : 0.9069;
        if (!(after > longest) || particles > most * volume)
            reject("sides[{}].speed = {} m/s: at the end the gas has {:.4g} m of {:.4g} m left; allowed: "
                   "more than a diameter, and a packing fraction up to {}. Take a slower piston or a "
                   "shorter edmd.duration",
                   n, side.speed, after, before, most);
    }

    void check_curved(std::size_t n) const {
        const CurvedWall& wall = scene.curved_walls[n];
        const bool cylinder = wall.shape == CurvedShape::cylinder, heated = wall.kind == SideKind::heated;
        if (cylinder && scene.domain.dimension == 2)
            reject("curved_walls[{}].shape: a plane has no cylinders; \"sphere\" is a circle there", n);
        for (const AxisOfSpace& axis : axes(scene.domain.dimension)) {
            if (cylinder && axis.index == static_cast<std::size_t>(wall.axis)) continue;
            if (scene.domain.periodic[axis.index])
                reject("curved_walls[{}]: the domain is periodic in {}; take it out of domain.periodic", n,
                       axis.name);
            const double at = wall.center.*axis.component, lower = scene.domain.lower.*axis.component,
                         upper = scene.domain.upper.*axis.component;
            if (at - wall.radius < lower - 1e-9 * wall.radius ||
                at + wall.radius > upper + 1e-9 * wall.radius)
                reject(
                    "curved_walls[{}]: reaches from {} to {} m in {}; allowed: within the domain, {} to {} m",
                    n, at - wall.radius, at + wall.radius, axis.name, lower, upper);
        }
        double longest = scene.gas.diameter;
        for (const Species& more : scene.species) longest = std::max(longest, more.diameter);
        if (wall.gas == CurvedGas::inside && !(2 * wall.radius > longest))
            reject("curved_walls[{}].radius = {} m: particles of diameter {} m do not fit into it", n,
                   wall.radius, longest);
        if (heated != (wall.temperature > 0))
            reject("curved_walls[{}].temperature = {}: a heated wall needs a temperature above 0 J, a "
                   "reflecting one has none",
                   n, wall.temperature);
        const auto unused = [&](bool given, const char* key, const char* why) {
            if (given) reject("curved_walls[{}].{}: has no effect here, {}; leave it out", n, key, why);
        };
        unused(heated && wall.restitution != 1, "restitution", "the wall is heated");
        unused(heated && wall.tangential_restitution != 1, "tangential_restitution", "the wall is heated");
        unused(!heated && wall.accommodation != 1, "accommodation", "the wall is not heated");
        unused(!heated && scene.gas.tangential_restitution == 1 && wall.tangential_restitution != 1,
               "tangential_restitution", "the particles are smooth");
    }

    void check_dsmc() const {
        const Dsmc& d = scene.dsmc;
        for (std::size_t n = 0; n < scene.sides.size(); ++n)
            if (scene.sides[n].speed != 0)
                reject("sides[{}].speed = {} m/s: pistons are known to method = \"edmd\" only; use 0", n,
                       scene.sides[n].speed);
        double cells = 1;
        for (const AxisOfSpace& axis : axes(scene.domain.dimension))
            cells *= static_cast<double>(std::max<std::int64_t>(1, d.cells[axis.index]));
        if (cells > 1e9) reject("dsmc.cells: {:.4g} cells; allowed: up to 1e9", cells);
        if (static_cast<std::int64_t>(d.profile_axis) >= scene.domain.dimension)
            reject("dsmc.profile_axis: a plane has no z axis");
        if (d.scheme == CollisionScheme::maxwell && !scene.species.empty())
            reject("dsmc.scheme = \"maxwell\": knows one kind of particles; leave out [[species]]");
        if (d.near_partners > 1 && d.scheme != CollisionScheme::no_time_counter)
            reject("dsmc.near_partners = {}: goes with scheme = \"no-time-counter\"; use 1", d.near_partners);
        if (d.adaptive && d.heating > 0)
            reject("dsmc.adaptive: a heated gas does not cool down; leave out adaptive or heating");
    }

    void check_mixture(std::size_t most_kinds) const {
        if (scene.species.size() + 1 > most_kinds)
            reject("species: {} of them; allowed: up to {} with this method", scene.species.size(),
                   most_kinds - 1);
        double count = static_cast<double>(scene.gas.particles);
        for (const Species& more : scene.species) count += static_cast<double>(more.particles);
        if (count > 2e9) reject("gas.particles: {:.4g} with all species; allowed: up to 2e9", count);
        check_pairs();
    }

    void check_pairs() const {
        const auto kinds = static_cast<std::int64_t>(scene.species.size()) + 1;
        for (std::size_t n = 0; n < scene.gas_pairs.size(); ++n) {
            const GasPair& pair = scene.gas_pairs[n];
            for (const std::int64_t kind : pair.between)
                if (kind >= kinds)
                    reject("gas_pairs[{}].between: kind {}; allowed: 0 to {}, 0 is [gas] and the others are "
                           "[[species]]",
                           n, kind, kinds - 1);
            for (std::size_t other = 0; other < n; ++other) {
                const auto& before = scene.gas_pairs[other].between;
                if (before == pair.between || before == std::array{pair.between[1], pair.between[0]})
                    reject("gas_pairs[{}].between: gas_pairs[{}] is the same pair", n, other);
            }
            const bool viscoelastic = scene.gas.model == RestitutionModel::viscoelastic;
            if (viscoelastic && pair.restitution != 1)
                reject("gas_pairs[{}].restitution: has no effect here, the gas is viscoelastic; give "
                       "dissipation",
                       n);
            if (!viscoelastic && pair.dissipation != 0)
                reject("gas_pairs[{}].dissipation: has no effect here, the gas is not viscoelastic; give "
                       "restitution",
                       n);
        }
        constexpr std::int64_t most = 1000; // of which all pairs are kept
        if (kinds > most && !scene.gas_pairs.empty())
            reject("gas_pairs: go with up to {} kinds of particles; there are {}", most, kinds);
        if (kinds == 1 && !scene.gas_pairs.empty())
            reject("gas_pairs: there is one kind of particles; give gas.restitution, or gas.dissipation, or "
                   "[[species]]");
    }

    void check_edmd() const {
        const Edmd& e = scene.edmd;
        if (scene.gas.weight != 1)
            reject("gas.weight = {}: hard particles stand for themselves; use 1", scene.gas.weight);
        double count = static_cast<double>(scene.gas.particles), shortest = scene.gas.diameter,
               longest = scene.gas.diameter;
        for (const Species& more : scene.species) {
            count += static_cast<double>(more.particles);
            shortest = std::min(shortest, more.diameter);
            longest = std::max(longest, more.diameter);
        }
        if (count > 1e9) reject("gas.particles: {:.4g} with all species; allowed: up to 1e9", count);
        if (longest > 100 * shortest)
            reject("species.diameter: {} m and {} m; allowed: a ratio up to 100", shortest, longest);
        for (const AxisOfSpace& axis : axes(scene.domain.dimension)) {
            const double length = scene.domain.upper.*axis.component - scene.domain.lower.*axis.component;
            if (longest > length || (!scene.domain.periodic[axis.index] && longest == length))
                reject("gas.diameter: particles of {} m do not fit into the domain, {} m in {}", longest,
                       length, axis.name);
            if (scene.domain.periodic[axis.index] && 2 * longest > length)
                reject("domain: is {} m long in {}; allowed: at least two diameters, {} m, where it is "
                       "periodic, so that no particle meets itself or another one twice",
                       length, axis.name, 2 * longest);
            if (e.cell_edge > length)
                reject("edmd.cell_edge = {} m: allowed: up to the length of the domain, {} m", e.cell_edge,
                       length);
        }
        for (std::size_t n = 0; n < scene.sides.size(); ++n) check_piston(n);
        if (scene.curved_walls.size() > 200)
            reject("curved_walls: {} of them; allowed: up to 200", scene.curved_walls.size());
        for (std::size_t n = 0; n < scene.curved_walls.size(); ++n) check_curved(n);
        if (e.start != EventStart::automatic && e.start != EventStart::random && !scene.curved_walls.empty())
            reject("edmd.start: between curved walls particles are placed at random; use \"auto\" or "
                   "\"random\"");
        if (e.start != EventStart::growth && e.growth_rate != 0.05)
            reject("edmd.growth_rate = {}: has no effect here; give start = \"growth\"", e.growth_rate);
        if (e.heating == 0 && e.heating_interval > 0)
            reject("edmd.heating_interval = {}: has no effect here; give edmd.heating", e.heating_interval);
        if (e.duration == 0 && e.events == 0)
            reject("edmd: says no end; give duration, events or both above 0");
        if (static_cast<std::int64_t>(e.profile_axis) >= scene.domain.dimension)
            reject("edmd.profile_axis: a plane has no z axis");
    }
};

} // namespace

void validate_edmd(const Scene& scene, const std::string& file) {
    const GasValidator v{{scene, file}};
    v.check_domain();
    v.check_shear_without_walls();
    v.check_gas(scene.domain.dimension == 3 ? 0.7405 : 0.9069, "the closest packing");
    for (std::size_t n = 0; n < scene.sides.size(); ++n) v.check_side(n);
    v.check_mixture(65001);
    v.check_edmd();
    check_watch(scene, file);
}

void validate_dsmc(const Scene& scene, const std::string& file) {
    const GasValidator v{{scene, file}};
    v.check_domain();
    // Beyond freezing there is no fluid that the contact values were made for.
    v.check_gas(laws::freezing_fraction[scene.domain.dimension - 2], "where the fluid freezes");
    for (std::size_t n = 0; n < scene.sides.size(); ++n) v.check_side(n);
    v.check_sheared_gas();
    v.check_mixture(16);
    v.check_dsmc();
    check_watch(scene, file);
}

} // namespace sandlane::scene
