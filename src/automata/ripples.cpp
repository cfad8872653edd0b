#include "automata/ripples.hpp"

#include "automata/reference/ripples.hpp"
#include "automata/spectrum.hpp"
#include "core/bytes.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandlane::automata {

namespace {

constexpr std::uint32_t start_stream = 1 << 20;
constexpr std::int32_t tile_rows = 16; // fixed, whatever the threads
constexpr double highest = 0x1p18;     // differences of 2^19 are 2^51 fixed units, exact in kernels

std::ptrdiff_t stride_of(std::int32_t columns) {
    return static_cast<std::ptrdiff_t>(padded(static_cast<std::size_t>(columns))) + 2 * simd::ripple_pad;
}

void fail_high() {
    fail(Exit::unstable, "ripples: a height is beyond {:.0f}; lower transport, wind or the number of steps",
         highest);
}

} // namespace

// ---- steps

RippleStepper::RippleStepper(std::int32_t columns, std::int32_t rows, const RippleRules& rules,
                             const Means& means)
    : columns_(columns), rows_(rows), rules_(rules), means_(means) {
    if (means.isa == simd::Isa::scalar) return;
    const auto stride = static_cast<std::size_t>(stride_of(columns));
    landed_.resize(stride * static_cast<std::size_t>(rows), 0);
    scratch_.resize(7 * stride * static_cast<std::size_t>(means.threads), 0);
    const auto tiles = static_cast<std::size_t>((rows + tile_rows - 1) / tile_rows);
    clamped_.resize(tiles);
    high_.resize(tiles);
}

std::int64_t RippleStepper::step(Column<std::int64_t>& heights, std::uint32_t t) {
    const std::ptrdiff_t stride = stride_of(columns_);
    if (means_.isa == simd::Isa::scalar) {
        std::vector<std::int64_t> plain;
        for (std::int32_t y = 0; y < rows_; ++y) {
            const std::int64_t* row = heights.data() + y * stride + simd::ripple_pad;
            plain.insert(plain.end(), row, row + columns_);
        }
        const double most = highest * ripple_unit;
        if (std::any_of(plain.begin(), plain.end(),
                        [&](std::int64_t h) { return std::abs(static_cast<double>(h)) > most; }))
            fail_high(); // before the step, as kernels do
        const std::int64_t clamped = reference::step(plain, columns_, rows_, rules_, t);
        for (std::int32_t y = 0; y < rows_; ++y)
            std::copy_n(plain.data() + std::ptrdiff_t{y} * columns_, columns_,
                        heights.data() + y * stride + simd::ripple_pad);
        return clamped;
    }
    simd::RippleView v{};
    v.heights = heights.data() + simd::ripple_pad;
    v.landed = landed_.data() + simd::ripple_pad;
    v.rows = rows_;
    v.columns = columns_;
    v.stride = stride;
    v.length = rules_.length;
    v.wind = rules_.wind;
    v.transport = rules_.fixed_transport();
    v.near = rules_.creep * (1.0 / 6);
    v.far = rules_.creep * (1.0 / 12);
    v.line = rules_.creep * 0.5;
    v.highest = highest * ripple_unit;
    v.seed[0] = rules_.seed[0];
    v.seed[1] = rules_.seed[1];
    v.step = t;
    const simd::AutomataKernels& kernels = simd::automata_kernels(means_.isa);
    const simd::SaltationKernel saltation = kernels.saltation[static_cast<int>(rules_.landing)];
    const auto scratch = [&] {
        return scratch_.data() + 7 * stride * (means_.threads > 1 ? thread_index() : 0);
    };
    const auto first = [](std::size_t tile) { return static_cast<std::int32_t>(tile) * tile_rows; };
    for_tiles(clamped_.size(), means_.threads, [&](std::size_t k) {
        const simd::RippleResult r = saltation(v, first(k), std::min(first(k + 1), rows_), scratch());
        clamped_[k] = r.clamped;
        high_[k] = r.too_high ? 1 : 0;
    });
    if (std::find(high_.begin(), high_.end(), 1) != high_.end()) fail_high();
    for_tiles(clamped_.size(), means_.threads,
              [&](std::size_t k) { kernels.creep(v, first(k), std::min(first(k + 1), rows_), scratch()); });
    return std::accumulate(clamped_.begin(), clamped_.end(), std::int64_t{0});
}

