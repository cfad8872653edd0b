// Force-based molecular dynamics of discs and spheres: the time step, and what happens between steps.
#pragma once

#include "analysis/snapshot.hpp"
#include "analysis/watched.hpp"
#include "core/bytes.hpp"
#include "core/hash.hpp"
#include "md/balance.hpp"
#include "md/lattice.hpp"
#include "md/link_cells.hpp"
#include "md/observables.hpp"
#include "md/pair_lists.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "md/still_tiles.hpp"
#include "md/walls.hpp"
#include "scene/cell_grid.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::md {

// Steps from one sort of the storage to the next; fixed, because link cells add forces in storage order.
inline constexpr std::int64_t sort_interval = 256;

class Simulation {
public:
    Simulation(scene::Scene scene, std::vector<scene::GrainState> grains, const Needs& needs, Plan plan);

    // Runs n time steps; afterwards the state stands at time() = step() tick. Where the time step adapts, n
    // counts ticks, and the run ends with the first whole step at or after them.
    void run(std::int64_t steps);

    [[nodiscard]] std::int64_t step() const { return step_; }
    [[nodiscard]] double time() const { return static_cast<double>(step_) * plan_.tick; }
    // Time steps that run() has taken, of whatever length.
    [[nodiscard]] std::int64_t taken() const { return taken_; }
    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] const State& state() const { return state_; }
    [[nodiscard]] std::size_t bytes() const {
        return state_.bytes() + lattice_.bytes() + cells_.bytes() + lists_.bytes();
    }

    // Energies, contacts and overlaps of the present state; see observables.hpp.
    [[nodiscard]] Observables observe() const;
    [[nodiscard]] analysis::Snapshot snapshot() const;
    // The contacts of snapshot().
    [[nodiscard]] analysis::Contacts contacts() const;
    // 128-bit hash over the id-ordered state: equal hashes mean equal bits.
    [[nodiscard]] Hash128 state_hash() const;

    // Forces of the present state [particle][force_stride] by the plan's kernels, or by another table
    // (reference).
    [[nodiscard]] std::vector<double> forces(simd::Isa isa, scene::NeighbourMethod method) const;

    // Work of moving walls on the grains since the start, J: trapezoidal sum over all steps.
    [[nodiscard]] double wall_work() const { return wall_work_; }
    // Work of a shear flow without walls, J: of the forces across its seam, trapezoidal sum over all steps,
    // and what grains gain as they cross it.
    [[nodiscard]] double shear_work() const { return shear_work_; }
    // Energy that poured grains brought less what removed ones took, J.
    [[nodiscard]] double added_energy() const { return added_energy_; }
    // What the contacts have taken so far, J: initial + added energy + work of the walls and of the
    // shear - present energy.
    // Includes the elastic energy left when a law's force is cut at zero, and the error of the integrator.
    [[nodiscard]] double dissipated(const Observables& now) const {
        return initial_energy_ + added_energy_ + wall_work_ + shear_work_ - now.energy();
    }

    // Errors of the run so far, of those that the scene watches; `now` are the observables of the present
    // state.
    [[nodiscard]] analysis::Watched watch(const Observables& now);
    [[nodiscard]] const Balance& balance() const { return balance_; }

    // Tiles of grains at rest that the next step goes over, as things stand; see md.freeze.
    [[nodiscard]] std::size_t still_tiles() const { return plan_.freeze ? still_.skipped() : 0; }
    [[nodiscard]] std::int64_t removed() const { return removed_; }
    [[nodiscard]] std::int64_t delayed() const { return delayed_; }
    [[nodiscard]] const std::vector<std::string>& events() const { return events_; }

    // Complete state for checkpoints; restore() needs a Simulation made from the same scene.
    void serialise(ByteWriter& out) const;
    [[nodiscard]] std::string serialise() const; // the same, whole
    void restore(std::string_view bytes);

