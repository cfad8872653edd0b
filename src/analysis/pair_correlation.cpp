// Pair correlation g(r): pairs of centres at distance r over those of grains placed at random in the same
// region. Across sides that are not periodic the number for random grains follows from the mean overlap of
// the rectangle with itself shifted by r (set covariance, Stoyan, Kendall, Mecke 1995), so that an ideal gas
// gives 1 at every r.
#include "analysis/analysis.hpp"
#include "analysis/region.hpp"
#include "scene/cell_grid.hpp"

#include <algorithm>
#include <numbers>

namespace sandlane::analysis {

namespace {

class PairCorrelation : public Average {
public:
    PairCorrelation(Region region, bool periodic_x, bool periodic_y, double range, std::size_t bins)
        : Average(2 * bins), region_(region), periodic_x_(periodic_x), periodic_y_(periodic_y), range_(range),
          bins_(bins) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{"distance", "m"}, {"g", "1"}, {"pairs", "1"}};
    }

    void add(const Frame& frame) override {
        ++frames_;
        const std::size_t grains = count_pairs(frame.grains);
        const double n = static_cast<double>(grains), pairs = 0.5 * n * (n - 1);
        for (std::size_t b = 0; b < bins_; ++b)
            expected(b) += pairs * (random(edge(b + 1)) - random(edge(b)));
    }

    [[nodiscard]] Rows rows() const override {
        Rows rows;
        for (std::size_t b = 0; b < bins_; ++b) {
            const double found = sums_[b], random_pairs = sums_[bins_ + b];
            rows.push_back({0.5 * (edge(b) + edge(b + 1)), random_pairs > 0 ? found / random_pairs : 0,
                            per_frame(found)});
        }
        return rows;
    }

private:
    // Returns how many grains lie in the region.
    std::size_t count_pairs(const Snapshot& s) {
        scene::Domain domain;
        domain.lower = region_.lower;
        domain.upper = region_.upper;
        domain.periodic = {periodic_x_, periodic_y_};
        const scene::Box box(domain);
        scene::CellGrid grid(box, range_, s.size());
        std::vector<Vec> inside;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p{s.x[i], s.y[i], 0};
            if (!region_.contains(p)) continue;
            grid.for_near(p, [&](std::size_t other) { count(norm(box.separation(p, inside[other]))); });
            grid.insert(p);
            inside.push_back(p);
        }
        return inside.size();
    }

    void count(double distance) {
        if (distance < range_)
            sums_[std::min(bins_ - 1,
                           static_cast<std::size_t>(distance / range_ * static_cast<double>(bins_)))] += 1;
    }

    // Probability that two random points of the region are closer than r, for r up to the shorter open side.
    [[nodiscard]] double random(double r) const {
        const double a = region_.size().x, b = region_.size().y, area = region_.area();
        double sides = 0; // length of the sides that a shifted rectangle loses
        if (!periodic_x_) sides += b;
        if (!periodic_y_) sides += a;
        const double corner = periodic_x_ || periodic_y_ ? 0 : 0.5 * r * r * r * r;
        return (std::numbers::pi * area * r * r - 4.0 / 3.0 * sides * r * r * r + corner) / (area * area);
    }

    double& expected(std::size_t bin) { return sums_[bins_ + bin]; }
    [[nodiscard]] double edge(std::size_t bin) const {
        return range_ * static_cast<double>(bin) / static_cast<double>(bins_);
    }

    Region region_;
    bool periodic_x_, periodic_y_;
    double range_;
    std::size_t bins_;
};

} // namespace

std::unique_ptr<Analysis> make_pair_correlation(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    const Region region = region_of(scene, spec);
    const bool whole = is_whole_domain(spec);
    const double shortest = std::min(region.size().x, region.size().y);
    return std::make_unique<PairCorrelation>(region, whole && scene.domain.periodic[0],
                                             whole && scene.domain.periodic[1],
                                             spec.range > 0 ? spec.range : 0.5 * shortest,
                                             spec.bins > 0 ? static_cast<std::size_t>(spec.bins) : 100);
}

} // namespace sandlane::analysis
