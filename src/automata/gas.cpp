#include "automata/gas.hpp"

#include "automata/reference/gas.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sandlane::automata {

std::uint32_t sixteenths(double probability) {
    return static_cast<std::uint32_t>(std::lround(probability * (1 << simd::probability_bits)));
}

GasLattice::GasLattice(std::int32_t width, std::int32_t height)
    : columns(width), rows(height), words((width + 63) / 64),
      stride((words + simd::segment_words - 1) / simd::segment_words * simd::segment_words) {
    for (auto& p : plane) p.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows), 0);
}

void GasLattice::make_solid(std::int32_t x, std::int32_t y) {
    if (solid.empty()) solid.resize(plane[0].size(), 0);
    assign(solid[word(x, y)], x, true);
}

std::uint64_t GasLattice::particles(int direction) const {
    std::uint64_t sum = 0;
    for (const std::uint64_t w : plane[static_cast<std::size_t>(direction)])
        sum += static_cast<std::uint64_t>(std::popcount(w));
    return sum;
}

namespace {

simd::GasKernel kernel_for(const GasLattice& lattice, const GasRules& rules, simd::Isa isa) {
    if (isa == simd::Isa::scalar) return nullptr;
    const bool general = !lattice.solid.empty() || rules.gravity > 0 || rules.model == GasModel::pipe;
    const auto variant = general             ? simd::GasVariant::general
                         : rules.alternating ? simd::GasVariant::alternating
                                             : simd::GasVariant::plain;
    return simd::automata_kernels(isa).gas[static_cast<int>(rules.model)][static_cast<int>(variant)];
}

} // namespace

GasStepper::GasStepper(const GasLattice& lattice, const GasRules& rules, const Means& means,
                       bool active_tiles)
    : rules_(rules), means_(means), kernel_(kernel_for(lattice, rules, means.isa)),
      tiles_(static_cast<std::size_t>((lattice.rows + simd::gas_tile_rows - 1) / simd::gas_tile_rows)),
      scratch_words_(padded(simd::gas_scratch_words(lattice.stride))) {
    if (kernel_ == nullptr) return;
    scratch_.resize(scratch_words_ * static_cast<std::size_t>(means.threads));
    into_first_.resize(tiles_ * 2 * static_cast<std::size_t>(lattice.stride));
    into_last_.resize(into_first_.size());
    if (!active_tiles) return;
    live_.resize(static_cast<std::size_t>(lattice.rows) * static_cast<std::size_t>(lattice.stride) /
                     simd::segment_words,
                 1);
    occupied_ = live_;
}

// Particles move by one site: what is near an occupied segment may be occupied next.
void GasStepper::spread_activity(const GasLattice& lattice) {
    const std::int32_t segments = lattice.stride / simd::segment_words,
                       last = (lattice.words - 1) / simd::segment_words, rows = lattice.rows;
    for_tiles(tiles_, means_.threads, [&](std::size_t k) {
        const std::int32_t first = static_cast<std::int32_t>(k) * simd::gas_tile_rows;
        for (std::int32_t y = first; y < std::min(first + simd::gas_tile_rows, rows); ++y)
            for (std::int32_t s = 0; s < segments; ++s) {
                std::uint8_t any = 0;
                for (const std::int32_t row : {(y + rows - 1) % rows, y, (y + 1) % rows}) {
                    const std::uint8_t* o = occupied_.data() + std::ptrdiff_t{row} * segments;
                    any |=
                        static_cast<std::uint8_t>(o[s] | o[s > 0 ? s - 1 : last] | o[s < last ? s + 1 : 0]);
                }
                live_[static_cast<std::size_t>(y) * static_cast<std::size_t>(segments) +
                      static_cast<std::size_t>(s)] = s <= last ? any : 0;
            }
    });
}

