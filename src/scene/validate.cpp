// What one key of a scene of grains cannot know alone: names that refer to each other, shapes that need
// certain keys, coefficients that the chosen laws read.
#include "scene/schema.hpp"
#include "scene/space.hpp"
#include "scene/validator.hpp"
#include "scene/wall_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace sandlane::scene {

namespace {

bool is_positive(double x) {
    return x > 0;
}

struct GrainValidator : Validator {
    const std::int64_t dimension = scene.domain.dimension;
    const bool spatial = dimension == 3;

    [[nodiscard]] std::string names() const {
        std::string all;
        for (const Material& m : scene.materials)
            all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", m.name);
        return all;
    }

    void material_exists(const std::string& name, const std::string& path) const {
        if (name.empty() && scene.materials.size() == 1) return;
        for (const Material& m : scene.materials)
            if (m.name == name) return;
        if (name.empty()) reject("{}.material: is missing; there are several materials: {}", path, names());
        reject("{}.material: \"{}\" is not a material; known: {}", path, name, names());
    }

    // "1, 2" or "1, 2, 3".
    [[nodiscard]] std::string text(Vec v) const { return components(v, dimension); }

    template <class Condition> [[nodiscard]] bool all_components(Vec v, const Condition& condition) const {
        return std::ranges::all_of(axes(dimension),
                                   [&](const AxisOfSpace& axis) { return condition(v.*axis.component); });
    }

    void check_sheared_cell() const {
        check_shear();
        if (scene.domain.shear_rate == 0) return;
        const NeighbourMethod m = scene.md.neighbours;
        if (m != NeighbourMethod::automatic && m != NeighbourMethod::verlet)
            reject("md.neighbours: \"{}\" cannot follow domain.shear_rate; use \"auto\" or \"verlet\"",
                   neighbour_choices()[static_cast<std::size_t>(m)]);
        for (std::size_t n = 0; n < scene.walls.size(); ++n)
            reject("walls[{}]: a cell with domain.shear_rate has no walls", n);
    }

    // Choices that mean something in the plane only.
    void check_method() const {
        if (!spatial) return;
        if (scene.md.body == Body::disc)
            reject("md.body: \"disc\" is no body of a three-dimensional scene; use \"sphere\"");
        if (scene.md.inertia == Inertia::disc)
            reject("md.inertia: \"disc\" belongs to two-dimensional scenes; use \"sphere\"");
        const NeighbourMethod neighbours = scene.md.neighbours;
        if (neighbours == NeighbourMethod::lattice || neighbours == NeighbourMethod::lattice_half)
            reject("md.neighbours: \"{}\" is for two-dimensional scenes; use \"auto\", \"verlet\" or "
                   "\"link-cells\"",
                   neighbour_choices()[static_cast<std::size_t>(neighbours)]);
        if (scene.md.tangential == TangentialLaw::walton_braun)
            reject("md.tangential: \"walton-braun\" is a law of two-dimensional scenes; use "
                   "\"cundall-strack\" or \"haff-werner\"");
        if (std::ranges::count(scene.output.trajectory, Trajectory::book) > 0)
            reject(
                "output.trajectory: \"book\" is a format of two-dimensional scenes; use \"dump\", \"xyz\" or "
                "\"vtp\"");
    }

    void check_materials() const {
        if (scene.materials.empty()) reject("materials: at least one [[materials]] table is needed");
        for (std::size_t n = 0; n < scene.materials.size(); ++n) {
            const Material& m = scene.materials[n];
            for (std::size_t other = 0; other < n; ++other)
                if (scene.materials[other].name == m.name)
                    reject("materials[{}].name: \"{}\" is used twice", n, m.name);
#define NORMAL(type, choice, name, key)                                                                      \
    if (scene.md.normal == NormalLaw::choice && !(m.key > 0))                                                \
        reject("materials[{}]." #key ": {} is out of range; md.normal = \"" name "\" needs more than 0", n,  \
               m.key);
#include "laws/laws.def"
            if (has_springs() && !(m.tangential_stiffness > 0))
                reject("materials[{}].tangential_stiffness: {} is out of range; md.tangential = "
                       "\"{}\" needs more than 0 N/m",
                       n, m.tangential_stiffness,
                       tangential_choices()[static_cast<std::size_t>(scene.md.tangential)]);
            if (scene.md.normal == NormalLaw::walton_braun && !(m.unloading_stiffness >= m.stiffness))
                reject("materials[{}].unloading_stiffness: {} is out of range; md.normal = \"walton-braun\" "
                       "needs {} (stiffness) or more",
                       n, m.unloading_stiffness, m.stiffness);
            check_cohesion(m.cohesion, fmt::format("materials[{}]", n));
            check_rolling(m, n);
        }
        for (std::size_t n = 0; n < scene.pairs.size(); ++n)
            check_pair(scene.pairs[n], fmt::format("pairs[{}]", n));
    }

