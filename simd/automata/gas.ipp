// Lattice gas: collision and propagation of the rows of a tile, in place. Each row is read and collided whole
// into a buffer; what it sends along the row, down and up is shifted from there into the lattice, upwards one
// row later. So a row is ready for the next step as soon as the row above it has been collided: two steps
// take one pass over the memory.
#pragma once

#include "simd/automata/bytes.hpp"
#include "simd/automata/collisions.hpp"
#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

// by_bytes: FHP-III by a table of bytes, else by Boolean expressions of planes.
template <class Arch, bool by_bytes = false> struct GasRows {
    using W = WordBatch<Arch>;
    static constexpr std::int32_t lanes = static_cast<std::int32_t>(W::size);
    static constexpr std::int32_t pad = segment_words;

    // Rows of the buffer have a segment more on both sides, for what comes in at the ends.
    struct Buffer {
        std::uint64_t* collided[gas_planes];
        std::uint64_t* rising[2]; // what the row before sent up, in place

        Buffer(std::uint64_t* scratch, std::int32_t stride) {
            const std::ptrdiff_t row = stride + 2 * pad;
            for (int i = 0; i < gas_planes; ++i) collided[i] = scratch + i * row + pad;
            for (int i = 0; i < 2; ++i) rising[i] = scratch + (gas_planes + i) * row + pad;
        }
    };

    // How a plane moves along x in a row: +1, 0 or -1 sites; diagonals depend on the row (brick layout).
    template <bool square> static SANDLANE_INLINE int shift_of(int direction, std::int32_t row) {
        if constexpr (square) return direction == 0 ? 1 : direction == 2 ? -1 : 0;
        const int odd = row & 1;
        switch (direction) {
        case 0:
            return 1;
        case 3:
            return -1;
        case 1:
        case 5:
            return odd;
        default:
            return odd - 1;
        }
    }

    // The pads get what comes in across the periodic ends: site -1 is the last one, site `columns` the first.
    static SANDLANE_INLINE void close_ends(const GasView& v, std::uint64_t* row) {
        const std::int32_t last = v.columns - 1;
        row[-1] = (row[last >> 6] >> (last & 63) & 1) << 63;
        for (std::int32_t w = v.words; w < v.stride + pad; ++w) row[w] = 0;
        const std::uint64_t first = row[0] & 1, bit = std::uint64_t{1} << (v.columns & 63);
        std::uint64_t& end = row[v.columns >> 6];
        end = (end & ~bit) | (first * bit);
    }

    // `from` must have closed ends.
    static SANDLANE_INLINE void move(const GasView& v, const std::uint64_t* from, int shift,
                                     std::uint64_t* to, std::int32_t first, std::int32_t last) {
        if (shift > 0)
            for (std::int32_t w = first; w < last; w += lanes)
                (left<1>(load_words<Arch>(from + w)) | right<63>(load_words<Arch>(from + w - 1)))
                    .store_unaligned(to + w);
        else if (shift < 0)
            for (std::int32_t w = first; w < last; w += lanes)
                (right<1>(load_words<Arch>(from + w)) | left<63>(load_words<Arch>(from + w + 1)))
                    .store_unaligned(to + w);
        else
            for (std::int32_t w = first; w < last; w += lanes)
                load_words<Arch>(from + w).store_unaligned(to + w);
        if (v.words <= last && v.words > first) to[v.words - 1] &= mask_of(v);
        for (std::int32_t w = v.words; w < last; ++w) to[w] = 0;
    }
    static SANDLANE_INLINE std::uint64_t mask_of(const GasView& v) {
        const int used = v.columns & 63;
        return used == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
    }

    static SANDLANE_INLINE WordSource source_of(const GasView& v, std::int32_t row) {
        return {{v.seed[0], v.seed[1]}, static_cast<std::uint32_t>(row), v.step};
    }
    static SANDLANE_INLINE W draw(const WordSource& source, const W& index, std::uint32_t stream,
                                  std::uint32_t probability) {
        if (probability == 0) return W(std::uint64_t{0});
        if (probability >> probability_bits != 0) return W(~std::uint64_t{0});
        return bernoulli_words<Arch>(index, source, stream, probability);
    }

    template <GasModel model>
    static SANDLANE_INLINE void collide(const GasView& v, const WordSource& source, const W& index,
                                        const W& xi, W* n) {
        if constexpr (model == GasModel::hpp) collide_hpp(n);
        if constexpr (model == GasModel::fhp1) collide_fhp1(n, xi);
        if constexpr (model == GasModel::fhp2) collide_fhp2(n, xi);
        if constexpr (model == GasModel::fhp3) collide_fhp3(n, xi);
        if constexpr (model == GasModel::pipe) {
            const W joins = draw(source, index, gas_stream::dissipation, v.dissipation);
            collide_with_rest(n, xi, W(~joins), joins);
        }
    }

    static constexpr int planes_of(GasModel model) {
        return model == GasModel::hpp ? 4 : model == GasModel::fhp1 ? 6 : 7;
    }

    // Gravity, and what solid sites send back: before and after the collisions, n.
    template <GasModel model>
    static SANDLANE_INLINE void turn_and_return(const GasView& v, const WordSource& source, const W& index,
                                                std::ptrdiff_t at, const W* before, W* n) {
        constexpr int planes = planes_of(model), half = model == GasModel::hpp ? 2 : 3;
        if constexpr (model != GasModel::hpp)
            turn_towards_x<planes == 7>(n, draw(source, index, gas_stream::gravity, v.gravity));
        if (v.solid == nullptr) return;
        const W solid = load_words<Arch>(v.solid + at);
        for (int i = 0; i < planes; ++i) {
            const int from = i == 6 ? 6 : (i + half) % (2 * half);
            n[i] = (solid & before[from]) | (~solid & n[i]);
        }
    }

    template <GasModel model, GasVariant variant>
    static void collide_row(const GasView& v, std::int32_t row, WordRange range, const Buffer& buffer) {
        if constexpr (by_bytes) {
            collide_bytes<variant>(v, row, range, buffer);
            return;
        }
        constexpr int planes = planes_of(model);
        constexpr bool general = variant == GasVariant::general || model == GasModel::pipe;
        const WordSource source = source_of(v, row);
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * v.stride;
        const W alternating(((static_cast<std::uint32_t>(row) + v.step) & 1) != 0 ? 0x5555555555555555ULL
                                                                                  : 0xaaaaaaaaaaaaaaaaULL);
        const W lane = lane_numbers<Arch>();
        for (std::int32_t w = range.first; w < range.last; w += lanes) {
            W n[gas_planes];
            for (int i = 0; i < planes; ++i) n[i] = load_words<Arch>(v.plane[i] + start + w);
            // A row of a plane is often no longer than a page, where the processor stops to read ahead.
            if (w % segment_words == 0)
                for (int i = 0; i < planes; ++i) __builtin_prefetch(v.plane[i] + start + v.stride + w, 1);
            const W index = lane + W(static_cast<std::uint64_t>(w));
            W xi = alternating;
            if constexpr (variant != GasVariant::alternating && model != GasModel::hpp)
                xi = random_words<Arch>(index, source, gas_stream::chirality * 64 + probability_bits - 1);
            W before[gas_planes];
            if constexpr (general)
                for (int i = 0; i < planes; ++i) before[i] = n[i];
            collide<model>(v, source, index, xi, n);
            if constexpr (general) turn_and_return<model>(v, source, index, start + w, before, n);
            for (int i = 0; i < planes; ++i) n[i].store_unaligned(buffer.collided[i] + w);
        }
    }

    template <GasVariant variant>
    static void collide_bytes(const GasView& v, std::int32_t row, WordRange range, const Buffer& buffer) {
        const WordSource source = source_of(v, row);
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * v.stride;
        RowPlanes planes{{}, {}, v.stride};
        for (int i = 0; i < gas_planes; ++i) {
            planes.from[i] = v.plane[i] + start;
            planes.to[i] = buffer.collided[i];
        }
        ByteCollisions<Arch>::collide(source, range, planes);
        if constexpr (variant == GasVariant::general)
            for (std::int32_t w = range.first; w < range.last; w += lanes) {
                W before[gas_planes], n[gas_planes];
                for (int i = 0; i < gas_planes; ++i) {
                    before[i] = load_words<Arch>(planes.from[i] + w);
                    n[i] = load_words<Arch>(planes.to[i] + w);
                }
                const W index = lane_numbers<Arch>() + W(static_cast<std::uint64_t>(w));
                turn_and_return<GasModel::fhp3>(v, source, index, start + w, before, n);
                for (int i = 0; i < gas_planes; ++i) n[i].store_unaligned(planes.to[i] + w);
            }
    }

    // The same where any number of particles rests on a site.
    static void collide_counted_row(const GasView& v, std::int32_t row, const Buffer& buffer) {
        const WordSource source = source_of(v, row);
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * v.stride;
        const W lane = lane_numbers<Arch>();
        for (std::int32_t w = 0; w < v.stride; w += lanes) {
            W n[gas_planes];
            for (int i = 0; i < gas_planes; ++i) n[i] = load_words<Arch>(v.plane[i] + start + w);
            const W several = load_words<Arch>(v.counted->several + start + w);
            const W index = lane + W(static_cast<std::uint64_t>(w));
            const W xi = random_words<Arch>(index, source, gas_stream::chirality * 64 + probability_bits - 1);
            const W stops = draw(source, index, gas_stream::dissipation, v.dissipation);
            const W gravity = draw(source, index, gas_stream::gravity, v.gravity);
            const RestChange<W> change = collide_counted(n, several, xi, stops, gravity);
            for (int i = 0; i < gas_planes; ++i) n[i].store_unaligned(buffer.collided[i] + w);
            change.one.store_unaligned(v.counted->one + start + w);
            change.two.store_unaligned(v.counted->two + start + w);
            change.less.store_unaligned(v.counted->less + start + w);
        }
    }

    // What the first or last row sends into a wall comes back at the same site: straight, or mirrored.
    template <bool square>
    static void reflect(const GasView& v, std::int32_t row, const Buffer& buffer, bool lower,
                        std::uint64_t* to0, std::uint64_t* to1, std::uint64_t* walls) {
        if constexpr (square) { // one direction only
            const std::uint64_t* from = buffer.collided[lower ? 3 : 1];
            for (std::int32_t w = 0; w < v.stride; ++w) to0[w] = from[w];
            return;
        }
        // Straight: 4 -> 1, 5 -> 2; mirrored: 4 -> 2, 5 -> 1. Above, the same the other way.
        const std::uint64_t *first = buffer.collided[lower ? 4 : 1], *second = buffer.collided[lower ? 5 : 2];
        const WordSource source = source_of(v, row);
        const W lane = lane_numbers<Arch>();
        for (std::int32_t w = 0; w < v.stride; w += lanes)
            draw(source, lane + W(static_cast<std::uint64_t>(w)), gas_stream::wall, v.roughness)
                .store_unaligned(walls + w);
        for (std::int32_t w = 0; w < v.stride; w += lanes) {
            const W b = load_words<Arch>(walls + w), a0 = load_words<Arch>(first + w),
                    a1 = load_words<Arch>(second + w);
            ((b & a0) | (~b & a1)).store_unaligned(to0 + w);
            ((b & a1) | (~b & a0)).store_unaligned(to1 + w);
        }
        to0[v.words - 1] &= mask_of(v);
        to1[v.words - 1] &= mask_of(v);
    }

    // Runs of segments of a row, as words.
    struct Runs {
        WordRange* run;
        std::int32_t count = 0;

        explicit Runs(WordRange* memory) : run(memory) {}
        void find(const std::uint8_t* flags, std::int32_t segments) {
            count = 0;
            for (std::int32_t s = 0; s < segments; ++s) {
                if (flags[s] == 0) continue;
                const std::int32_t first = s;
                while (s < segments && flags[s] != 0) ++s;
                run[count++] = {first * segment_words, s * segment_words};
            }
        }
        void swap(Runs& other) {
            WordRange* const r = run;
            const std::int32_t c = count;
            run = other.run;
            count = other.count;
            other.run = r;
            other.count = c;
        }
        void take_all(std::int32_t words) {
            run[0] = {0, words};
            count = 1;
        }
    };

    // Which segments of the present row hold particles, and which words its particles can reach in a row: the
    // segments beside them too, and those that must be emptied.
    class Activity {
    public:
        Activity(const GasView& v, std::uint64_t* memory)
            : v_(v), segments_(v.stride / segment_words), own(reinterpret_cast<WordRange*>(memory)),
              below(own.run + segments_ + 1), level(below.run + segments_ + 1),
              above(level.run + segments_ + 1), arriving(above.run + segments_ + 1),
              flags_(reinterpret_cast<std::uint8_t*>(arriving.run + segments_ + 1)) {
            if (v.live != nullptr) return;
            for (Runs* runs : {&own, &below, &level, &above, &arriving}) runs->take_all(v.stride);
        }

        // planes: of the model. Before the row is collided.
        void look(std::int32_t row, int planes) {
            if (v_.live == nullptr) return;
            arriving.swap(above);
            std::uint8_t* occupied = v_.occupied + std::ptrdiff_t{row} * segments_;
            const std::uint8_t* live = live_in(row);
            for (std::int32_t s = 0; s < segments_; ++s)
                occupied[s] = live[s] != 0 && holds_any(row, s, planes) ? 1 : 0;
            own.find(occupied, segments_);
            const std::int32_t last = (v_.words - 1) / segment_words;
            const auto near = [&](std::int32_t s) {
                return occupied[s] | occupied[s > 0 ? s - 1 : last] | occupied[s < last ? s + 1 : 0];
            };
            const auto reach = [&](std::int32_t to, Runs& runs) {
                const std::uint8_t* there = live_in((to + v_.rows) % v_.rows);
                for (std::int32_t s = 0; s < segments_; ++s)
                    flags_[s] = static_cast<std::uint8_t>(s <= last && (near(s) | there[s]) != 0 ? 1 : 0);
                runs.find(flags_, segments_);
            };
            reach(row - 1, below);
            reach(row, level);
            reach(row + 1, above);
        }

    private:
        const GasView& v_;
        std::int32_t segments_;

        [[nodiscard]] const std::uint8_t* live_in(std::int32_t row) const {
            return v_.live + std::ptrdiff_t{row} * segments_;
        }
        [[nodiscard]] bool holds_any(std::int32_t row, std::int32_t segment, int planes) const {
            const std::ptrdiff_t at = std::ptrdiff_t{row} * v_.stride + segment * segment_words;
            std::uint64_t any = 0;
            for (int i = 0; i < planes; ++i)
                for (std::int32_t w = 0; w < segment_words; ++w) any |= v_.plane[i][at + w];
            return any != 0;
        }

    public:
        Runs own, below, level, above;
        Runs arriving; // above, of the row before

    private:
        std::uint8_t* flags_;
    };

    static void move_runs(const GasView& v, const Runs& runs, const std::uint64_t* from, int shift,
                          std::uint64_t* to) {
        for (std::int32_t k = 0; k < runs.count; ++k)
            move(v, from, shift, to, runs.run[k].first, runs.run[k].last);
    }
    static void empty(const Runs& runs, const Buffer& buffer, int planes) {
        for (std::int32_t k = 0; k < runs.count; ++k)
            for (int i = 0; i < planes; ++i)
                for (std::int32_t w = runs.run[k].first; w < runs.run[k].last; ++w) buffer.collided[i][w] = 0;
    }

    // What a row needs while it is in work, by step of a pass.
    struct Level {
        Buffer buffer;
        std::uint64_t* walls;
        Activity active;

        Level(const GasView& v, std::uint64_t* scratch)
            : buffer(scratch, v.stride), walls(buffer.rising[1] + v.stride + pad),
              active(v, walls + v.stride) {}
    };

    // Rows of a tile in order; `row` may be beyond the last of the lattice, which is periodic then.
    template <GasModel model, GasVariant variant>
    static void pass_row(const GasView& v, const GasTile& tile, std::int32_t row, Level& level) {
        constexpr bool square = model == GasModel::hpp;
        constexpr int planes = planes_of(model), directions = square ? 4 : 6;
        // Directions along the row, up and down.
        constexpr int along[2] = {0, square ? 2 : 3}, up[2] = {1, square ? 1 : 2},
                      down[2] = {square ? 3 : 4, square ? 3 : 5}, sideways = square ? 1 : 2;
        const Buffer& buffer = level.buffer;
        Activity& active = level.active;
        const bool first = row == tile.first, last = row + 1 == tile.last;
        if (row >= v.rows) row -= v.rows;
        const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(row) * v.stride;
        const std::ptrdiff_t below =
            row > 0 ? start - v.stride : start + (v.rows - 1) * std::ptrdiff_t{v.stride};
        if (v.live != nullptr) empty(active.own, buffer, planes);
        active.look(row, planes);
        if constexpr (variant == GasVariant::counted)
            collide_counted_row(v, row, buffer);
        else
            for (std::int32_t k = 0; k < active.own.count; ++k)
                collide_row<model, variant>(v, row, active.own.run[k], buffer);
        if (!first) // sent up by the row before
            for (int k = 0; k < sideways; ++k)
                move_runs(v, active.arriving, buffer.rising[k], 0, v.plane[up[k]] + start);
        if (first && tile.below[0] == nullptr)
            reflect<square>(v, row, buffer, true, v.plane[up[0]] + start, v.plane[up[1]] + start,
                            level.walls);
        if (last && tile.above[0] == nullptr)
            reflect<square>(v, row, buffer, false, v.plane[down[0]] + start, v.plane[down[1]] + start,
                            level.walls);
        for (int i = 0; i < directions; ++i) close_ends(v, buffer.collided[i]);
        for (const int i : along)
            move_runs(v, active.level, buffer.collided[i], shift_of<square>(i, row), v.plane[i] + start);
        if constexpr (planes == 7) move_runs(v, active.level, buffer.collided[6], 0, v.plane[6] + start);
        for (int k = 0; k < sideways; ++k) {
            const int shift = shift_of<square>(down[k], row);
            if (!first)
                move_runs(v, active.below, buffer.collided[down[k]], shift, v.plane[down[k]] + below);
            else if (tile.below[0] != nullptr)
                move(v, buffer.collided[down[k]], shift, tile.below[k], 0, v.stride);
        }
        for (int k = 0; k < sideways; ++k) {
            const int shift = shift_of<square>(up[k], row);
            if (!last)
                move_runs(v, active.above, buffer.collided[up[k]], shift, buffer.rising[k]);
            else if (tile.above[0] != nullptr)
                move(v, buffer.collided[up[k]], shift, tile.above[k], 0, v.stride);
        }
    }

    template <GasModel model, GasVariant variant>
    static void step(const GasView& v, const GasTile& tile, std::uint64_t* scratch) {
        Level level(v, scratch);
        if (v.live != nullptr)
            for (int i = 0; i < planes_of(model); ++i)
                for (std::int32_t w = 0; w < v.stride; ++w) level.buffer.collided[i][w] = 0;
        for (std::int32_t row = tile.first; row < tile.last; ++row)
            pass_row<model, variant>(v, tile, row, level);
    }

    // A row goes on to the second step when the row above it has taken the first.
    template <GasModel model, GasVariant variant>
    static void pair(const GasView& v, const GasTile& first, const GasTile& second, std::uint64_t* scratch) {
        GasView later = v;
        ++later.step;
        Level one(v, scratch), two(later, scratch + gas_scratch_words(v.stride));
        const auto go_on = [&](std::int32_t row) {
            if (row >= second.first && row < second.last) pass_row<model, variant>(later, second, row, two);
        };
        for (std::int32_t row = first.first; row < first.last; ++row) {
            pass_row<model, variant>(v, first, row, one);
            go_on(row - 1);
        }
        go_on(first.last - 1);
    }
};

} // namespace sandlane::simd
