#include "dsmc/simulation.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace sandlane::dsmc {

using simd::gas_row;

namespace {

constexpr std::size_t spare_rows = 8; // a kernel reads eight rows at a time

void copy_row(const simd::GasRows& from, std::int32_t i, const simd::GasRows& to, std::int32_t j) {
    const std::ptrdiff_t a = std::ptrdiff_t{i} * gas_row, b = std::ptrdiff_t{j} * gas_row;
    std::memcpy(to.place + b, from.place + a, gas_row * sizeof(double));
    std::memcpy(to.velocity + b, from.velocity + a, gas_row * sizeof(double));
    if (from.spin != nullptr) std::memcpy(to.spin + b, from.spin + a, gas_row * sizeof(double));
}

std::int32_t cell_of(const simd::GasRows& rows, std::int32_t i) {
    std::uint64_t word = 0;
    std::memcpy(&word, rows.place + std::ptrdiff_t{i} * gas_row + 3, sizeof word);
    return static_cast<std::int32_t>(word >> 32);
}

simd::GasRows from_row(const simd::GasRows& rows, std::int32_t i) {
    const std::ptrdiff_t at = std::ptrdiff_t{i} * gas_row;
    return {rows.place + at, rows.velocity + at, rows.spin == nullptr ? nullptr : rows.spin + at};
}

// Cells are computed for places inside the box only.
void check_particles(const Setup& setup, const std::vector<Particle>& particles) {
    for (const Particle& p : particles)
        for (std::size_t d = 0; d < static_cast<std::size_t>(setup.dimension); ++d)
            if (!(p.place[d] >= setup.lower[d] && p.place[d] <= setup.upper[d]) ||
                !std::isfinite(p.velocity[d]))
                fail(Exit::invalid_input,
                     "particle {}: place {} m, velocity {} m/s in direction {}; it must be in the box, {} m "
                     "to {} m",
                     p.id, p.place[d], p.velocity[d], "xyz"[d], setup.lower[d], setup.upper[d]);
}

} // namespace

void Simulation::Rows::require(std::size_t rows, bool rough, bool keep) {
    if (rows + spare_rows <= capacity()) return;
    // Some room for fluctuations, so that tiles of a steady gas hardly ever grow.
    const auto n = static_cast<double>(rows);
    const std::size_t wanted = (rows + static_cast<std::size_t>(4 * std::sqrt(n) + 0.01 * n)) + spare_rows;
    const auto renew = [&](Column<double>& column) {
        Column<double> larger(wanted * gas_row);
        if (keep) std::memcpy(larger.data(), column.data(), column.size() * sizeof(double));
        column.swap(larger);
    };
    renew(place);
    renew(velocity);
    if (rough) renew(spin);
}

simd::GasRows Simulation::Rows::view() {
    return {place.data(), velocity.data(), spin.empty() ? nullptr : spin.data()};
}

void Simulation::Scratch::require(std::size_t rows, bool rough) {
    sorted.require(rows, rough, false);
    leaving.require(rows, rough, false);
    if (targets.size() < rows) targets.resize(rows + rows / 8);
}

