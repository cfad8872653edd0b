// Grains that come and go while a run goes on: pours and factories, sinks, open sides of the domain.
#include "core/error.hpp"
#include "md/simulation.hpp"
#include "scene/population.hpp"
#include "scene/sized_grids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

constexpr std::int64_t retry = 100; // steps until a grain that found no room tries again
constexpr int tries = 20;           // places that a factory looks at in one attempt

} // namespace

// Grains that are there and those that have just come, for questions about room.
class Simulation::Room {
public:
    explicit Room(const Simulation& simulation)
        : simulation_(simulation), box_(simulation.box(simulation.time())),
          grids_(box_, simulation.state_.size() + simulation.waiting_.size() - simulation.next_waiting_,
                 [&](std::size_t i) { return radius(simulation, i); }) {
        for (std::size_t i = 0; i < simulation.state_.size(); ++i)
            add(simulation.state_.position(i), simulation.state_.radius(i));
    }

    void add(Vec position, double radius) { grids_.insert(position, radius); }

    [[nodiscard]] bool for_grain(Vec position, double radius) const {
        bool room = true;
        grids_.for_near(position, radius, [&](std::size_t i) {
            const Vec d = box_.separation(position, simulation_.state_.position(i));
            const double reach = simulation_.state_.radius(i) + radius;
            room = room && !(dot(d, d) < reach * reach);
        });
        if (!room) return false;
        simulation_.walls_.for_touching(position, radius,
                                        [&](std::size_t, const WallContact&) { room = false; });
        return room;
    }

    // Finds a place; a factory's grain looks at several.
    bool find_place(scene::GrainState& grain) const {
        if (grain.factory < 0) return for_grain(grain.position, grain.radius);
        for (int n = 0; n < tries; ++n) {
            const auto attempt = static_cast<std::uint64_t>(simulation_.step_ * tries + n);
            grain.position = scene::factory_place(simulation_.scene_, static_cast<std::size_t>(grain.factory),
                                                  grain.id, attempt);
            if (for_grain(grain.position, grain.radius)) return true;
        }
        return false;
    }

private:
    // Those that are there, then those that will come.
    static double radius(const Simulation& simulation, std::size_t i) {
        const std::size_t there = simulation.state_.size();
        return i < there ? simulation.state_.radius(i)
                         : simulation.waiting_[simulation.next_waiting_ + i - there].radius;
    }

    const Simulation& simulation_;
    scene::Box box_;
    scene::SizedGrids grids_;
};

void Simulation::insert_due() {
    const auto due = [&] {
        return next_waiting_ < waiting_.size() && insertion_step(waiting_[next_waiting_]) <= step_;
    };
    if (!due()) return;
    Room room(*this);
    bool inserted = false;
    while (due()) {
        scene::GrainState grain = waiting_[next_waiting_];
        if (!room.find_place(grain)) {
            ++delayed_;
            waiting_[next_waiting_].insert_at =
                static_cast<double>(step_ + retry * plan_.stride) * plan_.tick;
            const auto from = waiting_.begin() + static_cast<std::ptrdiff_t>(next_waiting_);
            std::stable_sort(from, waiting_.end(),
                             [](const auto& a, const auto& b) { return a.insert_at < b.insert_at; });
            continue;
        }
        state_.append(with_shear_flow(grain), plan_.dt);
        room.add(grain.position, grain.radius);
        const std::size_t i = state_.size() - 1;
        const std::vector<double> no_force(state_.force_stride());
        state_.set_accelerations(i, no_force.data(), motion_view(force_step_));
        added_energy_ += grain_energy(scene_, plan_, state_, i);
        balance_.mass += state_.mass[i];
        balance_.brought = balance_.brought + (state_.mass[i] / plan_.dt) * state_.shift(i);
        ++next_waiting_;
        inserted = true;
    }
    if (inserted) sort_by_place();
}

// ahead: of the time up to which gravity is booked its velocity stands, s.
void Simulation::take_out(std::size_t grain, double ahead) {
    added_energy_ -= grain_energy(scene_, plan_, state_, grain);
    const double mass = state_.mass[grain];
    balance_.mass -= mass;
    balance_.brought =
        balance_.brought - (mass / plan_.dt) * state_.shift(grain) + (mass * ahead) * linear_gravity(scene_);
    ++removed_;
}

void Simulation::keep(const std::vector<std::uint32_t>& kept) {
    walls_.invalidate(state_);
    lists_.invalidate(state_);
    state_.reorder(kept);
}

void Simulation::empty_sinks() {
    const auto sinks = [&](Vec p) {
        return std::any_of(scene_.sinks.begin(), scene_.sinks.end(), [&](const scene::Sink& s) {
            return time() >= s.start && p.x >= s.lower.x && p.x < s.upper.x && p.y >= s.lower.y &&
                   p.y < s.upper.y && (plan_.dimension == 2 || (p.z >= s.lower.z && p.z < s.upper.z));
        });
    };
    if (scene_.sinks.empty()) return;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < state_.size(); ++i)
        if (sinks(state_.position(i)))
            take_out(i, 0);
        else
            kept.push_back(static_cast<std::uint32_t>(i));
    if (kept.size() < state_.size()) keep(kept);
}

bool Simulation::is_inside(Vec p) const {
    const Vec low = plan_.lower, high = plan_.upper;
    return p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y &&
           (plan_.dimension == 2 || (p.z >= low.z && p.z < high.z));
}

// Grains whose predicted centre left an open side are removed and counted, or end the run.
void Simulation::handle_outside() {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < state_.size(); ++i) {
        const Vec p = state_.position(i);
        if (is_inside(p)) {
            kept.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        const std::string place = text_of(p);
        if (!std::isfinite(norm(p)) || !std::isfinite(norm(state_.shift(i))))
            fail(Exit::unstable,
                 "step {}, t = {:.6g} s: grain {} has position {}: the run is unstable; lower md.dt", step_,
                 time(), state_.id[i], place);
        if (scene_.domain.outside == scene::Outside::error)
            fail(Exit::unstable,
                 "step {}, t = {:.6g} s: grain {} left the domain at {}. Enlarge the domain, add walls, or "
                 "set domain.outside = \"remove\".",
                 step_, time(), state_.id[i], place);
        take_out(i, plan_.dt);
    }
    keep(kept);
    bin();
}

} // namespace sandlane::md
