// Event-driven dynamics of hard particles by the improved algorithm: cells, states that wait for their own
// events, the next contacts of each particle, a queue of buckets (specification, 6).
#pragma once

#include "core/column.hpp"
#include "edmd/algorithm.hpp"
#include "edmd/queue.hpp"
#include "simd/edmd/tables.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::edmd {

class Simulation final : public Algorithm {
public:
    // Throws Error(invalid_input) for a box of fewer than three cells in a periodic direction.
    Simulation(Setup setup, const std::vector<Particle>& particles, simd::Isa isa, int threads);

    std::int64_t run(std::int64_t events, double until = std::numeric_limits<double>::infinity()) override;
    [[nodiscard]] std::size_t size() const override { return states_.size(); }
    [[nodiscard]] std::size_t bytes() const override;
    [[nodiscard]] const Work& work() const { return work_; }
    [[nodiscard]] std::vector<RawState> raw_states() const override;
    [[nodiscard]] std::string serialise() const override;
    void restore(const std::string& bytes) override;
    [[nodiscard]] std::array<std::int32_t, 3> cells() const {
        return {view_.count[0], view_.count[1], view_.count[2]};
    }

private:
    template <int dimension, bool special> std::int64_t loop(std::int64_t events, double until);
    template <int dimension, bool special> void cross(std::uint32_t i);
    template <int dimension, bool special> void collide_pair(std::uint32_t i, std::uint32_t j);
    template <int dimension> void meet_side(std::uint32_t i, std::uint32_t wall);
    template <int dimension, bool special>
    void settle(std::uint32_t i, const Body& body, std::uint32_t partner);
    template <int dimension, bool special> void fold(std::uint32_t i);
    // layer < 0: the complete search, else of what is new through that face.
    template <int dimension, bool special> void search(std::uint32_t i, int layer);
    template <int dimension, bool special> void look_for_crossing(std::uint32_t i);
    template <int dimension, bool special> void renew(std::uint32_t i);
    template <int dimension, bool special>
    [[nodiscard]] bool still_meets(std::uint32_t i, std::uint32_t j, double time) const;
    template <int dimension> [[nodiscard]] Vector<double> shift_of(std::uint32_t i, std::uint32_t j) const;
    // Of a sheared gas: boxes between i and the image of j that its cell faces. False: it faces none.
    template <int dimension>
    bool boxes_between(std::uint32_t i, std::uint32_t j, std::array<std::int64_t, 3>& boxes) const;
    template <int dimension>
    [[nodiscard]] Image image_between(std::uint32_t i, std::uint32_t j, double now) const;
    template <int dimension> void find_column(std::uint32_t i);
    template <int dimension> void slide_rows();
    template <int dimension> void search_again(std::uint32_t i);
    void count_columns();
    [[nodiscard]] double next_slide() const;
    void restart_epoch();
    template <int dimension> [[nodiscard]] bool just_met(std::uint32_t i, std::uint32_t j) const;
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
    [[nodiscard]] std::int64_t cell_number(const std::uint16_t (&cell)[3]) const {
        return cell[0] + view_.count[0] * (cell[1] + static_cast<std::int64_t>(view_.count[1]) * cell[2]);
    }
    void add_to_cell(std::int64_t cell, std::uint32_t i);
    void take_from_cell(std::int64_t cell, std::uint32_t i);
    void choose_cells();
    void place_particles(const std::vector<Particle>& particles);
    void begin_epoch();
    void kick();
    [[nodiscard]] Drift drift() const;
    [[nodiscard]] bool stands_in_its_cell(std::uint32_t k) const;
    void sort_by_cell();
    void set_epoch_end();

    const simd::EdmdKernels* kernels_;
    simd::HardSearchNear search_near_;
    int threads_;
    bool special_;
    Work work_;
    double now_ = 0; // of the epoch

    Column<simd::HardState> states_;
    Column<simd::HardEvents> events_;
    Column<simd::HardCell> cells_; // and what goes on from full ones
    std::uint32_t free_cell_ = 0;
    std::int64_t cell_count_ = 0, plane_ = 0; // all, in a layer of the third direction
    double edge_[3] = {1, 1, 1};
    Column<std::int32_t> turns_;       // boxes crossed until the last fold, three for each particle
    std::vector<Vector<double>> spin_; // rough particles
    simd::HardSearch view_{};
    std::vector<double> radius_;
    Queue queue_;
    bool far_ = false; // more than the cache next to a core holds: what comes up is fetched ahead
};

} // namespace sandlane::edmd