Simulation::Simulation(const Setup& setup, const std::vector<Particle>& particles, simd::Isa isa, int threads)
    : setup_(setup), kernels_(&simd::dsmc_kernels(isa)), threads_(threads), size_(particles.size()) {
    setup_.walls.dimension = setup.dimension;
    setup_.walls.inertia = setup.inertia;
    setup_.walls.shear = setup.shear;
    for (std::size_t k = 0; k < setup.kinds(); ++k) {
        const Kind kind = setup.kind(k);
        simd::GasWallKind& wall = setup_.walls.kind[k];
        wall.mass = kind.mass / setup.mass;
        wall.speed = std::sqrt(setup.mass / kind.mass);
        if (setup.adaptive && !setup.others.empty()) mass_.push_back(wall.mass);
        if (!setup.rough) continue;
        wall.radius = 0.5 * kind.diameter;
        wall.spin_speed = 1 / std::sqrt(setup.inertia * 0.25 * kind.diameter * kind.diameter);
    }
    mixture_ = mixture_of(setup);
    for (int d = 0; d < 3; ++d) {
        setup_.walls.lower[d] = setup.lower[d];
        setup_.walls.upper[d] = setup.upper[d];
    }
    double count = 1;
    for (int d = 0; d < setup.dimension; ++d) count *= setup.cells[d];
    tiling_ = Tiling(setup_.cells, setup_.walls.periodic, static_cast<double>(size_) / count);
    for (int d = 0; d < 3; ++d) axis_[d] = tiling_.axis(d, setup_.lower[d], setup_.upper[d]);
    set_safe_region();
    tiles_.resize(static_cast<std::size_t>(tiling_.tiles()));
    results_.resize(tiles_.size());
    scratch_.resize(static_cast<std::size_t>(std::max(threads, 1)));
    const auto cells = static_cast<std::size_t>(tiling_.cells_per_tile());
    for (Scratch& s : scratch_) {
        s.start.resize(cells + 1);
        for (auto& next : s.next) next.resize(cells);
        s.slot.resize(static_cast<std::size_t>(tiling_.slots()) + 1);
        for (auto& list : s.lists) list.resize(cells + 16);
    }
    for (Tile& tile : tiles_)
        for (Outbox& out : tile.out) out.start.assign(static_cast<std::size_t>(tiling_.slots()) + 1, 0);
    check_particles(setup_, particles);
    place_particles(particles);
    dt_ = next_dt_ = setup_.dt;
    first_square_sum_ = square_sum_;
    find_maxwell_rate();
}

// Collisions of a particle per second at the temperature of the start.
void Simulation::find_maxwell_rate() {
    if (setup_.scheme != laws::CollisionScheme::maxwell || size_ == 0) return;
    const double start = setup_.mass * first_square_sum_ / (setup_.dimension * static_cast<double>(size_));
    maxwell_rate_ = scales(setup_, size_, start).collision_rate;
}

// Particles stand in the tile where they are, in the order given.
void Simulation::place_particles(const std::vector<Particle>& particles) {
    std::vector<std::int32_t> number(particles.size()), count(tiles_.size(), 0);
    square_sum_ = 0;
    const auto mass_of = [&](const Particle& p) { return mass_.empty() ? 1.0 : mass_[p.kind]; };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        double cell = 0;
        for (std::size_t d = 0; d < static_cast<std::size_t>(setup_.dimension); ++d) {
            cell += laws::nearest_cell_number(axis_[d], particles[i].place[d]);
            square_sum_ += mass_of(particles[i]) * particles[i].velocity[d] * particles[i].velocity[d];
        }
        number[i] = static_cast<std::int32_t>(cell);
        ++count[static_cast<std::size_t>(number[i] / tiling_.cells_per_tile())];
    }
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        tiles_[t].rows.require(static_cast<std::size_t>(count[t]), setup_.rough, false);
        tiles_[t].count = 0;
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Particle& p = particles[i];
        Tile& tile = tiles_[static_cast<std::size_t>(number[i] / tiling_.cells_per_tile())];
        const simd::GasRows row = from_row(tile.rows.view(), tile.count++);
        std::uint64_t images = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            row.place[d] = p.place[d];
            row.velocity[d] = p.velocity[d];
            if (row.spin != nullptr) row.spin[d] = p.spin[d];
            images |= (static_cast<std::uint64_t>(static_cast<std::int64_t>(p.image[d])) & 0xfffff) << 20 * d;
        }
        images |= static_cast<std::uint64_t>(p.kind) << 60;
        const std::uint64_t word = static_cast<std::uint64_t>(number[i]) << 32 | p.id;
        std::memcpy(row.place + 3, &word, sizeof word);
        std::memcpy(row.velocity + 3, &images, sizeof images);
        if (row.spin != nullptr) row.spin[3] = 0;
    }
}

