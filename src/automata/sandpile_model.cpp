// The sandpile of a scene: sweeps until it is quiet, grains and their avalanches, or the identity.
#include "automata/identity.hpp"
#include "automata/sandpile.hpp"
#include "core/bytes.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::automata {

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

SandpileModel::~SandpileModel() = default;

void SandpileModel::run(std::int64_t steps) {
    if (pile_.drive != scene::PileDrive::none && !stable_) relax();
    const std::int64_t last = step_ + steps;
    while (step_ < last && !finished()) {
        if (pile_.start == scene::PileStart::doubled)
            search(last - step_);
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

// From the smallest lattice of the search to the whole one.
std::vector<std::pair<std::int32_t, std::int32_t>> SandpileModel::levels() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> sizes = {{lattice_.columns, lattice_.rows}};
    while (std::max(sizes.back().first, sizes.back().second) > smallest_search)
        sizes.push_back({(sizes.back().first + 1) / 2, (sizes.back().second + 1) / 2});
    std::reverse(sizes.begin(), sizes.end());
    return sizes;
}

void SandpileModel::search(std::int64_t most) {
    const auto sizes = levels();
    const auto [columns, rows] = sizes[level_];
    if (search_ == nullptr)
        search_ = std::make_unique<IdentitySearch>(stretched(potential_, columns, rows, means_.threads),
                                                   means_, pile_.active_tiles);
    const IdentitySearch::Progress progress = search_->sweep(most);
    step_ += progress.sweeps;
    topplings_ += progress.topplings;
    if (!search_->finished()) return;
    potential_ = search_->potential();
    stable_ = ++level_ == sizes.size();
    if (stable_)
        for (std::int32_t y = 0; y < rows; ++y)
            for (std::int32_t x = 0; x < columns; ++x) lattice_.set(x, y, search_->lattice().get(x, y));
    search_.reset();
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
        // Of the search as far as it is, or of the last identity.
        const Potential p = search_ != nullptr ? search_->potential() : potential_;
        w.put(static_cast<std::uint64_t>(level_));
        w.put(static_cast<std::uint8_t>(search_ != nullptr));
        w.put(p.columns);
        w.put(p.rows);
        w.put_array(p.w.data(), p.w.size());
        if (search_ != nullptr) search_->save(w);
    }
    return std::move(w).bytes();
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
    if (pile_.start == scene::PileStart::doubled) restore_search(r);
    if (step < 0 || !r.at_end()) fail(Exit::io, "damaged state");
    read.other = read.heights;
    lattice_ = std::move(read);
    sweeper_.visit_all();
    step_ = step;
    topplings_ = topplings;
    phase_ = phase;
    stable_ = stable;
}

void SandpileModel::restore_search(ByteReader& r) {
    const auto level = r.get<std::uint64_t>();
    const bool searching = r.get<std::uint8_t>() != 0;
    Potential p{r.get<std::int32_t>(), r.get<std::int32_t>(), {}};
    r.get_array(p.w);
    // The size of the level in work, or of the last one that is done.
    const auto sizes = levels();
    std::pair<std::int32_t, std::int32_t> expected{0, 0};
    const std::uint64_t size = searching ? level : level - 1; // wraps around before the first
    if (size < sizes.size()) expected = sizes[size];
    if (level > sizes.size() || (searching && level == sizes.size()) ||
        std::pair{p.columns, p.rows} != expected ||
        p.w.size() != static_cast<std::size_t>(p.columns) * static_cast<std::size_t>(p.rows))
        fail(Exit::io, "the state is one of another lattice");
    // Of a Laplacian of at most 7 on each site (two stable heights and the grains between them): a larger one
    // is no potential of this lattice, and would be toppled back without end.
    const double most = 7.0 * (p.columns + 1.0) * (p.rows + 1.0);
    for (const double w : p.w)
        if (!(std::abs(w) <= most)) fail(Exit::io, "damaged state");
    std::unique_ptr<IdentitySearch> search;
    if (searching) {
        search = std::make_unique<IdentitySearch>(p, means_, pile_.active_tiles);
        search->load(r);
        p = {};
    }
    search_ = std::move(search);
    potential_ = std::move(p);
    level_ = static_cast<std::size_t>(level);
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
    std::vector<Quantity> heights = quantities();
    return {{"height", "grains", "", static_cast<std::size_t>(lattice_.columns),
             static_cast<std::size_t>(lattice_.rows), std::move(heights[0].values), false,
             stable_ ? 3.0 : 0.0}};
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
