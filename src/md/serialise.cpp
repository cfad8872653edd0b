// The complete state of a simulation as bytes. What follows from the scene alone is not stored.
#include "core/bytes.hpp"
#include "md/simulation.hpp"

#include <cmath>
#include <map>

namespace sandlane::md {

namespace {

// Calls body(column) for every column of the state, in the order of the file.
template <class StateRef, class Body> void for_columns(StateRef& state, const Body& body) {
    body(state.gear);
    body(state.radius);
    body(state.inverse_radius);
    body(state.mass);
    body(state.inverse_mass);
    body(state.spin_factor);
    body(state.material);
    body(state.image_x);
    body(state.image_y);
    body(state.id);
}

// What indexes memory, and what the plan was made for. Corrected positions may lie a fraction of a step
// outside.
bool suits(const State& state, const scene::Scene& scene, const Plan& plan, const Needs& needs) {
    const auto materials = static_cast<std::int32_t>(scene.materials.size());
    const auto near = [&](double x, double low, double high) {
        return x > low - needs.radius_min && x < high + needs.radius_min;
    };
    for (std::size_t i = 0; i < state.size(); ++i)
        if (state.material[i] < 0 || state.material[i] >= materials ||
            !(state.radius[i] >= needs.radius_min && state.radius[i] <= needs.radius_max) ||
            !near(state.value(i, 0, 0), plan.lower.x, plan.upper.x) ||
            !near(state.value(i, 1, 0), plan.lower.y, plan.upper.y))
            return false;
    return true;
}

} // namespace

std::string Simulation::serialise() const {
    ByteWriter w;
    w.put(step_);
    w.put(plan_.dt);
    w.put(static_cast<std::int32_t>(plan_.neighbours));
    w.put(static_cast<std::int32_t>(plan_.may_switch ? 1 : 0));
    w.put(removed_);
    w.put(delayed_);
    for (const double energy : {initial_energy_, added_energy_, wall_work_, wall_power_}) w.put(energy);
    w.put(static_cast<std::int32_t>(state_.order));
    w.put(static_cast<std::int32_t>(state_.dofs));
    for_columns(state_, [&](const auto& column) { w.put_array(column.data(), column.size()); });
    w.put(static_cast<std::uint64_t>(next_waiting_));
    w.put(static_cast<std::uint64_t>(waiting_.size()));
    for (const scene::GrainState& g : waiting_) {
        w.put(g.id);
        w.put(g.insert_at);
    }
    w.put(static_cast<std::uint64_t>(events_.size()));
    for (const std::string& event : events_) w.put_text(event);
    return w.bytes();
}

void Simulation::restore(const std::string& bytes) {
    const auto damaged = [] { fail(Exit::io, "its state does not belong to its scene"); };
    ByteReader r(bytes);
    step_ = r.get<std::int64_t>();
    if (step_ < 0 || step_ > std::int64_t{1} << 53) damaged();
    if (r.get<double>() != plan_.dt) damaged();
    const auto method = static_cast<scene::NeighbourMethod>(r.get<std::int32_t>());
    const bool may_switch = r.get<std::int32_t>() != 0;
    removed_ = r.get<std::int64_t>();
    delayed_ = r.get<std::int64_t>();
    for (double* energy : {&initial_energy_, &added_energy_, &wall_work_, &wall_power_})
        *energy = r.get<double>();
    if (r.get<std::int32_t>() != state_.order || r.get<std::int32_t>() != state_.dofs) damaged();
    for_columns(state_, [&](auto& column) { r.get_array(column); });
    state_.adopt(plan_);
    if (!suits(state_, scene_, plan_, needs_)) damaged();
    next_waiting_ = static_cast<std::size_t>(r.get<std::uint64_t>());
    if (r.get<std::uint64_t>() != waiting_.size() || next_waiting_ > waiting_.size()) damaged();
    std::map<std::int64_t, scene::GrainState> by_id;
    for (const scene::GrainState& g : waiting_) by_id.emplace(g.id, g);
    for (scene::GrainState& g : waiting_) {
        const auto found = by_id.find(r.get<std::int64_t>());
        if (found == by_id.end()) damaged();
        g = found->second;
        g.insert_at = r.get<double>();
        if (!(std::isfinite(g.insert_at) && g.insert_at >= 0)) damaged();
    }
    events_.clear();
    const auto events = r.get<std::uint64_t>();
    for (std::uint64_t n = 0; n < events; ++n) events_.push_back(r.get_text());
    if (!r.at_end()) damaged();
    if (method != plan_.neighbours) use_link_cells();
    if (method != plan_.neighbours) damaged();
    plan_.may_switch = may_switch;
    force_step_ = step_ + 1;
    sorted_ = true;
    state_.refresh_records(plan_.dt);
    walls_.invalidate();
    lists_.invalidate();
    bin();
}

} // namespace sandlane::md
