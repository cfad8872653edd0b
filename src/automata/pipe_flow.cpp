// Granular flow in a pipe (docs/automata.md 4): with one rest particle per site, a lattice gas of bit planes;
// with any number of them, site by site.
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
        std::int64_t inside = 0;
        for (int i = 0; i < rules_.planes(); ++i)
            for (std::int32_t y = 0; y < lattice_.rows; ++y) {
                const std::uint64_t* words =
                    lattice_.plane[static_cast<std::size_t>(i)].data() + std::ptrdiff_t{y} * lattice_.stride;
                for (std::int32_t w = 0; 64 * w < window_; ++w) {
                    const std::int32_t left = window_ - 64 * w;
                    const std::uint64_t mask =
                        left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
                    inside += std::popcount(words[w] & mask);
                }
            }
        statistics_.add_window(static_cast<double>(inside) / (static_cast<double>(window_) * lattice_.rows));
        if (step_ % statistics_.map_every() != 0) return;
        const auto sum = [&](std::int64_t x, std::int64_t y, const auto& weight) {
            double total = 0;
            for (int i = 0; i < rules_.planes(); ++i)
                if (lattice_.get(i, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)))
                    total += weight(i);
            return total;
        };
        statistics_.add_to_maps([&](auto x, auto y) { return sum(x, y, [](int) { return 1.0; }); },
                                [&](auto x, auto y) { return sum(x, y, [](int i) { return speed[i]; }); });
    }
    void save(ByteWriter& w) const override { statistics_.save(w); }
    void load(ByteReader& r) override { statistics_.load(r); }

private:
    std::int32_t window_;
    PipeStatistics statistics_;
};

class CountedPipeModel final : public Model {
public:
    CountedPipeModel(CountedPipe pipe, const GasRules& rules, const scene::PipeFlow& scene)
        : pipe_(std::move(pipe)), rules_(rules), window_(scene.window),
          statistics_(scene.length, scene.width) {
        look();
    }

    void run(std::int64_t steps) override {
        for (std::int64_t n = 0; n < steps; ++n) {
            crowded_ += automata::step(pipe_, rules_, static_cast<std::uint32_t>(step_));
            ++step_;
            look();
        }
    }
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] std::size_t sites() const override { return pipe_.movers.size(); }
    [[nodiscard]] std::string serialise() const override {
        ByteWriter w;
        w.put(step_);
        w.put(crowded_);
        w.put_array(pipe_.movers.data(), pipe_.movers.size());
        w.put_array(pipe_.resting.data(), pipe_.resting.size());
        statistics_.save(w);
        return w.bytes();
    }
    void restore(const std::string& state) override {
        ByteReader r(state);
        const auto step = r.get<std::int64_t>(), crowded = r.get<std::int64_t>();
        CountedPipe read = pipe_;
        r.get_array(read.movers);
        r.get_array(read.resting);
        if (read.movers.size() != sites() || read.resting.size() != sites())
            fail(Exit::io, "the state is one of another pipe");
        statistics_.load(r);
        pipe_ = std::move(read);
        step_ = step;
        crowded_ = crowded;
    }
    [[nodiscard]] std::vector<Quantity> quantities() const override {
        return {{"movers", "1", {pipe_.movers.begin(), pipe_.movers.end()}},
                {"resting", "1", {pipe_.resting.begin(), pipe_.resting.end()}}};
    }
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        return {{"step", "1"},          {"particles", "1"}, {"moving", "1"},
                {"flow", "sites/step"}, {"crowded", "1"},   {"window_density", "1/site"}};
    }
    [[nodiscard]] std::vector<double> log_row() const override {
        double flow = 0;
        for (std::int64_t y = 0; y < pipe_.width; ++y)
            for (std::int64_t x = 0; x < pipe_.length; ++x) flow += momentum(x, y);
        const auto particles = static_cast<double>(pipe_.particles());
        return {static_cast<double>(step_),          particles,
                static_cast<double>(pipe_.moving()), particles > 0 ? flow / particles : 0,
                static_cast<double>(crowded_),       statistics_.window()};
    }
    [[nodiscard]] std::vector<Field> fields() const override {
        Field density{"density",
                      "particles per site",
                      "",
                      static_cast<std::size_t>(pipe_.length),
                      static_cast<std::size_t>(pipe_.width),
                      {},
                      false,
                      0};
        for (std::int64_t y = 0; y < pipe_.width; ++y)
            for (std::int64_t x = 0; x < pipe_.length; ++x) density.values.push_back(particles(x, y));
        return {density};
    }
    [[nodiscard]] std::vector<Field> final_fields() const override { return statistics_.fields(); }
    [[nodiscard]] std::vector<Table> final_tables() const override { return statistics_.tables(); }
    [[nodiscard]] Facts facts() const override {
        return {{"model", "pipe flow, any number of rest particles"},
                {"lattice", fmt::format("{} x {} sites, triangular (bricks)", pipe_.length, pipe_.width)},
                {"kernels", "site by site, on one thread; there is no vector kernel"}};
    }

private:
    [[nodiscard]] std::size_t at(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>(y * pipe_.length + x);
    }
    [[nodiscard]] double particles(std::int64_t x, std::int64_t y) const {
        return std::popcount(pipe_.movers[at(x, y)]) + pipe_.resting[at(x, y)];
    }
    [[nodiscard]] double momentum(std::int64_t x, std::int64_t y) const {
        double sum = 0;
        for (int i = 0; i < 6; ++i)
            if ((pipe_.movers[at(x, y)] >> i & 1) != 0) sum += speed[i];
        return sum;
    }
    void look() {
        double inside = 0;
        for (std::int64_t y = 0; y < pipe_.width; ++y)
            for (std::int64_t x = 0; x < window_; ++x) inside += particles(x, y);
        statistics_.add_window(inside / static_cast<double>(window_ * pipe_.width));
        if (step_ % statistics_.map_every() == 0)
            statistics_.add_to_maps([&](auto x, auto y) { return particles(x, y); },
                                    [&](auto x, auto y) { return momentum(x, y); });
    }

    CountedPipe pipe_;
    GasRules rules_;
    std::int64_t window_;
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
    if (s.variant == scene::PipeVariant::counted_rest) {
        CountedPipe pipe(s.length, s.width);
        put_particles(particles, s.length, s.width, 6, rules.seed,
                      [&](std::int32_t x, std::int32_t y, int bit) {
                          std::uint8_t& movers = pipe.movers[static_cast<std::size_t>(y * s.length + x)];
                          const auto wanted = static_cast<std::uint8_t>(1 << bit);
                          const bool is_free = (movers & wanted) == 0;
                          movers |= wanted;
                          return is_free;
                      });
        return std::make_unique<CountedPipeModel>(std::move(pipe), rules, s);
    }
    GasLattice lattice(static_cast<std::int32_t>(s.length), static_cast<std::int32_t>(s.width));
    put_particles(particles, s.length, s.width, 7, rules.seed, [&](std::int32_t x, std::int32_t y, int bit) {
        const bool is_free = !lattice.get(bit, x, y);
        lattice.set(bit, x, y, true);
        return is_free;
    });
    return std::make_unique<PipeFlowModel>(std::move(lattice), rules, means, s);
}

} // namespace sandlane::automata
