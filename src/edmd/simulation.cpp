#include "edmd/simulation.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "edmd/epochs.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::edmd {

using simd::HardEvents;
using simd::HardState;
using simd::image_zero;
using simd::never_meets;
using simd::no_partner;

namespace {

// State of more than this is fetched ahead; below it costs more than it saves.
constexpr std::size_t far_bytes = std::size_t{8} << 20;

} // namespace

Simulation::Simulation(Setup setup, const std::vector<Particle>& particles, simd::Isa isa, int threads)
    : Algorithm(std::move(setup)), kernels_(&simd::edmd_kernels(isa)), threads_(threads),
      special_(!setup_.is_plain()) {
    const int space = setup_.dimension == 3 ? 1 : 0;
    search_near_ = setup_.growth > 0   ? kernels_->growing[space]
                   : setup_.shear != 0 ? kernels_->sheared[space]
                   : special_          ? kernels_->general[space]
                                       : kernels_->plain[space];
    for (const Class& c : setup_.classes) radius_.push_back(c.radius);
    states_.resize(particles.size());
    events_.resize(particles.size());
    turns_.resize(3 * particles.size());
    if (setup_.rough) spin_.resize(particles.size());
    choose_cells();
    place_particles(particles);
    sort_by_cell();
    set_epoch_end();
    far_ = bytes() > far_bytes;
    dispatch_predict_all();
}

void Simulation::choose_cells() {
    double longest = 0;
    for (int d = 0; d < setup_.dimension; ++d) longest = std::max(longest, setup_.length(d));
    // So that rounding cannot hide a contact behind a face.
    const double least = 2 * setup_.largest_radius() * (1 + 1e-12) + 64 * 2.3e-16 * longest;
    const double share = setup_.volume() / std::max<double>(1, static_cast<double>(states_.size()));
    // Half a particle in each, or as asked, but not more than eight cells for each.
    const double wanted = std::max(
        setup_.cell_edge, std::pow((setup_.cell_edge > 0 ? 0.125 : 0.5) * share, 1.0 / setup_.dimension));
    cell_count_ = 1;
    for (int d = 0; d < 3; ++d) {
        view_.count[d] = 1;
        if (d >= setup_.dimension) continue;
        const double edge = std::max(wanted, least);
        // Four around a periodic box where there is room for them.
        const double most = std::floor(setup_.length(d) / least);
        const double count = std::max(std::floor(setup_.length(d) / edge), std::min(4.0, most));
        view_.count[d] = static_cast<std::int32_t>(std::clamp(count, 1.0, 65535.0));
        view_.periodic[d] = setup_.periodic[d];
        view_.length[d] = setup_.periodic[d] ? setup_.length(d) : 0;
        edge_[d] = setup_.length(d) / view_.count[d];
        cell_count_ *= view_.count[d];
    }
    for (int d = 0; d < setup_.dimension; ++d)
        if (const int needed = setup_.shear != 0 && d == 0 ? 4 : 3;
            setup_.periodic[d] && view_.count[d] < needed)
            fail(Exit::invalid_input, "the box has {} cells in a periodic direction, fewer than {}",
                 view_.count[d], needed);
    plane_ = std::int64_t{view_.count[0]} * view_.count[1];
    cells_.resize(static_cast<std::size_t>(cell_count_));
    view_.radius = radius_.data();
    for (int d = 0; d < 3; ++d) view_.gravity[d] = setup_.gravity[d];
    view_.growth = setup_.growth;
}

void Simulation::place_particles(const std::vector<Particle>& particles) {
    for (std::size_t n = 0; n < particles.size(); ++n) {
        const Particle& p = particles[n];
        HardState& s = states_[n];
        HardEvents& e = events_[n];
        e = {never_meets, never_meets,  never_meets, no_partner, no_partner, Queue::nowhere, p.id, no_partner,
             0,           -never_meets, {0, 0, 0},   0,          0};
        s = {};
        s.word = static_cast<std::uint64_t>(p.kind) << 48;
        for (int d = 0; d < 3; ++d) {
            const auto k = static_cast<std::size_t>(d);
            s.word |= image_zero << 16 * d;
            if (d >= setup_.dimension) continue;
            s.place[d] = p.place[k];
            s.velocity[d] = p.velocity[k];
            turns_[3 * n + k] = static_cast<std::int32_t>(p.image[k]);
            const double at = std::floor((p.place[k] - setup_.lower[d]) / edge_[d]);
            e.cell[d] =
                static_cast<std::uint16_t>(std::clamp(at, 0.0, static_cast<double>(view_.count[d] - 1)));
        }
        if (setup_.rough) spin_[n] = {p.spin[0], p.spin[1], p.spin[2]};
        add_to_cell(cell_number(e.cell), static_cast<std::uint32_t>(n));
    }
}

