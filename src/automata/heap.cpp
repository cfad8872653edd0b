#include "automata/heap.hpp"

#include "automata/spectrum.hpp"
#include "core/bytes.hpp"
#include "core/column.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandlane::automata {

HeapTable::HeapTable(std::int64_t columns, const HeapRules& rules) : columns_(columns), rules_(rules) {
    heights_.assign(static_cast<std::size_t>(rules.two_sided ? 2 * columns - 1 : columns), 0);
    visits_.assign(rules.roughness > 0 ? heights_.size() : 0, 0);
}

double HeapTable::threshold(std::size_t place, std::uint32_t grain) {
    if (rules_.roughness == 0) return rules_.sticking;
    const std::uint32_t visit = visits_[place]++;
    if (visit == 0) visited_.push_back(place);
    const PhiloxCounter r = philox({static_cast<std::uint32_t>(place), grain, visit, 2}, rules_.seed);
    const double u = static_cast<double>((std::uint64_t{r[0]} << 32 | r[1]) >> 11) * 0x1p-53;
    return rules_.sticking * (1 - rules_.roughness + 2 * rules_.roughness * u);
}

int HeapTable::steeper_side(std::uint32_t grain) {
    if (!rules_.two_sided) return 0;
    const std::int32_t right = height(0, 1), left = height(1, 1);
    if (right != left) return left < right ? 1 : 0;
    return static_cast<int>(philox({0, grain, choices_++, 3}, rules_.seed)[0] & 1);
}

// A grain on column x goes on while its energy allows, then stays. False: it stays where it began.
bool HeapTable::roll(int side, std::int64_t x, double energy, std::uint32_t grain) {
    const std::int64_t start = x;
    while (x < columns_ - 1) {
        const double drop = height(side, x) - height(side, x + 1);
        const double left = rules_.retained * (energy + drop);
        const double needed = threshold(place(side, x), grain);
        if (!(energy + drop > 0) || !(left > needed)) {
            ++heights_[place(side, x)];
            return x > start;
        }
        energy = left;
        ++x;
    }
    ++lost_;
    return true;
}

void HeapTable::drop(std::uint32_t grain) {
    for (const std::size_t p : visited_) visits_[p] = 0;
    visited_.clear();
    choices_ = 0;
    roll(steeper_side(grain), 0, rules_.start_energy, grain);
    if (rules_.steepest > 0) avalanche(grain);
}

// From the wall outwards, until no top grain of a column that is too steep goes anywhere.
void HeapTable::avalanche(std::uint32_t grain) {
    for (bool moved = true; moved;) {
        moved = false;
        for (int side = 0; side < (rules_.two_sided ? 2 : 1); ++side)
            for (std::int64_t x = 0; x + 1 < columns_; ++x) {
                if (height(side, x) - height(side, x + 1) <= rules_.steepest) continue;
                --heights_[place(side, x)];
                if (roll(side, x, 0, grain)) {
                    moved = true;
                    ++released_;
                }
            }
    }
}

void drop_on_lanes(std::span<HeapTable> heaps, simd::Isa isa, std::uint32_t first, std::int64_t grains) {
    constexpr std::size_t lanes = simd::heap_lanes;
    const HeapRules& rules = heaps.front().rules();
    const std::size_t places = heaps.front().heights().size();
    const bool general = rules.two_sided || rules.steepest > 0;
    Column<double> heights(places * lanes, 0);
    Column<std::uint64_t> visits(general ? places * lanes : 0, 0);
    std::int64_t lost[lanes] = {}, released[lanes] = {};
    simd::HeapView v{heights.data(),
                     heaps.front().columns(),
                     rules.two_sided ? heaps.front().columns() - 1 : 0,
                     rules.retained,
                     rules.sticking,
                     rules.start_energy,
                     rules.roughness,
                     rules.steepest,
                     {},
                     lost,
                     released,
                     visits.data()};
    for (std::size_t l = 0; l < lanes; ++l) { // lanes without a heap do as the first
        const HeapTable& heap = heaps[l < heaps.size() ? l : 0];
        v.seed[l][0] = heap.rules().seed[0];
        v.seed[l][1] = heap.rules().seed[1];
        for (std::size_t x = 0; x < places; ++x) heights[x * lanes + l] = heap.heights()[x];
    }
    simd::automata_kernels(isa).heap[rules.roughness > 0 ? 1 : 0][general ? 1 : 0](v, first, grains);
    for (std::size_t l = 0; l < heaps.size(); ++l) {
        for (std::size_t x = 0; x < places; ++x)
            heaps[l].heights()[x] = static_cast<std::int32_t>(heights[x * lanes + l]);
        heaps[l].set_counts(heaps[l].lost() + lost[l], heaps[l].released() + released[l]);
    }
}

