#include "automata/sandpile.hpp"

#include "automata/reference/sandpile.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace sandlane::automata {

// ---- the lattice

PileLattice::PileLattice(std::int32_t width, std::int32_t tall, int height_bytes)
    : columns(width), rows(tall), bytes(height_bytes),
      strips((width * height_bytes + simd::strip_bytes - 1) / simd::strip_bytes),
      stride(std::ptrdiff_t{simd::strip_bytes} * (strips + 2)) {
    heights.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows + 2), 0);
    other = heights;
}

void PileLattice::put(Column<std::uint8_t>& to, std::int32_t x, std::int32_t y, std::uint32_t height) const {
    std::uint8_t* p = to.data() + origin() + y * stride + std::ptrdiff_t{x} * bytes;
    p[0] = static_cast<std::uint8_t>(height);
    if (bytes == 2) p[1] = static_cast<std::uint8_t>(height >> 8);
}

std::uint64_t PileLattice::grains() const {
    std::uint64_t sum = 0;
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) sum += get(x, y);
    return sum;
}

// ---- sweeps

PileSweeper::PileSweeper(const PileLattice& lattice, const Means& means, bool active_tiles)
    : means_(means), active_tiles_(active_tiles), large_(lattice.heights.size() > std::size_t{1} << 19),
      strips_(static_cast<std::size_t>(lattice.strips)),
      bands_(static_cast<std::size_t>((lattice.rows + simd::band_rows - 1) / simd::band_rows)) {
    inner_.resize(simd::strip_bytes / 8, 0);
    const auto inside =
        static_cast<std::size_t>(lattice.columns * lattice.bytes - (lattice.strips - 1) * simd::strip_bytes);
    std::fill_n(reinterpret_cast<std::uint8_t*>(inner_.data()), inside, std::uint8_t{0xff});
    changed_.resize((bands_ + 2) * (strips_ + 2), 0);
    for (std::size_t band = 1; band <= bands_; ++band)
        std::fill_n(changed_.data() + band * (strips_ + 2) + 1, strips_, std::uint8_t{1});
    next_.resize(changed_.size(), 0);
    topplings_.resize(bands_ * strips_);
    sums_.resize(bands_);
    visits_.resize(bands_);
}

std::uint64_t PileSweeper::sweep(PileLattice& lattice, bool unit, Column<std::uint8_t>* odometer) {
    if (means_.isa != simd::Isa::scalar) return sweep_tiles(lattice, unit, odometer);
    reference::Pile pile(lattice.columns, lattice.rows);
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x) pile.at(x, y) = lattice.get(x, y);
    const std::int64_t topplings = reference::sweep(pile, unit);
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x)
            lattice.set(x, y, static_cast<std::uint32_t>(pile.at(x, y)));
    if (odometer != nullptr) {
        std::size_t n = 0;
        for (std::int32_t y = 0; y < lattice.rows; ++y)
            for (std::int32_t x = 0; x < lattice.columns; ++x) {
                std::uint8_t* count = odometer->data() + lattice.origin() + y * lattice.stride + 2 * x;
                const auto sum = static_cast<std::uint32_t>((count[0] | count[1] << 8) + pile.topplings[n++]);
                count[0] = static_cast<std::uint8_t>(sum);
                count[1] = static_cast<std::uint8_t>(sum >> 8);
            }
    }
    return static_cast<std::uint64_t>(topplings);
}

std::uint64_t PileSweeper::sweep_tiles(PileLattice& lattice, bool unit, Column<std::uint8_t>* odometer) {
    const simd::AutomataKernels& kernels = simd::automata_kernels(means_.isa);
    const simd::PileKernel kernel =
        odometer != nullptr ? kernels.pile_odometer : kernels.pile[lattice.bytes - 1][unit ? 1 : 0];
    const simd::PileView view{lattice.heights.data() + lattice.origin(),
                              lattice.other.data() + lattice.origin(),
                              lattice.stride,
                              inner_.data(),
                              odometer != nullptr ? odometer->data() + lattice.origin() : nullptr,
                              lattice.strips};
    const std::size_t wide = strips_ + 2;
    for_tiles(bands_, means_.threads, [&](std::size_t band) {
        begin_band(band, topplings_);
        const std::uint8_t* around = changed_.data() + band * wide;
        const auto is_active = [&](std::size_t strip) {
            std::uint8_t any = 0;
            for (std::size_t row = 0; row < 3; ++row)
                for (std::size_t k = 0; k < 3; ++k) any |= around[row * wide + strip + k];
            return !active_tiles_ || any != 0;
        };
        const auto first_row = static_cast<std::int32_t>(band) * simd::band_rows;
        simd::PileTiles tiles{first_row,
                              std::min(first_row + simd::band_rows, lattice.rows),
                              0,
                              0,
                              topplings_.data() + band * strips_,
                              next_.data() + (band + 1) * wide + 1};
        visits_[band] = 0;
        for (std::size_t strip = 0; strip < strips_;) {
            if (!is_active(strip)) {
                ++strip;
                continue;
            }
            const std::size_t first = strip;
            while (strip < strips_ && is_active(strip)) ++strip;
            tiles.first = static_cast<std::int32_t>(first);
            tiles.last = static_cast<std::int32_t>(strip);
            visits_[band] += strip - first;
            kernel(view, tiles);
        }
        sums_[band] = sum_of_band(band, topplings_);
    });
    lattice.heights.swap(lattice.other);
    changed_.swap(next_);
    visited_ = static_cast<double>(std::accumulate(visits_.begin(), visits_.end(), std::uint64_t{0})) /
               static_cast<double>(bands_ * strips_);
    return std::accumulate(sums_.begin(), sums_.end(), std::uint64_t{0});
}