    [[nodiscard]] bool has_springs() const {
        return scene.md.tangential == TangentialLaw::cundall_strack ||
               scene.md.tangential == TangentialLaw::walton_braun;
    }

    void check_pair(const MaterialPair& pair, const std::string& path) const {
        material_exists(pair.first, path);
        material_exists(pair.second, path);
        if (pair.stiffness == 0 || pair.young == 0 || (has_springs() && pair.tangential_stiffness == 0))
            reject(
                "{}: a stiffness of 0 is no contact law; allowed: above 0, or negative for the mixing rule",
                path);
        check_cohesion(pair.cohesion, path);
        check_rolling_spring(pair.rolling_stiffness, path);
        const bool overrides = pair.stiffness > 0 || pair.unloading_stiffness >= 0;
        if (scene.md.normal == NormalLaw::walton_braun && overrides &&
            !(pair.stiffness > 0 && pair.unloading_stiffness >= pair.stiffness))
            reject(
                "{}: stiffness = {} and unloading_stiffness = {}; md.normal = \"walton-braun\" needs both or "
                "neither, and unloading_stiffness not below stiffness",
                path, pair.stiffness, pair.unloading_stiffness);
    }

    void check_cohesion(double cohesion, const std::string& path) const {
        if (cohesion > 0 && scene.md.normal != NormalLaw::cohesive_viscoelastic)
            reject(
                "{}.cohesion: {} Pa has no effect with md.normal = \"{}\"; choose \"cohesive-viscoelastic\", "
                "or leave it out",
                path, cohesion, normal_choices()[static_cast<std::size_t>(scene.md.normal)]);
    }

    void check_rolling_spring(double stiffness, const std::string& path) const {
        if (stiffness > 0 && !has_springs())
            reject("{}.rolling_stiffness: {} needs friction with a spring, too, else the grains creep: "
                   "md.tangential = \"cundall-strack\" or \"walton-braun\"; or leave it out",
                   path, stiffness);
    }

    void check_rolling(const Material& m, std::size_t n) const {
        if ((m.rolling_friction > 0) != (m.rolling_damping > 0 || m.rolling_stiffness > 0))
            reject("materials[{}]: rolling friction needs rolling_friction ({}) above 0, and rolling_damping "
                   "({}) or rolling_stiffness ({})",
                   n, m.rolling_friction, m.rolling_damping, m.rolling_stiffness);
        check_rolling_spring(m.rolling_stiffness, fmt::format("materials[{}]", n));
        if (m.rolling_friction > 0 && scene.md.tangential == TangentialLaw::none)
            reject("materials[{}].rolling_friction: {} has no effect with md.tangential = \"none\"; choose "
                   "\"haff-werner\" or \"cundall-strack\", or leave it out",
                   n, m.rolling_friction);
    }

    static bool comes_later(const Grains& g) {
        return g.kind == GrainKind::pour || g.kind == GrainKind::factory;
    }

    void check_sinks() const {
        for (std::size_t n = 0; n < scene.sinks.size(); ++n) {
            const Sink& s = scene.sinks[n];
            if (!all_components(s.upper - s.lower, is_positive))
                reject("sinks[{}].upper: [{}] must lie above lower = [{}]", n, text(s.upper), text(s.lower));
        }
    }

    void check_grains(const Grains& g, const std::string& path) const {
        material_exists(g.material, path);
        const bool sized = g.kind == GrainKind::lattice || g.kind == GrainKind::random || comes_later(g);
        if (sized && !(g.sizes.min > 0)) reject("{}.radius: is missing", path);
        const bool several = std::ranges::any_of(g.counts, [](std::int64_t n) { return n > 1; });
        if (g.kind == GrainKind::lattice && several && !all_components(g.spacing, is_positive))
            reject("{}.spacing: [{}] must be above 0 in {} directions", path, text(g.spacing),
                   spatial ? "all" : "both");
        if (comes_later(g) && !(g.rate > 0))
            reject("{}.rate: {} must be above 0 grains per second", path, g.rate);
        if (g.kind == GrainKind::file && g.file.empty()) reject("{}.file: is missing", path);
        const bool in_region = g.kind == GrainKind::random || comes_later(g);
        if (in_region && !all_components(g.upper - g.lower, [](double length) { return length >= 0; }))
            reject("{}.upper: [{}] must not lie below lower = [{}]", path, text(g.upper), text(g.lower));
    }

