// The time step that follows the contacts (docs/physics.md 8): chosen from the state alone, every 256 steps
// or so.
#include "md/near_pairs.hpp"
#include "md/simulation.hpp"

#include <algorithm>
#include <limits>

namespace sandlane::md {

void Simulation::choose_time_step() {
    if (!scene_.md.adaptive_dt) return;
    const double wanted = wanted_time_step();
    std::int64_t stride = plan_.largest_stride;
    while (stride > plan_.least_stride &&
           (plan_.largest_stride % stride != 0 || static_cast<double>(stride) * plan_.tick > wanted))
        --stride;
    if (stride != plan_.stride) set_stride(stride);
}

void Simulation::set_stride(std::int64_t stride) {
    state_.rescale(static_cast<double>(stride) / static_cast<double>(plan_.stride));
    plan_.stride = stride;
    plan_.dt = static_cast<double>(stride) * plan_.tick;
    force_step_ = step_ + stride;
}

// What the stiffest of the present contacts needs, and what one that begins may need until the next choice:
// of two of the lightest grains that are there or come, one of them as fast as any, the other at rest.
double Simulation::wanted_time_step() const {
    double wanted = std::numeric_limits<double>::infinity(), fastest = 0;
    Needs present = needs_;
    present.radius_min = present.mass_min = std::numeric_limits<double>::infinity();
    const auto count_in = [&](double speed, double radius, double mass) {
        fastest = std::max(fastest, speed);
        present.radius_min = std::min(present.radius_min, radius);
        present.mass_min = std::min(present.mass_min, mass);
    };
    for (std::size_t i = 0; i < state_.size(); ++i)
        count_in(norm(state_.shift(i)) / plan_.dt, state_.radius(i), state_.mass[i]);
    const std::int64_t until = step_ + (sort_interval + 1) * plan_.largest_stride;
    for (std::size_t n = next_waiting_; n < waiting_.size() && insertion_step(waiting_[n]) <= until; ++n)
        count_in(norm(with_shear_flow(waiting_[n]).velocity), waiting_[n].radius, waiting_[n].mass);
    if (present.radius_min > needs_.radius_max) return wanted; // no grain at all
    const auto table = [&](int a, int b) {
        const std::size_t materials = scene_.materials.size();
        const std::size_t pair = static_cast<std::size_t>(a) * materials + static_cast<std::size_t>(b);
        return laws::coefficients_from<double>(coefficients_.data() + pair * laws::pair_coefficients);
    };
    const auto see = [&](int a, int b, double mass, double radius, double overlap) {
        if (overlap > 0)
            wanted = std::min(wanted, contact_time_step(scene_, table(a, b), mass, radius, overlap));
    };
    const auto position = [&](std::size_t i) { return state_.position(i); };
    for_near_pairs(box(time()), state_, position, [&](std::size_t i, std::size_t j, Vec d) {
        see(state_.material[i], state_.material[j], 1 / (state_.inverse_mass[i] + state_.inverse_mass[j]),
            1 / (state_.inverse_radius(i) + state_.inverse_radius(j)),
            state_.radius(i) + state_.radius(j) - norm(d));
    });
    Walls walls = walls_;
    walls.move_to(time());
    for (std::size_t i = 0; i < state_.size() && !walls.empty(); ++i)
        walls.for_touching(state_.position(i), state_.radius(i), [&](std::size_t e, const WallContact& c) {
            see(state_.material[i], walls.element(e).material, state_.mass[i],
                1 / (state_.inverse_radius(i) + c.inverse_radius), state_.radius(i) + c.radius - c.distance);
        });
    scene::Scene contacts;
    contacts.domain = scene_.domain;
    contacts.materials = scene_.materials;
    contacts.pairs = scene_.pairs;
    contacts.md = scene_.md;
    const Vec& g = scene_.domain.gravity; // of a plane, z is an angular acceleration
    const double falling =
        norm(plan_.dimension == 3 ? g : Vec{g.x, g.y, 0}) * static_cast<double>(until - step_) * plan_.tick;
    const double meeting = fastest + falling + walls.fastest();
    contacts.md.max_speed = std::max(meeting, 1e-6 * scene_.md.max_speed);
    wanted = std::min(wanted, derive(contacts, present).recommended_dt);
    return std::min(wanted, 0.05 * present.radius_min / contacts.md.max_speed);
}

} // namespace sandlane::md