void GasStepper::step(GasLattice& lattice, std::uint32_t t) {
    if (kernel_ == nullptr) {
        reference::step(lattice, rules_, t);
        return;
    }
    simd::GasView v{};
    for (std::size_t i = 0; i < lattice.plane.size(); ++i) v.plane[i] = lattice.plane[i].data();
    v.solid = lattice.solid.empty() ? nullptr : lattice.solid.data();
    v.rows = lattice.rows;
    v.columns = lattice.columns;
    v.words = lattice.words;
    v.stride = lattice.stride;
    v.seed[0] = rules_.seed[0];
    v.seed[1] = rules_.seed[1];
    v.step = t;
    v.dissipation = rules_.dissipation;
    v.gravity = rules_.gravity;
    v.roughness = rules_.roughness;
    v.live = live_.empty() ? nullptr : live_.data();
    v.occupied = live_.empty() ? nullptr : occupied_.data();
    const std::size_t edge = 2 * static_cast<std::size_t>(lattice.stride);
    const auto first_row = [&](std::size_t tile) {
        return static_cast<std::int32_t>(tile) * simd::gas_tile_rows;
    };
    for_tiles(tiles_, means_.threads, [&](std::size_t k) {
        const std::size_t below = (k + tiles_ - 1) % tiles_, above = (k + 1) % tiles_;
        const bool on_floor = rules_.closed && k == 0, under_roof = rules_.closed && k + 1 == tiles_;
        const simd::GasTile tile{first_row(k), std::min(first_row(k + 1), lattice.rows),
                                 on_floor ? nullptr : into_last_.data() + below * edge,
                                 under_roof ? nullptr : into_first_.data() + above * edge};
        const auto thread = means_.threads > 1 ? static_cast<std::size_t>(thread_index()) : 0;
        kernel_(v, tile, scratch_.data() + thread * scratch_words_);
    });
    // Directions that go up and down.
    const bool square = rules_.directions() == 4;
    const std::size_t up[] = {1, 2}, down[] = {square ? 3UL : 4UL, 5};
    const auto put = [&](const std::uint64_t* from, std::size_t direction, std::int32_t row) {
        const std::size_t stride = static_cast<std::size_t>(lattice.stride);
        std::copy(from, from + stride,
                  lattice.plane[direction].data() + static_cast<std::size_t>(row) * stride);
    };
    for_tiles(tiles_, means_.threads, [&](std::size_t k) {
        for (std::size_t n = 0; n < (square ? 1U : 2U); ++n) {
            const std::size_t at = k * edge + n * static_cast<std::size_t>(lattice.stride);
            if (!rules_.closed || k > 0) put(into_first_.data() + at, up[n], first_row(k));
            if (!rules_.closed || k + 1 < tiles_)
                put(into_last_.data() + at, down[n], std::min(first_row(k + 1), lattice.rows) - 1);
        }
    });
    if (!live_.empty()) spread_activity(lattice);
}

// ---- the model

void GasFlow::run(std::int64_t steps) {
    for (std::int64_t n = 0; n < steps; ++n) {
        stepper_.step(lattice_, static_cast<std::uint32_t>(step_));
        ++step_;
        look();
    }
}

std::string GasFlow::serialise() const {
    ByteWriter w;
    w.put(step_);
    for (int i = 0; i < rules_.planes(); ++i) {
        const Column<std::uint64_t>& p = lattice_.plane[static_cast<std::size_t>(i)];
        w.put_array(p.data(), p.size());
    }
    save(w);
    return w.bytes();
}

void GasFlow::restore(const std::string& state) {
    ByteReader r(state);
    const auto at = r.get<std::int64_t>();
    GasLattice read = lattice_;
    for (int i = 0; i < rules_.planes(); ++i) {
        Column<std::uint64_t>& p = read.plane[static_cast<std::size_t>(i)];
        const std::size_t expected = p.size();
        r.get_array(p);
        if (p.size() != expected) fail(Exit::io, "the state is one of another lattice");
    }
    load(r);
    lattice_ = std::move(read);
    stepper_.visit_all();
    step_ = at;
}

std::vector<Quantity> GasFlow::quantities() const {
    std::vector<Quantity> found;
    for (int i = 0; i < rules_.planes(); ++i) {
        Quantity q{i == 6 ? "rest" : "direction " + std::to_string(i), "1", {}};
        q.values.reserve(sites());
        for (std::int32_t y = 0; y < lattice_.rows; ++y)
            for (std::int32_t x = 0; x < lattice_.columns; ++x)
                q.values.push_back(lattice_.get(i, x, y) ? 1 : 0);
        found.push_back(std::move(q));
    }
    return found;
}

