#include "analysis/mixing.hpp"

#include "analysis/analysis.hpp"
#include "analysis/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sandlane::analysis {

namespace {

// Cells of a region, about equally long in all directions.
class Cells {
public:
    Cells(Region region, std::array<std::uint64_t, 3> counts) : region_(region), counts_(counts) {}

    [[nodiscard]] const std::array<std::uint64_t, 3>& counts() const { return counts_; }
    [[nodiscard]] std::size_t size() const { return counts_[0] * counts_[1] * counts_[2]; }
    // Of a place inside the region.
    [[nodiscard]] std::size_t index(Vec p) const {
        const auto at = [&](scene::Axis axis) {
            const std::uint64_t count = counts_[static_cast<std::size_t>(axis)];
            if (count == 1) return std::uint64_t{0};
            const double unit =
                (component(p, axis) - component(region_.lower, axis)) / component(region_.size(), axis);
            return std::min(count - 1, static_cast<std::uint64_t>(unit * static_cast<double>(count)));
        };
        return (at(scene::Axis::z) * counts_[1] + at(scene::Axis::y)) * counts_[0] + at(scene::Axis::x);
    }

private:
    Region region_;
    std::array<std::uint64_t, 3> counts_;
};

class MixingSeries final : public Series {
public:
    MixingSeries(Region region, const scene::AnalysisSpec& spec)
        : region_(region), axis_(spec.axis), populations_(spec.populations),
          wanted_(static_cast<double>(spec.bins)) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{"time", "s"},     {"mixing", "1"}, {"share", "1"},
                {"variance", "1"}, {"grains", "1"}, {"cells", "1"}};
    }

    void add(const Frame& frame) override {
        const Snapshot& s = frame.grains;
        rows_.clear();
        if (s.size() == 0) return;
        if (counts_[0] == 0) start(s);
        const Cells cells(region_, counts_);
        std::vector<MixingCell> filled(cells.size());
        const std::vector<Side> side = sides(s);
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p = s.position(i);
            if (side[i] == Side::neither || !region_.contains(p)) continue;
            MixingCell& cell = filled[cells.index(p)];
            ++cell.grains;
            if (side[i] == Side::first) ++cell.first;
        }
        const Mixing m = lacey_mixing(filled);
        rows_ = {{s.time, m.index, m.share, m.variance, static_cast<double>(m.grains),
                  static_cast<double>(m.cells)}};
    }

    void save(ByteWriter& bytes) const override {
        for (const std::uint64_t count : counts_) bytes.put(count);
        bytes.put_array(first_.data(), first_.size());
        bytes.put_array(second_.data(), second_.size());
    }
    void load(ByteReader& bytes) override {
        for (std::uint64_t& count : counts_) {
            count = bytes.get<std::uint64_t>();
            if (count > most) fail(Exit::io, "the checkpoint holds the cells of another analysis");
        }
        bytes.get_array(first_);
        bytes.get_array(second_);
    }

private:
    enum class Side { first, second, neither };
    static constexpr std::uint64_t most = 4096;       // cells along one side
    static constexpr double most_cells = 1 << 22;     // in all
    static constexpr double diameters_per_cell = 3.0; // enough grains for a share, few enough to see grains

    // Fixes the cells, and who is on which side.
    void start(const Snapshot& s) {
        const double diameter =
            2 * std::accumulate(s.radius.begin(), s.radius.end(), 0.0) / static_cast<double>(s.size());
        const Vec size = region_.size();
        const double longest = std::max({size.x, size.y, size.z});
        double edge = wanted_ > 0 ? longest / wanted_ : diameters_per_cell * diameter;
        const double dimension = region_.dimension;
        edge = std::max(edge, std::pow(region_.measure() / most_cells, 1 / dimension));
        const auto count = [&](double length) {
            return static_cast<std::uint64_t>(
                std::clamp(std::round(length / edge), 1.0, static_cast<double>(most)));
        };
        counts_ = {count(size.x), count(size.y), region_.dimension == 3 ? count(size.z) : 1};
        if (populations_ == scene::Populations::sides) divide(s);
    }

    // By the median along the axis, ties by id.
    void divide(const Snapshot& s) {
        std::vector<std::pair<double, std::int64_t>> order;
        for (std::size_t i = 0; i < s.size(); ++i)
            if (region_.contains(s.position(i))) order.emplace_back(component(s.position(i), axis_), s.id[i]);
        std::sort(order.begin(), order.end());
        for (std::size_t n = 0; n < order.size(); ++n)
            (n < order.size() / 2 ? first_ : second_).push_back(order[n].second);
        std::sort(first_.begin(), first_.end());
        std::sort(second_.begin(), second_.end());
    }

    [[nodiscard]] std::vector<Side> sides(const Snapshot& s) const {
        std::vector<Side> side(s.size(), Side::second);
        const int material = *std::min_element(s.material.begin(), s.material.end());
        const auto [small, large] = std::minmax_element(s.radius.begin(), s.radius.end());
        const double middle = 0.5 * (*small + *large);
        const auto has = [](const std::vector<std::int64_t>& ids, std::int64_t id) {
            return std::binary_search(ids.begin(), ids.end(), id);
        };
        for (std::size_t i = 0; i < s.size(); ++i) {
            switch (populations_) {
            case scene::Populations::sides:
                side[i] = has(first_, s.id[i])    ? Side::first
                          : has(second_, s.id[i]) ? Side::second
                                                  : Side::neither;
                break;
            case scene::Populations::materials:
                if (s.material[i] == material) side[i] = Side::first;
                break;
            case scene::Populations::sizes:
                if (s.radius[i] < middle) side[i] = Side::first;
                break;
            }
        }
        return side;
    }

    Region region_;
    scene::Axis axis_;
    scene::Populations populations_;
    double wanted_;                            // cells along the longest side; 0: by the size of the grains
    std::array<std::uint64_t, 3> counts_{};    // 0: no grains seen yet
    std::vector<std::int64_t> first_, second_; // sides: ids in order
};

} // namespace

Mixing lacey_mixing(const std::vector<MixingCell>& cells) {
    Mixing m;
    std::int64_t first = 0;
    for (const MixingCell& cell : cells) {
        m.grains += cell.grains;
        first += cell.first;
        if (cell.grains > 0) ++m.cells;
    }
    const auto n = static_cast<double>(m.grains);
    m.share = m.grains > 0 ? static_cast<double>(first) / n : 0;
    for (const MixingCell& cell : cells) {
        if (cell.grains == 0) continue;
        const auto grains = static_cast<double>(cell.grains);
        const double excess = static_cast<double>(cell.first) / grains - m.share;
        m.variance += grains * excess * excess / n;
    }
    const double apart = m.share * (1 - m.share);
    const double random = apart * static_cast<double>(m.cells - 1) / (n - 1);
    m.index =
        apart > random ? (apart - m.variance) / (apart - random) : std::numeric_limits<double>::quiet_NaN();
    return m;
}

std::unique_ptr<Analysis> make_mixing(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    return std::make_unique<MixingSeries>(region_of(scene, spec), spec);
}

} // namespace sandlane::analysis
