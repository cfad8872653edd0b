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

simd::GasVariant variant_of(const GasLattice& lattice, const GasRules& rules) {
    if (rules.counted) return simd::GasVariant::counted;
    const bool general = !lattice.solid.empty() || rules.gravity > 0 || rules.model == GasModel::pipe;
    return general             ? simd::GasVariant::general
           : rules.alternating ? simd::GasVariant::alternating
                               : simd::GasVariant::plain;
}

} // namespace

GasStepper::GasStepper(const GasLattice& lattice, const GasRules& rules, const Means& means,
                       bool active_tiles, bool by_planes)
    : rules_(rules), means_(means), rows_(lattice.rows),
      tiles_(static_cast<std::size_t>((lattice.rows + simd::gas_tile_rows - 1) / simd::gas_tile_rows)),
      crew_(static_cast<int>(std::min(static_cast<std::size_t>(means.threads), tiles_))),
      scratch_words_(padded(simd::gas_scratch_words(lattice.stride))) {
    if (means.isa == simd::Isa::scalar) return;
    const simd::AutomataKernels& kernels = simd::automata_kernels(means.isa);
    const int model = static_cast<int>(rules.model), variant = static_cast<int>(variant_of(lattice, rules));
    by_bytes_ = rules.model == GasModel::fhp3 && !by_planes && kernels.fhp3_bytes[variant] != nullptr;
    kernel_ = by_bytes_ ? kernels.fhp3_bytes[variant] : kernels.gas[model][variant];
    const std::int32_t last_rows = rows_ - first_row(tiles_ - 1);
    if (!active_tiles && last_rows >= 3)
        pair_ = by_bytes_ ? kernels.fhp3_bytes_pair[variant] : kernels.gas_pair[model][variant];
    scratch_.resize(2 * scratch_words_ * static_cast<std::size_t>(crew_));
    const std::size_t edge_words = tiles_ * 2 * static_cast<std::size_t>(lattice.stride);
    for (Edges* edges : {&edges_, &second_}) {
        edges->into_first.resize(edge_words);
        edges->into_last.resize(edge_words);
    }
    if (!active_tiles) return;
    live_.resize(static_cast<std::size_t>(lattice.rows) * static_cast<std::size_t>(lattice.stride) /
                     simd::segment_words,
                 1);
    occupied_ = live_;
}

// Particles move by one site: what is near an occupied segment may be occupied next.
void GasStepper::spread_activity(const GasLattice& lattice, std::size_t tile) {
    const std::int32_t segments = lattice.stride / simd::segment_words,
                       last = (lattice.words - 1) / simd::segment_words, rows = lattice.rows;
    for (std::int32_t y = first_row(tile); y < std::min(first_row(tile + 1), rows); ++y)
        for (std::int32_t s = 0; s < segments; ++s) {
            std::uint8_t any = 0;
            for (const std::int32_t row : {(y + rows - 1) % rows, y, (y + 1) % rows}) {
                const std::uint8_t* o = occupied_.data() + std::ptrdiff_t{row} * segments;
                any |= static_cast<std::uint8_t>(o[s] | o[s > 0 ? s - 1 : last] | o[s < last ? s + 1 : 0]);
            }
            live_[static_cast<std::size_t>(y) * static_cast<std::size_t>(segments) +
                  static_cast<std::size_t>(s)] = s <= last ? any : 0;
        }
}

simd::GasView GasStepper::view(GasLattice& lattice, std::uint32_t t) const {
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
    return v;
}

simd::GasTile GasStepper::tile(const GasLattice& lattice, std::size_t k, Edges& edges) const {
    const std::size_t stride = static_cast<std::size_t>(lattice.stride), below = (k + tiles_ - 1) % tiles_,
                      above = (k + 1) % tiles_;
    simd::GasTile t{first_row(k), std::min(first_row(k + 1), rows_), {}, {}};
    const bool on_floor = rules_.closed && k == 0, under_roof = rules_.closed && k + 1 == tiles_;
    for (std::size_t n = 0; n < 2; ++n) {
        t.below[n] = on_floor ? nullptr : edges.into_last.data() + (2 * below + n) * stride;
        t.above[n] = under_roof ? nullptr : edges.into_first.data() + (2 * above + n) * stride;
    }
    return t;
}

std::uint64_t* GasStepper::scratch() {
    const auto thread = crew_ > 1 ? static_cast<std::size_t>(thread_index()) : 0;
    return scratch_.data() + thread * 2 * scratch_words_;
}

namespace {

// Directions that go up and down; one of each on the square lattice.
struct Sideways {
    std::size_t count, up[2], down[2];
};
Sideways sideways(const GasRules& rules) {
    if (rules.directions() == 4) return {1, {1, 1}, {3, 3}};
    return {2, {1, 2}, {4, 5}};
}

} // namespace

// What crossed between the last row of a tile and the first of the next one.
void GasStepper::put_edges(GasLattice& lattice, const Edges& edges, std::size_t lower) const {
    const auto stride = static_cast<std::size_t>(lattice.stride);
    const std::size_t upper = (lower + 1) % tiles_;
    const Sideways s = sideways(rules_);
    const auto put = [&](const Column<std::uint64_t>& from, std::size_t at, std::size_t direction,
                         std::int32_t row) {
        std::copy_n(from.data() + at * stride, stride,
                    lattice.plane[direction].data() + static_cast<std::size_t>(row) * stride);
    };
    for (std::size_t n = 0; n < s.count; ++n) {
        put(edges.into_last, 2 * lower + n, s.down[n], std::min(first_row(lower + 1), rows_) - 1);
        put(edges.into_first, 2 * upper + n, s.up[n], first_row(upper));
    }
}