TailFit fit_tail(std::span<const double> x, std::span<const double> h) {
    TailFit best;
    best.error = std::numeric_limits<double>::infinity();
    const double n = static_cast<double>(x.size());
    for (double x0 = 0.25; x0 < 100; x0 *= 1.05) {
        double sum[3][3] = {}, right[3] = {};
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double v[3] = {1, x[i], std::log(x[i] + x0)};
            for (int r = 0; r < 3; ++r) {
                right[r] += v[r] * h[i];
                for (int c = 0; c < 3; ++c) sum[r][c] += v[r] * v[c];
            }
        }
        for (int k = 0; k < 3; ++k) // Gauss; the matrix is positive definite
            for (int r = 0; r < 3; ++r) {
                if (r == k) continue;
                const double factor = sum[r][k] / sum[k][k];
                for (int c = k; c < 3; ++c) sum[r][c] -= factor * sum[k][c];
                right[r] -= factor * right[k];
            }
        TailFit fit{right[0] / sum[0][0], right[1] / sum[1][1], right[2] / sum[2][2], x0, 0};
        double rest = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double off = h[i] - fit.a - fit.b * x[i] - fit.c * std::log(x[i] + x0);
            rest += off * off;
        }
        fit.error = std::sqrt(rest / n);
        if (fit.error < best.error) best = fit;
    }
    return best;
}

namespace {

class HeapModel final : public Model {
public:
    HeapModel(const scene::Scene& scene, const Means& means) : heap_(scene.heap), means_(means) {
        for (std::int64_t n = 0; n < heap_.heaps; ++n) {
            const auto seed = static_cast<std::uint64_t>(scene.seed + n);
            tables_.emplace_back(heap_.columns, HeapRules{heap_.retained,
                                                          heap_.sticking,
                                                          heap_.start_energy,
                                                          heap_.roughness,
                                                          heap_.steepest,
                                                          heap_.sides == scene::HeapSides::two,
                                                          {static_cast<std::uint32_t>(seed),
                                                           static_cast<std::uint32_t>(seed >> 32)}});
        }
    }

    void run(std::int64_t steps) override {
        if (in_lanes()) {
            constexpr std::size_t lanes = simd::heap_lanes;
            for_tiles_dynamic((tables_.size() + lanes - 1) / lanes, means_.threads, [&](std::size_t n) {
                const std::size_t count = std::min(lanes, tables_.size() - n * lanes);
                drop_on_lanes(std::span(tables_).subspan(n * lanes, count), means_.isa,
                              static_cast<std::uint32_t>(step_), steps);
            });
        } else {
            for_tiles_dynamic(tables_.size(), means_.threads, [&](std::size_t n) {
                for (std::int64_t k = 0; k < steps; ++k)
                    tables_[n].drop(static_cast<std::uint32_t>(step_ + k));
            });
        }
        step_ += steps;
    }
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] std::size_t sites() const override { return tables_.size(); } // grains of a step

