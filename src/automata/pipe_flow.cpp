// Granular flow in a pipe (docs/physics.md 18): the lattice gas with dissipation, and its density waves.
#include "automata/gas.hpp"
#include "automata/spectrum.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sandlane::automata {

namespace {

constexpr std::uint32_t start_stream = 1 << 20;
constexpr std::size_t map_rows = 512; // of the space-time map

// Particles on distinct random bits of distinct random sites.
void fill(GasLattice& lattice, std::int64_t particles, const PhiloxKey& seed) {
    const auto columns = static_cast<std::uint64_t>(lattice.columns),
               rows = static_cast<std::uint64_t>(lattice.rows);
    for (std::uint64_t k = 0; particles > 0; ++k) {
        const PhiloxCounter r = philox(
            {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32), 0, start_stream}, seed);
        const auto y = static_cast<std::int32_t>(r[0] * rows >> 32),
                   x = static_cast<std::int32_t>(r[1] * columns >> 32);
        const auto bit = static_cast<int>(r[2] * std::uint64_t{7} >> 32);
        if (lattice.get(bit, x, y)) continue;
        lattice.set(bit, x, y, true);
        --particles;
    }
}

class PipeFlowModel final : public GasFlow {
public:
    PipeFlowModel(GasLattice lattice, const GasRules& rules, const Means& means, const scene::PipeFlow& pipe)
        : GasFlow(std::move(lattice), rules, means), window_(static_cast<std::int32_t>(pipe.window)),
          map_every_(std::max<std::int64_t>(1, pipe.steps / static_cast<std::int64_t>(map_rows))) {
        look();
    }

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        std::vector<analysis::LogColumn> columns = GasFlow::log_columns();
        columns.push_back({"window_density", "1/site"});
        return columns;
    }
    [[nodiscard]] std::vector<double> log_row() const override {
        std::vector<double> row = GasFlow::log_row();
        row.push_back(series_.back());
        return row;
    }
    [[nodiscard]] std::vector<Field> fields() const override {
        std::vector<Field> fields = GasFlow::fields();
        std::reverse(fields.begin(), fields.end());
        return fields;
    }
    // Places along x, times upwards.
    [[nodiscard]] std::vector<Field> final_fields() const override {
        const auto wide = static_cast<std::size_t>(lattice_.columns);
        return {{"space-time", "particles per site", "", wide, map_.size() / wide, map_, false, 0}};
    }
    [[nodiscard]] std::vector<Table> final_tables() const override {
        Table spectrum{"spectrum", {{"frequency", "1/step"}, {"power", "1"}}, {}, 0, 1, true};
        const Spectrum s = density_spectrum();
        for (std::size_t k = 0; k < s.frequency.size(); ++k)
            spectrum.rows.push_back({s.frequency[k], s.power[k]});
        Table fit{
            "power-law", {{"exponent", "1"}, {"standard_error", "1"}, {"from", "1/step"}, {"to", "1/step"}},
            {},          -1,
            -1,          true};
        if (!s.power.empty()) {
            const std::size_t peak =
                static_cast<std::size_t>(std::max_element(s.power.begin(), s.power.end()) - s.power.begin());
            const Line line = power_law(s, s.frequency[peak], 0.1);
            fit.rows.push_back({line.slope, line.error, s.frequency[peak], 0.1});
        }
        Table profile{"profile", {{"row", "1"}, {"density", "1/site"}, {"velocity", "sites/step"}}, {}, 0, 2,
                      false};
        for (std::int32_t y = 0; y < lattice_.rows; ++y) {
            const auto r = static_cast<std::size_t>(y);
            profile.rows.push_back({static_cast<double>(y),
                                    row_particles_[r] / (static_cast<double>(looks_) * lattice_.columns),
                                    row_particles_[r] > 0 ? row_momentum_[r] / row_particles_[r] : 0});
        }
        return {spectrum, fit, profile};
    }

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
        series_.push_back(static_cast<double>(inside) / (static_cast<double>(window_) * lattice_.rows));
        if (step_ % map_every_ == 0) add_to_maps();
    }
    void save(ByteWriter& w) const override {
        w.put_array(series_.data(), series_.size());
        w.put_array(map_.data(), map_.size());
        w.put_array(row_particles_.data(), row_particles_.size());
        w.put_array(row_momentum_.data(), row_momentum_.size());
        w.put(looks_);
    }
    void load(ByteReader& r) override {
        r.get_array(series_);
        r.get_array(map_);
        r.get_array(row_particles_);
        r.get_array(row_momentum_);
        looks_ = r.get<std::int64_t>();
        const bool fits = map_.size() % static_cast<std::size_t>(lattice_.columns) == 0 &&
                          row_particles_.size() == static_cast<std::size_t>(lattice_.rows) &&
                          row_momentum_.size() == row_particles_.size();
        if (!fits || series_.empty()) fail(Exit::io, "the state is one of another pipe");
    }

private:
    void add_to_maps() {
        row_particles_.resize(static_cast<std::size_t>(lattice_.rows), 0);
        row_momentum_.resize(row_particles_.size(), 0);
        constexpr double speed[] = {1, 0.5, -0.5, -1, -0.5, 0.5, 0};
        std::vector<double> columns(static_cast<std::size_t>(lattice_.columns), 0);
        for (int i = 0; i < rules_.planes(); ++i)
            for (std::int32_t y = 0; y < lattice_.rows; ++y)
                for (std::int32_t x = 0; x < lattice_.columns; ++x) {
                    if (!lattice_.get(i, x, y)) continue;
                    columns[static_cast<std::size_t>(x)] += 1.0 / lattice_.rows;
                    row_particles_[static_cast<std::size_t>(y)] += 1;
                    row_momentum_[static_cast<std::size_t>(y)] += speed[i];
                }
        map_.insert(map_.end(), columns.begin(), columns.end());
        ++looks_;
    }
    // Pieces of an eighth of the series, so that several are averaged.
    [[nodiscard]] Spectrum density_spectrum() const {
        return welch(series_, std::bit_floor(std::max<std::size_t>(series_.size() / 8, 1)));
    }

    std::int32_t window_;
    std::int64_t map_every_, looks_ = 0;
    std::vector<double> series_; // density of the window at every step
    std::vector<double> map_;    // [times][columns]
    std::vector<double> row_particles_, row_momentum_;
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
    GasLattice lattice(static_cast<std::int32_t>(s.length), static_cast<std::int32_t>(s.width));
    fill(lattice, std::llround(s.density * static_cast<double>(s.length) * static_cast<double>(s.width)),
         rules.seed);
    return std::make_unique<PipeFlowModel>(std::move(lattice), rules, means, s);
}

} // namespace sandlane::automata
