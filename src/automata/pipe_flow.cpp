// Granular flow in a pipe (docs/automata.md 5), with one rest particle per site or any number of them.
#include "automata/counted_pipe.hpp"
#include "automata/gas.hpp"
#include "automata/pipe_statistics.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sandlane::automata {

namespace {

constexpr std::uint32_t start_stream = 1 << 20;
constexpr double speed[] = {1, 0.5, -0.5, -1, -0.5, 0.5, 0}; // c_x

// Calls place(x, y, bit) until it has accepted so many; it refuses a bit that is taken.
template <class Place>
void put_particles(std::int64_t particles, std::int64_t length, std::int64_t width, int bits,
                   const PhiloxKey& seed, const Place& place) {
    const auto columns = static_cast<std::uint64_t>(length), rows = static_cast<std::uint64_t>(width);
    for (std::uint64_t k = 0; particles > 0; ++k) {
        const PhiloxCounter r = philox(
            {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32), 0, start_stream}, seed);
        const auto y = static_cast<std::int32_t>(r[0] * rows >> 32),
                   x = static_cast<std::int32_t>(r[1] * columns >> 32);
        if (place(x, y, static_cast<int>(r[2] * static_cast<std::uint64_t>(bits) >> 32))) --particles;
    }
}

// On the first columns of a lattice.
std::int64_t particles_in(const GasLattice& lattice, int planes, std::int32_t columns) {
    std::int64_t inside = 0;
    for (int i = 0; i < planes; ++i)
        for (std::int32_t y = 0; y < lattice.rows; ++y) {
            const std::uint64_t* words =
                lattice.plane[static_cast<std::size_t>(i)].data() + std::ptrdiff_t{y} * lattice.stride;
            for (std::int32_t w = 0; 64 * w < columns; ++w) {
                const std::int32_t left = columns - 64 * w;
                const std::uint64_t mask = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
                inside += std::popcount(words[w] & mask);
            }
        }
    return inside;
}

// Bits of a site, those of directions 0 to 5 and the rest particle.
unsigned state_at(const GasLattice& lattice, std::int32_t x, std::int32_t y) {
    const std::size_t word = static_cast<std::size_t>(y) * static_cast<std::size_t>(lattice.stride) +
                             static_cast<std::size_t>(x >> 6);
    unsigned state = 0;
    for (unsigned i = 0; i < 7; ++i)
        state |= static_cast<unsigned>(lattice.plane[i][word] >> (x & 63) & 1) << i;
    return state;
}

double particles_at(const GasLattice& lattice, std::int32_t x, std::int32_t y) {
    return std::popcount(state_at(lattice, x, y));
}

double momentum_at(const GasLattice& lattice, std::int32_t x, std::int32_t y) {
    const unsigned state = state_at(lattice, x, y);
    double sum = 0;
    for (unsigned i = 0; i < 6; ++i) sum += (state >> i & 1) != 0 ? speed[i] : 0;
    return sum;
}

class PipeFlowModel final : public GasFlow {
public:
    PipeFlowModel(GasLattice lattice, const GasRules& rules, const Means& means, const scene::PipeFlow& pipe)
        : GasFlow(std::move(lattice), rules, means), window_(static_cast<std::int32_t>(pipe.window)),
          statistics_(pipe.length, pipe.width) {
        look();
    }

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        std::vector<analysis::LogColumn> columns = GasFlow::log_columns();
        columns.push_back({"window_density", "1/site"});
        return columns;
    }
    [[nodiscard]] std::vector<double> log_row() const override {
        std::vector<double> row = GasFlow::log_row();
        row.push_back(statistics_.window());
        return row;
    }
    [[nodiscard]] std::vector<Field> fields() const override {
        std::vector<Field> fields = GasFlow::fields();
        std::reverse(fields.begin(), fields.end()); // density first
        return fields;
    }
    [[nodiscard]] std::vector<Field> final_fields() const override { return statistics_.fields(); }
    [[nodiscard]] std::vector<Table> final_tables() const override { return statistics_.tables(); }

