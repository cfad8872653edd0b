#include "analysis/flow.hpp"

#include "analysis/analysis.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::analysis {

namespace {

Vec unwrapped(const Snapshot& s, std::size_t i) {
    const Vec size = s.upper - s.lower;
    return {s.x[i] + s.image_x[i] * size.x, s.y[i] + s.image_y[i] * size.y, 0};
}

// +1: from the left to the right, -1: back, 0: not through the segment. Points on the line count to its left,
// so that a path that stops on it crosses once.
int direction(Vec p, Vec q, Vec from, Vec to) {
    const Vec along = to - from;
    const double before = cross(along, p - from).z, after = cross(along, q - from).z;
    if ((before >= 0) == (after >= 0)) return 0;
    const Vec at = p + (before / (before - after)) * (q - p);
    const double along_line = dot(along, at - from);
    if (!(along_line >= 0 && along_line < dot(along, along))) return 0;
    return before >= 0 ? 1 : -1;
}

class Flow : public Series {
public:
    Flow(Vec from, Vec to) : from_(from), to_(to) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{"time", "s"}, {"grains", "1"}, {"mass", "kg"}, {"mass_flow", "kg/s"}, {"total_mass", "kg"}};
    }
    void add(const Frame& frame) override {
        const Snapshot& now = frame.grains;
        rows_.clear();
        if (started_) {
            const Crossings c = crossings(before_, now, from_, to_);
            total_ += c.mass;
            rows_ = {
                {now.time, c.grains, c.mass, now.time > time_ ? c.mass / (now.time - time_) : 0, total_}};
        }
        before_ = places_of(now);
        time_ = now.time;
        started_ = true;
    }

    void save(ByteWriter& bytes) const override {
        bytes.put(static_cast<std::int32_t>(started_));
        bytes.put(time_);
        bytes.put(total_);
        std::vector<std::int64_t> ids;
        for (const auto& [id, place] : before_) ids.push_back(id);
        std::sort(ids.begin(), ids.end());
        std::vector<double> values;
        for (const std::int64_t id : ids) values.insert(values.end(), {before_.at(id).x, before_.at(id).y});
        bytes.put_array(ids.data(), ids.size());
        bytes.put_array(values.data(), values.size());
    }
    void load(ByteReader& bytes) override {
        started_ = bytes.get<std::int32_t>() != 0;
        time_ = bytes.get<double>();
        total_ = bytes.get<double>();
        std::vector<std::int64_t> ids;
        std::vector<double> values;
        bytes.get_array(ids);
        bytes.get_array(values);
        if (values.size() != 2 * ids.size())
            fail(Exit::io, "the checkpoint holds the places of another flow");
        before_.clear();
        for (std::size_t n = 0; n < ids.size(); ++n) before_[ids[n]] = {values[2 * n], values[2 * n + 1]};
    }

private:
    Vec from_, to_;
    bool started_ = false;
    double time_ = 0, total_ = 0; // s, kg
    Places before_;
};

} // namespace

Places places_of(const Snapshot& s) {
    Places places;
    places.reserve(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec p = unwrapped(s, i);
        places[s.id[i]] = {p.x, p.y};
    }
    return places;
}

Crossings crossings(const Places& before, const Snapshot& now, Vec from, Vec to) {
    Crossings sum;
    const Vec size = now.upper - now.lower;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const auto found = before.find(now.id[i]);
        if (found == before.end()) continue;
        const Vec end{now.x[i], now.y[i], 0},
            path = unwrapped(now, i) - Vec{found->second.x, found->second.y, 0};
        const Vec start = end - path;
        // A path that leaves the domain goes on beyond the other side: look at its images up to the start's.
        const auto images = [](double x, double lower, double length, bool periodic) {
            return periodic ? static_cast<int>(std::floor((x - lower) / length)) : 0;
        };
        const int nx = images(start.x, now.lower.x, size.x, now.periodic_x);
        const int ny = images(start.y, now.lower.y, size.y, now.periodic_y);
        for (int kx = std::min(nx, 0); kx <= std::max(nx, 0); ++kx)
            for (int ky = std::min(ny, 0); ky <= std::max(ny, 0); ++ky) {
                const Vec shift{kx * size.x, ky * size.y, 0};
                const int crossed = direction(start - shift, end - shift, from, to);
                sum.grains += crossed;
                sum.mass += crossed * now.mass[i];
            }
    }
    return sum;
}

std::unique_ptr<Analysis> make_flow(const scene::Scene&, const scene::AnalysisSpec& spec) {
    return std::make_unique<Flow>(spec.from, spec.to);
}

} // namespace sandlane::analysis
