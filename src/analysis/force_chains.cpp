#include "analysis/force_chains.hpp"

#include "analysis/sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sandlane::analysis {

namespace {

struct Bond {
    std::size_t to;
    Vec direction; // unit vector
};

// Contacts among the grains above the threshold, as lists of neighbours.
std::vector<std::vector<Bond>> loaded_bonds(const Frame& frame, double threshold) {
    const std::vector<double>& pressure = frame.grains.pressure;
    std::vector<std::vector<Bond>> bonds(frame.grains.size());
    for (const Contact& c : frame.contacts) {
        if (c.with_wall()) continue;
        const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
        if (!(pressure[i] > threshold && pressure[j] > threshold)) continue;
        bonds[i].push_back({j, c.normal});
        bonds[j].push_back({i, -1.0 * c.normal});
    }
    return bonds;
}

class ForceChainSeries : public Series {
public:
    ForceChainSeries(double threshold, std::int64_t dimension)
        : threshold_(threshold), dimension_(dimension) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{"time", "s"},        {"mean_pressure", pressure_unit(dimension_)},
                {"triples", "1"},     {"chains", "1"},
                {"members", "1"},     {"member_share", "1"},
                {"mean_length", "1"}, {"longest", "1"}};
    }
    void add(const Frame& frame) override {
        const double mean = mean_pressure(frame.grains);
        const ForceChains found = find_force_chains(frame, threshold_ * mean);
        const auto chains = static_cast<double>(found.length.size());
        const auto members = static_cast<double>(found.members());
        const auto grains = static_cast<double>(frame.grains.size());
        const auto longest = std::max_element(found.length.begin(), found.length.end());
        rows_ = {{frame.grains.time, mean, static_cast<double>(found.triples), chains, members,
                  grains > 0 ? members / grains : 0, chains > 0 ? members / chains : 0,
                  longest != found.length.end() ? static_cast<double>(*longest) : 0}};
    }

private:
    double threshold_; // in units of the mean pressure
    std::int64_t dimension_;
};

} // namespace

std::int64_t ForceChains::members() const {
    return std::accumulate(length.begin(), length.end(), std::int64_t{0});
}

ForceChains find_force_chains(const Frame& frame, double threshold) {
    const double limit = std::cos(150 * std::numbers::pi / 180);
    const std::vector<std::vector<Bond>> bonds = loaded_bonds(frame, threshold);
    const std::size_t n = bonds.size();
    ForceChains found;
    Sets sets(n);
    std::vector<bool> member(n, false);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t a = 0; a < bonds[j].size(); ++a)
            for (std::size_t b = a + 1; b < bonds[j].size(); ++b) {
                if (!(dot(bonds[j][a].direction, bonds[j][b].direction) < limit)) continue;
                ++found.triples;
                for (const std::size_t other : {bonds[j][a].to, bonds[j][b].to}) {
                    sets.join(j, other);
                    member[other] = true;
                }
                member[j] = true;
            }
    found.chain.assign(n, -1);
    for (std::size_t i = 0; i < n; ++i) { // a root comes before the other members of its set
        if (!member[i]) continue;
        const std::size_t root = sets.root(i);
        if (root == i) {
            found.chain[i] = static_cast<std::int32_t>(found.length.size());
            found.length.push_back(0);
        }
        found.chain[i] = found.chain[root];
        ++found.length[static_cast<std::size_t>(found.chain[i])];
    }
    return found;
}

double mean_pressure(const Snapshot& s) {
    if (s.size() == 0) return 0;
    return std::accumulate(s.pressure.begin(), s.pressure.end(), 0.0) / static_cast<double>(s.size());
}

std::unique_ptr<Analysis> make_force_chains(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    return std::make_unique<ForceChainSeries>(spec.threshold, scene.domain.dimension);
}

} // namespace sandlane::analysis
