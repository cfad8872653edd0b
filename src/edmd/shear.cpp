// Cells of a sheared gas (Lees and Edwards): those beyond a side in y glide past those within. Which columns
// face each other changes each time they have moved by one; particles that come through a side find the
// column where they are. Nothing of this changes a state, so that events do not depend on it.
#include "edmd/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::edmd {

using simd::HardEvents;
using simd::HardState;
using simd::image_of;
using simd::never_meets;

template <int dimension>
bool Simulation::boxes_between(std::uint32_t i, std::uint32_t j, std::array<std::int64_t, 3>& boxes) const {
    const HardEvents &a = events_[i], &b = events_[j];
    std::int64_t faces[3] = {0, 0, 0};
    bool near = true;
    for (int d = 1; d < dimension; ++d) {
        const int apart = a.cell[d] - b.cell[d];
        faces[d] = apart > 1 ? 1 : apart < -1 ? -1 : 0;
        near = near && std::abs(apart - static_cast<int>(faces[d]) * view_.count[d]) <= 1;
    }
    simd::FacingColumns columns{-1, 1};
    if (faces[1] != 0) columns = simd::facing_columns(view_, faces[1]);
    // The image of j in one of these columns, if there is one.
    const std::int64_t apart = b.cell[0] - a.cell[0], count = view_.count[0];
    faces[0] = simd::box_of(columns.to - apart, count);
    near = near && apart + faces[0] * count >= columns.from;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
        const int axis = static_cast<int>(d);
        boxes[d] = image_of(states_[i], axis) - image_of(states_[j], axis) + faces[d];
    }
    return near;
}
template bool Simulation::boxes_between<2>(std::uint32_t, std::uint32_t, std::array<std::int64_t, 3>&) const;
template bool Simulation::boxes_between<3>(std::uint32_t, std::uint32_t, std::array<std::int64_t, 3>&) const;

// Of a particle that has come into the box above or below.
template <int dimension> void Simulation::find_column(std::uint32_t i) {
    HardState& s = states_[i];
    const double length = view_.length[0];
    const double up = static_cast<double>(image_of(s, 1)), along = static_cast<double>(image_of(s, 0));
    const double x = s.place[0] + s.velocity[0] * (now_ - s.time) - up * setup_.offset_at(now_) -
                     along * length - setup_.lower[0];
    const double boxes = std::floor(x / length);
    s.word += static_cast<std::uint64_t>(static_cast<std::int64_t>(boxes));
    const double at = std::floor((x - boxes * length) / edge_[0]);
    events_[i].cell[0] =
        static_cast<std::uint16_t>(std::clamp(at, 0.0, static_cast<double>(view_.count[0] - 1)));
}
template void Simulation::find_column<2>(std::uint32_t);
template void Simulation::find_column<3>(std::uint32_t);

void Simulation::count_columns() {
    view_.offset = setup_.offset;
    view_.speed = setup_.image_speed();
    view_.columns = static_cast<std::int64_t>(std::floor(setup_.offset_at(now_) / edge_[0]));
}

// When other columns come to face each other, of this epoch.
double Simulation::next_slide() const {
    if (setup_.shear == 0) return never_meets;
    const double to = static_cast<double>(view_.columns + (view_.speed > 0 ? 1 : 0)) * edge_[0];
    return (to - setup_.offset) / view_.speed;
}

// A search from one side is enough for both.
template <int dimension> void Simulation::slide_rows() {
    view_.columns += view_.speed > 0 ? 1 : -1;
    std::uint16_t at[3] = {0, static_cast<std::uint16_t>(view_.count[1] - 1), 0};
    for (; at[2] < view_.count[2]; ++at[2])
        for (at[0] = 0; at[0] < view_.count[0]; ++at[0]) {
            const simd::HardCell* cell = &cells_[static_cast<std::size_t>(cell_number(at))];
            for (;;) {
                for (std::uint32_t k = 0; k < cell->size(); ++k) search_again<dimension>(cell->particle[k]);
                if (cell->next() == 0) break;
                cell = &cells_[cell->next()];
            }
        }
}
template void Simulation::slide_rows<2>();
template void Simulation::slide_rows<3>();

} // namespace sandlane::edmd
