// Pair correlation g(r): pairs of centres at distance r over those of grains placed at random in the same
// region. Across sides that are not periodic the number for random grains follows from the mean overlap of
// the rectangle, or box, with itself shifted by r in any direction (set covariance, Stoyan, Kendall, Mecke
// 1995), so that an ideal gas gives 1 at every r.
#include "analysis/analysis.hpp"
#include "analysis/region.hpp"
#include "scene/cell_grid.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace sandlane::analysis {

namespace {

class PairCorrelation : public Average {
public:
    PairCorrelation(Region region, std::array<bool, 3> periodic, double range, std::size_t bins)
        : Average(2 * bins), region_(region), periodic_(periodic), range_(range), bins_(bins) {}

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
        domain.dimension = region_.dimension;
        domain.periodic = periodic_;
        const scene::Box box(domain);
        scene::CellGrid grid(box, range_, s.size());
        std::vector<Vec> inside;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p = s.position(i);
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
        return region_.dimension == 3 ? random_in_box(r) : random_in_rectangle(r);
    }

    [[nodiscard]] double random_in_rectangle(double r) const {
        const double a = region_.size().x, b = region_.size().y, area = region_.measure();
        double sides = 0; // length of the sides that a shifted rectangle loses
        if (!periodic_[0]) sides += b;
        if (!periodic_[1]) sides += a;
        const double corner = periodic_[0] || periodic_[1] ? 0 : 0.5 * r * r * r * r;
        return (std::numbers::pi * area * r * r - 4.0 / 3.0 * sides * r * r * r + corner) / (area * area);
    }

    // A box a b c shifted by h keeps (a - |h_x|)(b - |h_y|)(c - |h_z|). Over all directions |h_x| is r/2 in
    // the mean, |h_x h_y| is 2 r^2/(3 pi), |h_x h_y h_z| is r^3/(4 pi); a periodic side loses nothing.
    [[nodiscard]] double random_in_box(double r) const {
        const Vec size = region_.size();
        const double x = periodic_[0] ? 0 : 1, y = periodic_[1] ? 0 : 1, z = periodic_[2] ? 0 : 1;
        const double volume = region_.measure();
        const double faces = x * size.y * size.z + y * size.x * size.z + z * size.x * size.y;
        const double edges = x * y * size.z + x * z * size.y + y * z * size.x, corner = x * y * z;
        const double r3 = r * r * r;
        const double pi = std::numbers::pi;
        return r3 * (4 * pi / 3 * volume - pi / 2 * faces * r + 8.0 / 15 * edges * r * r - corner / 6 * r3) /
               (volume * volume);
    }

    double& expected(std::size_t bin) { return sums_[bins_ + bin]; }
    [[nodiscard]] double edge(std::size_t bin) const {
        return range_ * static_cast<double>(bin) / static_cast<double>(bins_);
    }

    Region region_;
    std::array<bool, 3> periodic_;
    double range_;
    std::size_t bins_;
};

} // namespace

std::unique_ptr<Analysis> make_pair_correlation(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    const Region region = region_of(scene, spec);
    const std::array<bool, 3> periodic =
        is_whole_domain(spec) ? scene.domain.periodic : std::array<bool, 3>{};
    double shortest = std::min(region.size().x, region.size().y);
    if (region.dimension == 3) shortest = std::min(shortest, region.size().z);
    return std::make_unique<PairCorrelation>(region, periodic, spec.range > 0 ? spec.range : 0.5 * shortest,
                                             spec.bins > 0 ? static_cast<std::size_t>(spec.bins) : 100);
}

} // namespace sandlane::analysis
