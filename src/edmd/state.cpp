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

std::vector<RawState> Simulation::raw_states() const {
    std::vector<RawState> all;
    all.reserve(states_.size());
    for (const std::uint32_t k : order_by_id()) {
        const HardState& s = states_[k];
        const HardEvents& e = events_[k];
        RawState raw;
        raw.place = {s.place[0], s.place[1], s.place[2]};
        raw.velocity = {s.velocity[0], s.velocity[1], s.velocity[2]};
        if (setup_.rough) raw.spin = {spin_[k].x, spin_[k].y, spin_[k].z};
        raw.time = s.time;
        raw.last_time = e.last_time;
        for (std::size_t d = 0; d < 3; ++d) raw.boxes[d] = turns_[3 * k + d];
        raw.last = simd::is_wall(e.last) ? simd::no_partner : events_[e.last].id;
        raw.hits = e.hits;
        raw.kind = static_cast<std::uint32_t>(s.word >> 48);
        all.push_back(raw);
    }
    return all;
}

std::string Simulation::frame() const {
    ByteWriter out;
    put_frame(out);
    for (const std::int32_t count : view_.count) out.put(count);
    return std::move(out).bytes();
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
    out.put_array(&work_, 1);
    put_course(out);
    return std::move(out).bytes();
}

void Simulation::restore(const std::string& bytes) {
    ByteReader in(bytes);
    if (in.get_text() != frame())
        fail(Exit::io, "the state is of other particles, another box or other cells");
    const std::size_t n = states_.size();
    std::vector<HardState> states;
    std::vector<std::uint32_t> words;
    std::vector<double> times;
    std::vector<std::int32_t> turns;
    std::vector<Work> work;
    in.get_array(states);
    in.get_array(words);
    in.get_array(times);
    in.get_array(turns);
    in.get_array(spin_);
    in.get_array(work);
    if (states.size() != n || words.size() != 6 * n || times.size() != n || turns.size() != 3 * n ||
        (setup_.rough && spin_.size() != n) || work.size() != 1)
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
    work_ = work[0];
    get_course(in);
    for (const RawState& s : raw_states())
        if (!suits(s)) fail(Exit::io, "damaged state");
    now_ = clock_.now;
    for (std::uint32_t k = 0; k < n; ++k)
        if (!stands_in_its_cell(k)) fail(Exit::io, "damaged state");
    sort_by_cell();
    dispatch_predict_all();
}

// Now, or in the next one: crossings are caught up within their rounding, not through the box.
bool Simulation::stands_in_its_cell(std::uint32_t k) const {
    const HardState& s = states_[k];
    const double dt = now_ - s.time;
    for (int d = 0; d < setup_.dimension; ++d) {
        double x = s.place[d] + s.velocity[d] * dt + setup_.gravity[d] * (0.5 * (dt * dt)) - setup_.lower[d] -
                   static_cast<double>(simd::image_of(s, d)) * setup_.length(d);
        if (d == 0 && setup_.shear != 0)
            x -= static_cast<double>(simd::image_of(s, 1)) * setup_.offset_at(now_);
        const double below = events_[k].cell[d] * edge_[d] - x,
                     above = x - (events_[k].cell[d] + 1) * edge_[d];
        // Beyond the walls there are no cells.
        const bool lowest = !setup_.periodic[d] && events_[k].cell[d] == 0;
        const bool highest = !setup_.periodic[d] && events_[k].cell[d] + 1 == view_.count[d];
        if ((below > edge_[d] && !lowest) || (above > edge_[d] && !highest)) return false;
    }
    return true;
}

} // namespace sandlane::edmd