void PileSweeper::begin_band(std::size_t band, Column<std::uint64_t>& topplings) {
    std::fill_n(next_.data() + (band + 1) * (strips_ + 2), strips_ + 2, std::uint8_t{0});
    std::fill_n(topplings.data() + band * strips_, strips_, std::uint64_t{0});
}

std::uint64_t PileSweeper::sum_of_band(std::size_t band, const Column<std::uint64_t>& topplings) const {
    const std::uint64_t* strip = topplings.data() + band * strips_;
    return std::accumulate(strip, strip + strips_, std::uint64_t{0});
}

namespace {

constexpr std::size_t block_bands = 4; // of 8 rows, between two sweeps of a pair: a part of L2

} // namespace

// The rows of a block, with one more on both sides, after the first sweep lie in `between`; from there the
// second goes.
struct PileSweeper::Pair {
    PileLattice& lattice;
    simd::PileKernel plain, counting; // counting: adds to the odometer, if there is one
    std::uint8_t* odometer;           // of site (0, 0), or null
    const std::uint64_t* inner;
    std::uint8_t* between; // [threads][rows_between][stride]

    static constexpr std::int32_t block_rows = static_cast<std::int32_t>(block_bands) * simd::band_rows;
    static constexpr std::int32_t rows_between = block_rows + 2;

    // From `from` to `to`, both of lattice row `row` and strip 0.
    [[nodiscard]] simd::PileView view(const std::uint8_t* from, std::uint8_t* to, std::int32_t row) const {
        return {from,
                to,
                lattice.stride,
                inner,
                odometer != nullptr ? odometer + row * lattice.stride : nullptr,
                lattice.strips};
    }
    [[nodiscard]] std::uint8_t* site(Column<std::uint8_t>& heights, std::int32_t row) const {
        return heights.data() + lattice.origin() + row * lattice.stride;
    }
};

void PileSweeper::sweep_block(const Pair& pair, std::size_t block) {
    PileLattice& lattice = pair.lattice;
    const std::ptrdiff_t stride = lattice.stride, thread = means_.threads > 1 ? thread_index() : 0;
    const auto low = static_cast<std::int32_t>(block) * Pair::block_rows;
    const std::int32_t rows = std::min(Pair::block_rows, lattice.rows - low);
    std::uint8_t* between = pair.between + thread * stride * Pair::rows_between;
    const simd::PileView into =
        pair.view(pair.site(lattice.heights, low - 1), between + simd::strip_bytes, low - 1);
    const simd::PileView out =
        pair.view(between + simd::strip_bytes + stride, pair.site(lattice.other, low), low);
    for (std::size_t band = block * block_bands; band < std::min((block + 1) * block_bands, bands_); ++band) {
        begin_band(band, first_topplings_);
        begin_band(band, topplings_);
    }
    std::vector<std::uint64_t> uncounted(strips_); // of rows of the neighbouring blocks
    std::vector<std::uint8_t> unseen(strips_);
    for (const std::int32_t at : {0, rows + 1}) {
        const std::int32_t row = low - 1 + at;
        if (row < 0 || row >= lattice.rows)
            std::fill_n(between + at * stride, stride, std::uint8_t{0});
        else
            pair.plain(into, {at, at + 1, 0, lattice.strips, uncounted.data(), unseen.data()});
    }
    // The rows of `into` begin one before the block.
    const auto sweep_bands = [&](const simd::PileView& view, std::int32_t offset,
                                 Column<std::uint64_t>& topplings) {
        for (std::int32_t first = 0; first < rows; first += simd::band_rows) {
            const std::size_t band = block * block_bands + static_cast<std::size_t>(first / simd::band_rows);
            pair.counting(view, {first + offset, std::min(first + simd::band_rows, rows) + offset, 0,
                                 lattice.strips, topplings.data() + band * strips_,
                                 next_.data() + (band + 1) * (strips_ + 2) + 1});
        }
    };
    sweep_bands(into, 1, first_topplings_);
    sweep_bands(out, 0, topplings_);
}

