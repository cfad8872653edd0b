#include "scene/initial_state.hpp"

#include "core/error.hpp"
#include "core/memory.hpp"
#include "scene/population.hpp"
#include "scene/sized_grids.hpp"
#include "scene/space.hpp"
#include "scene/standing_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::scene {

namespace {

constexpr double legal_overlap = 0.05; // of the smaller radius (docs/physics.md 12)

class Checker {
public:
    Checker(const Scene& scene, const StandingWalls& walls, const std::vector<GrainState>& grains,
            const std::vector<std::size_t>& from)
        : scene_(scene), walls_(walls), grains_(grains), population_(from), box_(scene.domain) {
        for (const GrainState& g : grains) largest_ = std::max(largest_, g.radius);
    }

    // One grain, before others are placed around it.
    void check_one(const GrainState& g) const {
        check_place(g);
        const bool finite = is_finite(g.velocity) && is_finite(g.angular_velocity) &&
                            std::isfinite(g.angle) && std::isfinite(g.omega) && std::isfinite(g.radius);
        if (!finite || !std::isnormal(g.mass) || g.insert_at == std::numeric_limits<double>::infinity())
            fail(Exit::invalid_input,
                 "{}: velocity ({}) m/s, spin {} rad/s, mass {} kg, time {} s: beyond the range of numbers",
                 name(g), text(g.velocity), spin(g), g.mass, g.insert_at);
    }

    void check() const {
        check_periods();
        check_overlaps();
        check_walls();
    }

private:
    [[nodiscard]] static bool is_finite(Vec v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    }
    [[nodiscard]] std::string text(Vec v) const { return components(v, box_.dimension); }
    [[nodiscard]] std::string spin(const GrainState& g) const {
        return box_.dimension == 3 ? fmt::format("({})", text(g.angular_velocity))
                                   : fmt::format("{}", g.omega);
    }
    [[nodiscard]] std::string name(const GrainState& g) const {
        const auto id = static_cast<std::size_t>(g.id);
        return fmt::format("grain {} ({})", g.id, population_name(scene_, population_[id]));
    }

    // With a shorter period a grain could touch two images of another.
    void check_periods() const {
        for (const auto& [axis, component, index] : axes(box_.dimension)) {
            const double period = box_.size().*component;
            if (box_.periodic[index] && period < 4 * largest_)
                fail(Exit::invalid_input,
                     "domain.periodic: the period of {} m along {} is too short for the largest radius {} m; "
                     "allowed: {} m or more (two diameters). Enlarge domain.upper.",
                     period, axis, largest_, 4 * largest_);
        }
    }

    void check_place(const GrainState& g) const {
        bool inside = true;
        for (const AxisOfSpace& axis : axes(box_.dimension)) {
            const double Vec::*x = axis.component;
            inside = inside && g.position.*x >= box_.lower.*x && g.position.*x < box_.upper.*x;
        }
        if (!inside)
            fail(Exit::invalid_input,
                 "{}: its centre ({}) m lies outside the domain; allowed: {} m. Move it or enlarge the "
                 "domain.",
                 name(g), text(g.position), intervals());
    }

    // "[0, 1) x [0, 2)".
    [[nodiscard]] std::string intervals() const {
        std::string all;
        for (const auto& [axis, component, index] : axes(box_.dimension))
            all += fmt::format("{}[{}, {})", all.empty() ? "" : " x ", box_.lower.*component,
                               box_.upper.*component);
        return all;
    }

    void check_overlaps() const {
        std::vector<std::size_t> present; // poured ones are checked when they are inserted
        for (std::size_t i = 0; i < grains_.size(); ++i)
            if (!std::isfinite(grains_[i].insert_at)) present.push_back(i);
        SizedGrids grids(box_, present.size(), [&](std::size_t n) { return grains_[present[n]].radius; });
        double worst = legal_overlap;
        std::size_t first = 0, second = 0, count = 0;
        for (std::size_t n = 0; n < present.size(); ++n) {
            const GrainState& g = grains_[present[n]];
            grids.for_near(g.position, g.radius, [&](std::size_t m) {
                const GrainState& other = grains_[present[m]];
                const double distance = norm(box_.separation(g.position, other.position));
                const double overlap = g.radius + other.radius - distance;
                const double ratio = overlap / std::min(g.radius, other.radius);
                if (ratio <= legal_overlap) return;
                ++count;
                if (ratio <= worst) return;
                worst = ratio;
                first = present[m];
                second = present[n];
            });
            grids.insert(g.position, g.radius);
        }
        if (count > 0) refuse_overlap(grains_[first], grains_[second], worst, count);
    }

