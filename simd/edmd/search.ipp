// One particle against those of the cells around it, eight at a time.
#pragma once

#include "laws/pair_time.hpp"
#include "simd/edmd/tables.hpp"
#include "simd/rows.hpp"
#include "simd/words.hpp"

#include <bit>
#include <cstring>

namespace sandlane::simd {

// Cells next to each other in one direction, and the faces of the box between (1 in the field of the
// direction, with the bias of images).
struct CellRun {
    std::int64_t offset[4];
    std::uint64_t faces[4];
    int size = 0;
};
SANDLANE_INLINE void add_cell(CellRun& run, std::int64_t at, std::int64_t count, bool periodic,
                              std::int64_t stride, int shift) {
    std::uint64_t faces = image_zero;
    if (at < 0) {
        if (!periodic) return;
        at += count;
        --faces;
    } else if (at >= count) {
        if (!periodic) return;
        at -= count;
        ++faces;
    }
    run.offset[run.size] = at * stride;
    run.faces[run.size++] = faces << shift;
}

// The cells of a row beyond a side of a sheared gas that face a cell, or the one that came last when a
// particle has moved one up or down along it.
SANDLANE_INLINE CellRun cells_beyond(const HardSearch& view, std::int64_t at, std::int64_t up, int layer) {
    FacingColumns facing = facing_columns(view, up);
    if (layer == 0) facing.to = facing.from;
    if (layer == 1) facing.from = facing.to;
    CellRun run;
    for (std::int64_t k = at + facing.from; k <= at + facing.to; ++k) {
        const std::int64_t box = box_of(k, view.count[0]);
        run.offset[run.size] = k - box * view.count[0];
        run.faces[run.size++] = image_zero + static_cast<std::uint64_t>(box);
    }
    return run;
}

// The candidates: their numbers, and the faces of the box between, which are not listed where there are none.
struct Candidates {
    static constexpr int room = 256;
    std::uint32_t particle[room + width];
    std::uint64_t faces[room + width];
};

template <class Arch, int dimension, bool general, bool grows, bool sheared> class NearSearch {
    using B = Block<Arch>;
    using W = Words<Arch>;

public:
    SANDLANE_INLINE NearSearch(const HardSearch& view, std::uint32_t i, std::uint32_t excluded,
                               HardFound& found)
        : view_(view), i_(i), excluded_(excluded), found_(found) {
        const HardState& s = view.state[i];
        me_ = {{B(s.place[0]), B(s.place[1]), B(s.place[2])},
               {B(s.velocity[0]), B(s.velocity[1]), B(s.velocity[2])},
               B(s.time)};
        // The class does not count.
        images_ = s.word & 0x0000ffffffffffffULL;
        radius_ = view.radius[general ? s.word >> 48 : 0];
    }

    SANDLANE_INLINE void all(int layer) {
        const HardEvents& e = view_.events[i_];
        if (is_inside(e, layer))
            look_inside(e, layer);
        else
            look_across(e, layer);
    }

private:
    [[nodiscard]] SANDLANE_INLINE bool is_inside(const HardEvents& e, int layer) const {
        bool inside = true;
        for (int d = 0; d < dimension; ++d) {
            const int at = e.cell[d];
            const bool alone = layer >= 0 && layer / 2 == d, up = layer % 2 == 1;
            if (!alone || !up) inside = inside && at > 0;
            if (!alone || up) inside = inside && at + 1 < view_.count[d];
        }
        return inside;
    }

    // Nothing of the box lies between.
    SANDLANE_INLINE void look_inside(const HardEvents& e, int layer) {
        std::int64_t from[3] = {-1, -1, -1}, to[3] = {1, 1, 1};
        if (dimension == 2) from[2] = to[2] = 0;
        if (layer >= 0) from[layer / 2] = to[layer / 2] = layer % 2 == 0 ? -1 : 1;
        const std::int64_t row = view_.count[0], plane = row * view_.count[1];
        const HardCell* here = view_.cells + e.cell[0] + row * e.cell[1];
        if constexpr (dimension == 3) here += plane * e.cell[2];
        Candidates c;
        int size = 0;
        for (std::int64_t z = from[2]; z <= to[2]; ++z)
            for (std::int64_t y = from[1]; y <= to[1]; ++y) {
                const HardCell* cell = here + (z * plane + y * row + from[0]);
                const HardCell* const last = here + (z * plane + y * row + to[0]);
                for (; cell <= last; ++cell) size = put_cell<false>(c, size, cell, 0);
            }
        predict<false>(c, size);
    }

    SANDLANE_INLINE void look_across(const HardEvents& e, int layer) {
        CellRun run[3];
        std::int64_t stride = 1;
        for (int d = 0; d < dimension; ++d) {
            const std::int64_t at = e.cell[d];
            int from = -1, to = 1;
            if (layer >= 0 && layer / 2 == d) from = to = layer % 2 == 0 ? -1 : 1;
            for (int k = from; k <= to; ++k)
                add_cell(run[d], at + k, view_.count[d], view_.periodic[d], stride, 16 * d);
            stride *= view_.count[d];
        }
        if constexpr (dimension == 2) {
            run[2].offset[0] = 0;
            run[2].faces[0] = 0;
            run[2].size = 1;
        }
        CellRun below, above; // in rows beyond the sides
        if constexpr (sheared) {
            below = cells_beyond(view_, e.cell[0], -1, layer);
            above = cells_beyond(view_, e.cell[0], 1, layer);
        }
        Candidates c;
        int size = 0;
        for (int z = 0; z < run[2].size; ++z)
            for (int y = 0; y < run[1].size; ++y) {
                const std::int64_t line = run[2].offset[z] + run[1].offset[y];
                const std::uint64_t faces = run[2].faces[z] + run[1].faces[y];
                const CellRun* row = &run[0];
                if constexpr (sheared) {
                    if (run[1].faces[y] < image_zero << 16) row = &below;
                    if (run[1].faces[y] > image_zero << 16) row = &above;
                }
                for (int x = 0; x < row->size; ++x)
                    size =
                        put_cell<true>(c, size, view_.cells + line + row->offset[x], faces + row->faces[x]);
            }
        predict<true>(c, size);
    }

    // Adds the particles of a cell; returns how many candidates there are now.
    template <bool across>
    SANDLANE_INLINE int put_cell(Candidates& c, int size, const HardCell* cell, std::uint64_t faces) {
        for (;;) {
            std::memcpy(c.particle + size, cell->particle, sizeof *cell);
            if constexpr (across) W(faces).store(c.faces + size);
            size += static_cast<int>(cell->size());
            if (size + width > Candidates::room) [[unlikely]] {
                predict<across>(c, size);
                size = 0;
            }
            if (cell->meta <= cell_slots) [[likely]]
                return size;
            cell = view_.cells + cell->next();
        }
    }

    template <bool across> SANDLANE_INLINE void predict(Candidates& c, int n) {
        // Lanes beyond the last one are the particle itself, which does not approach itself.
        if constexpr (across) W(no_faces).store(c.faces + n);
        for (int l = 0; l < width; ++l) c.particle[n + l] = i_;
        for (int k = 0; k < n; k += width) block(c.particle + k, across ? W::load(c.faces + k) : W(no_faces));
    }

    static constexpr std::uint64_t no_faces = image_zero | image_zero << 16 | image_zero << 32;

    SANDLANE_INLINE void block(const std::uint32_t* particle, const W& faces) {
        B field[8];
        Rows<Arch, 8>::gather(reinterpret_cast<const double*>(view_.state),
                              reinterpret_cast<const std::int32_t*>(particle), field);
        const laws::Flight<B> other{{field[0], field[1], field[2]}, {field[3], field[4], field[5]}, field[6]};
        // Images of i less those of j and faces between, in each field plus twice the bias; no field borrows
        // from the next.
        const W difference = (W(images_) + faces) - words_of(field[7]);
        Vector<B> shift;
        [[maybe_unused]] B turns(0.0);
        if constexpr (sheared) turns = boxes<1>(difference);
        shift.x = image<0>(difference);
        shift.y = image<1>(difference);
        if constexpr (dimension == 3) shift.z = image<2>(difference);
        B reach(radius_ + radius_);
        Vector<B> gravity{B(0.0), B(0.0), B(0.0)};
        if constexpr (general) {
            double radii[width];
            for (int l = 0; l < width; ++l) radii[l] = view_.radius[view_.state[particle[l]].word >> 48];
            reach = B(radius_) + load<Arch>(radii);
            gravity = {B(view_.gravity[0]), B(view_.gravity[1]), B(view_.gravity[2])};
        }
        B time;
        if constexpr (grows)
            time = laws::growing_pair_time<dimension, B>(me_, other, shift, reach, B(view_.scale),
                                                         B(view_.growth), B(never_meets));
        else if constexpr (sheared)
            time = laws::sheared_pair_time<dimension, B>(me_, other, shift, turns, reach, B(view_.offset),
                                                         B(view_.speed), B(never_meets));
        else
            time = laws::pair_time<dimension, general, B>(me_, other, shift, reach, gravity, B(never_meets));
        const unsigned meets = bits(time < B(never_meets));
        unsigned hits = meets & ~bits(time > B(found_.second_time));
        if (hits != meets) found_.missed = true;
        if (hits == 0) return;
        double times[width];
        store(times, time);
        for (; hits != 0; hits &= hits - 1) {
            const int l = std::countr_zero(hits);
            if (particle[l] != excluded_) add_contact(found_, times[l], particle[l], view_.events);
        }
    }

    template <int d> SANDLANE_INLINE B boxes(const W& difference) const {
        const W field = right<16 * d>(difference) & W(image_mask);
        // As a number, less the bias: exact.
        return block_of(field ^ W(std::bit_cast<std::uint64_t>(0x1p52))) -
               B(0x1p52 + static_cast<double>(image_zero));
    }
    template <int d> SANDLANE_INLINE B image(const W& difference) const {
        return boxes<d>(difference) * B(view_.length[d]);
    }

    const HardSearch& view_;
    std::uint32_t i_, excluded_;
    HardFound& found_;
    laws::Flight<B> me_;
    std::uint64_t images_;
    double radius_;
};

template <class Arch, int dimension, bool general, bool grows = false, bool sheared = false>
void search_near(const HardSearch& view, std::uint32_t i, int layer, std::uint32_t excluded,
                 HardFound& found) {
    NearSearch<Arch, dimension, general, grows, sheared>(view, i, excluded, found).all(layer);
}

} // namespace sandlane::simd
