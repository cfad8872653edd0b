// What one key cannot know alone: names that refer to each other, shapes that need certain keys, coefficients
// that the chosen laws read.
#include "core/error.hpp"
#include "scene/schema.hpp"
#include "scene/wall_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace sandlane::scene {

namespace {

struct Validator {
    const Scene& scene;
    const std::string& file;

    template <class... Args>
    [[noreturn]] void reject(fmt::format_string<Args...> format, Args&&... args) const {
        fail(Exit::invalid_input, "{}: {}", file, fmt::format(format, std::forward<Args>(args)...));
    }

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

    void check_domain() const {
        const Vec size = scene.domain.upper - scene.domain.lower;
        if (!(size.x > 0 && size.y > 0 && std::isfinite(size.x) && std::isfinite(size.y)))
            reject("domain: upper = [{}, {}] must lie above lower = [{}, {}] in both directions, at a finite "
                   "distance",
                   scene.domain.upper.x, scene.domain.upper.y, scene.domain.lower.x, scene.domain.lower.y);
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
            if (scene.md.tangential == TangentialLaw::cundall_strack && !(m.tangential_stiffness > 0))
                reject("materials[{}].tangential_stiffness: {} is out of range; md.tangential = "
                       "\"cundall-strack\" needs more than 0 N/m",
                       n, m.tangential_stiffness);
        }
        for (std::size_t n = 0; n < scene.pairs.size(); ++n) {
            material_exists(scene.pairs[n].first, fmt::format("pairs[{}]", n));
            material_exists(scene.pairs[n].second, fmt::format("pairs[{}]", n));
            if (scene.pairs[n].stiffness == 0 || scene.pairs[n].young == 0)
                reject("pairs[{}]: a stiffness of 0 is no contact law; allowed: above 0, or negative for the "
                       "mixing rule",
                       n);
        }
    }

    void check_grains(const Grains& g, const std::string& path) const {
        material_exists(g.material, path);
        const bool sized =
            g.kind == GrainKind::lattice || g.kind == GrainKind::random || g.kind == GrainKind::pour;
        if (sized && !(g.sizes.min > 0)) reject("{}.radius: is missing", path);
        if (g.kind == GrainKind::lattice && (g.spacing.x <= 0 || g.spacing.y <= 0) &&
            (g.counts[0] > 1 || g.counts[1] > 1))
            reject("{}.spacing: [{}, {}] must be above 0 in both directions", path, g.spacing.x, g.spacing.y);
        if (g.kind == GrainKind::pour && !(g.rate > 0))
            reject("{}.rate: {} must be above 0 grains per second", path, g.rate);
        if (g.kind == GrainKind::file && g.file.empty()) reject("{}.file: is missing", path);
        const bool in_region = g.kind == GrainKind::random || g.kind == GrainKind::pour;
        if (in_region && (g.upper.x < g.lower.x || g.upper.y < g.lower.y))
            reject("{}.upper: [{}, {}] must not lie below lower = [{}, {}]", path, g.upper.x, g.upper.y,
                   g.lower.x, g.lower.y);
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

    void check_wall(const Wall& w, const std::string& path) const {
        material_exists(w.material, path);
        switch (w.kind) {
        case WallKind::plane:
            need_points(w, path, 1);
            if (norm(w.normal) == 0)
                reject("{}.normal: is missing; a plane needs the direction of its free side", path);
            break;
        case WallKind::segment:
            if (w.points.size() != 2)
                reject("{}.points: has {} points; a segment has 2", path, w.points.size());
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
        case WallKind::cylinder:
        case WallKind::cone:
        case WallKind::mesh:
            break;
        }
        for (std::size_t n = 1; n < w.points.size(); ++n)
            if (w.kind != WallKind::plane && w.points[n] == w.points[n - 1])
                reject("{}.points: points {} and {} coincide", path, n - 1, n);
        if (w.motion.empty()) return;
        for (const Motion& m : scene.motions)
            if (m.name == w.motion) return;
        reject("{}.motion: \"{}\" is not the name of a [[motions]] table", path, w.motion);
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
        if (a.kind == AnalysisKind::flow) {
            if (whole)
                reject("{}.to: is the same as from = [{}, {}]; a line has two ends", path, a.from.x,
                       a.from.y);
            return;
        }
        if (!whole && (a.from.x == a.to.x || a.from.y == a.to.y))
            reject("{}.to: [{}, {}] and from = [{}, {}] span no area", path, a.to.x, a.to.y, a.from.x,
                   a.from.y);
        if (a.kind == AnalysisKind::pair_correlation) check_range(a, path, whole);
    }

    // Beyond it the number of pairs of an ideal gas is not known in closed form.
    void check_range(const AnalysisSpec& a, const std::string& path, bool whole) const {
        const Vec size = whole ? scene.domain.upper - scene.domain.lower : a.to - a.from;
        const double x = std::abs(size.x) * (whole && scene.domain.periodic[0] ? 0.5 : 1);
        const double y = std::abs(size.y) * (whole && scene.domain.periodic[1] ? 0.5 : 1);
        if (a.range > std::min(x, y))
            reject("{}.range: {} m is out of range; allowed: up to {} m, the shorter side, half of it if "
                   "periodic",
                   path, a.range, std::min(x, y));
    }
};

} // namespace

void validate(const Scene& scene, const std::string& file) {
    const Validator v{scene, file};
    v.check_domain();
    v.check_materials();
    for (std::size_t n = 0; n < scene.grains.size(); ++n)
        v.check_grains(scene.grains[n], fmt::format("grains[{}]", n));
    for (std::size_t n = 0; n < scene.walls.size(); ++n)
        v.check_wall(scene.walls[n], fmt::format("walls[{}]", n));
    for (std::size_t n = 0; n < scene.analyses.size(); ++n) {
        v.check_analysis_name(n, fmt::format("analysis[{}]", n));
        v.check_analysis(scene.analyses[n], fmt::format("analysis[{}]", n));
    }
    for (std::size_t n = 0; n < scene.motions.size(); ++n)
        for (std::size_t other = 0; other < n; ++other)
            if (scene.motions[other].name == scene.motions[n].name)
                v.reject("motions[{}].name: \"{}\" is used twice", n, scene.motions[n].name);
}

} // namespace sandlane::scene