protected:
    void look() override {
        statistics_.add_window(static_cast<double>(particles_in(lattice_, rules_.planes(), window_)) /
                               (static_cast<double>(window_) * lattice_.rows));
        if (step_ % statistics_.map_every() == 0)
            statistics_.add_to_maps([&](auto x, auto y) { return particles_at(lattice_, x, y); },
                                    [&](auto x, auto y) { return momentum_at(lattice_, x, y); });
    }
    [[nodiscard]] bool looks() const override { return true; }
    void save(ByteWriter& w) const override { statistics_.save(w); }
    void load(ByteReader& r) override { statistics_.load(r); }

private:
    std::int32_t window_;
    PipeStatistics statistics_;
};

class CountedPipeModel final : public Model {
public:
    CountedPipeModel(CountedPipe pipe, const GasRules& rules, const Means& means,
                     const scene::PipeFlow& scene)
        : pipe_(std::move(pipe)), means_(means), stepper_(pipe_, rules, means),
          window_(static_cast<std::int32_t>(scene.window)), statistics_(scene.length, scene.width) {
        look();
    }

    void run(std::int64_t steps) override {
        for (std::int64_t n = 0; n < steps; ++n) {
            crowded_ += stepper_.step(pipe_, static_cast<std::uint32_t>(step_));
            ++step_;
            look();
        }
    }
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] std::size_t sites() const override { return pipe_.beyond.size(); }
    [[nodiscard]] std::string serialise() const override {
        ByteWriter w;
        w.put(step_);
        w.put(crowded_);
        for (const Column<std::uint64_t>& plane : pipe_.lattice.plane)
            w.put_array(plane.data(), plane.size());
        w.put_array(pipe_.beyond.data(), pipe_.beyond.size());
        statistics_.save(w);
        return w.bytes();
    }
    void restore(const std::string& state) override {
        ByteReader r(state);
        const auto step = r.get<std::int64_t>(), crowded = r.get<std::int64_t>();
        CountedPipe read = pipe_;
        const auto get = [&](auto& column) {
            const std::size_t expected = column.size();
            r.get_array(column);
            if (column.size() != expected) fail(Exit::io, "the state is one of another pipe");
        };
        for (Column<std::uint64_t>& plane : read.lattice.plane) get(plane);
        get(read.beyond);
        statistics_.load(r);
        if (step < 0 || !r.at_end()) fail(Exit::io, "damaged state");
        for (std::int32_t y = 0; y < rows(); ++y)
            for (std::int32_t x = 0; x < columns(); ++x) read.set_resting(x, y, read.resting(x, y));
        pipe_ = std::move(read);
        step_ = step;
        crowded_ = crowded;
    }
    [[nodiscard]] std::vector<Quantity> quantities() const override {
        Quantity movers{"movers", "1", {}}, resting{"resting", "1", {}};
        for (std::int32_t y = 0; y < rows(); ++y)
            for (std::int32_t x = 0; x < columns(); ++x) {
                movers.values.push_back(state_at(pipe_.lattice, x, y) & 63);
                resting.values.push_back(static_cast<double>(pipe_.resting(x, y)));
            }
        return {movers, resting};
    }
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        return {{"step", "1"},          {"particles", "1"}, {"moving", "1"},
                {"flow", "sites/step"}, {"crowded", "1"},   {"window_density", "1/site"}};
    }
    [[nodiscard]] std::vector<double> log_row() const override {
        double flow = 0;
        for (std::size_t i = 0; i < 6; ++i)
            flow += speed[i] * static_cast<double>(pipe_.lattice.particles(static_cast<int>(i)));
        const auto particles = static_cast<double>(pipe_.particles());
        return {static_cast<double>(step_),          particles,
                static_cast<double>(pipe_.moving()), particles > 0 ? flow / particles : 0,
                static_cast<double>(crowded_),       statistics_.window()};
    }
    [[nodiscard]] std::vector<Field> fields() const override {
        Field density{"density",
                      "particles per site",
                      "",
                      static_cast<std::size_t>(columns()),
                      static_cast<std::size_t>(rows()),
                      {},
                      false,
                      0};
        for (std::int32_t y = 0; y < rows(); ++y)
            for (std::int32_t x = 0; x < columns(); ++x) density.values.push_back(particles(x, y));
        return {density};
    }
    [[nodiscard]] std::vector<Field> final_fields() const override { return statistics_.fields(); }
    [[nodiscard]] std::vector<Table> final_tables() const override { return statistics_.tables(); }
    [[nodiscard]] Facts facts() const override {
        return {{"model", "pipe flow, any number of rest particles"},
                {"lattice", fmt::format("{} x {} sites, triangular (bricks)", columns(), rows())},
                {"kernels",
                 means_.isa == simd::Isa::scalar
                     ? "the scalar reference, site by site"
                     : fmt::format("bit planes, in place, tiles of {} rows; lists of sites where several "
                                   "particles rest",
                                   simd::gas_tile_rows)}};
    }