    void need_points(const Wall& w, const std::string& path, std::size_t least) const {
        if (w.points.size() < least)
            reject("{}.points: has {} points; kind needs {} or more", path, w.points.size(), least);
    }

    void need_radius(const Wall& w, const std::string& path) const {
        if (!(w.radius > 0)) reject("{}.radius: {} must be above 0 m", path, w.radius);
    }

    void need_angles(const Wall& w, const std::string& path) const {
        if (!(w.angle_to > w.angle_from))
            reject("{}.angle_to: {} must be above angle_from = {} rad", path, w.angle_to, w.angle_from);
    }

    void check_wall_grains(const Wall& w, const std::string& path) const {
        need_radius(w, path);
        if (w.ring_radius > 0)
            need_angles(w, path);
        else
            need_points(w, path, 1);
        const double most = 1e7, count = wall_grain_count(w);
        if (!(count <= most))
            reject("{}.spacing: {} m makes {:.3g} wall grains; allowed: up to {:.0e}. Increase spacing or "
                   "radius.",
                   path, w.spacing > 0 ? w.spacing : 2 * w.radius, count, most);
    }

    void need_two_points(const Wall& w, const std::string& path, const char* what) const {
        if (w.points.size() != 2) reject("{}.points: has {} points; {} has 2", path, w.points.size(), what);
    }

    void check_plane(const Wall& w, const std::string& path) const {
        need_points(w, path, 1);
        if (norm(w.normal) == 0)
            reject("{}.normal: is missing; a plane needs the direction of its free side", path);
    }

    void check_box(const Wall& w, const std::string& path) const {
        need_two_points(w, path, "a box");
        if (!all_components(w.points[1] - w.points[0], [](double length) { return length != 0; }))
            reject("{}.points: [{}] and [{}] span no volume; give two opposite corners of the box", path,
                   text(w.points[0]), text(w.points[1]));
    }

    void check_cone(const Wall& w, const std::string& path) const {
        need_two_points(w, path, "the axis of a cone");
        if (!(w.radius > 0 || w.radius_to > 0))
            reject("{}.radius: {} and radius_to: {} m; one of them must be above 0", path, w.radius,
                   w.radius_to);
    }

    // Kinds that the other dimension does not have.
    void check_kind(const Wall& w, const std::string& path) const {
        const bool both = w.kind == WallKind::plane, is_spatial = w.kind >= WallKind::box;
        if (!both && is_spatial != spatial)
            reject("{}.kind: \"{}\" is for {}-dimensional scenes; allowed here: {}", path,
                   wall_choices()[static_cast<std::size_t>(w.kind)], is_spatial ? "three" : "two",
                   spatial ? "\"plane\", \"box\", \"cylinder\", \"cone\", \"mesh\""
                           : "\"plane\", \"segment\", \"polyline\", \"arc\", \"grains\"");
    }

    void check_wall(const Wall& w, const std::string& path) const {
        material_exists(w.material, path);
        check_kind(w, path);
        switch (w.kind) {
        case WallKind::plane:
            check_plane(w, path);
            break;
        case WallKind::segment:
            need_two_points(w, path, "a segment");
            break;
        case WallKind::polyline:
            need_points(w, path, 2);
            break;
        case WallKind::arc:
            need_radius(w, path);
            need_angles(w, path);
            break;
        case WallKind::grains:
            if (w.items.empty()) check_wall_grains(w, path);
            break;
        case WallKind::box:
            check_box(w, path);
            break;
        case WallKind::cylinder:
            need_two_points(w, path, "the axis of a cylinder");
            need_radius(w, path);
            break;
        case WallKind::cone:
            check_cone(w, path);
            break;
        case WallKind::mesh:
            if (w.file.empty()) reject("{}.file: is missing; a mesh needs an STL file", path);
            break;
        }
        for (std::size_t n = 1; n < w.points.size(); ++n)
            if (w.kind != WallKind::plane && w.points[n] == w.points[n - 1])
                reject("{}.points: points {} and {} coincide", path, n - 1, n);
        motion_exists(w, path);
    }

    void motion_exists(const Wall& w, const std::string& path) const {
        if (w.motion.empty()) return;
        for (const Motion& m : scene.motions)
            if (m.name == w.motion) return;
        reject("{}.motion: \"{}\" is not the name of a [[motions]] table", path, w.motion);
    }