void Simulation::set_safe_region() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (int d = 0; d < 3; ++d) {
        safe_lower_[d] = setup_.lower[d];
        safe_upper_[d] = setup_.upper[d];
        if (!setup_.walls.periodic[d]) {
            safe_lower_[d] += setup_.walls.side[d][0].motion.amplitude;
            safe_upper_[d] -= setup_.walls.side[d][1].motion.amplitude;
        }
        if (d >= setup_.dimension) {
            safe_lower_[d] = -infinity;
            safe_upper_[d] = infinity;
        }
    }
}

simd::GasRandom Simulation::random() const {
    const auto step = static_cast<std::uint64_t>(step_);
    return {{static_cast<std::uint32_t>(setup_.seed), static_cast<std::uint32_t>(setup_.seed >> 32)},
            static_cast<std::uint32_t>(step),
            static_cast<std::uint32_t>(step >> 32)};
}

// ---- a step

void Simulation::run(std::int64_t steps, double until) {
    if (steps <= 0 || time_ >= until) return;
    setup_.walls.time[1] = time_;
    pass({false, true});
    bool last = false;
    for (std::int64_t n = 1; !last; ++n) {
        time_ += 0.5 * next_dt_; // to the collisions
        dt_ = next_dt_;
        ++step_;
        choose_next_dt();
        setup_.walls.time[0] = time_;
        time_ += 0.5 * dt_; // to the middle between them
        setup_.walls.time[1] = time_;
        last = n == steps || time_ >= until;
        pass({true, !last});
    }
}

// From the temperature after the last collisions that are known.
void Simulation::choose_next_dt() {
    if (setup_.adaptive && square_sum_ > 0) next_dt_ = setup_.dt * std::sqrt(first_square_sum_ / square_sum_);
}

void Simulation::pass(Pass what) {
    for_tiles_dynamic(tiles_.size(), threads_,
                      [&](std::size_t tile) { work_on(static_cast<std::int32_t>(tile), what); });
    if (what.prepare) parity_ = 1 - parity_;
    far_ = false;
    double squares = 0;
    std::int64_t overflows = 0;
    for (const Result& r : results_) {
        squares += r.flight.square_sum;
        counts_.candidates += r.collisions.candidates;
        counts_.collisions += r.collisions.collisions;
        counts_.violations += r.collisions.violations;
        counts_.stuck += r.flight.stuck;
        overflows += r.collisions.overflows;
        far_ = far_ || r.far > 0;
    }
    // One flight after the other: a pass may do both, or either.
    for (const int flight : {0, 1})
        for (const Result& r : results_) wall_energy_ += r.flight.wall_energy[flight];
    if (!(squares < std::numeric_limits<double>::max()) || overflows > 0)
        fail(Exit::unstable, "step {}: {} (dt = {} s); use a smaller time step", step_,
             overflows > 0 ? "a cell wants more than a million collisions" : "velocities are not finite",
             dt_);
    if (what.collide) {
        square_sum_ = squares;
        note_decisions();
    }
}

// Kernels look at one candidate of many cells at a time; the order is that of cell after cell.
void Simulation::note_decisions() {
    for (auto& of_tile : heard_) {
        std::sort(of_tile.begin(), of_tile.end(), [](const auto& a, const auto& b) {
            return std::pair(a.cell, a.candidate) < std::pair(b.cell, b.candidate);
        });
        for (const simd::GasDecision& decision : of_tile) decisions_.push_back({step_, decision});
        of_tile.clear();
    }
}

std::vector<Decision> Simulation::take_decisions() {
    return std::exchange(decisions_, {});
}

