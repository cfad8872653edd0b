#include "md/simulation.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "md/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace sandlane::md {

using scene::NeighbourMethod;

namespace {

constexpr std::int32_t cell_tile_rows = 4;
constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Simulation::Simulation(scene::Scene scene, std::vector<scene::GrainState> grains, const Needs& needs,
                       Plan plan)
    : scene_(std::move(scene)), needs_(needs), plan_(std::move(plan)), kernels_(&simd::md_kernels(plan_.isa)),
      coefficients_(pair_table(scene_)), walls_(scene_, plan_, needs_) {
    state_.prepare(plan_, scene_.domain);
    prepare_method();
    start(std::move(grains));
}

// What the method of pair finding needs, for an unsorted state.
void Simulation::prepare_method() {
    lattice_ = Lattice();
    cells_ = LinkCells();
    lists_ = PairLists();
    state_.double_records = plan_.neighbours == NeighbourMethod::verlet;
    state_.resize_buffers();
    if (is_lattice(plan_.neighbours)) {
        lattice_ = Lattice(scene_, plan_, needs_.radius_max);
    } else if (plan_.neighbours == NeighbourMethod::verlet) {
        lists_ = PairLists(scene_, plan_, needs_);
        accumulators_.assign(static_cast<std::size_t>(plan_.threads),
                             Column<double>((tile_size + block_width) * state_.force_stride(), 0.0));
    } else {
        cells_ = LinkCells(scene_, plan_, needs_, plan_.neighbours == NeighbourMethod::brute_force);
    }
}

scene::GrainState Simulation::with_shear_flow(scene::GrainState grain) const {
    const double middle = 0.5 * (plan_.lower.y + plan_.upper.y);
    grain.velocity.x += scene_.domain.shear_rate * (grain.position.y - middle);
    return grain;
}

// Accelerations before the first step: without them every velocity would keep an error of a dt/2.
void Simulation::start(std::vector<scene::GrainState> grains) {
    for (const scene::GrainState& g : grains)
        if (g.insert_at > -infinity)
            waiting_.push_back(g);
        else
            state_.append(with_shear_flow(g), plan_.dt);
    grains = std::vector<scene::GrainState>(); // they may be many: free now
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const auto& a, const auto& b) { return a.insert_at < b.insert_at; });
    sort_by_place();
    bin();
    {
        const std::vector<double> forces = take_forces();
        const simd::MotionView view = motion_view(force_step_);
        for (std::size_t i = 0; i < state_.size(); ++i)
            state_.set_accelerations(i, forces.data() + i * state_.force_stride(), view);
    }
    wall_work_ = shear_work_ = 0;
    initial_energy_ = observe().energy();
    begin_balance();
}

// ---- the time step

void Simulation::run(std::int64_t steps) {
    const std::int64_t end = step_ + steps;
    while (step_ < end) {
        insert_due();
        if (step_ % sort_steps() == 0 || !sorted_) {
            empty_sinks();
            choose_time_step();
            sort_by_place();
        }
        const std::int64_t stop = next_stop(end);
        integrate(false, true);
        still_builds_ = -1; // the records were written in place
        while (step_ < stop) {
            const bool predict = step_ + plan_.stride < stop;
            if (plan_.neighbours == NeighbourMethod::verlet) {
                forces_and_motion(predict);
            } else {
                compute_forces();
                integrate(true, predict);
            }
            step_ += plan_.stride;
            ++taken_;
        }
    }
}

// First step at or after the time of insertion; one rule for looking ahead and for inserting, whatever the
// rounding.
std::int64_t Simulation::insertion_step(const scene::GrainState& grain) const {
    const double at = std::ceil(grain.insert_at / plan_.tick * (1 - 1e-14));
    return at < 9e15 ? static_cast<std::int64_t>(at) : std::numeric_limits<std::int64_t>::max();
}

std::int64_t Simulation::next_stop(std::int64_t end) const {
    const std::int64_t interval = sort_steps();
    std::int64_t stop = std::min(end, (step_ / interval + 1) * interval);
    if (next_waiting_ < waiting_.size())
        stop = std::min(stop, std::max(step_ + 1, insertion_step(waiting_[next_waiting_])));
    return (stop + plan_.stride - 1) / plan_.stride * plan_.stride;
}