// Storage follows the cells, so that neighbours stand near each other.
void Simulation::sort_by_cell() {
    const std::size_t n = states_.size();
    std::vector<std::uint32_t> order, rank(n);
    order.reserve(n);
    for (std::int64_t c = 0; c < cell_count_; ++c) {
        simd::HardCell* cell = &cells_[static_cast<std::size_t>(c)];
        for (;;) {
            for (std::uint32_t k = 0; k < cell->size(); ++k) {
                rank[cell->particle[k]] = static_cast<std::uint32_t>(order.size());
                order.push_back(cell->particle[k]);
                cell->particle[k] = rank[cell->particle[k]];
            }
            if (cell->next() == 0) break;
            cell = &cells_[cell->next()];
        }
    }
    Column<HardState> states(n);
    Column<HardEvents> events(n);
    Column<std::int32_t> turns(3 * n);
    std::vector<Vector<double>> spin(spin_.size());
    for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t from = order[k];
        states[k] = states_[from];
        events[k] = events_[from];
        if (!simd::is_wall(events[k].last)) events[k].last = rank[events[k].last];
        for (std::size_t d = 0; d < 3; ++d) turns[3 * k + d] = turns_[3 * from + d];
        if (setup_.rough) spin[k] = spin_[from];
    }
    states_.swap(states);
    events_.swap(events);
    turns_.swap(turns);
    spin_.swap(spin);
    view_.state = states_.data();
    view_.events = events_.data();
    view_.cells = cells_.data();
}

void Simulation::set_epoch_end() {
    double square = 0;
    for (const HardState& s : states_)
        square = std::max(square, s.velocity[0] * s.velocity[0] + s.velocity[1] * s.velocity[1] +
                                      s.velocity[2] * s.velocity[2]);
    epoch_end_ = longest_epoch(setup_, square);
    epoch_events_ = 0;
}

void Simulation::dispatch_predict_all() {
    view_.scale = setup_.scale;
    count_columns();
    if (setup_.dimension == 2) {
        special_ ? predict_all<2, true>() : predict_all<2, false>();
    } else {
        special_ ? predict_all<3, true>() : predict_all<3, false>();
    }
}

std::int64_t Simulation::run(std::int64_t events, double until) {
    std::int64_t done = 0;
    const std::int64_t whole = events_of_epoch(states_.size());
    while (done < events) {
        const double stop = std::min({epoch_end_, next_kick(), next_slide()}),
                     end = std::min(stop, clock_.until(until));
        now_ = clock_.now;
        const std::int64_t asked = std::min(events - done, whole - epoch_events_);
        const std::int64_t taken = setup_.dimension == 2
                                       ? (special_ ? loop<2, true>(asked, end) : loop<2, false>(asked, end))
                                       : (special_ ? loop<3, true>(asked, end) : loop<3, false>(asked, end));
        done += taken;
        epoch_events_ += taken;
        if (taken < asked && end < never_meets) now_ = std::max(now_, end);
        clock_.now = now_;
        const bool stopped = taken < asked && end == stop && end < never_meets;
        if (epoch_events_ == whole || (stopped && stop == epoch_end_))
            begin_epoch();
        else if (stopped && stop == next_kick())
            kick();
        else if (stopped)
            setup_.dimension == 2 ? slide_rows<2>() : slide_rows<3>();
        else if (taken < asked)
            break;
    }
    return done;
}

Drift Simulation::drift() const {
    Drift drift;
    for (const std::uint32_t k : order_by_id()) {
        const HardState& s = states_[k];
        drift.add(setup_.classes[s.word >> 48].mass, {s.velocity[0], s.velocity[1], s.velocity[2]});
    }
    return drift;
}

// A kick changes all velocities; everything is predicted anew.
void Simulation::kick() {
    restart_epoch();
    const std::vector<std::uint32_t> at = order_by_id();
    std::vector<std::uint32_t> kinds;
    kinds.reserve(at.size());
    for (const std::uint32_t k : at) kinds.push_back(static_cast<std::uint32_t>(states_[k].word >> 48));
    const std::vector<Vector<double>> given = kicks(setup_, kinds, kicks_++);
    for (std::size_t n = 0; n < at.size(); ++n) {
        double(&v)[3] = states_[at[n]].velocity;
        tally_.add_kick(setup_.classes[kinds[n]].mass, {v[0], v[1], v[2]}, given[n]);
        v[0] += given[n].x, v[1] += given[n].y, v[2] += given[n].z;
        events_[at[n]].last = no_partner;
    }
    const std::int64_t events = epoch_events_;
    set_epoch_end();
    epoch_events_ = events; // so that storage is sorted now and then
    dispatch_predict_all();
}

// The present becomes time zero.
void Simulation::restart_epoch() {
    setup_.dimension == 2 ? synchronise<2>() : synchronise<3>();
    const double before = setup_.offset_at(now_);
    restart_clock();
    now_ = 0;
    if (setup_.shear == 0) return;
    // The boxes above stand some lengths of a box less along x. Who has just left its box in y, and by
    // rounding was not folded back, counts them.
    const std::int64_t less = std::llround((before - setup_.offset) / setup_.length(0));
    for (HardState& s : states_) s.word += static_cast<std::uint64_t>(less * simd::image_of(s, 1));
}

void Simulation::begin_epoch() {
    restart_epoch();
    check_course(drift());
    sort_by_cell();
    set_epoch_end();
    dispatch_predict_all();
    ++work_.epochs;
}

std::size_t Simulation::bytes() const {
    return states_.bytes() + events_.bytes() + cells_.bytes() + turns_.bytes() +
           spin_.size() * sizeof(Vector<double>) + queue_.bytes();
}

} // namespace sandlane::edmd