void GasStepper::run(GasLattice& lattice, std::uint32_t t, std::int64_t steps) {
    if (kernel_ == nullptr) {
        for (std::int64_t n = 0; n < steps; ++n) reference::step(lattice, rules_, t++);
        return;
    }
    with_crew(crew_, [&](Crew& crew) {
        std::uint32_t at = t;
        for (std::int64_t left = steps; left > 0;) {
            const int taken = pair_ != nullptr && left > 1 ? 2 : 1;
            if (taken == 2)
                two_steps(crew, lattice, at);
            else
                one_step(crew, lattice, at, nullptr);
            at += static_cast<std::uint32_t>(taken);
            left -= taken;
        }
    });
}

void GasStepper::step(GasLattice& lattice, std::uint32_t t, const simd::CountedView* counted) {
    if (kernel_ == nullptr)
        reference::step(lattice, rules_, t);
    else
        with_crew(crew_, [&](Crew& crew) { one_step(crew, lattice, t, counted); });
}

void GasStepper::one_step(Crew& crew, GasLattice& lattice, std::uint32_t t,
                          const simd::CountedView* counted) {
    simd::GasView v = view(lattice, t);
    v.live = live_.empty() ? nullptr : live_.data();
    v.occupied = live_.empty() ? nullptr : occupied_.data();
    v.counted = counted;
    crew.for_tiles(tiles_, [&](std::size_t k) { kernel_(v, tile(lattice, k, edges_), scratch()); });
    crew.for_tiles(rules_.closed ? tiles_ - 1 : tiles_,
                   [&](std::size_t lower) { put_edges(lattice, edges_, lower); });
    if (!live_.empty()) crew.for_tiles(tiles_, [&](std::size_t k) { spread_activity(lattice, k); });
}

// First, every tile: two steps of its rows, but of the outermost ones, which need rows of other tiles after
// the first step, only one. Then these two rows of each pair of neighbours.
void GasStepper::two_steps(Crew& crew, GasLattice& lattice, std::uint32_t t) {
    const simd::GasView v = view(lattice, t), later = view(lattice, t + 1);
    crew.for_tiles(tiles_, [&](std::size_t k) {
        const simd::GasTile first = tile(lattice, k, edges_);
        simd::GasTile second = first;
        // What the second step sends from within the tile into its outermost rows waits.
        const std::size_t at = 2 * k * static_cast<std::size_t>(lattice.stride);
        for (std::size_t n = 0; n < 2; ++n) {
            const std::size_t row = at + n * static_cast<std::size_t>(lattice.stride);
            if (first.below[0] != nullptr) second.below[n] = second_.into_first.data() + row;
            if (first.above[0] != nullptr) second.above[n] = second_.into_last.data() + row;
        }
        second.first += first.below[0] != nullptr ? 1 : 0;
        second.last -= first.above[0] != nullptr ? 1 : 0;
        pair_(v, first, second, scratch());
    });
    crew.for_tiles(rules_.closed ? tiles_ - 1 : tiles_,
                   [&](std::size_t lower) { finish_pair(lattice, later, lower); });
}

void GasStepper::finish_pair(GasLattice& lattice, const simd::GasView& later, std::size_t lower) {
    put_edges(lattice, edges_, lower);
    const auto stride = static_cast<std::size_t>(lattice.stride);
    const std::size_t upper = (lower + 1) % tiles_;
    const Sideways s = sideways(rules_);
    const std::int32_t last = std::min(first_row(lower + 1), rows_) - 1, first = first_row(upper);
    simd::GasTile rows{last, last + 2, {}, {}};
    const auto row_of = [&](std::size_t direction, std::int32_t row) {
        return lattice.plane[direction].data() + static_cast<std::size_t>(row) * stride;
    };
    for (std::size_t n = 0; n < 2; ++n) {
        rows.below[n] = row_of(s.down[n], last - 1);
        rows.above[n] = row_of(s.up[n], first + 1);
    }
    kernel_(later, rows, scratch());
    for (std::size_t n = 0; n < s.count; ++n) {
        std::copy_n(second_.into_last.data() + (2 * lower + n) * stride, stride, row_of(s.up[n], last));
        std::copy_n(second_.into_first.data() + (2 * upper + n) * stride, stride, row_of(s.down[n], first));
    }
}

// ---- the model

void GasFlow::run(std::int64_t steps) {
    if (!looks()) {
        stepper_.run(lattice_, static_cast<std::uint32_t>(step_), steps);
        step_ += steps;
        return;
    }
    for (const std::int64_t last = step_ + steps; step_ < last; look())
        stepper_.step(lattice_, static_cast<std::uint32_t>(step_++));
}

std::string GasFlow::serialise() const {
    ByteWriter w;
    w.put(step_);
    for (int i = 0; i < rules_.planes(); ++i) {
        const Column<std::uint64_t>& p = lattice_.plane[static_cast<std::size_t>(i)];
        w.put_array(p.data(), p.size());
    }
    save(w);
    return std::move(w).bytes();
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
    if (at < 0 || !r.at_end()) fail(Exit::io, "damaged state");
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
                        : fmt::format("bit planes, in place, tiles of {} rows{}{}", simd::gas_tile_rows,
                                      looks() ? "" : ", two steps in a pass",
                                      stepper_.by_bytes() ? ", collisions by a table of bytes" : "")}};
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
