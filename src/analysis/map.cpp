// Where the load is: averages over square bins of about one mean diameter (md-spheres 8.3, the maps of
// chapter 1). In 3D the bins are columns along the viewing axis: averages over the depth of the region.
#include "analysis/force_chains.hpp"
#include "analysis/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sandlane::analysis {

namespace {

class Map : public Average {
public:
    Map(Region region, scene::Axis viewing, double threshold, std::size_t columns)
        : Average(0), region_(region), threshold_(threshold), wanted_(columns) {
        if (region.dimension == 2) return;
        if (viewing == scene::Axis::x) across_ = scene::Axis::y;
        if (viewing != scene::Axis::z) up_ = scene::Axis::z;
    }

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        std::vector<LogColumn> columns{{axis_name(across_), "m"}, {axis_name(up_), "m"},
                                       {"grains", "1"},           {"pressure", unit()},
                                       {"velocity_x", "m/s"},     {"velocity_y", "m/s"}};
        if (region_.dimension == 3) columns.push_back({"velocity_z", "m/s"});
        columns.insert(columns.end(), {{"loaded_in_chains", "1"}, {"loaded_outside", "1"}});
        return columns;
    }

    void add(const Frame& frame) override {
        const Snapshot& s = frame.grains;
        if (s.size() == 0) return;
        if (columns_ == 0) make_bins(s);
        ++frames_;
        const double limit = threshold_ * mean_pressure(s);
        const ForceChains chains = find_force_chains(frame, limit);
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p = s.position(i), v = s.velocity(i);
            if (!region_.contains(p)) continue;
            const bool loaded = s.pressure[i] > limit, member = chains.chain[i] >= 0;
            const std::array<double, 7> values{
                1, s.pressure[i], v.x, v.y, loaded && member ? 1.0 : 0.0, loaded && !member ? 1.0 : 0.0, v.z};
            double* sum = sums_.data() + bin_of(p) * fields();
            for (std::size_t f = 0; f < fields(); ++f) sum[f] += values[f];
        }
    }

    [[nodiscard]] Rows rows() const override {
        Rows rows;
        for (std::size_t b = 0; b < columns_ * rows_; ++b) {
            const double* sum = sums_.data() + b * fields();
            const double share = sum[0] > 0 ? 1 / sum[0] : 0;
            const std::size_t column = b % columns_, row = b / columns_;
            const double x = static_cast<double>(column) + 0.5, y = static_cast<double>(row) + 0.5;
            std::vector<double>& out = rows.emplace_back();
            out = {lower().x + x * bin_width(),
                   lower().y + y * bin_height(),
                   per_frame(sum[0]),
                   share * sum[1],
                   share * sum[2],
                   share * sum[3]};
            if (region_.dimension == 3) out.push_back(share * sum[6]);
            out.insert(out.end(), {per_frame(sum[4]), per_frame(sum[5])});
        }
        return rows;
    }

    [[nodiscard]] std::vector<Grid> grids() const override {
        if (columns_ == 0) return {};
        Grid pressure = grid("pressure", "mean pressure", unit());
        Grid chains = grid("chains", "loaded, in chains", ""),
             outside = grid("outside", "loaded, not in chains", "");
        for (const std::vector<double>& row : rows()) {
            pressure.values.push_back(row[3]);
            chains.values.push_back(row.end()[-2]);
            outside.values.push_back(row.end()[-1]);
        }
        return {pressure, chains, outside};
    }

    void save(ByteWriter& bytes) const override {
        bytes.put(static_cast<std::uint64_t>(columns_));
        bytes.put(static_cast<std::uint64_t>(rows_));
        Average::save(bytes);
    }
    void load(ByteReader& bytes) override {
        const auto columns = bytes.get<std::uint64_t>(), rows = bytes.get<std::uint64_t>();
        if (columns > most || rows > most) fail(Exit::io, "the checkpoint holds the sums of another map");
        set_bins(columns, rows);
        Average::load(bytes);
    }

private:
    // count, pressure, vx, vy, above the threshold in a chain, above it in none; 3D: vz
    [[nodiscard]] std::size_t fields() const { return region_.dimension == 3 ? 7 : 6; }
    static constexpr std::size_t most = 4096; // columns or rows

    // By the mean diameter of the first grains seen, unless the scene says how many columns.
    void make_bins(const Snapshot& s) {
        const double diameter =
            2 * std::accumulate(s.radius.begin(), s.radius.end(), 0.0) / static_cast<double>(s.size());
        const auto bins = [](double length, double edge) {
            return static_cast<std::size_t>(
                std::clamp(std::round(length / edge), 1.0, static_cast<double>(most)));
        };
        const std::size_t columns = wanted_ > 0 ? wanted_ : bins(size().x, diameter);
        set_bins(columns, bins(size().y, size().x / static_cast<double>(columns)));
    }
    void set_bins(std::size_t columns, std::size_t rows) {
        columns_ = columns;
        rows_ = rows;
        sums_.assign(columns * rows * fields(), 0.0);
    }

    [[nodiscard]] std::string unit() const { return pressure_unit(region_.dimension); }
    // In the plane of the map, x to the right and y up.
    [[nodiscard]] Vec in_plane(Vec p) const { return {component(p, across_), component(p, up_), 0}; }
    [[nodiscard]] Vec lower() const { return in_plane(region_.lower); }
    [[nodiscard]] Vec size() const { return in_plane(region_.size()); }
    [[nodiscard]] double bin_width() const { return size().x / static_cast<double>(columns_); }
    [[nodiscard]] double bin_height() const { return size().y / static_cast<double>(rows_); }
    [[nodiscard]] std::size_t bin_of(Vec p) const {
        const Vec at = in_plane(p) - lower();
        const auto column = static_cast<std::size_t>(at.x / bin_width());
        const auto row = static_cast<std::size_t>(at.y / bin_height());
        return std::min(row, rows_ - 1) * columns_ + std::min(column, columns_ - 1);
    }
    [[nodiscard]] Grid grid(std::string name, std::string label, std::string unit) const {
        return {std::move(name),         std::move(label), std::move(unit), lower(),
                in_plane(region_.upper), columns_,         rows_,           {}};
    }

    Region region_;
    scene::Axis across_ = scene::Axis::x, up_ = scene::Axis::y;
    double threshold_; // in units of the mean pressure
    std::size_t wanted_, columns_ = 0, rows_ = 0;
};

} // namespace

std::unique_ptr<Analysis> make_map(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    return std::make_unique<Map>(region_of(scene, spec), spec.axis, spec.threshold,
                                 static_cast<std::size_t>(spec.bins));
}

} // namespace sandlane::analysis
