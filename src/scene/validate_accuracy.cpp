// What md.accuracy and [watch] do not go together with.
#include "scene/schema.hpp"
#include "scene/space.hpp"
#include "scene/validator.hpp"

#include <cmath>

namespace sandlane::scene {

// What accuracy chooses must not be given.
void check_accuracy(const Scene& scene, const std::string& file) {
    const Validator v{scene, file};
    const Md& m = scene.md;
    if (m.accuracy == 0) return;
    if (m.accuracy < 1e-8)
        v.reject("md.accuracy: {} is out of range; allowed: 1e-08 to 0.1, or 0: not asked for", m.accuracy);
    if (m.dt > 0)
        v.reject("md.dt: {} s contradicts md.accuracy = {}, which chooses the time step; leave out one of "
                 "them",
                 m.dt, m.accuracy);
    if (m.integrator != Integrator::automatic)
        v.reject("md.integrator: is given, but md.accuracy = {} chooses it; leave out one of them, or write "
                 "\"auto\"",
                 m.accuracy);
    if (m.adaptive_dt)
        v.reject("md.adaptive_dt: true contradicts md.accuracy = {}, which chooses one time step for the "
                 "run; leave out one of them",
                 m.accuracy);
}

namespace {

// Whether nothing but walls changes the energy of a gas.
bool keeps_energy(const Scene& scene) {
    const Gas& g = scene.gas;
    const bool elastic = g.model == RestitutionModel::constant && g.restitution == 1 &&
                         std::abs(g.tangential_restitution) == 1 && g.friction == 0;
    const double heating = scene.method == Engine::edmd ? scene.edmd.heating : scene.dsmc.heating;
    return elastic && scene.gas_pairs.empty() && heating == 0 && norm(scene.domain.gravity) == 0 &&
           scene.domain.shear_rate == 0;
}

bool keeps_momentum(const Scene& scene) {
    const double heating = scene.method == Engine::edmd ? scene.edmd.heating : scene.dsmc.heating;
    bool walls = !scene.curved_walls.empty();
    for (const AxisOfSpace& axis : axes(scene.domain.dimension))
        walls = walls || !scene.domain.periodic[axis.index];
    return !walls && heating == 0 && norm(scene.domain.gravity) == 0 && scene.domain.shear_rate == 0;
}

} // namespace

void check_watch(const Scene& scene, const std::string& file) {
    const Validator v{scene, file};
    const Watch& w = scene.watch;
    const bool gas = scene.method != Engine::md;
    if (gas && w.step.asked)
        v.reject("watch.step_error: contacts of hard particles take no steps; leave it out");
    if (scene.method == Engine::dsmc && w.overlap.asked)
        v.reject("watch.largest_overlap: particles of direct simulation have no places to overlap at; leave "
                 "it out");
    if (gas && w.energy.asked && !keeps_energy(scene))
        v.reject("watch.energy_residual: is defined for gases in which only walls change the energy: "
                 "restitution 1, no friction, heating, gravity or shear; leave it out");
    if (gas && w.momentum.asked && !keeps_momentum(scene))
        v.reject("watch.momentum_error: is defined for gases without walls, heating, gravity and shear; "
                 "leave it out");
    if (!gas && w.momentum.asked && scene.domain.shear_rate != 0)
        v.reject("watch.momentum_error: is not defined with domain.shear_rate = {}, momentum changes where "
                 "grains cross the seam; leave it out",
                 scene.domain.shear_rate);
}

} // namespace sandlane::scene
