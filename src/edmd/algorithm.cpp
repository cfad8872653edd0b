#include "edmd/algorithm.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::edmd {

std::vector<Particle> Algorithm::particles() const {
    const std::vector<RawState> states = raw_states();
    std::vector<Particle> all(states.size());
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    for (std::size_t n = 0; n < states.size(); ++n) {
        const RawState& s = states[n];
        laws::Flight<double> f{
            {s.place[0], s.place[1], s.place[2]}, {s.velocity[0], s.velocity[1], s.velocity[2]}, s.time};
        laws::fly<3, true>(f, clock_.now - s.time, gravity);
        Particle& p = all[n];
        p.id = static_cast<std::uint32_t>(n);
        p.kind = s.kind;
        p.place = {f.place.x, f.place.y, f.place.z};
        p.velocity = {f.velocity.x, f.velocity.y, f.velocity.z};
        p.spin = s.spin;
        p.image = s.boxes;
        if (setup_.shear != 0)
            p.image[1] += fold_height(setup_, clock_.now, p.place[0], p.place[1], p.velocity[0]);
        for (std::size_t d = 0; d < static_cast<std::size_t>(setup_.dimension); ++d) {
            const int axis = static_cast<int>(d);
            if (!setup_.periodic[axis] || (setup_.shear != 0 && d == 1)) continue;
            const double boxes = std::floor((p.place[d] - setup_.lower[axis]) / setup_.length(axis));
            p.place[d] -= boxes * setup_.length(axis);
            p.image[d] += static_cast<std::int64_t>(boxes);
        }
    }
    return all;
}

Hash128 Algorithm::state_hash() const {
    ByteWriter out;
    for (const RawState& s : raw_states()) {
        for (std::size_t d = 0; d < 3; ++d) {
            out.put(s.place[d]);
            out.put(s.velocity[d]);
            out.put(s.spin[d]);
            out.put(s.boxes[d]);
        }
        out.put(s.time);
        out.put(s.last_time);
        out.put(s.last);
        out.put(s.hits);
    }
    out.put(clock_.epoch);
    out.put(clock_.carry);
    out.put(log_.hash());
    return hash_bytes(out.bytes().data(), out.bytes().size());
}

void Algorithm::put_frame(ByteWriter& out) const {
    out.put(setup_.dimension);
    for (int d = 0; d < 3; ++d) {
        out.put(setup_.lower[d]);
        out.put(setup_.upper[d]);
        out.put(setup_.periodic[d]);
    }
    out.put(static_cast<std::uint64_t>(size()));
    out.put(setup_.rough);
    out.put(setup_.shear);
    out.put(setup_.kicks);
    out.put(setup_.kick_interval);
    for (const Class& c : setup_.classes) {
        out.put(c.radius);
        out.put(c.mass);
        out.put(c.inertia);
    }
}

void Algorithm::put_course(ByteWriter& out) const {
    out.put_array(&clock_, 1);
    out.put_array(&tally_, 1);
    out.put_array(&guard_, 1);
    out.put(log_.state());
    out.put(log_.count());
    out.put(epoch_events_);
    out.put(epoch_end_);
    out.put(kicks_);
    out.put(setup_.scale);
    out.put(setup_.offset);
}

namespace {

// Of a sheared gas: whether the box above stands where an epoch can bring it.
bool is_near(const Setup& setup, double now) {
    return setup.offset >= 0 && setup.offset <= setup.length(0) &&
           std::abs(setup.image_speed()) * now <= 1e6 * setup.length(0);
}

} // namespace

void Algorithm::get_course(ByteReader& in) {
    std::vector<Clock> clock;
    std::vector<Tally> tally;
    std::vector<CollapseGuard> guard;
    in.get_array(clock);
    in.get_array(tally);
    in.get_array(guard);
    if (clock.size() != 1 || tally.size() != 1 || guard.size() != 1) fail(Exit::io, "damaged state");
    clock_ = clock[0];
    tally_ = tally[0];
    guard_ = guard[0];
    const auto state = in.get<std::uint64_t>(), count = in.get<std::uint64_t>();
    log_.restore(state, count);
    epoch_events_ = in.get<std::int64_t>();
    epoch_end_ = in.get<double>();
    kicks_ = in.get<std::int64_t>();
    setup_.scale = in.get<double>();
    setup_.offset = in.get<double>();
    const bool makes_sense = std::isfinite(clock_.epoch) && std::isfinite(clock_.carry) && clock_.now >= 0 &&
                             std::isfinite(clock_.now) && epoch_end_ >= 0 && epoch_events_ >= 0 &&
                             epoch_events_ <= events_of_epoch(size()) && kicks_ >= 0 && setup_.scale > 0 &&
                             std::isfinite(setup_.scale) && is_near(setup_, clock_.now);
    if (!makes_sense || !in.at_end()) fail(Exit::io, "damaged state");
}

