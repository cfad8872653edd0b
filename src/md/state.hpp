// The particles of a run as aligned columns, stored in spatial order; ids are for the outside.
#pragma once

#include "analysis/snapshot.hpp"
#include "core/column.hpp"
#include "md/plan.hpp"
#include "scene/initial_state.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace sandlane::md {

inline constexpr std::size_t tile_size = simd::tile_grains;

// Only the columns that the plan needs are allocated: without friction there is no angle and no spin column.
struct State {
    int order = 5, dofs = 2;    // stored derivatives; x, y (and phi)
    Column<double> gear;        // [block][dof * order + k][lane], Nordsieck-scaled (docs/physics.md 7)
    Column<double> record;      // [particle][record_fields], see simd/tables.hpp
    Column<double> next_record; // of the next step, where forces and motion share one pass (double_records)
    bool double_records = false;
    Column<double> force; // [particle][force_fields], zero between steps
    Column<double> radius, inverse_radius, mass, inverse_mass, spin_factor;
    Column<std::int32_t> material, image_x, image_y;
    Column<std::int64_t> id;

    [[nodiscard]] std::size_t size() const { return radius.size(); }
    [[nodiscard]] std::size_t tiles() const { return (size() + tile_size - 1) / tile_size; }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] bool spin() const { return dofs == 3; }

    // Value k of degree of freedom dof of one particle.
    [[nodiscard]] double& value(std::size_t i, int dof, int k) { return gear[gear_index(i, dof, k)]; }
    [[nodiscard]] double value(std::size_t i, int dof, int k) const { return gear[gear_index(i, dof, k)]; }

    void append(const scene::GrainState& grain, const Plan& plan, double dt);
    // New storage order: position n gets the particle that stood at order[n]; shorter orders drop particles.
    void reorder(std::span<const std::uint32_t> order);
    // After a restore: sizes the derived columns and checks that all have one length.
    void adopt(const Plan& plan);
    // Makes room for as many buffers of records as double_records says.
    void resize_records();
    // Rewrites records from the state, for the time of the state.
    void refresh_records(double dt);

private:
    [[nodiscard]] std::size_t gear_index(std::size_t i, int dof, int k) const {
        const auto fields = static_cast<std::size_t>(dofs * order);
        return i / block_width * block_width * fields +
               static_cast<std::size_t>(dof * order + k) * block_width + i % block_width;
    }
    void resize(std::size_t n);
    void park_padding();
    Vec parking_; // a position inside the domain for the padding lanes
};

} // namespace sandlane::md
