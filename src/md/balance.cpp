// The balance of energy and momentum that a run keeps of itself, where its scene watches them
// (docs/physics.md 14). Steps cost one pass over the forces of each tile while they are in the cache.
#include "md/law_traits.hpp"
#include "md/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::md {

namespace {

// Whether no contact takes energy.
bool without_loss(const scene::Scene& scene, const Needs& needs) {
    if (needs.friction || needs.couples != laws::Couples::none) return false;
    const bool hysteresis = scene.md.normal == scene::NormalLaw::walton_braun;
    const std::vector<double> table = pair_table(scene);
    for (std::size_t p = 0; p < table.size(); p += laws::pair_coefficients) {
        const Coefficients c = laws::coefficients_from<double>(table.data() + p);
        if (c.dissipative != (hysteresis ? c.elastic : 0)) return false;
    }
    return true;
}

bool watches(const scene::Watch& watch) {
    return watch.overlap.asked || watch.energy.asked || watch.momentum.asked || watch.step.asked;
}

} // namespace

double Simulation::balance_kind() const {
    if (!watches(scene_.watch)) return 0;
    const bool lossless = without_loss(scene_, needs_);
    const bool sums = scene_.watch.momentum.asked || (scene_.watch.energy.asked && !lossless);
    return 1 + (lossless ? 2 : 0) + (sums ? 4 : 0);
}

void Simulation::begin_balance() {
    balance_ = {};
    balance_.kind = balance_kind();
    sums_ = balance_.kind >= 4;
    if (balance_.kind == 0) return;
    const Observables now = observe();
    balance_.energy = balanced_energy(now);
    balance_.momentum = now.momentum;
    for (std::size_t i = 0; i < state_.size(); ++i) balance_.mass += state_.mass[i];
    // Smaller ones are looked at with the rows of the log only.
    if (scene_.watch.overlap.asked) balance_.examined = 1e-3 * needs_.radius_min;
}

// Sums over the grains of a tile of what stands in its forces now: those between grains, or all, with their
// power. Without walls both are the same.
void Simulation::sum_forces(std::size_t tile, const double* force, bool all) {
    if (!all && !needs_.walls) return;
    const std::size_t begin = tile * tile_size, end = std::min(state_.size(), begin + tile_size);
    const std::size_t stride = state_.force_stride();
    double sum[3] = {};
    for (std::size_t i = 0; i < end - begin; ++i)
        for (int d = 0; d < plan_.dimension; ++d) sum[d] += force[i * stride + static_cast<std::size_t>(d)];
    TileSums& sums = tile_sums_[tile];
    if (!all || !needs_.walls) sums.between = {sum[0], sum[1], sum[2]};
    if (!all) return;
    sums.all = {sum[0], sum[1], sum[2]};
    sums.power = 0;
    for (std::size_t i = begin; i < end; ++i)
        sums.power += power_of(i, force + (i - begin) * stride) / plan_.dt;
}

// W times dt, of the forces and torques on a grain.
double Simulation::power_of(std::size_t i, const double* force) const {
    const int dimension = plan_.dimension;
    const bool couples = plan_.rotation == simd::Rotation::couples;
    const double* record = state_.record_of(i);
    double power = 0;
    for (int d = 0; d < dimension; ++d) power += force[d] * record[dimension + d];
    if (!state_.turns()) return power;
    if (dimension == 2) {
        power += force[2] * record[simd::Record<2>::spin];
        if (couples) power += force[3] * record[simd::Record<2>::spin] * state_.inverse_radius(i);
        return power;
    }
    const double* spin = state_.spin.data() + i * simd::spin_fields;
    for (int d = 0; d < 3; ++d)
        power += (force[4 + d] * state_.radius(i) + (couples ? force[8 + d] : 0.0)) * spin[d];
    return power;
}

// Trapezoidal sums, as for the work of walls.
void Simulation::add_balance() {
    Balance& b = balance_;
    double power = 0;
    Vec walls;
    for (const TileSums& t : tile_sums_) {
        power += t.power;
        walls = walls + (t.all - t.between);
    }
    const double dt = plan_.dt;
    const Vec gravity = linear_gravity(scene_);
    b.work += 0.5 * dt * (b.power + power);
    b.wall_impulse = b.wall_impulse + (0.5 * dt) * (b.wall_force + walls);
    b.brought = b.brought + (b.mass * dt) * gravity;
    b.exchanged += dt * (norm(walls) + b.mass * norm(gravity));
    b.power = power;
    b.wall_force = walls;
}

// What only the work of forces changes; without loss, what nothing changes.
double Simulation::balanced_energy(const Observables& now) const {
    const bool lossless = static_cast<int>(balance_.kind) & 2;
    return lossless ? now.energy() - added_energy_ - wall_work_ - shear_work_
                    : now.kinetic + now.rotational + now.potential - added_energy_;
}

double Simulation::energy_residual(const Observables& now) const {
    const bool lossless = static_cast<int>(balance_.kind) & 2;
    const double scale =
        balance_.most_energy + std::abs(dissipated(now)) + std::abs(wall_work_) + std::abs(shear_work_);
    const double known = lossless ? 0.0 : balance_.work + balance_.crossing;
    const double residual = balanced_energy(now) - balance_.energy - known;
    return scale > 0 ? std::abs(residual) / scale : 0;
}

double Simulation::momentum_error(const Observables& now) const {
    const double scale = balance_.most_momentum + balance_.exchanged;
    const Vec known = balance_.momentum + balance_.brought + balance_.wall_impulse;
    return scale > 0 ? norm(now.momentum - known) / scale : 0;
}

} // namespace sandlane::md
