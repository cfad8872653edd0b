// A run looks at its own errors (docs/physics.md 14): overlaps in every step, the others when it is asked.
#include "core/error.hpp"
#include "md/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace watched = analysis::watched;

std::string Simulation::text_of(Vec p) const {
    return plan_.dimension == 2 ? fmt::format("({:.6g}, {:.6g})", p.x, p.y)
                                : fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

std::string Simulation::text_of(const Place& c) const {
    if (c.first < 0) return "no contact";
    const std::string where = text_of(c.position);
    if (c.second >= 0) return fmt::format("grains {} and {} at {}", c.first, c.second, where);
    const auto wall = static_cast<std::size_t>(-1 - c.second);
    return fmt::format("grain {} and wall \"{}\" at {}", c.first, scene_.walls[wall].name, where);
}

void Simulation::note_overlap(double ratio, const Place& where, double at) {
    if (ratio <= balance_.deepest) return;
    balance_.deepest = ratio;
    balance_.deepest_time = at;
    deepest_ = where;
    const double stop = scene_.watch.overlap.stop;
    if (stop > 0 && ratio > stop)
        fail(Exit::unstable,
             "step {}, t = {:.6g} s: {} overlap by {:.4g} of the smaller radius, more than "
             "watch.largest_overlap allows ({:.4g}). The material is too soft for this load, or the time "
             "step too large: raise its stiffness or lower md.dt.",
             step_, at, text_of(where), ratio, stop);
}

// Once in ten per cent of growth: a search costs as much as some twenty steps.
void Simulation::see_overlap(double overlap) {
    const Touching worst = deepest_pair(true);
    balance_.examined = 1.1 * overlap;
    const double stop = scene_.watch.overlap.stop * needs_.radius_min;
    if (stop > overlap) balance_.examined = std::min(balance_.examined, stop);
    note_overlap(worst.overlap / std::min(state_.radius(worst.first), state_.radius(worst.second)),
                 {state_.id[worst.first], state_.id[worst.second], state_.position(worst.first)},
                 force_time());
}

void Simulation::see_wall(const WallResult& worst) {
    if (worst.largest_ratio <= balance_.deepest) return;
    const auto grain = static_cast<std::size_t>(worst.grain);
    note_overlap(worst.largest_ratio, {state_.id[grain], -1 - worst.wall, state_.position(grain)},
                 force_time());
}

// Each contact of the sample as a binary collision, with dt and with dt/2 from the same gap.
void Simulation::add_step_error(analysis::Watched& w) const {
    Walls now = walls_;
    now.move_to(time());
    const ContactMemory pairs = lists_.memory(state_), of_walls = walls_.memory(state_);
    const auto sample =
        sample_contacts(scene_, plan_, state_, now, coefficients_, {pairs, of_walls}, box(time()), step_);
    double sum = 0, largest = -1;
    const SampledContact* worst = nullptr;
    for (const SampledContact& s : sample) {
        const double gap = s.phase * plan_.dt * s.impact.speed;
        const auto energy = [&](double dt) {
            const double e =
                stepped_restitution(plan_.normal, {plan_.scheme, plan_.resolved}, s.impact, dt, gap);
            return e * e;
        };
        const double error = std::abs(energy(plan_.dt) - energy(0.5 * plan_.dt));
        sum += error * error;
        if (error <= largest) continue;
        largest = error;
        worst = &s;
    }
    if (worst == nullptr) return;
    w.value[watched::step] = std::sqrt(sum / static_cast<double>(sample.size()));
    w.where[watched::step] =
        fmt::format("the largest, {:.3g}, is that of {}", largest, text_of(worst->place));
}

analysis::Watched Simulation::watch(const Observables& now) {
    analysis::Watched w;
    if (balance_.kind == 0) return w;
    const scene::Watch& asked = scene_.watch;
    double momentum = 0;
    std::size_t fastest = 0;
    for (std::size_t i = 0; i < state_.size(); ++i) {
        momentum += state_.mass[i] * norm(state_.shift(i)) / plan_.dt;
        if (norm(state_.shift(i)) > norm(state_.shift(fastest))) fastest = i;
    }
    balance_.most_momentum = std::max(balance_.most_momentum, momentum);
    balance_.most_energy = std::max(balance_.most_energy, now.kinetic + now.rotational + now.elastic);
    if (asked.overlap.asked) {
        note_overlap(now.largest_overlap, now.deepest, time());
        w.value[watched::overlap] = balance_.deepest;
        w.where[watched::overlap] = text_of(deepest_);
    }
    if (asked.energy.asked) w.value[watched::energy] = energy_residual(now);
    if (asked.momentum.asked) w.value[watched::momentum] = momentum_error(now);
    if (asked.step.asked) add_step_error(w);
    for (const std::size_t n : {watched::energy, watched::momentum})
        if (state_.size() > 0)
            w.where[n] = fmt::format("the fastest grain is {} at {}", state_.id[fastest],
                                     text_of(state_.position(fastest)));
    std::fill(std::begin(w.time), std::end(w.time), time());
    w.time[watched::overlap] = balance_.deepest_time;
    return w;
}

} // namespace sandlane::md
