#include "automata/sandpile.hpp"

#include "automata/identity.hpp"
#include "automata/reference/sandpile.hpp"
#include "core/bytes.hpp"
#include "core/error.hpp"

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
    changed_.resize((bands_ + 2) * (strips_ + 2), 1);
    next_.resize(changed_.size(), 0);
    topplings_.resize(bands_ * strips_);
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
    next_.fill(0);
    topplings_.fill(0);
    for_tiles(bands_, means_.threads, [&](std::size_t band) {
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
    });
    lattice.heights.swap(lattice.other);
    changed_.swap(next_);
    visited_ = static_cast<double>(std::accumulate(visits_.begin(), visits_.end(), std::uint64_t{0})) /
               static_cast<double>(bands_ * strips_);
    return std::accumulate(topplings_.begin(), topplings_.end(), std::uint64_t{0});
}

namespace {

constexpr std::size_t block_bands = 4; // of 8 rows, between two sweeps of a pair: a part of L2

} // namespace

// Each block takes its first sweep, with a row more on both sides, into a buffer, and the second from there.
std::array<std::uint64_t, 2> PileSweeper::sweep_pair(PileLattice& lattice, bool unit,
                                                     Column<std::uint8_t>* odometer) {
    if (means_.isa == simd::Isa::scalar) {
        const std::uint64_t first = sweep(lattice, unit, odometer);
        return {first, sweep(lattice, unit, odometer)};
    }
    const simd::AutomataKernels& kernels = simd::automata_kernels(means_.isa);
    const simd::PileKernel plain = kernels.pile[lattice.bytes - 1][unit ? 1 : 0],
                           kernel = odometer != nullptr ? kernels.pile_odometer : plain;
    const std::ptrdiff_t stride = lattice.stride, rows_between = block_bands * simd::band_rows + 2;
    between_.resize(
        static_cast<std::size_t>(stride * rows_between) * static_cast<std::size_t>(means_.threads), 0);
    first_topplings_.resize(topplings_.size());
    first_topplings_.fill(0);
    topplings_.fill(0);
    next_.fill(0);
    for_tiles((bands_ + block_bands - 1) / block_bands, means_.threads, [&](std::size_t block) {
        const std::ptrdiff_t thread = means_.threads > 1 ? thread_index() : 0;
        const auto low = static_cast<std::int32_t>(block * block_bands) * simd::band_rows;
        const auto high =
            std::min(low + static_cast<std::int32_t>(block_bands) * simd::band_rows, lattice.rows);
        std::uint8_t* between = between_.data() + thread * stride * rows_between; // row low - 1 first
        const auto view = [&](const std::uint8_t* from, std::uint8_t* to, std::int32_t row) {
            return simd::PileView{from,
                                  to,
                                  stride,
                                  inner_.data(),
                                  odometer != nullptr ? odometer->data() + lattice.origin() + row * stride
                                                      : nullptr,
                                  lattice.strips};
        };
        const simd::PileView into = view(lattice.heights.data() + lattice.origin() + (low - 1) * stride,
                                         between + simd::strip_bytes, low - 1),
                             out = view(between + simd::strip_bytes + stride,
                                        lattice.other.data() + lattice.origin() + low * stride, low);
        const auto run = [&](simd::PileKernel k, const simd::PileView& v, std::int32_t first,
                             std::int32_t last, std::uint64_t* topplings, std::uint8_t* changed) {
            k(v, {first, last, 0, lattice.strips, topplings, changed});
        };
        std::vector<std::uint64_t> unwanted(strips_);
        std::vector<std::uint8_t> unseen(strips_);
        const auto edge = [&](std::int32_t row, std::int32_t at) { // of the neighbouring blocks
            if (row < 0 || row >= lattice.rows)
                std::fill_n(between + at * stride, stride, std::uint8_t{0});
            else
                run(plain, into, at, at + 1, unwanted.data(), unseen.data());
        };
        edge(low - 1, 0);
        edge(high, high - low + 1);
        const auto for_bands = [&](const auto& body) {
            for (std::int32_t row = low; row < high; row += simd::band_rows)
                body(row - low, std::min(row + simd::band_rows, high) - low,
                     static_cast<std::size_t>(row / simd::band_rows));
        };
        const auto flags = [&](std::size_t band) { return next_.data() + (band + 1) * (strips_ + 2) + 1; };
        for_bands([&](std::int32_t first, std::int32_t last, std::size_t band) {
            run(kernel, into, first + 1, last + 1, first_topplings_.data() + band * strips_, flags(band));
        });
        for_bands([&](std::int32_t first, std::int32_t last, std::size_t band) {
            run(kernel, out, first, last, topplings_.data() + band * strips_, flags(band));
        });
    });
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

// ---- the model

namespace {

constexpr std::int32_t smallest_search = 32; // sites of a side that need no smaller lattice

int bytes_for(const scene::Sandpile& s) {
    return s.height + s.centre > 255 ? 2 : 1;
}

} // namespace

SandpileModel::SandpileModel(const scene::Scene& scene, const Means& means)
    : pile_(scene.sandpile),
      means_(means), seed_{static_cast<std::uint32_t>(scene.seed),
                           static_cast<std::uint32_t>(static_cast<std::uint64_t>(scene.seed) >> 32)},
      lattice_(static_cast<std::int32_t>(pile_.columns), static_cast<std::int32_t>(pile_.rows),
               bytes_for(pile_)),
      sweeper_(lattice_, means, pile_.active_tiles), statistics_(4) {
    const auto height =
        static_cast<std::uint32_t>(pile_.start == scene::PileStart::identity ? 6 : pile_.height);
    for (std::int32_t y = 0; y < lattice_.rows; ++y)
        for (std::int32_t x = 0; x < lattice_.columns; ++x) lattice_.set(x, y, height);
    lattice_.set(lattice_.columns / 2, lattice_.rows / 2, height + static_cast<std::uint32_t>(pile_.centre));
}

void SandpileModel::run(std::int64_t steps) {
    if (pile_.drive != scene::PileDrive::none && !stable_) relax();
    const std::int64_t last = step_ + steps;
    while (step_ < last && !finished()) {
        if (pile_.start == scene::PileStart::doubled)
            search();
        else if (pile_.drive == scene::PileDrive::none)
            sweep(last - step_);
        else
            drop_grain();
    }
}

void SandpileModel::sweep(std::int64_t most) {
    const bool unit = pile_.sweep == scene::PileSweep::unit;
    if (most < 2 || !sweeper_.pairs_pay()) {
        count_sweep(sweeper_.sweep(lattice_, unit));
        return;
    }
    for (const std::uint64_t topplings : sweeper_.sweep_pair(lattice_, unit))
        if (!count_sweep(topplings)) return;
}

// False if no site toppled: the pile is stable, or half way to the identity.
bool SandpileModel::count_sweep(std::uint64_t topplings) {
    topplings_ += topplings;
    if (topplings > 0) {
        ++step_;
        return true;
    }
    if (pile_.start == scene::PileStart::identity && phase_ == 0) {
        phase_ = 1;
        for (std::int32_t y = 0; y < lattice_.rows; ++y)
            for (std::int32_t x = 0; x < lattice_.columns; ++x) lattice_.set(x, y, 6 - lattice_.get(x, y));
        sweeper_.visit_all();
    } else {
        stable_ = true;
    }
    return false;
}

// A step is a lattice of twice the size.
void SandpileModel::search() {
    std::vector<std::pair<std::int32_t, std::int32_t>> sizes = {{lattice_.columns, lattice_.rows}};
    while (std::max(sizes.back().first, sizes.back().second) > smallest_search)
        sizes.push_back({(sizes.back().first + 1) / 2, (sizes.back().second + 1) / 2});
    const auto level = static_cast<std::size_t>(step_);
    const auto [columns, rows] = sizes[sizes.size() - 1 - level];
    IdentitySearch search(stretched(potential_, columns, rows, means_.threads), means_, pile_.active_tiles);
    while (search.sweep()) {
    }
    topplings_ += search.topplings();
    potential_ = search.potential();
    ++step_;
    stable_ = level + 1 == sizes.size();
    if (!stable_) return;
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) lattice_.set(x, y, search.lattice().get(x, y));
}