// ---- wavelengths

std::vector<double> mode_powers(const std::vector<double>& heights, std::int32_t columns, std::int32_t rows) {
    const auto n = static_cast<std::size_t>(columns);
    std::vector<double> powers(n / 2, 0);
    const std::int32_t every = std::max(1, rows / 32);
    for (std::int32_t y = 0; y < rows; y += every) {
        const double* h = heights.data() + static_cast<std::size_t>(y) * n;
        const std::vector<std::complex<double>> modes = fourier({h, h + n});
        for (std::size_t m = 0; m < powers.size(); ++m) powers[m] += std::norm(modes[m + 1]);
    }
    return powers;
}

double crest_distance(const std::vector<double>& heights, std::int32_t columns, std::int32_t rows) {
    const double mean =
        std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
    std::int64_t crests = 0;
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) {
            const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
            const double here = heights[row + static_cast<std::size_t>(x)],
                         next = heights[row + static_cast<std::size_t>((x + 1) % columns)];
            crests += here <= mean && next > mean ? 1 : 0;
        }
    return crests > 0 ? static_cast<double>(columns) * rows / static_cast<double>(crests) : 0;
}

// ---- the model

namespace {

RippleRules rules_of(const scene::Scene& scene) {
    const scene::Ripples& s = scene.ripples;
    const auto seed = static_cast<std::uint64_t>(scene.seed);
    return {s.transport, s.wind,
            s.length,    s.creep,
            s.landing,   {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
}

} // namespace

RippleModel::RippleModel(const scene::Scene& scene, const Means& means)
    : ripples_(scene.ripples), means_(means), rules_(rules_of(scene)),
      columns_(static_cast<std::int32_t>(ripples_.columns)), rows_(static_cast<std::int32_t>(ripples_.rows)),
      stepper_(columns_, rows_, rules_, means) {
    const bool fixed = ripples_.arithmetic == scene::RippleArithmetic::fixed;
    const std::ptrdiff_t stride = stride_of(columns_);
    if (fixed)
        fixed_.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows_), 0);
    else
        floating_.resize(sites(), 0);
    for (std::int32_t y = 0; y < rows_; ++y)
        for (std::int32_t x = 0; x < columns_; ++x) {
            const PhiloxCounter r = philox(
                {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, start_stream}, rules_.seed);
            const double height = ripples_.noise * (r[0] * 0x1p-32 - 0.5);
            if (fixed)
                fixed_[static_cast<std::size_t>(y * stride + simd::ripple_pad + x)] =
                    static_cast<std::int64_t>(std::floor(height * ripple_unit));
            else
                floating_[static_cast<std::size_t>(std::int64_t{y} * columns_ + x)] = height;
        }
}

void RippleModel::run(std::int64_t steps) {
    for (std::int64_t n = 0; n < steps; ++n) {
        const auto t = static_cast<std::uint32_t>(step_);
        // As for fixed numbers; no number at all is caught, too.
        if (!std::all_of(floating_.begin(), floating_.end(), [](double h) { return std::abs(h) <= highest; }))
            fail_high();
        clamped_ += fixed_.empty() ? reference::step(floating_, columns_, rows_, rules_, t)
                                   : stepper_.step(fixed_, t);
        ++step_;
    }
}

std::vector<double> RippleModel::heights() const {
    if (fixed_.empty()) return floating_;
    std::vector<double> heights;
    heights.reserve(sites());
    for (std::int32_t y = 0; y < rows_; ++y) {
        const std::int64_t* row = fixed_.data() + y * stride_of(columns_) + simd::ripple_pad;
        for (std::int32_t x = 0; x < columns_; ++x)
            heights.push_back(static_cast<double>(row[x]) / ripple_unit);
    }
    return heights;
}