void Simulation::integrate(bool correct, bool predict) {
    const simd::MotionKernel kernel = motion_kernel(correct, predict);
    simd::MotionView whole = motion_view(force_step_);
    const std::size_t n = state_.size();
    const bool on_lattice = predict && is_lattice(plan_.neighbours);
    motion_results_.assign(state_.tiles(), {});
    for_tiles(state_.tiles(), plan_.threads, [&](std::size_t tile) {
        const std::size_t begin = tile * tile_size, end = std::min(n, begin + tile_size);
        simd::MotionView view = whole;
        if (correct) view.force += begin * state_.force_stride();
        motion_results_[tile] =
            kernel(view, static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end));
        if (on_lattice && motion_results_[tile].outside == 0)
            lattice_.leave(state_, kernels_->plane.bin, begin, end);
    });
    if (predict) check_motion();
}

simd::MotionKernel Simulation::motion_kernel(bool correct, bool predict) const {
    const auto& table = correct ? (predict ? kernels().advance : kernels().correct) : kernels().predict;
    return table[plan_.scheme - 3][static_cast<int>(plan_.rotation)];
}

// One pass over the tiles: forces at the predicted positions, correction, and the next prediction, whose
// records go to the other buffer because tiles that come later still need these.
void Simulation::forces_and_motion(bool predict) {
    const simd::MotionKernel kernel = motion_kernel(true, predict);
    simd::MotionView whole = motion_view(force_step_ + plan_.stride);
    whole.new_records = state_.next_record.data();
    whole.new_spins = state_.next_spin.data();
    move_walls();
    lists_.update(state_, pair_view(), kernels(), plan_.threads, force_time());
    // What a tile that is stepped over gave last time still holds.
    motion_results_.resize(state_.tiles());
    wall_results_.resize(state_.tiles());
    tile_overlaps_.resize(state_.tiles());
    if (sums_) tile_sums_.resize(state_.tiles());
    const bool watch = plan_.freeze && predict;
    if (watch) watch_still_tiles();
    for_tiles(state_.tiles(), plan_.threads, [&](std::size_t tile) {
        if (watch && still_.can_skip(tile)) return;
        if (!watch) return step_tile(tile, kernel, whole);
        const auto look = [&](const auto& at) { // the list and what walls remember, before or after
            at(lists_.tile(tile, state_), simd::memory_row(plan_.memory), walls_.memory_of_tile(tile));
        };
        if (still_.at_rest(tile))
            look([&](const simd::TileList& list, int row, const std::vector<double>& of_walls) {
                still_.before(tile, state_, list, row, of_walls);
            });
        step_tile(tile, kernel, whole);
        look([&](const simd::TileList& list, int row, const std::vector<double>& of_walls) {
            still_.after(tile, state_, list, row, of_walls, walls_.moves_near(tile));
        });
    });
    if (watch) still_.advance();
    check_overlap(largest_overlap());
    check_walls();
    add_wall_work();
    add_shear_work();
    if (sums_) add_balance();
    force_step_ += plan_.stride;
    state_.record.swap(state_.next_record);
    state_.spin.swap(state_.next_spin);
    if (predict) check_motion();
}

// Forces at the predicted positions and what follows from them for the grains of one tile.
void Simulation::step_tile(std::size_t tile, simd::MotionKernel kernel, simd::MotionView view) {
    const std::size_t begin = tile * tile_size, end = std::min(state_.size(), begin + tile_size);
    view.force = add_tile_forces(tile);
    motion_results_[tile] = kernel(view, static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end));
}

// m, of all tiles.
double Simulation::largest_overlap() const {
    return std::accumulate(tile_overlaps_.begin(), tile_overlaps_.end(), 0.0,
                           [](double a, double b) { return std::max(a, b); });
}

// What is known of tiles at rest holds for the lists that it was seen with.
void Simulation::watch_still_tiles() {
    const std::int64_t builds = lists_.builds() + walls_.builds();
    if (builds != still_builds_)
        still_.reset(state_.tiles());
    else if (lists_.refreshes() != still_refreshes_)
        for (std::size_t tile = 0; tile < state_.tiles(); ++tile)
            still_.see_list(tile, lists_.tile(tile, state_));
    still_builds_ = builds;
    still_refreshes_ = lists_.refreshes();
}