void SandpileModel::relax() {
    while (const std::uint64_t topplings = sweeper_.sweep(lattice_, false)) topplings_ += topplings;
    stable_ = true;
}

void SandpileModel::drop_grain() {
    const auto columns = static_cast<std::uint64_t>(lattice_.columns),
               rows = static_cast<std::uint64_t>(lattice_.rows), k = static_cast<std::uint64_t>(step_);
    std::uint64_t x = columns / 2, y = rows / 2;
    if (pile_.drive == scene::PileDrive::random) {
        const PhiloxCounter r =
            philox({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32), 0, 0}, seed_);
        x = r[0] * columns >> 32;
        y = r[1] * rows >> 32;
    } else if (pile_.drive == scene::PileDrive::ordered) {
        y = 7 * k % rows;
        x = (11 * k + k / columns) % columns;
    }
    const Avalanche a = runner_.drop(lattice_, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y));
    topplings_ += static_cast<std::uint64_t>(a.size);
    ++step_;
    if (step_ <= pile_.burn_in) return;
    const std::int64_t values[] = {a.size, a.area, a.duration, a.radius};
    for (std::size_t n = 0; n < 4; ++n) statistics_[n].add(values[n]);
}

std::string SandpileModel::serialise() const {
    ByteWriter w;
    w.put(step_);
    w.put(topplings_);
    w.put(static_cast<std::int32_t>(phase_));
    w.put(static_cast<std::uint8_t>(stable_));
    for (std::int32_t y = 0; y < lattice_.rows; ++y)
        w.put_array(lattice_.heights.data() + lattice_.origin() + y * lattice_.stride,
                    static_cast<std::size_t>(lattice_.columns * lattice_.bytes));
    for (const LogBins& bins : statistics_) bins.save(w);
    if (pile_.start == scene::PileStart::doubled) {
        w.put(potential_.columns);
        w.put(potential_.rows);
        w.put_array(potential_.w.data(), potential_.w.size());
    }
    return w.bytes();
}

