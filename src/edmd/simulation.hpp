// Event-driven dynamics of hard particles by the improved algorithm: cells, states that wait for their own
// events, the next contacts of each particle, a queue of buckets (specification, 6).
#pragma once

#include "core/column.hpp"
#include "core/hash.hpp"
#include "edmd/event_log.hpp"
#include "edmd/physics.hpp"
#include "edmd/queue.hpp"
#include "edmd/setup.hpp"
#include "simd/edmd/tables.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::edmd {

// Sums over all particles, in the order of their ids.
struct Observables {
    double temperature = 0;         // m <(v - u)^2>/d, J
    std::vector<double> of_class;   // the same of each class
    double spin_temperature = 0;    // J <w^2> per component, J; 0: smooth
    double energy = 0;              // kinetic, of translation and spin, J
    double fourth = 0;              // a2, of the thermal energies
    std::array<double, 3> drift{};  // u of the centre of mass, m/s
};
[[nodiscard]] Observables observe(const Setup& setup, const std::vector<Particle>& particles);

class Simulation {
public:
    // Throws Error(invalid_input) for a box of fewer than three cells in a periodic direction.
    Simulation(Setup setup, const std::vector<Particle>& particles, simd::Isa isa, int threads);

    // Takes so many events, collisions and hits of walls, but none later than `until` on the clock; returns
    // how many. The clock stands at the last one, or at `until` if it was reached.
    std::int64_t run(std::int64_t events, double until = std::numeric_limits<double>::infinity());

    [[nodiscard]] double time() const { return clock_.time(); }
    [[nodiscard]] const Setup& setup() const { return setup_; }
    [[nodiscard]] std::size_t size() const { return states_.size(); }
    [[nodiscard]] const Tally& tally() const { return tally_; }
    [[nodiscard]] const EventLog& log() const { return log_; }
    [[nodiscard]] EventLog& log() { return log_; }
    [[nodiscard]] const Work& work() const { return work_; }
    [[nodiscard]] std::size_t bytes() const;

    // At the time of the clock, by id.
    [[nodiscard]] std::vector<Particle> particles() const;
    [[nodiscard]] Hash128 state_hash() const;
    // Complete state for checkpoints; restore() needs a Simulation of the same particles and box.
    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes); // throws Error(io) for a state of something else
    // Goes on with the kernels of another instruction set.
    void use(simd::Isa isa);

private:
    template <int dimension, bool special> std::int64_t loop(std::int64_t events, double until);
    template <int dimension, bool special> void cross(std::uint32_t i);
    template <int dimension, bool special> void collide_pair(std::uint32_t i, std::uint32_t j);
    template <int dimension> void meet_side(std::uint32_t i, std::uint32_t wall);
    template <int dimension> void settle(std::uint32_t i, const Body& body, std::uint32_t partner);
    template <int dimension> void fold(std::uint32_t i);
    // layer < 0: the complete search, else of what is new through that face.
    template <int dimension, bool special> void search(std::uint32_t i, int layer);
    template <int dimension, bool special> void look_for_crossing(std::uint32_t i);
    template <int dimension, bool special> void renew(std::uint32_t i);
    template <int dimension, bool special>
    [[nodiscard]] bool still_meets(std::uint32_t i, std::uint32_t j, double time) const;
    template <int dimension> [[nodiscard]] Vector<double> shift_of(std::uint32_t i, std::uint32_t j) const;
    template <int dimension, bool special> void predict_all();
    template <int dimension, class Row> void for_rows(std::uint32_t i, int layer, const Row& row) const;
    template <int dimension> void fetch_cells(std::uint32_t i, int layer) const;
    template <int dimension> void fetch_states(std::uint32_t i, int layer) const;
    template <int dimension> void look_ahead();
    void dispatch_predict_all();
    template <int dimension> void synchronise();
    void settle_tie();
    [[nodiscard]] std::vector<std::uint32_t> order_by_id() const;
    [[nodiscard]] std::string frame() const;
    [[nodiscard]] std::int64_t cell_number(const std::uint16_t (&cell)[3]) const;
    void add_to_cell(std::int64_t cell, std::uint32_t i);
    void take_from_cell(std::int64_t cell, std::uint32_t i);
    void choose_cells();
    void place_particles(const std::vector<Particle>& particles);
    void begin_epoch();
    void sort_by_cell();
    void set_epoch_end();

    Setup setup_;
    const simd::EdmdKernels* kernels_;
    simd::HardSearchNear search_near_;
    int threads_;
    bool special_;
    Clock clock_;
    Tally tally_;
    EventLog log_;
    Work work_;
    double now_ = 0; // of the epoch

    Column<simd::HardState> states_;
    Column<simd::HardEvents> events_;
    Column<simd::HardCell> cells_; // and what goes on from full ones
    std::uint32_t free_cell_ = 0;
    std::int64_t cell_count_ = 0;
    double edge_[3] = {1, 1, 1};
    Column<std::int32_t> turns_;   // boxes crossed until the last fold, three for each particle
    std::vector<Vector<double>> spin_; // rough particles
    simd::HardSearch view_{};
    std::vector<double> radius_;
    Queue queue_;
    bool far_ = false; // more than the cache next to a core holds: what comes up is fetched ahead
    std::int64_t epoch_events_ = 0; // in this epoch
    double epoch_end_ = 0;          // of this epoch at the latest
};

} // namespace sandlane::edmd