// Forces on the grains of a tile in the calling thread's accumulator, which the motion kernel clears.
double* Simulation::add_tile_forces(std::size_t tile) {
    double* force = accumulators_[static_cast<std::size_t>(thread_index())].data();
    const simd::TileKernel kernel = tile_kernel();
    tile_overlaps_[tile] = kernel(pair_view(), lists_.tile(tile, state_), force, 0.0);
    if (sums_) sum_forces(tile, force, false);
    if (!walls_.empty())
        wall_results_[tile] = walls_.add_forces(wall_input(force, tile * tile_size), tile, state_.size(),
                                                plan_.isa != simd::Isa::scalar);
    if (sums_) sum_forces(tile, force, true);
    return force;
}

// After a prediction: orientations, guards on the speed, lists and lattice follow the grains, grains outside
// leave.
void Simulation::check_motion() {
    if (plan_.orientation) turn_grains(state_, plan_.threads);
    double shift2 = 0;
    std::int64_t outside = 0;
    for (const simd::MotionResult& r : motion_results_) {
        shift2 = std::max(shift2, r.largest_shift2);
        outside += r.outside;
    }
    largest_speed_ = std::sqrt(shift2) / plan_.dt;
    for (const simd::MotionResult& r : motion_results_) {
        const double gain = r.seam_gain / (plan_.dt * plan_.dt);
        shear_work_ += gain;
        balance_.crossing += gain;
    }
    if (largest_speed_ * plan_.dt > 0.1 * needs_.radius_min)
        fail(
            Exit::unstable,
            "step {}, t = {:.6g} s: a grain moves at {:.4g} m/s, {:.3g} m per step, more than 0.1 R_min = "
            "{:.3g} m. The time step is too large for this flow, or the run has become unstable; lower md.dt "
            "below {:.3g} s.",
            step_, time(), largest_speed_, largest_speed_ * plan_.dt, 0.1 * needs_.radius_min,
            0.1 * needs_.radius_min / largest_speed_ * base_time_step(plan_) / plan_.dt);
    // The factor covers what a contact changes of the speed within the step.
    walls_.account(1.25 * plan_.dt * (largest_speed_ + walls_.fastest()));
    const double seam_speed = std::abs(scene_.domain.shear_rate) * (plan_.upper.y - plan_.lower.y);
    lists_.account(1.25 * plan_.dt * (largest_speed_ + 0.5 * seam_speed));
    if (outside > 0) return handle_outside();
    if (is_lattice(plan_.neighbours))
        for_tiles(state_.tiles(), plan_.threads, [&](std::size_t tile) {
            lattice_.enter(state_, tile * tile_size, std::min(state_.size(), (tile + 1) * tile_size));
        });
}

void Simulation::move_walls() {
    walls_.move_to(force_time());
    walls_.update(state_, state_.record.data());
}

// Forces at the predicted positions, time (step + 1) dt, where the method keeps them; at the start, of the
// initial state.
void Simulation::compute_forces() {
    move_walls();
    pair_forces();
    const auto sum = [&](bool walls) {
        if (!sums_) return;
        tile_sums_.resize(state_.tiles());
        for_tiles(state_.tiles(), plan_.threads, [&](std::size_t tile) {
            sum_forces(tile, state_.force.data() + tile * tile_size * state_.force_stride(), walls);
        });
    };
    sum(false);
    wall_forces();
    sum(true);
    add_wall_work();
    if (sums_) add_balance();
    force_step_ += plan_.stride;
}

// The same for every method: [particle][force_stride], and none are left.
std::vector<double> Simulation::take_forces() {
    std::vector<double> forces(state_.size() * state_.force_stride());
    if (plan_.neighbours != NeighbourMethod::verlet) {
        compute_forces();
        std::copy_n(state_.force.data(), forces.size(), forces.data());
        state_.force.fill(0.0);
        return forces;
    }
    move_walls();
    lists_.update(state_, pair_view(), kernels(), plan_.threads, force_time());
    tile_overlaps_.assign(state_.tiles(), 0.0);
    wall_results_.assign(state_.tiles(), {});
    if (sums_) tile_sums_.assign(state_.tiles(), {});
    for (std::size_t tile = 0; tile < state_.tiles(); ++tile) {
        double* force = add_tile_forces(tile);
        const std::size_t begin = tile * tile_size, count = std::min(state_.size() - begin, tile_size);
        for (std::size_t n = 0; n < count * state_.force_stride(); ++n)
            forces[begin * state_.force_stride() + n] = std::exchange(force[n], 0.0);
    }
    check_overlap(largest_overlap());
    check_walls();
    add_wall_work();
    add_shear_work();
    if (sums_) add_balance();
    force_step_ += plan_.stride;
    return forces;
}

