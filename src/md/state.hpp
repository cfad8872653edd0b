// The particles of a run as aligned columns, stored in spatial order; ids are for the outside.
#pragma once

#include "core/column.hpp"
#include "core/quaternion.hpp"
#include "core/vec.hpp"
#include "md/plan.hpp"
#include "scene/initial_state.hpp"
#include "simd/tables.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace sandlane::md {

inline constexpr std::size_t tile_size = simd::tile_grains;

// Only the columns that the plan needs are allocated: without friction there is no spin, without periodic
// sides no images.
struct State {
    int dimension = 2, order = 5; // stored derivatives
    simd::Rotation rotation = simd::Rotation::none;
    // Position and displacement per step are the integrator's values k = 0 and 1; they live in the records
    // that the pair kernels read (simd/records.hpp). Values k >= 2: [block][dof * (order - 2) + k - 2][lane],
    // Nordsieck-scaled (docs/physics.md 7).
    Column<double> record, spin, gear;
    Column<double> next_record, next_spin; // where forces and motion share one pass (double_records)
    bool double_records = false;
    Column<double> force;       // [particle][force_stride], zero between steps; not with double_records
    Column<double> orientation; // [particle][w, x, y, z], where it is followed
    Column<double> mass, inverse_mass;
    Column<std::int32_t> material;
    std::array<Column<std::int32_t>, 3> image; // of periodic sides; else empty
    Column<std::int64_t> id;

    void prepare(const Plan& plan, const scene::Domain& domain);

    [[nodiscard]] std::size_t size() const { return mass.size(); }
    [[nodiscard]] std::size_t tiles() const { return (size() + tile_size - 1) / tile_size; }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] bool turns() const { return rotation != simd::Rotation::none; }
    [[nodiscard]] int dofs() const { return simd::degrees_of_freedom(dimension, turns()); }
    [[nodiscard]] std::size_t force_stride() const {
        return static_cast<std::size_t>(simd::force_stride(dimension, rotation));
    }

    [[nodiscard]] double* record_of(std::size_t i) { return record.data() + i * simd::record_fields; }
    [[nodiscard]] const double* record_of(std::size_t i) const {
        return record.data() + i * simd::record_fields;
    }
    [[nodiscard]] double radius(std::size_t i) const { return record_of(i)[simd::radius_field(dimension)]; }
    [[nodiscard]] double inverse_radius(std::size_t i) const {
        return record_of(i)[simd::radius_field(dimension) + 1];
    }
    [[nodiscard]] double largest_radius() const;
    [[nodiscard]] Vec position(std::size_t i) const { return vector_at(i, 0); }
    [[nodiscard]] Vec shift(std::size_t i) const { return vector_at(i, dimension); } // v dt
    // omega dt; along z in 2D.
    [[nodiscard]] Vec turn(std::size_t i) const;
    [[nodiscard]] double angle(std::size_t i) const; // 2D, rad
    [[nodiscard]] int images(std::size_t i, std::size_t direction) const {
        return image[direction].empty() ? 0 : image[direction][i];
    }
    // Value k >= 2 of degree of freedom dof.
    [[nodiscard]] double& value(std::size_t i, int dof, int k) { return gear[gear_index(i, dof, k)]; }
    [[nodiscard]] double value(std::size_t i, int dof, int k) const { return gear[gear_index(i, dof, k)]; }

    [[nodiscard]] Quaternion orientation_of(std::size_t i) const {
        const double* q = orientation.data() + 4 * i;
        return {q[0], q[1], q[2], q[3]};
    }
    void set_orientation(std::size_t i, Quaternion q);

    // A grain with no accelerations.
    void append(const scene::GrainState& grain, double dt);
    // Value k = 2 of all degrees of freedom from the accumulated forces.
    void set_accelerations(std::size_t i, const double* forces, const simd::MotionView& view);
    // For a time step so many times as long: values k of the integrator are scaled by its powers.
    void rescale(double ratio);
    // New storage order: position n gets the particle that stood at order[n]; shorter orders drop particles.
    void reorder(std::span<const std::uint32_t> order_of);
    // After a restore: sizes the derived columns and checks that all have one length.
    void adopt();
    // Makes room for as many buffers of records as double_records says.
    void resize_buffers();
    // Calls body(column, fields per particle) for the columns that make up the state.
    template <class Body> void for_columns(const Body& body) { for_columns_of(*this, body); }
    template <class Body> void for_columns(const Body& body) const { for_columns_of(*this, body); }

private:
    template <class Self, class Body> static void for_columns_of(Self& self, const Body& body) {
        body(self.record, std::size_t{simd::record_fields});
        body(self.spin, self.spin_fields());
        body(self.orientation, std::size_t{self.follows_orientation_ ? 4U : 0U});
        body(self.mass, std::size_t{1});
        body(self.inverse_mass, std::size_t{1});
        body(self.material, std::size_t{1});
        for (std::size_t d = 0; d < 3; ++d) body(self.image[d], std::size_t{self.periodic_[d] ? 1U : 0U});
        body(self.id, std::size_t{1});
    }
    [[nodiscard]] std::size_t spin_fields() const {
        return dimension == 3 && turns() ? std::size_t{simd::spin_fields} : 0;
    }
    [[nodiscard]] Vec vector_at(std::size_t i, int field) const {
        const double* r = record_of(i) + field;
        return {r[0], r[1], dimension == 3 ? r[2] : 0.0};
    }
    [[nodiscard]] std::size_t gear_fields() const { return static_cast<std::size_t>(dofs() * (order - 2)); }
    [[nodiscard]] std::size_t gear_index(std::size_t i, int dof, int k) const {
        return i / block_width * block_width * gear_fields() +
               static_cast<std::size_t>(dof * (order - 2) + k - 2) * block_width + i % block_width;
    }
    void resize(std::size_t n);
    void park_padding();

    Vec parking_; // a position inside the domain for the padding lanes
    std::array<bool, 3> periodic_{};
    bool follows_orientation_ = false;
};

} // namespace sandlane::md
