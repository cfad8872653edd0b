#include "app/md_difference.hpp"

#include <limits>
#include <span>

namespace sandlane::app {

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

std::vector<Difference> compare_forces(const md::Simulation& simulation, simd::Isa first, simd::Isa second) {
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

} // namespace sandlane::app