void Simulation::pair_forces() {
    const simd::PairKernel pair = law().pair[static_cast<int>(plan_.couples)][plan_.many_materials ? 1 : 0];
    const simd::PairView pairs = pair_view();
    const bool on_lattice = is_lattice(plan_.neighbours);
    if (!on_lattice) cells_.build(state_, kernels().bin, plan_.threads);
    const std::int32_t height = on_lattice ? lattice_.tile_rows() : cell_tile_rows;
    const std::int32_t rows = on_lattice ? lattice_.rows() : cells_.rows();
    const auto tiles = static_cast<std::size_t>((rows + height - 1) / height);
    const simd::LatticeView sites = lattice_.view();
    const simd::CellView cells = cells_.view();
    const auto& lattice_kernels =
        plan_.neighbours == NeighbourMethod::lattice_half ? kernels_->lattice_half : kernels_->lattice_full;
    const simd::LatticeKernel lattice_kernel = lattice_kernels[plan_.many_radii ? 1 : 0];
    std::vector<simd::SweepResult> results(tiles);
    for_tiles_dynamic(tiles, plan_.threads, [&](std::size_t tile) {
        const std::int32_t begin = static_cast<std::int32_t>(tile) * height,
                           end = std::min(rows, begin + height);
        results[tile] = on_lattice ? lattice_kernel(sites, pairs, pair, begin, end)
                                   : kernels().cells(cells, pairs, pair, begin, end);
    });
    double overlap = 0;
    std::int64_t occupied = 0;
    for (const simd::SweepResult& r : results) {
        overlap = std::max(overlap, r.largest_overlap);
        occupied += r.occupied;
    }
    if (occupied != static_cast<std::int64_t>(state_.size())) {
        const Lattice::Clash clash = lattice_.find_clash(state_);
        const auto a = static_cast<std::size_t>(clash.first), b = static_cast<std::size_t>(clash.second);
        use_link_cells();
        events_.push_back(
            fmt::format("DELTA_EXCEEDED: grains {} and {} share a lattice site at step {}: their "
                        "overlap exceeds delta = {} of R_min; link cells from here on",
                        state_.id[a], state_.id[b], step_, scene_.md.delta));
        state_.force.fill(0.0);
        return pair_forces();
    }
    check_overlap(overlap);
}

void Simulation::wall_forces() {
    if (walls_.empty()) return;
    wall_results_.assign(state_.tiles(), {});
    for_tiles(state_.tiles(), plan_.threads, [&](std::size_t tile) {
        const std::size_t first = tile * tile_size;
        wall_results_[tile] =
            walls_.add_forces(wall_input(state_.force.data() + first * state_.force_stride(), first), tile,
                              state_.size(), plan_.isa != simd::Isa::scalar);
    });
    check_walls();
}

void Simulation::check_walls() {
    WallResult worst;
    for (const WallResult& r : wall_results_)
        if (r.largest_ratio > worst.largest_ratio) worst = r;
    if (scene_.watch.overlap.asked && worst.grain >= 0) see_wall(worst);
    if (worst.largest_ratio < 0.9) return;
    fail(Exit::unstable,
         "step {}, t = {:.6g} s: grain {} overlaps wall \"{}\" by {:.3g} of its radius (allowed: 0.9). "
         "Stiffen the material, lower md.dt, or check the wall's motion.",
         step_, time(), state_.id[static_cast<std::size_t>(worst.grain)],
         scene_.walls[static_cast<std::size_t>(worst.wall)].name, worst.largest_ratio);
}

void Simulation::add_wall_work() {
    double power = 0;
    for (const WallResult& r : wall_results_) power += r.power;
    wall_work_ += 0.5 * plan_.dt * (wall_power_ + power);
    wall_power_ = power;
}

} // namespace sandlane::md
