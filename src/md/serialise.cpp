// The complete state of a simulation as bytes. What follows from the scene alone is not stored.
#include "core/bytes.hpp"
#include "md/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sandlane::md {

namespace {

// What indexes memory, and what the plan was made for. Corrected positions may lie a fraction of a step
// outside.
bool suits(const State& state, std::size_t i, const scene::Scene& scene, const Plan& plan,
           const Needs& needs) {
    const double* record = state.record_of(i);
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(record, record + simd::record_fields, finite)) return false;
    for (int dof = 0; dof < state.dofs(); ++dof)
        for (int k = 2; k < state.order; ++k)
            if (!std::isfinite(state.value(i, dof, k))) return false;
    if (plan.orientation) {
        const Quaternion q = state.orientation_of(i);
        const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
        if (!(std::abs(square - 1) < 1e-12)) return false;
    }
    const auto near = [&](double x, double low, double high) {
        return x > low - needs.radius_min && x < high + needs.radius_min;
    };
    const Vec p = state.position(i), turn = state.turn(i);
    const double mass = state.mass[i], radius = state.radius(i);
    return near(p.x, plan.lower.x, plan.upper.x) && near(p.y, plan.lower.y, plan.upper.y) &&
           (plan.dimension == 2 || near(p.z, plan.lower.z, plan.upper.z)) && std::isfinite(norm(turn)) &&
           radius >= needs.radius_min && radius <= needs.radius_max && mass >= needs.mass_min &&
           mass <= needs.mass_max && state.inverse_radius(i) == 1.0 / radius &&
           state.inverse_mass[i] == 1.0 / mass && state.id[i] >= 0 &&
           static_cast<std::size_t>(state.id[i]) < needs.grains + needs.poured && state.material[i] >= 0 &&
           static_cast<std::size_t>(state.material[i]) < scene.materials.size();
}

} // namespace

void Simulation::serialise(ByteWriter& w) const {
    w.put(step_);
    w.put(plan_.tick);
    w.put(plan_.stride);
    w.put(static_cast<std::int32_t>(plan_.neighbours));
    w.put(removed_);
    w.put(delayed_);
    for (const double energy :
         {initial_energy_, added_energy_, wall_work_, wall_power_, shear_work_, shear_power_})
        w.put(energy);
    w.put_array(&balance_, 1);
    w.put(static_cast<std::int32_t>(state_.order));
    w.put(static_cast<std::int32_t>(state_.dofs()));
    w.put_array(state_.gear.data(), state_.gear.size());
    state_.for_columns(
        [&](const auto& column, std::size_t fields) { w.put_array(column.data(), state_.size() * fields); });
    w.put(static_cast<std::uint64_t>(next_waiting_));
    w.put(static_cast<std::uint64_t>(waiting_.size()));
    for (const scene::GrainState& g : waiting_) {
        w.put(g.id);
        w.put(g.insert_at);
    }
    w.put(static_cast<std::uint64_t>(events_.size()));
    for (const std::string& event : events_) w.put_text(event);
    if (plan_.memory > 0) {
        lists_.write_memory(state_, w);
        walls_.memory(state_).write(w);
    }
}

std::string Simulation::serialise() const {
    ByteWriter bytes;
    serialise(bytes);
    return std::move(bytes).bytes();
}

void Simulation::restore(std::string_view bytes) {
    const auto damaged = [] { fail(Exit::io, "its state does not belong to its scene"); };
    ByteReader r(bytes);
    step_ = r.get<std::int64_t>();
    if (step_ < 0 || step_ > std::int64_t{1} << 53) damaged();
    if (r.get<double>() != plan_.tick) damaged();
    plan_.stride = r.get<std::int64_t>();
    if (plan_.stride < plan_.least_stride || plan_.stride > plan_.largest_stride ||
        plan_.largest_stride % plan_.stride != 0 || step_ % plan_.stride != 0)
        damaged();
    plan_.dt = static_cast<double>(plan_.stride) * plan_.tick;
    const auto method = static_cast<scene::NeighbourMethod>(r.get<std::int32_t>());
    removed_ = r.get<std::int64_t>();
    delayed_ = r.get<std::int64_t>();
    for (double* energy :
         {&initial_energy_, &added_energy_, &wall_work_, &wall_power_, &shear_work_, &shear_power_})
        *energy = r.get<double>();
    std::vector<Balance> balance;
    r.get_array(balance);
    if (balance.size() != 1) damaged();
    if (r.get<std::int32_t>() != state_.order || r.get<std::int32_t>() != state_.dofs()) damaged();
    r.get_array(state_.gear);
    state_.for_columns([&](auto& column, std::size_t) { r.get_array(column); });
    state_.adopt();
    for (std::size_t i = 0; i < state_.size(); ++i)
        if (!suits(state_, i, scene_, plan_, needs_)) damaged();
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
    const auto grains = static_cast<std::int64_t>(needs_.grains + needs_.poured);
    const auto memory = [&] {
        const ContactMemory kind(plan_.memory, plan_.odd_memory);
        return plan_.memory > 0 ? ContactMemory::read(r, kind, grains) : kind;
    };
    lists_.adopt(memory());
    walls_.adopt(memory());
    if (!r.at_end()) damaged();
    if (is_lattice(plan_.neighbours) && method == scene::NeighbourMethod::link_cells) use_link_cells();
    if (method != plan_.neighbours) damaged();
    force_step_ = step_ + plan_.stride;
    sorted_ = true;
    if (lattice_.rows() > 0) lattice_.clear(state_); // the next prediction puts all grains on it
    if (balance.front().kind == balance_kind())
        balance_ = balance.front();
    else
        begin_balance(); // watched from now on
}

} // namespace sandlane::md
