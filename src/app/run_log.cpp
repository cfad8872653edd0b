#include "app/run_log.hpp"

namespace sandlane::app {

namespace {

struct Entry {
    const char *name, *unit;
    double (*value)(const md::Simulation&, const md::Observables&);
};

using Sim = const md::Simulation&;
using Obs = const md::Observables&;

constexpr Entry entries[] = {
    {"time", "s", [](Sim s, Obs) { return s.time(); }},
    {"step", "1", [](Sim s, Obs) { return static_cast<double>(s.step()); }},
    {"grains", "1", [](Sim, Obs o) { return static_cast<double>(o.grains); }},
    {"kinetic_energy", "J", [](Sim, Obs o) { return o.kinetic; }},
    {"rotational_energy", "J", [](Sim, Obs o) { return o.rotational; }},
    {"elastic_energy", "J", [](Sim, Obs o) { return o.elastic; }},
    {"potential_energy", "J", [](Sim, Obs o) { return o.potential; }},
    {"total_energy", "J", [](Sim, Obs o) { return o.kinetic + o.rotational + o.elastic + o.potential; }},
    {"momentum_x", "kg m/s", [](Sim, Obs o) { return o.momentum_x; }},
    {"momentum_y", "kg m/s", [](Sim, Obs o) { return o.momentum_y; }},
    {"contacts", "1", [](Sim, Obs o) { return static_cast<double>(o.contacts); }},
    {"wall_contacts", "1", [](Sim, Obs o) { return static_cast<double>(o.wall_contacts); }},
    {"largest_overlap", "R_min", [](Sim, Obs o) { return o.largest_overlap; }},
    {"largest_speed", "m/s", [](Sim, Obs o) { return o.largest_speed; }},
    {"removed", "1", [](Sim s, Obs) { return static_cast<double>(s.removed()); }},
};

} // namespace

std::vector<analysis::LogColumn> log_columns() {
    std::vector<analysis::LogColumn> columns;
    for (const Entry& entry : entries) columns.push_back({entry.name, entry.unit});
    return columns;
}

std::vector<double> log_row(const md::Simulation& simulation, const md::Observables& observed) {
    std::vector<double> row;
    for (const Entry& entry : entries) row.push_back(entry.value(simulation, observed));
    return row;
}

} // namespace sandlane::app
