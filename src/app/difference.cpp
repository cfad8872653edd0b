#include "app/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace sandlane::app {

std::uint64_t ulp_distance(double a, double b) {
    if (std::isnan(a) || std::isnan(b))
        return std::isnan(a) && std::isnan(b) ? 0 : std::numeric_limits<std::uint64_t>::max();
    // Maps doubles to integers of the same order, with -0 and +0 adjacent at zero distance.
    const auto ordered = [](double x) {
        const auto raw = std::bit_cast<std::int64_t>(x);
        return raw < 0 ? std::numeric_limits<std::int64_t>::min() - raw : raw;
    };
    const std::int64_t x = ordered(a), y = ordered(b);
    return x > y ? static_cast<std::uint64_t>(x) - static_cast<std::uint64_t>(y)
                 : static_cast<std::uint64_t>(y) - static_cast<std::uint64_t>(x);
}

Difference difference(std::string quantity, std::string unit, const std::vector<std::int64_t>& ids,
                      const std::vector<double>& a, const std::vector<double>& b) {
    Difference d{std::move(quantity), std::move(unit), 0, 0, 0, -1};
    double scale = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        scale = std::max({scale, std::abs(a[i]), std::abs(b[i])});
        const double gap = std::abs(a[i] - b[i]);
        d.ulps = std::max(d.ulps, ulp_distance(a[i], b[i]));
        if (gap > d.absolute || std::isnan(gap)) {
            d.absolute = gap;
            d.id = ids[i];
        }
    }
    if (d.absolute > 0) d.relative = d.absolute / scale;
    return d;
}

namespace {

using analysis::Snapshot;

struct Column {
    const char *name, *unit;
    std::vector<double> Snapshot::*values;
};
constexpr Column plane_columns[] = {{"x", "m", &Snapshot::x},           {"y", "m", &Snapshot::y},
                                    {"angle", "rad", &Snapshot::angle}, {"vx", "m/s", &Snapshot::vx},
                                    {"vy", "m/s", &Snapshot::vy},       {"omega", "rad/s", &Snapshot::omega}};
constexpr Column space_columns[] = {{"x", "m", &Snapshot::x},
                                    {"y", "m", &Snapshot::y},
                                    {"z", "m", &Snapshot::z},
                                    {"vx", "m/s", &Snapshot::vx},
                                    {"vy", "m/s", &Snapshot::vy},
                                    {"vz", "m/s", &Snapshot::vz},
                                    {"omega_x", "rad/s", &Snapshot::omega_x},
                                    {"omega_y", "rad/s", &Snapshot::omega_y},
                                    {"omega_z", "rad/s", &Snapshot::omega}};

void add_orientations(const Snapshot& a, const Snapshot& b, std::vector<Difference>& to) {
    if (a.orientation.empty() || b.orientation.empty()) return; // not followed
    struct Part {
        const char* name;
        double Quaternion::*value;
    };
    constexpr Part parts[] = {{"orientation_w", &Quaternion::w},
                              {"orientation_x", &Quaternion::x},
                              {"orientation_y", &Quaternion::y},
                              {"orientation_z", &Quaternion::z}};
    for (const Part& part : parts) {
        std::vector<double> first, second;
        for (const Quaternion& q : a.orientation) first.push_back(q.*part.value);
        for (const Quaternion& q : b.orientation) second.push_back(q.*part.value);
        to.push_back(difference(part.name, "1", a.id, first, second));
    }
}

} // namespace

std::vector<Difference> compare_snapshots(const Snapshot& a, const Snapshot& b) {
    if (a.id != b.id || a.dimension != b.dimension)
        return {{"grains", "", std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity(), 0, -1}};
    std::vector<Difference> found;
    const std::span<const Column> columns =
        a.dimension == 3 ? std::span<const Column>(space_columns) : plane_columns;
    for (const Column& c : columns)
        found.push_back(difference(c.name, c.unit, a.id, a.*c.values, b.*c.values));
    add_orientations(a, b, found);
    found.push_back(
        difference("pressure", analysis::pressure_unit(a.dimension), a.id, a.pressure, b.pressure));
    return found;
}

std::vector<Difference> compare_forces(md::Simulation& simulation, simd::Isa first, simd::Isa second) {
    const auto method = simulation.plan().neighbours;
    const std::vector<double> a = simulation.forces(first, method), b = simulation.forces(second, method);
    std::vector<std::int64_t> ids(simulation.state().id.begin(), simulation.state().id.end());
    std::vector<Difference> result;
    const md::State& state = simulation.state();
    struct Field {
        const char* name;
        std::size_t position; // in the row of a grain
    };
    const Field plane[] = {{"force x", 0}, {"force y", 1}, {"tangential force", 2}};
    const Field space[] = {{"force x", 0},    {"force y", 1},    {"force z", 2},
                           {"torque/R x", 4}, {"torque/R y", 5}, {"torque/R z", 6}};
    for (const Field& field : state.dimension == 3 ? std::span<const Field>(space) : plane) {
        if (field.position >= state.force_stride()) continue;
        std::vector<double> x, y;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            x.push_back(a[i * state.force_stride() + field.position]);
            y.push_back(b[i * state.force_stride() + field.position]);
        }
        result.push_back(difference(field.name, "N", ids, x, y));
    }
    return result;
}

std::string difference_table(const std::vector<Difference>& differences) {
    std::string text = fmt::format("{:<18}{:<8}{:>12}{:>12}{:>12}  {}\n", "quantity", "unit", "absolute",
                                   "relative", "ULP", "grain");
    for (const Difference& d : differences)
        text += fmt::format("{:<18}{:<8}{:>12.3g}{:>12.3g}{:>12}  {}\n", d.quantity, d.unit, d.absolute,
                            d.relative, d.ulps, d.id < 0 ? "-" : std::to_string(d.id));
    return text;
}

double worst_relative(const std::vector<Difference>& differences) {
    double worst = 0;
    for (const Difference& d : differences)
        worst = std::max(worst, std::isnan(d.relative) ? INFINITY : d.relative);
    return worst;
}

} // namespace sandlane::app
