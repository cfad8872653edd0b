// What kernels see of a simulation: views of its columns, and where the seam of a sheared cell stands.
#include "md/simulation.hpp"

#include <cmath>
#include <limits>

namespace sandlane::md {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

WallInput Simulation::wall_input(double* force, std::size_t first) const {
    return {state_.record.data(),
            state_.material.data(),
            coefficients_.data(),
            static_cast<int>(scene_.materials.size()),
            force,
            first,
            nullptr,
            nullptr,
            0,
            plan_.dt,
            1.0 / plan_.dt,
            state_.spin.empty() ? nullptr : state_.spin.data(),
            static_cast<int>(state_.force_stride())};
}

// predicted: step whose positions the prediction gives.
simd::MotionView Simulation::motion_view(std::int64_t predicted) {
    const Vec size = plan_.upper - plan_.lower, g = scene_.domain.gravity;
    const double gravity[] = {g.x, g.y, g.z}, lower[] = {plan_.lower.x, plan_.lower.y, plan_.lower.z};
    const double upper[] = {plan_.upper.x, plan_.upper.y, plan_.upper.z}, sizes[] = {size.x, size.y, size.z};
    simd::MotionView view{};
    view.gear = state_.gear.data();
    view.records = view.new_records = state_.record.data();
    view.spins = view.new_spins = state_.spin.data();
    view.force = state_.force.data();
    view.inverse_mass = state_.inverse_mass.data();
    view.inverse_inertia = 1.0 / plan_.inertia_factor;
    view.half_dt2 = 0.5 * plan_.dt * plan_.dt;
    view.gravity_spin = plan_.dimension == 2 ? g.z : 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
        view.image[d] = state_.image[d].data();
        view.gravity[d] = gravity[d];
        view.lower[d] = lower[d];
        view.upper[d] = upper[d];
        view.period[d] = scene_.domain.periodic[d] ? sizes[d] : 0.0;
    }
    view.sheared = scene_.domain.shear_rate != 0;
    view.seam = seam(static_cast<double>(predicted) * plan_.tick);
    view.seam_shift = scene_.domain.shear_rate * size.y * plan_.dt;
    return view;
}

// How far along x the images beyond the upper side stand: [-1/2, 1/2) of the period.
double Simulation::seam(double time) const {
    if (scene_.domain.shear_rate == 0) return 0;
    const Vec size = plan_.upper - plan_.lower;
    const double offset = scene_.domain.shear_rate * size.y * time;
    return offset - size.x * std::floor(offset / size.x + 0.5);
}

scene::Box Simulation::box(double time) const {
    scene::Box box(scene_.domain);
    box.seam = seam(time);
    return box;
}

simd::PairView Simulation::pair_view() {
    const Vec size = plan_.upper - plan_.lower;
    const double sizes[] = {size.x, size.y, size.z};
    simd::PairView view{};
    view.records = state_.record.data();
    view.spins = state_.spin.empty() ? nullptr : state_.spin.data();
    view.material = state_.material.data();
    view.force = state_.force.data();
    for (std::size_t d = 0; d < 3; ++d) {
        view.period[d] = scene_.domain.periodic[d] ? sizes[d] : 0.0;
        view.half[d] = scene_.domain.periodic[d] ? 0.5 * sizes[d] : infinity;
    }
    view.coefficients = coefficients_.data();
    view.materials = static_cast<std::int32_t>(scene_.materials.size());
    view.dt = view.step = plan_.dt;
    view.inverse_dt = 1.0 / plan_.dt;
    view.sheared = scene_.domain.shear_rate != 0;
    view.seam = seam(force_time());
    view.seam_shift = scene_.domain.shear_rate * size.y * plan_.dt;
    return view;
}

} // namespace sandlane::md