private:
    void prepare_method();
    void start(std::vector<scene::GrainState> grains);
    void sort_by_place();
    void insert_due();
    void use_link_cells();
    void choose_time_step();
    void set_stride(std::int64_t stride);
    [[nodiscard]] double wanted_time_step() const;
    class Room;
    void empty_sinks();
    void take_out(std::size_t grain, double ahead);
    void keep(const std::vector<std::uint32_t>& kept);

    void integrate(bool correct, bool predict);
    void forces_and_motion(bool predict);
    void check_motion();
    void bin();
    void pair_forces();
    void wall_forces();
    void check_walls();
    void add_wall_work();
    void add_shear_work();
    [[nodiscard]] double seam_power(std::size_t tile);
    void compute_forces();
    [[nodiscard]] std::vector<double> take_forces();
    void watch_still_tiles();
    [[nodiscard]] double largest_overlap() const;
    void step_tile(std::size_t tile, simd::MotionKernel kernel, simd::MotionView view);
    void move_walls();
    // Of the positions that forces are wanted for next, s.
    [[nodiscard]] double force_time() const { return static_cast<double>(force_step_) * plan_.tick; }
    [[nodiscard]] simd::MotionKernel motion_kernel(bool correct, bool predict) const;
    [[nodiscard]] const simd::DimensionKernels& kernels() const { return kernels_->in(plan_.dimension); }
    [[nodiscard]] const simd::DimensionKernels::Law& law() const {
        return kernels().law[plan_.normal][plan_.tangential];
    }
    [[nodiscard]] simd::TileKernel tile_kernel() const {
        const int materials = plan_.many_materials ? 1 : 0;
        return plan_.resolved ? law().resolved[materials]
                              : law().tile[static_cast<int>(plan_.couples)][materials];
    }
    [[nodiscard]] double* add_tile_forces(std::size_t tile);
    [[nodiscard]] md::WallInput wall_input(double* force, std::size_t first) const;
    [[nodiscard]] bool is_inside(Vec p) const;
    void handle_outside();
    [[noreturn]] void fail_overlap() const;
    void check_overlap(double overlap);
    struct Touching {
        std::size_t first, second; // storage indices, first the one of the smaller id
        double overlap, distance;  // m
    };
    // The pair that overlaps most at the predicted positions, in m or relative to the smaller radius.
    [[nodiscard]] Touching deepest_pair(bool relative) const;
    void see_overlap(double overlap);
    void see_wall(const WallResult& worst);
    void note_overlap(double ratio, const Place& where, double time);
    [[nodiscard]] std::string text_of(Vec position) const;
    [[nodiscard]] std::string text_of(const Place& contact) const;

    // 1, and 2 where no contact loses energy, and 4 where forces are summed.
    [[nodiscard]] double balance_kind() const;
    void begin_balance();
    void sum_forces(std::size_t tile, const double* force, bool all);
    [[nodiscard]] double power_of(std::size_t grain, const double* force) const;
    void add_balance();
    [[nodiscard]] double balanced_energy(const Observables& now) const;
    [[nodiscard]] double energy_residual(const Observables& now) const;
    [[nodiscard]] double momentum_error(const Observables& now) const;
    void add_step_error(analysis::Watched& w) const;
    [[nodiscard]] simd::MotionView motion_view(std::int64_t predicted);
    [[nodiscard]] scene::GrainState with_shear_flow(scene::GrainState grain) const;
    [[nodiscard]] double seam(double time) const;
    [[nodiscard]] scene::Box box(double time) const;
    [[nodiscard]] simd::PairView pair_view();
    // From one sort to the next, where steps of all lengths meet.
    [[nodiscard]] std::int64_t sort_steps() const {
        const std::int64_t whole = plan_.largest_stride;
        return (sort_interval * plan_.stride + whole - 1) / whole * whole;
    }
    [[nodiscard]] std::int64_t insertion_step(const scene::GrainState& grain) const;
    [[nodiscard]] std::int64_t next_stop(std::int64_t end) const;

    scene::Scene scene_;
    Needs needs_;
    Plan plan_;
    const simd::MdKernels* kernels_;
    std::vector<double> coefficients_;
    State state_;
    Lattice lattice_;
    LinkCells cells_;
    PairLists lists_;
    StillTiles still_;                                      // with md.freeze
    std::int64_t still_builds_ = -1, still_refreshes_ = -1; // of the lists that it knows
    // Results of the tiles of one pass, and force accumulators of the threads.
    std::vector<simd::MotionResult> motion_results_;
    std::vector<WallResult> wall_results_;
    std::vector<double> tile_overlaps_;
    std::vector<TileSums> tile_sums_; // where forces are summed
    bool sums_ = false;
    Balance balance_;
    Place deepest_; // where the largest overlap was
    std::vector<Column<double>> accumulators_;
    Walls walls_;
    std::vector<scene::GrainState> waiting_; // poured grains, by time of insertion
    std::size_t next_waiting_ = 0;
    std::int64_t step_ = 0, force_step_ = 0, removed_ = 0, delayed_ = 0, taken_ = 0;
    double largest_speed_ = 0;
    double initial_energy_ = 0, added_energy_ = 0, wall_work_ = 0, wall_power_ = 0;
    double shear_work_ = 0, shear_power_ = 0;
    std::vector<std::string> events_;
    bool sorted_ = false;
};

} // namespace sandlane::md