    [[noreturn]] void refuse_overlap(const GrainState& a, const GrainState& b, double ratio,
                                     std::size_t count) const {
        const double distance = norm(box_.separation(a.position, b.position));
        const std::string more = count > 1 ? fmt::format(" ({} pairs overlap too much)", count) : "";
        if (distance == 0)
            fail(Exit::invalid_input, "{} and {} have the same centre ({}) m{}. Move one of them.", name(a),
                 name(b), text(a.position), more);
        fail(Exit::invalid_input,
             "{} and {} overlap by {:.4g} m, {:.3g} % of the smaller radius; allowed: up to {:.3g} %{}. "
             "Increase their distance or reduce the radii.",
             name(a), name(b), a.radius + b.radius - distance, 100 * ratio, 100 * legal_overlap, more);
    }

    void check_walls() const {
        for (const GrainState& g : grains_) {
            if (std::isfinite(g.insert_at)) continue;
            const double allowed = (1 - legal_overlap) * g.radius;
            walls_.for_near(g.position, allowed, [&](std::size_t piece) {
                refuse_wall(g, walls_.gap(piece, g.position).distance, walls_.wall(piece), allowed);
            });
        }
    }

    [[noreturn]] void refuse_wall(const GrainState& g, double distance, int wall, double allowed) const {
        const std::string& label = scene_.walls[static_cast<std::size_t>(wall)].name;
        fail(Exit::invalid_input,
             "{}: its centre ({}) m is {:.4g} m from the surface of walls[{}]{}; allowed: {:.4g} m or more "
             "(95 % of its radius {} m). Move the grain or the wall.",
             name(g), text(g.position), distance, wall, label.empty() ? "" : fmt::format(" \"{}\"", label),
             allowed, g.radius);
    }

    const Scene& scene_;
    const StandingWalls& walls_;
    const std::vector<GrainState>& grains_;
    const std::vector<std::size_t>& population_; // of each grain
    Box box_;
    double largest_ = 0;
};

// Before anything is allocated. Engines number grains with 32 bits.
void check_number(const Scene& scene) {
    const double most = std::numeric_limits<std::int32_t>::max();
    double total = 0;
    for (std::size_t p = 0; p < scene.grains.size(); ++p) {
        const double count = expected_grains(scene, p);
        total += count;
        if (!(total <= most))
            fail(Exit::invalid_input,
                 "{}: {:.4g} grains; allowed: up to {} in all populations together. Lower counts, count or "
                 "packing_fraction.",
                 population_name(scene, p), count, most);
    }
    require_memory(2 * total * sizeof(GrainState),
                   fmt::format("grains: the start state of {:.4g} grains", total));
}

} // namespace

double grain_mass(const Scene& scene, const Grains& population, int material, double radius) {
    const double density = population.density > 0
                               ? population.density
                               : scene.materials.at(static_cast<std::size_t>(material)).density;
    const double disc = std::numbers::pi * radius * radius * density;
    return scene.md.body == Body::disc ? disc : 4.0 / 3.0 * radius * disc;
}

std::vector<GrainState> initial_grains(const Scene& scene) {
    check_number(scene);
    const StandingWalls walls(scene);
    std::vector<GrainState> grains;
    std::vector<std::size_t> from;
    for (std::size_t p = 0; p < scene.grains.size(); ++p) {
        const std::size_t first = grains.size();
        for (GrainState& g : population(scene, p, grains, walls)) {
            g.id = static_cast<std::int64_t>(grains.size());
            grains.push_back(g);
            from.push_back(p);
        }
        const Checker checker(scene, walls, grains, from);
        for (std::size_t i = first; i < grains.size(); ++i) checker.check_one(grains[i]);
    }
    if (!grains.empty()) Checker(scene, walls, grains, from).check();
    return grains;
}

} // namespace sandlane::scene