void Simulation::work_on(std::int32_t t, Pass what) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(thread_index())];
    Tile& tile = tiles_[static_cast<std::size_t>(t)];
    Result& result = results_[static_cast<std::size_t>(t)];
    result = {};
    simd::GasFlightView view = flight_view(what);
    if (what.collide) {
        view.count = gather(t, scratch);
        collide(t, scratch, result);
        tile.rows.require(static_cast<std::size_t>(view.count), setup_.rough, false);
        view.from = scratch.sorted.view();
    } else {
        view.count = tile.count;
        view.from = tile.rows.view();
        scratch.require(static_cast<std::size_t>(view.count), setup_.rough);
    }
    view.stay = tile.rows.view();
    view.leave = scratch.leaving.view();
    view.first_cell = tiling_.first_cell(t);
    view.cells = tiling_.cells_per_tile();
    result.flight = kernels_->fly[setup_.dimension - 2](view);
    tile.count = result.flight.stay;
    if (what.prepare) send(t, scratch, result);
}

simd::GasFlightView Simulation::flight_view(Pass what) const {
    simd::GasFlightView view{};
    view.durations[0] = what.collide ? 0.5 * dt_ : 0;
    view.durations[1] = what.prepare ? 0.5 * next_dt_ : 0;
    for (int d = 0; d < 3; ++d) {
        view.gravity[d] = setup_.gravity[d];
        view.falls = view.falls || setup_.gravity[d] != 0;
        view.safe_lower[d] = safe_lower_[d];
        view.safe_upper[d] = safe_upper_[d];
        view.axis[d] = axis_[d];
    }
    view.sort = what.prepare;
    view.mass = mass_.empty() ? nullptr : mass_.data();
    view.kick = what.collide && setup_.kicks > 0 ? std::sqrt(setup_.kicks * dt_) : 0;
    view.random = random();
    view.walls = &setup_.walls;
    return view;
}

// All particles of a tile, sorted by cell: those from tiles before it, its own, those from tiles after it.
std::int32_t Simulation::gather(std::int32_t t, Scratch& scratch) const {
    auto& segments = scratch.segments;
    segments.clear();
    std::size_t total = 0;
    const auto add = [&](const Rows& rows, std::int32_t begin, std::int32_t count, bool mixed) {
        if (count == 0) return;
        const simd::GasRows at = from_row(const_cast<Rows&>(rows).view(), begin);
        segments.push_back({at.place, at.velocity, at.spin, count, mixed});
        total += static_cast<std::size_t>(count);
    };
    const auto add_slot = [&](std::int32_t source, std::int32_t slot, bool mixed) {
        const Outbox& out = tiles_[static_cast<std::size_t>(source)].out[parity_];
        const auto s = static_cast<std::size_t>(slot);
        add(out.rows, out.start[s], out.start[s + 1] - out.start[s], mixed);
    };
    const Tile& own = tiles_[static_cast<std::size_t>(t)];
    if (!far_) {
        bool own_added = false;
        for (const Neighbour& source : tiling_.sources(t)) {
            if (!own_added && source.tile > t) {
                add(own.rows, 0, own.count, false);
                own_added = true;
            }
            add_slot(source.tile, source.slot, false);
        }
        if (!own_added) add(own.rows, 0, own.count, false);
    } else {
        for (std::int32_t source = 0; source < tiling_.tiles(); ++source) {
            if (source == t) {
                add(own.rows, 0, own.count, false);
                continue;
            }
            const std::int32_t slot = tiling_.slot(source, t);
            add_slot(source, slot, slot == tiling_.far_slot());
        }
    }
    scratch.require(total, setup_.rough);
    const simd::SortView view{segments.data(),       static_cast<std::int32_t>(segments.size()),
                              tiling_.first_cell(t), tiling_.cells_per_tile(),
                              scratch.start.data(),  {scratch.next[0].data(), scratch.next[1].data()},
                              scratch.sorted.view()};
    return kernels_->sort(view);
}