bool Algorithm::suits(const RawState& s) const {
    constexpr double most_boxes = 1 << 15; // images are counted so far
    const double elapsed = clock_.now - s.time;
    for (std::size_t d = 0; d < 3; ++d) {
        const int axis = static_cast<int>(d);
        const double way = std::abs(s.place[d] - setup_.lower[axis]) + std::abs(s.velocity[d]) * elapsed +
                           0.5 * std::abs(setup_.gravity[axis]) * elapsed * elapsed;
        if (!std::isfinite(s.velocity[d]) || !std::isfinite(s.spin[d]) ||
            !(axis >= setup_.dimension || way < most_boxes * setup_.length(axis)))
            return false;
    }
    return elapsed >= 0 && std::isfinite(elapsed) && s.last_time <= clock_.now &&
           s.kind < setup_.classes.size();
}

void Algorithm::check_course(const Drift& drift) {
    const auto events = static_cast<std::int64_t>(log_.count());
    if (guard_.sees(time(), events, size()))
        fail(Exit::unstable,
             "inelastic collapse at t = {:.9g} s: after {} events, a thousand more for each particle take "
             "no time. Give edmd.contact_time or edmd.elastic_speed, e.g. a thousandth of the time between "
             "two collisions, or of the thermal speed",
             time(), events);
    // Without a collision nothing has cooled: particles may fly together from the start.
    if (tally_.collisions > 0 && drift.is_too_fast())
        fail(Exit::unstable,
             "at t = {:.9g} s, after {} events, the particles fly together {:.0e} times faster than relative "
             "to each other, too fast to tell these velocities from rounding. A gas that cools freely gets "
             "there by the rounding of its momentum: let it end earlier (edmd.duration, edmd.events), or "
             "heat it. In a field of gravity along a periodic direction all fall together: take it out of "
             "domain.periodic",
             time(), events, Drift::most);
    const double radius = setup_.smallest_radius();
    if (tally_.smallest_gap < -1e-9 * radius)
        fail(Exit::unstable, "particles overlap by {:.3g} m when they meet, at t = {:.9g} s",
             -tally_.smallest_gap, time());
}

std::vector<Particle> thermal_particles(const Setup& setup, std::vector<Particle> particles) {
    if (setup.shear != 0)
        for (Particle& p : particles) p.velocity[0] -= setup.flow(p.place[1]);
    return particles;
}

Observables observe(const Setup& setup, const std::vector<Particle>& given) {
    Observables o;
    if (given.empty()) return o;
    const std::vector<Particle> particles = thermal_particles(setup, given);
    const auto d = static_cast<std::size_t>(setup.dimension);
    const auto n = static_cast<double>(particles.size()), dimension = static_cast<double>(d);
    double mass = 0;
    o.of_class.assign(setup.classes.size(), 0);
    std::vector<double> count(setup.classes.size());
    for (const Particle& p : particles) {
        const double m = setup.classes[p.kind].mass;
        mass += m;
        for (std::size_t k = 0; k < d; ++k) o.drift[k] += m * p.velocity[k];
    }
    for (double& u : o.drift) u /= mass;
    double square = 0, fourth = 0;
    for (const Particle& p : particles) {
        const Class& c = setup.classes[p.kind];
        double thermal = 0;
        for (std::size_t k = 0; k < d; ++k) {
            const double v = p.velocity[k] - o.drift[k];
            thermal += c.mass * v * v;
            o.energy += 0.5 * c.mass * p.velocity[k] * p.velocity[k];
        }
        square += thermal;
        o.flux += c.mass * ((p.velocity[0] - o.drift[0]) * (p.velocity[1] - o.drift[1]));
        fourth += thermal * thermal;
        o.of_class[p.kind] += thermal / dimension;
        ++count[p.kind];
        const double moment = c.moment();
        for (const double w : p.spin) {
            o.spin_temperature += moment * w * w / (d == 3 ? 3 : 1) / n;
            o.energy += 0.5 * moment * w * w;
        }
    }
    o.temperature = square / (n * dimension);
    if (square > 0) o.fourth = fourth * n / (square * square) * dimension / (dimension + 2) - 1;
    for (std::size_t k = 0; k < count.size(); ++k) o.of_class[k] /= std::max(count[k], 1.0);
    return o;
}

} // namespace sandlane::edmd