    void check_motion(std::size_t n) const {
        const Motion& m = scene.motions[n];
        for (std::size_t other = 0; other < n; ++other)
            if (scene.motions[other].name == m.name)
                reject("motions[{}].name: \"{}\" is used twice", n, m.name);
        const bool turns = m.kind == MotionKind::rotate || m.kind == MotionKind::planetary;
        if (turns && norm(m.axis) == 0)
            reject("motions[{}].axis: [{}] is no direction; give for example [0, 0, 1]", n, text(m.axis));
    }

    // The name becomes that of a file.
    void check_analysis_name(std::size_t n, const std::string& path) const {
        const std::string& name = scene.analyses[n].name;
        for (std::size_t other = 0; other < n; ++other)
            if (scene.analyses[other].name == name) reject("{}.name: \"{}\" is used twice", path, name);
        const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
            return std::isalnum(c) != 0 || c == '_' || c == '-';
        });
        if (name.empty() || !plain || name.size() > 100)
            reject("{}.name: \"{}\" cannot name a file; use up to 100 letters, digits, - and _", path, name);
        if (name == "log") reject("{}.name: \"log\" is the name of another output", path);
    }

    void check_analysis(const AnalysisSpec& a, const std::string& path) const {
        const bool whole = a.from == a.to;
        if (a.axis == Axis::z && !spatial)
            reject("{}.axis: \"z\" is for three-dimensional scenes; allowed here: \"x\", \"y\"", path);
        if (a.kind == AnalysisKind::flow) {
            check_flow(a, path);
            return;
        }
        if (!whole && flat_directions(a) > 0)
            reject("{}.to: [{}] and from = [{}] span no {}", path, text(a.to), text(a.from),
                   spatial ? "volume" : "area");
        if (a.kind == AnalysisKind::pair_correlation) check_range(a, path, whole);
    }

    [[nodiscard]] std::int64_t flat_directions(const AnalysisSpec& a) const {
        return std::ranges::count_if(axes(dimension), [&](const AxisOfSpace& axis) {
            return a.from.*axis.component == a.to.*axis.component;
        });
    }

    void check_flow(const AnalysisSpec& a, const std::string& path) const {
        if (!spatial && a.from == a.to)
            reject("{}.to: is the same as from = [{}]; a line has two ends", path, text(a.from));
        if (spatial && flat_directions(a) != 1)
            reject(
                "{}.to: [{}] and from = [{}] are no opposite corners of a rectangle across an axis; exactly "
                "one coordinate must be the same in both",
                path, text(a.to), text(a.from));
    }

    // Beyond it the number of pairs of an ideal gas is not known in closed form.
    void check_range(const AnalysisSpec& a, const std::string& path, bool whole) const {
        const Vec size = whole ? scene.domain.upper - scene.domain.lower : a.to - a.from;
        double most = std::numeric_limits<double>::infinity();
        for (const auto& [name, component, index] : axes(dimension))
            most =
                std::min(most, std::abs(size.*component) * (whole && scene.domain.periodic[index] ? 0.5 : 1));
        if (a.range > most)
            reject("{}.range: {} m is out of range; allowed: up to {} m, the shorte{} side, half of it if "
                   "periodic",
                   path, a.range, most, spatial ? "st" : "r");
    }
};

} // namespace

void validate_md(const Scene& scene, const std::string& file) {
    const GrainValidator v{{scene, file}};
    v.check_domain();
    v.check_method();
    v.check_sheared_cell();
    check_accuracy(scene, file);
    check_watch(scene, file);
    v.check_materials();
    v.check_sinks();
    for (std::size_t n = 0; n < scene.grains.size(); ++n)
        v.check_grains(scene.grains[n], fmt::format("grains[{}]", n));
    for (std::size_t n = 0; n < scene.walls.size(); ++n)
        v.check_wall(scene.walls[n], fmt::format("walls[{}]", n));
    for (std::size_t n = 0; n < scene.analyses.size(); ++n) {
        v.check_analysis_name(n, fmt::format("analysis[{}]", n));
        v.check_analysis(scene.analyses[n], fmt::format("analysis[{}]", n));
    }
    for (std::size_t n = 0; n < scene.motions.size(); ++n) v.check_motion(n);
}

void validate(const Scene& scene, const std::string& file) {
    switch (scene.method) {
#define ENGINE(choice, name, what)                                                                           \
    case Engine::choice:                                                                                     \
        validate_##choice(scene, file);                                                                      \
        break;
#include "scene/engines.def"
    }
}

} // namespace sandlane::scene