std::string RippleModel::serialise() const {
    ByteWriter w;
    w.put(step_);
    w.put(clamped_);
    if (fixed_.empty()) w.put_array(floating_.data(), floating_.size());
    for (std::int32_t y = 0; !fixed_.empty() && y < rows_; ++y)
        w.put_array(fixed_.data() + y * stride_of(columns_) + simd::ripple_pad,
                    static_cast<std::size_t>(columns_));
    return w.bytes();
}

void RippleModel::restore(const std::string& state) {
    ByteReader r(state);
    const auto step = r.get<std::int64_t>(), clamped = r.get<std::int64_t>();
    const auto check = [](std::size_t size, std::size_t expected) {
        if (size != expected) fail(Exit::io, "the state is one of another bed");
    };
    if (fixed_.empty()) {
        std::vector<double> read;
        r.get_array(read);
        check(read.size(), floating_.size());
        floating_ = std::move(read);
    } else {
        Column<std::int64_t> read = fixed_;
        std::vector<std::int64_t> row;
        for (std::int32_t y = 0; y < rows_; ++y) {
            r.get_array(row);
            check(row.size(), static_cast<std::size_t>(columns_));
            std::copy(row.begin(), row.end(), read.data() + y * stride_of(columns_) + simd::ripple_pad);
        }
        fixed_ = std::move(read);
    }
    if (step < 0 || !r.at_end()) fail(Exit::io, "damaged state");
    step_ = step;
    clamped_ = clamped;
}

std::vector<Quantity> RippleModel::quantities() const {
    return {{"height", "1", heights()}};
}

std::vector<analysis::LogColumn> RippleModel::log_columns() const {
    return {{"step", "1"},       {"mean_height", "1"},    {"rms_height", "1"},
            {"wavelength", "1"}, {"crest_distance", "1"}, {"clamped", "1"}};
}

std::vector<double> RippleModel::log_row() const {
    const std::vector<double> h = heights();
    const double n = static_cast<double>(h.size()), mean = std::accumulate(h.begin(), h.end(), 0.0) / n;
    double squares = 0;
    for (const double height : h) squares += (height - mean) * (height - mean);
    const std::vector<double> powers = mode_powers(h, columns_, rows_);
    const auto mode = std::max_element(powers.begin(), powers.end()) - powers.begin() + 1;
    return {static_cast<double>(step_),
            mean,
            std::sqrt(squares / n),
            powers.empty() ? 0.0 : static_cast<double>(columns_) / static_cast<double>(mode),
            crest_distance(h, columns_, rows_),
            static_cast<double>(clamped_)};
}

std::vector<Field> RippleModel::fields() const {
    std::vector<double> h = heights();
    const double mean = std::accumulate(h.begin(), h.end(), 0.0) / static_cast<double>(h.size());
    for (double& height : h) height -= mean;
    return {{"height", "height above the mean", "", static_cast<std::size_t>(columns_),
             static_cast<std::size_t>(rows_), std::move(h), true, 0}};
}

std::vector<Table> RippleModel::final_tables() const {
    Table table{"modes", {{"mode", "1"}, {"wavelength", "1"}, {"power", "1"}}, {}, 1, 2, true};
    const std::vector<double> powers = mode_powers(heights(), columns_, rows_);
    for (std::size_t m = 0; m < powers.size(); ++m)
        table.rows.push_back({static_cast<double>(m + 1), columns_ / static_cast<double>(m + 1), powers[m]});
    return {table};
}

Facts RippleModel::facts() const {
    return {{"model", rows_ == 1 ? "ripples along a line" : "ripples of a plane"},
            {"bed", fmt::format("{} x {} sites, periodic", columns_, rows_)},
            {"kernels",
             fixed_.empty() ? "the scalar reference in double precision"
             : means_.isa == simd::Isa::scalar
                 ? "the scalar reference in numbers of 2^-32"
                 : fmt::format("numbers of 2^-32, saltation by rows, creep in tiles of {} rows", tile_rows)}};
}

} // namespace sandlane::automata
