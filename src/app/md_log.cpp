#include "app/md_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace sandlane::app {

namespace {

// Which scenes a column is of.
using Of = bool (*)(const scene::Scene&);
constexpr Of all_scenes = [](const scene::Scene&) { return true; };
constexpr Of in_plane = [](const scene::Scene& s) { return s.domain.dimension == 2; };
constexpr Of in_space = [](const scene::Scene& s) { return s.domain.dimension == 3; };
constexpr Of adaptive = [](const scene::Scene& s) { return s.md.adaptive_dt; };
constexpr Of sheared = [](const scene::Scene& s) { return s.domain.shear_rate != 0; };

struct Entry {
    const char *name, *unit;
    double (*value)(const md::Simulation&, const md::Observables&);
    Of of = all_scenes;
};

using Sim = const md::Simulation&;
using Obs = const md::Observables&;

constexpr Entry entries[] = {
    {"time", "s", [](Sim s, Obs) { return s.time(); }},
    {"step", "1", [](Sim s, Obs) { return static_cast<double>(s.step()); }},
    {"time_step", "s", [](Sim s, Obs) { return s.plan().dt; }, adaptive},
    {"grains", "1", [](Sim, Obs o) { return static_cast<double>(o.grains); }},
    {"kinetic_energy", "J", [](Sim, Obs o) { return o.kinetic; }},
    {"rotational_energy", "J", [](Sim, Obs o) { return o.rotational; }},
    {"elastic_energy", "J", [](Sim, Obs o) { return o.elastic; }},
    {"potential_energy", "J", [](Sim, Obs o) { return o.potential; }},
    {"total_energy", "J", [](Sim, Obs o) { return o.energy(); }},
    {"added_energy", "J", [](Sim s, Obs) { return s.added_energy(); }},
    {"wall_work", "J", [](Sim s, Obs) { return s.wall_work(); }},
    {"shear_work", "J", [](Sim s, Obs) { return s.shear_work(); }, sheared},
    {"dissipated_energy", "J", [](Sim s, Obs o) { return s.dissipated(o); }},
    {"momentum_x", "kg m/s", [](Sim, Obs o) { return o.momentum.x; }},
    {"momentum_y", "kg m/s", [](Sim, Obs o) { return o.momentum.y; }},
    {"momentum_z", "kg m/s", [](Sim, Obs o) { return o.momentum.z; }, in_space},
    {"contacts", "1", [](Sim, Obs o) { return static_cast<double>(o.contacts); }},
    {"wall_contacts", "1", [](Sim, Obs o) { return static_cast<double>(o.wall_contacts); }},
    {"largest_overlap", "R_min", [](Sim, Obs o) { return o.largest_overlap; }},
    {"largest_speed", "m/s", [](Sim, Obs o) { return o.largest_speed; }},
    {"removed", "1", [](Sim s, Obs) { return static_cast<double>(s.removed()); }},
};

struct WallEntry {
    const char *name, *unit;
    double (*value)(const md::WallLoad&);
    Of of = all_scenes;
};
constexpr WallEntry wall_entries[] = {
    {"force_x", "N", [](const md::WallLoad& w) { return w.force.x; }},
    {"force_y", "N", [](const md::WallLoad& w) { return w.force.y; }},
    {"force_z", "N", [](const md::WallLoad& w) { return w.force.z; }, in_space},
    {"torque", "N m", [](const md::WallLoad& w) { return w.torque.z; }, in_plane},
    {"torque_x", "N m", [](const md::WallLoad& w) { return w.torque.x; }, in_space},
    {"torque_y", "N m", [](const md::WallLoad& w) { return w.torque.y; }, in_space},
    {"torque_z", "N m", [](const md::WallLoad& w) { return w.torque.z; }, in_space},
    {"power", "W", [](const md::WallLoad& w) { return w.power; }},
};

// A name that a column can bear and no other wall has; else the wall's number.
std::string wall_name(const scene::Scene& scene, std::size_t wall) {
    const std::string& name = scene.walls[wall].name;
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
    const auto same = std::count_if(scene.walls.begin(), scene.walls.end(),
                                    [&](const scene::Wall& other) { return other.name == name; });
    return plain && same == 1 ? name : fmt::format("wall_{}", wall);
}

// Calls body(entry) for those that mean something in the scene.
template <class Entries, class Body>
void for_entries(const Entries& table, const scene::Scene& scene, const Body& body) {
    for (const auto& entry : table)
        if (entry.of(scene)) body(entry);
}

} // namespace

std::vector<analysis::LogColumn> log_columns(const scene::Scene& scene, const Watcher& watcher) {
    std::vector<analysis::LogColumn> columns;
    for_entries(entries, scene, [&](const Entry& e) { columns.push_back({e.name, e.unit}); });
    watcher.add_columns(columns);
    for (std::size_t wall = 0; wall < scene.walls.size(); ++wall)
        for_entries(wall_entries, scene, [&](const WallEntry& e) {
            columns.push_back({fmt::format("{}_{}", wall_name(scene, wall), e.name), e.unit});
        });
    return columns;
}

std::vector<double> log_row(const md::Simulation& simulation, const md::Observables& observed,
                            const Watcher& watcher) {
    const scene::Scene& scene = simulation.scene();
    std::vector<double> row;
    for_entries(entries, scene, [&](const Entry& e) { row.push_back(e.value(simulation, observed)); });
    watcher.add_row(row);
    for (const md::WallLoad& load : observed.walls)
        for_entries(wall_entries, scene, [&](const WallEntry& e) { row.push_back(e.value(load)); });
    return row;
}

} // namespace sandlane::app
