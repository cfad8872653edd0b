// What md.accuracy and [watch] do not go together with.
#include "scene/schema.hpp"
#include "scene/validator.hpp"

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

void check_watch(const Scene& scene, const std::string& file) {
    const Validator v{scene, file};
    if (scene.watch.momentum.asked && scene.domain.shear_rate != 0)
        v.reject("watch.momentum_error: is not defined with domain.shear_rate = {}, momentum changes where "
                 "grains cross the seam; leave it out",
                 scene.domain.shear_rate);
}

} // namespace sandlane::scene