void SandpileModel::restore(const std::string& state) {
    ByteReader r(state);
    const auto step = r.get<std::int64_t>();
    const auto topplings = r.get<std::uint64_t>();
    const auto phase = r.get<std::int32_t>();
    const bool stable = r.get<std::uint8_t>() != 0;
    const auto length = static_cast<std::size_t>(lattice_.columns * lattice_.bytes);
    PileLattice read = lattice_;
    std::vector<std::uint8_t> row;
    for (std::int32_t y = 0; y < lattice_.rows; ++y) {
        r.get_array(row);
        if (row.size() != length) fail(Exit::io, "the state is one of another lattice");
        std::copy(row.begin(), row.end(), read.heights.data() + read.origin() + y * read.stride);
    }
    for (LogBins& bins : statistics_) bins.load(r);
    if (pile_.start == scene::PileStart::doubled) {
        Potential p{r.get<std::int32_t>(), r.get<std::int32_t>(), {}};
        r.get_array(p.w);
        if (p.columns < 0 || p.columns > lattice_.columns || p.rows < 0 || p.rows > lattice_.rows ||
            p.w.size() != static_cast<std::size_t>(p.columns) * static_cast<std::size_t>(p.rows))
            fail(Exit::io, "the state is one of another lattice");
        potential_ = std::move(p);
    }
    read.other = read.heights;
    lattice_ = std::move(read);
    sweeper_.visit_all();
    step_ = step;
    topplings_ = topplings;
    phase_ = phase;
    stable_ = stable;
}

std::vector<Quantity> SandpileModel::quantities() const {
    Quantity q{"height", "1", {}};
    q.values.reserve(sites());
    for (std::int32_t y = 0; y < lattice_.rows; ++y)
        for (std::int32_t x = 0; x < lattice_.columns; ++x) q.values.push_back(lattice_.get(x, y));
    return {q, {"topplings", "1", {static_cast<double>(topplings_)}}};
}

std::vector<analysis::LogColumn> SandpileModel::log_columns() const {
    return {{"step", "1"}, {"grains", "1"}, {"topplings", "1"}, {"mean_size", "1"}};
}

std::vector<double> SandpileModel::log_row() const {
    return {static_cast<double>(step_), static_cast<double>(lattice_.grains()),
            static_cast<double>(topplings_), statistics_[0].mean()};
}

std::vector<Field> SandpileModel::fields() const {
    if (!potential_.w.empty() && !stable_) { // the identity of a smaller lattice
        Field field{"height",
                    "grains",
                    "",
                    static_cast<std::size_t>(potential_.columns),
                    static_cast<std::size_t>(potential_.rows),
                    {},
                    false,
                    3};
        for (const std::int32_t h : toppling_matrix(potential_)) field.values.push_back(h);
        return {field};
    }
    return {{"height", "grains", "", static_cast<std::size_t>(lattice_.columns),
             static_cast<std::size_t>(lattice_.rows), quantities()[0].values, false, stable_ ? 3.0 : 0.0}};
}

std::vector<Table> SandpileModel::final_tables() const {
    if (pile_.drive == scene::PileDrive::none) return {};
    const char* names[] = {"size", "area", "duration", "radius"};
    std::vector<Table> tables;
    for (std::size_t n = 0; n < 4; ++n)
        tables.push_back({std::string("avalanche-") + names[n],
                          {{names[n], "1"}, {"counts", "1"}, {"probability", "1"}},
                          statistics_[n].rows(),
                          0,
                          2,
                          true});
    return tables;
}

Facts SandpileModel::facts() const {
    return {{"model", "sandpile, threshold 4, open sides"},
            {"lattice", fmt::format("{} x {} sites, {} of height", lattice_.columns, lattice_.rows,
                                    lattice_.bytes == 1 ? "one byte" : "two bytes")},
            {"kernels",
             pile_.drive != scene::PileDrive::none
                 ? std::string("lists of unstable sites, one grain at a time")
             : means_.isa == simd::Isa::scalar
                 ? "the scalar reference, site by site"
                 : fmt::format("sweeps of tiles of {} bytes x {} rows{}", simd::strip_bytes, simd::band_rows,
                               pile_.active_tiles ? "; quiet ones are passed over" : "")}};
}

} // namespace sandlane::automata