private:
    [[nodiscard]] std::int32_t columns() const { return pipe_.lattice.columns; }
    [[nodiscard]] std::int32_t rows() const { return pipe_.lattice.rows; }
    [[nodiscard]] double particles(std::int32_t x, std::int32_t y) const {
        return particles_at(pipe_.lattice, x, y) + pipe_.beyond[pipe_.site(x, y)];
    }
    void look() {
        std::int64_t inside = particles_in(pipe_.lattice, 7, window_);
        for (std::int32_t y = 0; y < rows(); ++y)
            for (std::int32_t x = 0; x < window_; ++x) inside += pipe_.beyond[pipe_.site(x, y)];
        statistics_.add_window(static_cast<double>(inside) / (static_cast<double>(window_) * rows()));
        if (step_ % statistics_.map_every() == 0)
            statistics_.add_to_maps([&](auto x, auto y) { return particles(x, y); },
                                    [&](auto x, auto y) { return momentum_at(pipe_.lattice, x, y); });
    }

    CountedPipe pipe_;
    Means means_;
    CountedStepper stepper_;
    std::int32_t window_;
    PipeStatistics statistics_;
    std::int64_t step_ = 0, crowded_ = 0;
};

} // namespace

std::unique_ptr<Model> make_pipe_flow(const scene::Scene& scene, const Means& means) {
    const scene::PipeFlow& s = scene.pipe_flow;
    GasRules rules;
    rules.model = GasModel::pipe;
    rules.closed = true;
    rules.dissipation = sixteenths(s.dissipation);
    rules.gravity = sixteenths(s.gravity);
    rules.roughness = sixteenths(s.roughness);
    const auto seed = static_cast<std::uint64_t>(scene.seed);
    rules.seed = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
    const std::int64_t particles =
        std::llround(s.density * static_cast<double>(s.length) * static_cast<double>(s.width));
    const auto place_in = [](GasLattice& lattice) {
        return [&lattice](std::int32_t x, std::int32_t y, int bit) {
            const bool is_free = !lattice.get(bit, x, y);
            lattice.set(bit, x, y, true);
            return is_free;
        };
    };
    if (s.variant == scene::PipeVariant::counted_rest) {
        CountedPipe pipe(static_cast<std::int32_t>(s.length), static_cast<std::int32_t>(s.width));
        put_particles(particles, s.length, s.width, 6, rules.seed, place_in(pipe.lattice));
        return std::make_unique<CountedPipeModel>(std::move(pipe), rules, means, s);
    }
    GasLattice lattice(static_cast<std::int32_t>(s.length), static_cast<std::int32_t>(s.width));
    put_particles(particles, s.length, s.width, 7, rules.seed, place_in(lattice));
    return std::make_unique<PipeFlowModel>(std::move(lattice), rules, means, s);
}

} // namespace sandlane::automata
