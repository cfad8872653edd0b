// Reading a simulation: particles by id, hash, checkpoints.
#include "core/bytes.hpp"
#include "core/error.hpp"
#include "edmd/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sandlane::edmd {

using simd::HardEvents;
using simd::HardState;

std::vector<std::uint32_t> Simulation::order_by_id() const {
    std::vector<std::uint32_t> at(states_.size());
    for (std::size_t k = 0; k < states_.size(); ++k) at[events_[k].id] = static_cast<std::uint32_t>(k);
    return at;
}

std::vector<Particle> Simulation::particles() const {
    std::vector<Particle> all;
    all.reserve(states_.size());
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    for (const std::uint32_t k : order_by_id()) {
        const HardState& s = states_[k];
        laws::Flight<double> f{
            {s.place[0], s.place[1], s.place[2]}, {s.velocity[0], s.velocity[1], s.velocity[2]}, s.time};
        laws::fly<3, true>(f, clock_.now - s.time, gravity);
        Particle p;
        p.id = events_[k].id;
        p.kind = static_cast<std::uint32_t>(s.word >> 48);
        p.place = {f.place.x, f.place.y, f.place.z};
        p.velocity = {f.velocity.x, f.velocity.y, f.velocity.z};
        if (setup_.rough) p.spin = {spin_[k].x, spin_[k].y, spin_[k].z};
        for (std::size_t d = 0; d < static_cast<std::size_t>(setup_.dimension); ++d) {
            p.image[d] = turns_[3 * k + d];
            const int axis = static_cast<int>(d);
            if (!setup_.periodic[axis]) continue;
            const double boxes = std::floor((p.place[d] - setup_.lower[axis]) / setup_.length(axis));
            p.place[d] -= boxes * setup_.length(axis);
            p.image[d] += static_cast<std::int64_t>(boxes);
        }
        all.push_back(p);
    }
    return all;
}

Observables observe(const Setup& setup, const std::vector<Particle>& particles) {
    Observables o;
    if (particles.empty()) return o;
    const auto d = static_cast<std::size_t>(setup.dimension);
    const auto n = static_cast<double>(particles.size());
    double mass = 0;
    o.of_class.assign(setup.classes.size(), 0);
    std::vector<double> count(setup.classes.size());
    for (const Particle& p : particles) {
        const Class& c = setup.classes[p.kind];
        mass += c.mass;
        for (std::size_t k = 0; k < d; ++k) o.drift[k] += c.mass * p.velocity[k];
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
        fourth += thermal * thermal;
        o.of_class[p.kind] += thermal / static_cast<double>(d);
        ++count[p.kind];
        const double moment = c.inertia * c.mass * c.radius * c.radius;
        for (const double w : p.spin) o.spin_temperature += moment * w * w / (d == 3 ? 3 : 1) / n;
        for (const double w : p.spin) o.energy += 0.5 * moment * w * w;
    }
    const auto dimension = static_cast<double>(d);
    o.temperature = square / (n * dimension);
    o.fourth = square > 0 ? fourth * n / (square * square) * dimension / (dimension + 2) - 1 : 0;
    for (std::size_t k = 0; k < count.size(); ++k) o.of_class[k] /= std::max(count[k], 1.0);
    return o;
}

namespace {

// All that a state is, of one particle; numbers of others are ids.
template <class Put>
void describe_state(const HardState& s, const HardEvents& e, const Column<HardEvents>& events, const Put& put) {
    put(e.id);
    for (int d = 0; d < 3; ++d) {
        put(s.place[d]);
        put(s.velocity[d]);
    }
    put(s.time);
    put(simd::is_wall(e.last) ? e.last : events[e.last].id);
    put(e.last_time);
    put(e.hits);
}

} // namespace

Hash128 Simulation::state_hash() const {
    ByteWriter out;
    for (const std::uint32_t k : order_by_id()) {
        describe_state(states_[k], events_[k], events_, [&](auto value) { out.put(value); });
        for (std::size_t d = 0; d < 3; ++d) out.put(turns_[3 * k + d]);
        if (setup_.rough) out.put(spin_[k].x), out.put(spin_[k].y), out.put(spin_[k].z);
    }
    out.put(clock_.epoch);
    out.put(clock_.carry);
    out.put(log_.hash());
    return hash_bytes(out.bytes().data(), out.bytes().size());
}