std::vector<analysis::LogColumn> GasFlow::log_columns() const {
    return {{"step", "1"},       {"particles", "1"},  {"moving", "1"},
            {"momentum_x", "1"}, {"momentum_y", "1"}, {"flow", "sites/step"}};
}

std::vector<double> GasFlow::log_row() const {
    // Twice the velocities; HPP on its square lattice.
    constexpr double six[7][2] = {{2, 0}, {1, 1}, {-1, 1}, {-2, 0}, {-1, -1}, {1, -1}, {0, 0}};
    constexpr double four[4][2] = {{2, 0}, {0, 2}, {-2, 0}, {0, -2}};
    double particles = 0, moving = 0, x = 0, y = 0;
    for (int i = 0; i < rules_.planes(); ++i) {
        const auto count = static_cast<double>(lattice_.particles(i));
        const double* c = rules_.directions() == 4 ? four[i] : six[i];
        particles += count;
        if (i < rules_.directions()) moving += count;
        x += c[0] * count;
        y += c[1] * count;
    }
    return {static_cast<double>(step_), particles, moving, x, y, particles > 0 ? x / (2 * particles) : 0};
}

Facts GasFlow::facts() const {
    constexpr const char* names[] = {"HPP", "FHP-I", "FHP-II", "FHP-III", "pipe flow, one rest particle"};
    Facts facts = {
        {"model", names[static_cast<int>(rules_.model)]},
        {"lattice", fmt::format("{} x {} sites, {}", lattice_.columns, lattice_.rows,
                                rules_.directions() == 4 ? "square" : "triangular (bricks)")},
        {"kernels", means_.isa == simd::Isa::scalar
                        ? "the scalar reference, site by site"
                        : fmt::format("bit planes, in place, tiles of {} rows", simd::gas_tile_rows)}};
    if (!lattice_.solid.empty()) {
        std::size_t solid = 0;
        for (const std::uint64_t w : lattice_.solid) solid += static_cast<std::size_t>(std::popcount(w));
        facts.push_back({"solid sites", std::to_string(solid)});
    }
    return facts;
}

// Means over square blocks, so that noise does not hide the flow: at most 256 of them in a row.
std::vector<Field> GasFlow::fields() const {
    const std::int32_t block = std::max(1, (lattice_.columns + 255) / 256);
    const auto wide = static_cast<std::size_t>((lattice_.columns + block - 1) / block);
    const auto tall = static_cast<std::size_t>((lattice_.rows + block - 1) / block);
    const std::size_t n = wide * tall;
    std::vector<double> count(n, 0), ux(n, 0), uy(n, 0), places(n, 0);
    const double up = std::sqrt(0.75);
    const double six[7][2] = {{1, 0}, {0.5, up}, {-0.5, up}, {-1, 0}, {-0.5, -up}, {0.5, -up}, {0, 0}};
    const double four[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (std::int32_t y = 0; y < lattice_.rows; ++y)
        for (std::int32_t x = 0; x < lattice_.columns; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y / block) * wide + static_cast<std::size_t>(x / block);
            places[at] += lattice_.is_solid(x, y) ? 0 : 1;
            for (int i = 0; i < rules_.planes(); ++i) {
                if (!lattice_.get(i, x, y)) continue;
                const double* c = rules_.directions() == 4 ? four[i] : six[i];
                count[at] += 1;
                ux[at] += c[0];
                uy[at] += c[1];
            }
        }
    Field density{"density", "particles per site", "", wide, tall, std::vector<double>(n, 0), false, 0};
    Field vx{"velocity_x", "velocity x", "", wide, tall, std::vector<double>(n, 0), true, 0};
    Field vy = vx;
    vy.name = "velocity_y";
    vy.label = "velocity y";
    for (std::size_t k = 0; k < n; ++k) {
        density.values[k] = places[k] > 0 ? count[k] / places[k] : 0;
        vx.values[k] = count[k] > 0 ? ux[k] / count[k] : 0;
        vy.values[k] = count[k] > 0 ? uy[k] / count[k] : 0;
    }
    return {vy, vx, density};
}

} // namespace sandlane::automata