void Simulation::collide(std::int32_t t, Scratch& scratch, Result& result) {
    simd::GasCollisionView view{};
    view.rows = scratch.sorted.view();
    view.start = scratch.start.data();
    view.first_cell = tiling_.first_cell(t);
    view.cells = tiling_.cells_per_tile();
    for (int n = 0; n < simd::gas_lists; ++n) view.list[n] = scratch.lists[n].data();
    view.scheme = setup_.scheme;
    view.rate = 0.5 * setup_.weight * setup_.cross_section() * dt_ / setup_.cell_volume();
    // Spins, or heavy partners, can make particles faster than any was.
    const bool mixed = !setup_.others.empty();
    view.margin = setup_.margin * (setup_.rough || mixed ? 1.2 : 1.0);
    view.mixture = mixed ? &mixture_ : nullptr;
    view.partners = setup_.partners;
    for (int d = 0; d < 3; ++d) view.near_axis[d] = setup_.cells[d] > 1 ? 1 : 0;
    view.packing = setup_.enskog ? setup_.weight * setup_.particle_volume() / setup_.cell_volume() : 0;
    view.restitution = setup_.restitution;
    view.tangential = setup_.tangential;
    view.mass_ratio = setup_.inertia / (1 + setup_.inertia);
    view.radius = 0.5 * setup_.diameter;
    view.inertia = setup_.inertia;
    view.friction = setup_.friction;
    view.random = random();
    if (!heard_.empty())
        view.listener = {[](void* to, const simd::GasDecision& decision) {
                             static_cast<std::vector<simd::GasDecision>*>(to)->push_back(decision);
                         },
                         &heard_[static_cast<std::size_t>(t)]};
    view.maxwell = 0.5 * dt_ * maxwell_rate_;
    const bool vector = setup_.scheme == laws::CollisionScheme::maxwell ||
                        setup_.scheme == laws::CollisionScheme::no_time_counter;
    const simd::DsmcKernels& kernels = vector ? *kernels_ : simd::dsmc_kernels(simd::Isa::scalar);
    result.collisions = kernels.collide[setup_.dimension - 2][setup_.rough ? 1 : 0][mixed ? 1 : 0](view);
}

// Those that leave, by the tile they go to; the order is kept.
void Simulation::send(std::int32_t t, Scratch& scratch, Result& result) {
    Outbox& out = tiles_[static_cast<std::size_t>(t)].out[1 - parity_];
    const simd::GasRows leaving = scratch.leaving.view();
    const std::int32_t count = result.flight.leave;
    Column<std::int32_t>& next = scratch.slot;
    std::fill(next.begin(), next.end(), 0);
    const std::int32_t cells = tiling_.cells_per_tile();
    std::int32_t* slots = scratch.targets.data();
    for (std::int32_t i = 0; i < count; ++i) {
        slots[i] = tiling_.slot(t, cell_of(leaving, i) / cells);
        ++next[static_cast<std::size_t>(slots[i]) + 1];
    }
    result.far = next[next.size() - 1];
    for (std::size_t s = 1; s < next.size(); ++s) next[s] += next[s - 1];
    std::copy(next.begin(), next.end(), out.start.begin());
    out.rows.require(static_cast<std::size_t>(count), setup_.rough, false);
    const simd::GasRows to = out.rows.view();
    for (std::int32_t i = 0; i < count; ++i)
        copy_row(leaving, i, to, next[static_cast<std::size_t>(slots[i])]++);
}

std::size_t Simulation::bytes() const {
    std::size_t sum = 0;
    for (const Tile& tile : tiles_)
        sum += sizeof tile + tile.rows.bytes() + tile.out[0].rows.bytes() + tile.out[1].rows.bytes() +
               2 * tile.out[0].start.size() * sizeof(std::int32_t);
    for (const Scratch& s : scratch_) {
        sum += s.sorted.bytes() + s.leaving.bytes();
        sum += (s.start.size() + 2 * s.next[0].size() + s.targets.size()) * sizeof(std::int32_t);
        for (const auto& list : s.lists) sum += list.size() * sizeof(double);
    }
    return sum;
}

} // namespace sandlane::dsmc
