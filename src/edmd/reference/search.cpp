// The search of contacts, one candidate after the other: the table of kernels for --isa scalar.
#include "laws/pair_time.hpp"
#include "simd/edmd/tables.hpp"

namespace sandlane::simd {

namespace {

laws::Flight<double> flight_of(const HardState& s) {
    return {{s.place[0], s.place[1], s.place[2]}, {s.velocity[0], s.velocity[1], s.velocity[2]}, s.time};
}

template <int dimension, bool general, bool grows = false, bool sheared = false>
void search_near(const HardSearch& view, std::uint32_t i, int layer, std::uint32_t excluded,
                 HardFound& found) {
    const HardState& me = view.state[i];
    const Vector<double> gravity{view.gravity[0], view.gravity[1], view.gravity[2]};
    const auto class_of = [](const HardState& s) { return general ? s.word >> 48 : 0; };
    const auto look_at = [&](std::uint32_t j, const std::int64_t(&faces)[3]) {
        if (j == i || j == excluded) return;
        const HardState& other = view.state[j];
        double shift[3] = {0, 0, 0};
        for (int d = 0; d < dimension; ++d)
            shift[d] = static_cast<double>(image_of(me, d) - image_of(other, d) + faces[d]) * view.length[d];
        const double reach = view.radius[class_of(me)] + view.radius[class_of(other)];
        const Vector<double> apart{shift[0], shift[1], shift[2]};
        const double up = static_cast<double>(image_of(me, 1) - image_of(other, 1) + faces[1]);
        const double time =
            sheared ? laws::sheared_pair_time<dimension, double>(flight_of(me), flight_of(other), apart, up,
                                                                 reach, view.offset, view.speed, never_meets)
            : grows ? laws::growing_pair_time<dimension, double>(flight_of(me), flight_of(other), apart,
                                                                 reach, view.scale, view.growth, never_meets)
                    : laws::pair_time<dimension, general, double>(flight_of(me), flight_of(other), apart,
                                                                  reach, gravity, never_meets);
        if (time < never_meets) add_contact(found, time, j, view.events);
    };
    const auto visit = [&](const std::int64_t(&step)[3]) {
        std::int64_t number = 0, stride = 1, faces[3] = {0, 0, 0};
        for (int d = 0; d < dimension; ++d) {
            std::int64_t at = view.events[i].cell[d] + step[d];
            if (at < 0 || at >= view.count[d]) {
                if (!view.periodic[d]) return;
                faces[d] = box_of(at, view.count[d]);
                at -= faces[d] * view.count[d];
            }
            number += at * stride;
            stride *= view.count[d];
        }
        const HardCell* cell = view.cells + number;
        for (;;) {
            for (std::uint32_t n = 0; n < cell->size(); ++n) look_at(cell->particle[n], faces);
            if (cell->next() == 0) return;
            cell = view.cells + cell->next();
        }
    };
    std::int64_t from[3] = {-1, -1, -1}, to[3] = {1, 1, 1}, step[3];
    if (dimension == 2) from[2] = to[2] = 0;
    if (layer >= 0) from[layer / 2] = to[layer / 2] = layer % 2 == 0 ? -1 : 1;
    for (step[2] = from[2]; step[2] <= to[2]; ++step[2])
        for (step[1] = from[1]; step[1] <= to[1]; ++step[1]) {
            FacingColumns columns{from[0], to[0]};
            const std::int64_t up = box_of(view.events[i].cell[1] + step[1], view.count[1]);
            if (sheared && up != 0) { // the row stands elsewhere along x
                columns = facing_columns(view, up);
                if (layer == 0) columns.to = columns.from;
                if (layer == 1) columns.from = columns.to;
            }
            for (step[0] = columns.from; step[0] <= columns.to; ++step[0]) visit(step);
        }
}

} // namespace

const EdmdKernels& edmd_kernels_scalar();
const EdmdKernels& edmd_kernels_scalar() {
    static const EdmdKernels table{{search_near<2, false>, search_near<3, false>},
                                   {search_near<2, true>, search_near<3, true>},
                                   {search_near<2, true, true>, search_near<3, true, true>},
                                   {search_near<2, true, false, true>, search_near<3, true, false, true>}};
    return table;
}

} // namespace sandlane::simd