// Everything that a state must share with the simulation that takes it up.
std::string Simulation::frame() const {
    ByteWriter out;
    out.put(setup_.dimension);
    for (int d = 0; d < 3; ++d) {
        out.put(setup_.lower[d]);
        out.put(setup_.upper[d]);
        out.put(setup_.periodic[d]);
        out.put(view_.count[d]);
    }
    out.put(static_cast<std::uint64_t>(states_.size()));
    out.put(setup_.rough);
    for (const Class& c : setup_.classes) {
        out.put(c.radius);
        out.put(c.mass);
        out.put(c.inertia);
    }
    return out.bytes();
}

std::string Simulation::serialise() const {
    ByteWriter out;
    out.put_text(frame());
    out.put_array(states_.data(), states_.size());
    std::vector<std::uint32_t> words;
    std::vector<double> times;
    for (std::size_t k = 0; k < states_.size(); ++k) {
        const HardEvents& e = events_[k];
        words.insert(words.end(), {e.id, simd::is_wall(e.last) ? e.last : events_[e.last].id, e.hits,
                                   e.cell[0], e.cell[1], e.cell[2]});
        times.push_back(e.last_time);
    }
    out.put_array(words.data(), words.size());
    out.put_array(times.data(), times.size());
    out.put_array(turns_.data(), turns_.size());
    out.put_array(spin_.data(), spin_.size());
    out.put_array(&clock_, 1);
    out.put_array(&tally_, 1);
    out.put_array(&work_, 1);
    out.put(log_.state());
    out.put(log_.count());
    out.put(epoch_events_);
    out.put(epoch_end_);
    return out.bytes();
}

void Simulation::restore(const std::string& bytes) {
    ByteReader in(bytes);
    if (in.get_text() != frame()) fail(Exit::io, "the state is of other particles, another box or other cells");
    const std::size_t n = states_.size();
    std::vector<HardState> states;
    std::vector<std::uint32_t> words;
    std::vector<double> times;
    std::vector<std::int32_t> turns;
    std::vector<Clock> clock;
    std::vector<Tally> tally;
    std::vector<Work> work;
    in.get_array(states);
    in.get_array(words);
    in.get_array(times);
    in.get_array(turns);
    in.get_array(spin_);
    in.get_array(clock);
    in.get_array(tally);
    in.get_array(work);
    if (states.size() != n || words.size() != 6 * n || times.size() != n || turns.size() != 3 * n ||
        (setup_.rough && spin_.size() != n) || clock.size() != 1 || tally.size() != 1 || work.size() != 1)
        fail(Exit::io, "damaged state");
    std::vector<std::uint32_t> at(n, simd::no_partner);
    for (std::size_t k = 0; k < n; ++k) {
        if (words[6 * k] >= n || at[words[6 * k]] != simd::no_partner) fail(Exit::io, "damaged state");
        at[words[6 * k]] = static_cast<std::uint32_t>(k);
    }
    cells_.fill({});
    cells_.resize(static_cast<std::size_t>(cell_count_));
    free_cell_ = 0;
    for (std::size_t k = 0; k < n; ++k) {
        states_[k] = states[k];
        HardEvents& e = events_[k];
        e.id = words[6 * k];
        e.last = words[6 * k + 1];
        if (!simd::is_wall(e.last)) {
            if (e.last >= n) fail(Exit::io, "damaged state");
            e.last = at[e.last];
        }
        e.hits = words[6 * k + 2];
        e.last_time = times[k];
        for (std::size_t d = 0; d < 3; ++d) {
            if (words[6 * k + 3 + d] >= static_cast<std::uint32_t>(view_.count[d]))
                fail(Exit::io, "damaged state");
            e.cell[d] = static_cast<std::uint16_t>(words[6 * k + 3 + d]);
            turns_[3 * k + d] = turns[3 * k + d];
        }
        if ((states_[k].word >> 48) >= setup_.classes.size()) fail(Exit::io, "damaged state");
        add_to_cell(cell_number(e.cell), static_cast<std::uint32_t>(k));
    }
    clock_ = clock[0];
    tally_ = tally[0];
    work_ = work[0];
    const auto state = in.get<std::uint64_t>(), count = in.get<std::uint64_t>();
    log_.restore(state, count);
    epoch_events_ = in.get<std::int64_t>();
    epoch_end_ = in.get<double>();
    now_ = clock_.now;
    sort_by_cell();
    dispatch_predict_all();
}

void Simulation::use(simd::Isa isa) {
    kernels_ = &simd::edmd_kernels(isa);
    const int space = setup_.dimension == 3 ? 1 : 0;
    search_near_ = special_ ? kernels_->general[space] : kernels_->plain[space];
}

} // namespace sandlane::edmd