    [[nodiscard]] std::string serialise() const override {
        ByteWriter w;
        w.put(step_);
        for (const HeapTable& table : tables_) {
            w.put_array(table.heights().data(), table.heights().size());
            w.put(table.lost());
            w.put(table.released());
        }
        return w.bytes();
    }
    void restore(const std::string& state) override {
        ByteReader r(state);
        const auto step = r.get<std::int64_t>();
        std::vector<HeapTable> read = tables_;
        for (HeapTable& table : read) {
            const std::size_t expected = table.heights().size();
            r.get_array(table.heights());
            if (table.heights().size() != expected) fail(Exit::io, "the state is one of another heap");
            const auto lost = r.get<std::int64_t>(), released = r.get<std::int64_t>();
            table.set_counts(lost, released);
            // A grain raises a column by one.
            for (const std::int32_t h : table.heights())
                if (h < 0 || h > step) fail(Exit::io, "damaged state");
        }
        if (!r.at_end()) fail(Exit::io, "damaged state");
        tables_ = std::move(read);
        step_ = step;
    }
    [[nodiscard]] std::vector<Quantity> quantities() const override {
        Quantity q{"height", "1", {}};
        for (const HeapTable& table : tables_)
            q.values.insert(q.values.end(), table.heights().begin(), table.heights().end());
        return {q};
    }
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        return {{"step", "1"}, {"top", "1"}, {"foot", "1"}, {"slope", "1"}, {"lost", "1"}, {"released", "1"}};
    }
    [[nodiscard]] std::vector<double> log_row() const override {
        const std::vector<double> h = profile(0);
        double lost = 0, released = 0;
        for (const HeapTable& table : tables_) {
            lost += static_cast<double>(table.lost());
            released += static_cast<double>(table.released());
        }
        const auto heaps = static_cast<double>(tables_.size());
        return {static_cast<double>(step_),
                h[0],
                static_cast<double>(foot(h)),
                bulk_slope(h),
                lost / heaps,
                released / heaps};
    }
    // The first heap from the side, a row for each height.
    [[nodiscard]] std::vector<Field> fields() const override {
        const HeapTable& table = tables_.front();
        const std::int64_t most = *std::max_element(table.heights().begin(), table.heights().end());
        std::vector<std::int32_t> across; // from left to right
        if (heap_.sides == scene::HeapSides::two)
            for (std::int64_t x = shown() - 1; x > 0; --x) across.push_back(table.height(1, x));
        for (std::int64_t x = 0; x < shown(); ++x) across.push_back(table.height(0, x));
        const std::size_t rows = static_cast<std::size_t>(most + most / 8 + 4);
        const std::size_t shrink = std::max<std::size_t>(1, rows * across.size() / 4000000);
        Field field{"heap", "grains", "", across.size(), (rows + shrink - 1) / shrink, {}, false, 1};
        for (std::size_t row = 0; row < field.rows; ++row)
            for (const std::int32_t h : across)
                field.values.push_back(static_cast<std::size_t>(h) > row * shrink ? 0.75 : 0);
        return {field};
    }
    [[nodiscard]] std::vector<Table> final_tables() const override {
        const std::vector<double> h = profile(0);
        Table table{"profile", {{"x", "1"}, {"height", "1"}, {"deviation", "1"}}, {}, 0, 1, false};
        for (std::size_t x = 0; x < h.size() && x < foot(h) + 10; ++x) {
            double squares = 0;
            for (const HeapTable& t : tables_) {
                const double off = t.height(0, static_cast<std::int64_t>(x)) - h[x];
                squares += off * off;
            }
            table.rows.push_back(
                {static_cast<double>(x), h[x], std::sqrt(squares / static_cast<double>(tables_.size()))});
        }
        Table tail{
            "tail", {{"a", "1"}, {"b", "1"}, {"c", "1"}, {"x0", "1"}, {"error", "1"}, {"error_of_line", "1"}},
            {},     -1,
            -1,     true};
        // The outer half, x from the foot inwards.
        std::vector<double> x, y;
        const std::size_t end = foot(h);
        for (std::size_t k = 0; 2 * k < end && k < end; ++k) {
            x.push_back(static_cast<double>(k));
            y.push_back(h[end - k]);
        }
        if (x.size() > 6) {
            const TailFit fit = fit_tail(x, y);
            const Line line = fit_line(x, y);
            double rest = 0;
            for (std::size_t i = 0; i < x.size(); ++i)
                rest += std::pow(y[i] - line.offset - line.slope * x[i], 2);
            tail.rows.push_back(
                {fit.a, fit.b, fit.c, fit.x0, fit.error, std::sqrt(rest / static_cast<double>(x.size()))});
        }
        return {table, tail};
    }
    [[nodiscard]] Facts facts() const override {
        return {{"model", fmt::format("heap of energy, dissipation and sticking, {}",
                                      heap_.sides == scene::HeapSides::two ? "two sides" : "one side")},
                {"continuum slope",
                 fmt::format("U (1 - r)/r = {:.4g}", heap_.sticking * (1 - heap_.retained) / heap_.retained)},
                {"heaps", std::to_string(heap_.heaps)},
                {"kernels", in_lanes() ? "eight heaps at a time, a heap to a lane"
                                       : "one grain after the other; heaps in parallel"}};
    }

private:
    [[nodiscard]] bool in_lanes() const { return means_.isa != simd::Isa::scalar && tables_.size() > 1; }
    [[nodiscard]] std::vector<double> profile(int side) const {
        std::vector<double> mean(static_cast<std::size_t>(heap_.columns), 0);
        for (const HeapTable& table : tables_)
            for (std::size_t x = 0; x < mean.size(); ++x)
                mean[x] +=
                    table.height(side, static_cast<std::int64_t>(x)) / static_cast<double>(tables_.size());
        return mean;
    }
    static std::size_t foot(const std::vector<double>& h) {
        return static_cast<std::size_t>(std::find(h.begin(), h.end(), 0.0) - h.begin());
    }
    // Of the inner six tenths.
    static double bulk_slope(const std::vector<double>& h) {
        const std::size_t count = static_cast<std::size_t>(0.6 * static_cast<double>(foot(h))) + 1;
        if (count < 3) return 0;
        std::vector<double> x(count);
        std::iota(x.begin(), x.end(), 0.0);
        return -fit_line(x, std::span(h).first(count)).slope;
    }
    [[nodiscard]] std::int64_t shown() const {
        const HeapTable& t = tables_.front();
        std::int64_t last = 1;
        for (std::int64_t x = 0; x < heap_.columns; ++x)
            if (t.height(0, x) > 0) last = x + 1;
        return std::min(heap_.columns, last + last / 8 + 4);
    }

    scene::Heap heap_;
    Means means_;
    std::vector<HeapTable> tables_;
    std::int64_t step_ = 0;
};

} // namespace

std::unique_ptr<Model> make_heap(const scene::Scene& scene, const Means& means) {
    return std::make_unique<HeapModel>(scene, means);
}

} // namespace sandlane::automata