std::array<std::uint64_t, 2> PileSweeper::sweep_pair(PileLattice& lattice, bool unit,
                                                     Column<std::uint8_t>* odometer) {
    if (means_.isa == simd::Isa::scalar) {
        const std::uint64_t first = sweep(lattice, unit, odometer);
        return {first, sweep(lattice, unit, odometer)};
    }
    const simd::AutomataKernels& kernels = simd::automata_kernels(means_.isa);
    const simd::PileKernel plain = kernels.pile[lattice.bytes - 1][unit ? 1 : 0];
    between_.resize(static_cast<std::size_t>(lattice.stride * Pair::rows_between) *
                        static_cast<std::size_t>(means_.threads),
                    0);
    first_topplings_.resize(topplings_.size());
    const bool counts = odometer != nullptr;
    const Pair pair{lattice,
                    plain,
                    counts ? kernels.pile_odometer : plain,
                    counts ? odometer->data() + lattice.origin() : nullptr,
                    inner_.data(),
                    between_.data()};
    for_tiles((bands_ + block_bands - 1) / block_bands, means_.threads,
              [&](std::size_t block) { sweep_block(pair, block); });
    lattice.heights.swap(lattice.other);
    changed_.swap(next_);
    visited_ = active_tiles_ ? active_share() : 1;
    return {std::accumulate(first_topplings_.begin(), first_topplings_.end(), std::uint64_t{0}),
            std::accumulate(topplings_.begin(), topplings_.end(), std::uint64_t{0})};
}

// Of the tiles that changed in the last pass; near enough to decide how to go on.
double PileSweeper::active_share() const {
    std::size_t sum = 0;
    for (std::size_t band = 0; band < bands_; ++band)
        for (std::size_t strip = 0; strip < strips_; ++strip)
            sum += changed_[(band + 1) * (strips_ + 2) + strip + 1];
    return static_cast<double>(sum) / static_cast<double>(bands_ * strips_);
}

// ---- single grains

// Unit sweeps over lists: a site is in the next list once, when it reaches four grains; no site ever has
// eight.
Avalanche AvalancheRunner::drop(PileLattice& lattice, std::int32_t x, std::int32_t y) {
    Avalanche result;
    toppled_.resize(lattice.heights.size(), 0);
    if (++number_ == 0) {
        toppled_.fill(0);
        number_ = 1;
    }
    std::uint8_t* heights = lattice.heights.data();
    const std::ptrdiff_t stride = lattice.stride, origin = lattice.origin();
    const std::ptrdiff_t start = origin + y * stride + x;
    unstable_.clear();
    const auto add = [&](std::ptrdiff_t site, std::vector<std::ptrdiff_t>& list) {
        if (++heights[site] == 4) list.push_back(site);
    };
    add(start, unstable_);
    while (!unstable_.empty()) {
        ++result.duration;
        next_.clear();
        // All that are unstable now give first: a site that gets its grains back in this sweep topples in the
        // next.
        for (const std::ptrdiff_t site : unstable_)
            heights[site] = static_cast<std::uint8_t>(heights[site] - 4);
        for (const std::ptrdiff_t site : unstable_) {
            ++result.size;
            if (toppled_[static_cast<std::size_t>(site)] != number_) {
                toppled_[static_cast<std::size_t>(site)] = number_;
                ++result.area;
                const std::ptrdiff_t dy = (site - origin) / stride - y, dx = (site - origin) % stride - x;
                result.radius = std::max({result.radius, std::abs(dx), std::abs(dy)});
            }
        }
        for (const std::ptrdiff_t site : unstable_) {
            const std::ptrdiff_t column = (site - origin) % stride, row = (site - origin) / stride;
            if (column > 0) add(site - 1, next_);
            if (column + 1 < lattice.columns) add(site + 1, next_);
            if (row > 0) add(site - stride, next_);
            if (row + 1 < lattice.rows) add(site + stride, next_);
        }
        unstable_.swap(next_);
    }
    return result;
}

} // namespace sandlane::automata
