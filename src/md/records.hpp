// A grain as its record tells of it: the one place outside kernels that reads records (simd/records.hpp).
#pragma once

#include "core/vec.hpp"
#include "simd/tables.hpp"

namespace sandlane::md {

struct RecordedGrain {
    Vec position, velocity;   // m, m/s
    double surface_speed = 0; // R omega, m/s: 2D
    Vec angular_velocity;     // rad/s: 3D
    double radius = 0, inverse_radius = 0;
};

// spin: the record of its spin, 3D with rotation, else null.
template <int dimension>
[[nodiscard]] RecordedGrain recorded_grain(const double* record, const double* spin, double inverse_dt) {
    using Field = simd::Record<dimension>;
    const double* v = record + Field::velocity;
    RecordedGrain g;
    g.radius = record[Field::radius];
    g.inverse_radius = record[Field::inverse_radius];
    if constexpr (dimension == 3) {
        g.position = {record[0], record[1], record[2]};
        g.velocity = {v[0] * inverse_dt, v[1] * inverse_dt, v[2] * inverse_dt};
        if (spin != nullptr)
            g.angular_velocity = {spin[0] * inverse_dt, spin[1] * inverse_dt, spin[2] * inverse_dt};
    } else {
        g.position = {record[0], record[1], 0};
        g.velocity = {v[0] * inverse_dt, v[1] * inverse_dt, 0};
        g.surface_speed = record[Field::spin] * inverse_dt;
    }
    return g;
}

} // namespace sandlane::md
