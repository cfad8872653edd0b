#include "analysis/flow.hpp"

#include "analysis/analysis.hpp"
#include "analysis/region.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::analysis {

namespace {

Vec unwrapped(const Snapshot& s, std::size_t i) {
    const Vec size = s.upper - s.lower, p = s.position(i);
    return {p.x + s.image_x[i] * size.x, p.y + s.image_y[i] * size.y,
            s.dimension == 3 ? p.z + s.image_z[i] * size.z : 0.0};
}

// +1: from the left to the right, -1: back, 0: not through the segment. Points on the line count to its left,
// so that a path that stops on it crosses once.
int through_segment(Vec p, Vec q, Vec from, Vec to) {
    const Vec along = to - from;
    const double before = cross(along, p - from).z, after = cross(along, q - from).z;
    if ((before >= 0) == (after >= 0)) return 0;
    const Vec at = p + (before / (before - after)) * (q - p);
    const double along_line = dot(along, at - from);
    if (!(along_line >= 0 && along_line < dot(along, along))) return 0;
    return before >= 0 ? 1 : -1;
}

// +1: along the axis that the rectangle lies across, -1: back, 0: not through it. Points on it count to the
// side that the axis comes from.
int through_rectangle(Vec p, Vec q, Vec from, Vec to) {
    using scene::Axis;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        const double plane = component(from, axis);
        if (component(to, axis) != plane) continue;
        const double before = component(p, axis) - plane, after = component(q, axis) - plane;
        if ((before <= 0) == (after <= 0)) return 0;
        const Vec at = p + (before / (before - after)) * (q - p);
        for (const Axis side : {Axis::x, Axis::y, Axis::z}) {
            if (side == axis) continue;
            const auto [low, high] = std::minmax({component(from, side), component(to, side)});
            if (!(component(at, side) >= low && component(at, side) < high)) return 0;
        }
        return before <= 0 ? 1 : -1;
    }
    fail(Exit::internal, "flow: from and to have no coordinate in common");
}

class Flow : public Series {
public:
    Flow(Vec from, Vec to, std::int64_t dimension)
        : from_(from), to_(to), dimension_(static_cast<std::size_t>(dimension)) {}

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
        for (const std::int64_t id : ids) {
            const Vec place = before_.at(id);
            values.insert(values.end(), {place.x, place.y});
            if (dimension_ == 3) values.push_back(place.z);
        }
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
        if (values.size() != dimension_ * ids.size())
            fail(Exit::io, "the checkpoint holds the places of another flow");
        before_.clear();
        for (std::size_t n = 0; n < ids.size(); ++n) {
            const double* place = values.data() + dimension_ * n;
            before_[ids[n]] = {place[0], place[1], dimension_ == 3 ? place[2] : 0.0};
        }
    }

private:
    Vec from_, to_;
    std::size_t dimension_;
    bool started_ = false;
    double time_ = 0, total_ = 0; // s, kg
    Places before_;
};

} // namespace

Places places_of(const Snapshot& s) {
    Places places;
    places.reserve(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) places[s.id[i]] = unwrapped(s, i);
    return places;
}

Crossings crossings(const Places& before, const Snapshot& now, Vec from, Vec to) {
    const auto direction = now.dimension == 3 ? through_rectangle : through_segment;
    Crossings sum;
    const Vec size = now.upper - now.lower;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const auto found = before.find(now.id[i]);
        if (found == before.end()) continue;
        const Vec end = now.position(i), start = end - (unwrapped(now, i) - found->second);
        // A path that leaves the domain goes on beyond the other side: look at its images up to the start's.
        const auto images = [](double x, double lower, double length, bool periodic) {
            return periodic ? static_cast<int>(std::floor((x - lower) / length)) : 0;
        };
        const int nx = images(start.x, now.lower.x, size.x, now.periodic_x);
        const int ny = images(start.y, now.lower.y, size.y, now.periodic_y);
        const int nz = images(start.z, now.lower.z, size.z, now.periodic_z);
        for (int kx = std::min(nx, 0); kx <= std::max(nx, 0); ++kx)
            for (int ky = std::min(ny, 0); ky <= std::max(ny, 0); ++ky)
                for (int kz = std::min(nz, 0); kz <= std::max(nz, 0); ++kz) {
                    const Vec shift{kx * size.x, ky * size.y, kz * size.z};
                    const int crossed = direction(start - shift, end - shift, from, to);
                    sum.grains += crossed;
                    sum.mass += crossed * now.mass[i];
                }
    }
    return sum;
}

std::unique_ptr<Analysis> make_flow(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    return std::make_unique<Flow>(spec.from, spec.to, scene.domain.dimension);
}

} // namespace sandlane::analysis
