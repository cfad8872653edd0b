// Direct simulation Monte Carlo of a granular gas: flight, sorting and collisions tile by tile, in one pass
// over the particles per step.
#pragma once

#include "core/column.hpp"
#include "core/hash.hpp"
#include "dsmc/setup.hpp"
#include "dsmc/tiling.hpp"
#include "simd/dsmc/tables.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace sandlane::dsmc {

struct Counts {
    std::int64_t candidates = 0, collisions = 0, violations = 0, stuck = 0;
};

struct Decision {
    std::int64_t step;
    simd::GasDecision of;
};

// Sums over all particles, in the order of their ids, without the flow of a sheared gas.
struct Observables {
    double temperature = 0;           // m <(v - u)^2>/d, J
    double spin_temperature = 0;      // J <w^2> per component, J; 0: smooth
    double energy = 0;                // kinetic, of translation and spin, of all real particles, J
    double fourth = 0;                // a2 = <c^4> 4/(d (d + 2)) - 1 of c = v sqrt(m/2T)
    std::array<double, 3> drift{};    // u, m/s
    double directions[3] = {0, 0, 0}; // m <(v - u)^2> of each component, J
    std::vector<double> of_kind;      // temperature of each kind, J
    double shear_stress = 0;          // -p_xy of the flights, Pa; N/m in the plane
};

class Simulation {
public:
    Simulation(const Setup& setup, const std::vector<Particle>& particles, simd::Isa isa, int threads);

    // Takes n steps, or so many that time() reaches `until`; steps in one call or several are the same, bit
    // for bit. The state is that of the middle of a step, half a flight after the collisions, which makes the
    // splitting of flight and collisions second order in dt.
    void run(std::int64_t steps, double until = std::numeric_limits<double>::infinity());
    // Goes on with the kernels of another instruction set.
    void use(simd::Isa isa) { kernels_ = &simd::dsmc_kernels(isa); }

    // From now on: what became of every candidate, by step, cell and candidate.
    void keep_decisions() { heard_.resize(tiles_.size()); }
    [[nodiscard]] std::vector<Decision> take_decisions(); // since the last call

    [[nodiscard]] std::int64_t step() const { return step_; }
    [[nodiscard]] double time() const { return time_; }
    [[nodiscard]] double dt() const { return dt_; } // of the last step
    [[nodiscard]] const Setup& setup() const { return setup_; }
    [[nodiscard]] const Tiling& tiling() const { return tiling_; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] const Counts& counts() const { return counts_; }
    // Energy that walls gave to the gas, real particles, J.
    [[nodiscard]] double wall_energy() const { return wall_energy_ * setup_.mass * setup_.weight; }

    [[nodiscard]] std::vector<Particle> particles() const; // by id
    [[nodiscard]] Observables observe() const;
    [[nodiscard]] Hash128 state_hash() const;

    // Complete state for checkpoints; restore() needs a Simulation of the same setup.
    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes); // throws Error(io) for a state of another box, cells or dt

private:
    [[nodiscard]] std::string frame() const;
    struct Rows {
        Column<double> place, velocity, spin;
        void require(std::size_t rows, bool rough, bool keep);
        [[nodiscard]] simd::GasRows view();
        [[nodiscard]] std::size_t capacity() const { return place.size() / simd::gas_row; }
        [[nodiscard]] std::size_t bytes() const { return place.bytes() + velocity.bytes() + spin.bytes(); }
    };
    // Particles that leave a tile in one pass, by slot.
    struct Outbox {
        Rows rows;
        std::vector<std::int32_t> start;
    };
    struct alignas(column_alignment) Tile {
        Rows rows;
        std::int32_t count = 0;
        Outbox out[2];
    };
    // Of a thread. Aligned columns, so that no two threads write to one line of the cache.
    struct alignas(column_alignment) Scratch {
        Rows sorted, leaving;
        Column<std::int32_t> start, next[2], slot, targets;
        Column<double> lists[simd::gas_lists];
        std::vector<simd::GasSegment> segments;
        void require(std::size_t rows, bool rough);
    };
    struct alignas(column_alignment) Result {
        simd::GasCollisions collisions;
        simd::GasFlight flight;
        std::int64_t far = 0;
    };
    // What a pass over the tiles does: collisions and the flight after them, the flight before the next ones.
    struct Pass {
        bool collide, prepare;
    };

    void place_particles(const std::vector<Particle>& particles);
    void pass(Pass what);
    void work_on(std::int32_t tile, Pass what);
    [[nodiscard]] std::int32_t gather(std::int32_t tile, Scratch& scratch) const;
    void collide(std::int32_t tile, Scratch& scratch, Result& result);
    void note_decisions();
    void send(std::int32_t tile, Scratch& scratch, Result& result);
    [[nodiscard]] simd::GasFlightView flight_view(Pass what) const;
    void choose_next_dt();
    void find_maxwell_rate();
    void set_safe_region();
    [[nodiscard]] simd::GasRandom random() const;
    template <class Body> void for_rows(const Body& body) const;

    Setup setup_;
    simd::GasMixture mixture_;
    Tiling tiling_;
    const simd::DsmcKernels* kernels_;
    int threads_;
    std::size_t size_ = 0;
    std::vector<Tile> tiles_;
    std::vector<Scratch> scratch_;
    std::vector<Result> results_;
    laws::CellAxis axis_[3];
    double safe_lower_[3], safe_upper_[3];
    int parity_ = 0;   // of the outboxes that were written last
    bool far_ = false; // some of them go beyond the neighbours
    std::int64_t step_ = 0;
    double time_ = 0, dt_ = 0, next_dt_ = 0;
    double square_sum_ = 0,
           first_square_sum_ = 0; // of the velocities by mass, after the last collisions, at the start
    std::vector<double> mass_; // of the kinds over that of the first where the step follows them, else empty
    double maxwell_rate_ = 0;  // of Maxwell molecules, else 0, 1/s
    Counts counts_;
    double wall_energy_ = 0;
    std::vector<std::vector<simd::GasDecision>> heard_; // of this step, by tile; empty: nobody listens
    std::vector<Decision> decisions_;
};

} // namespace sandlane::dsmc
