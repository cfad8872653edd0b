#include "scene/population.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/rng.hpp"
#include "scene/lookup.hpp"
#include "scene/packing.hpp"
#include "scene/radius_law.hpp"
#include "scene/space.hpp"

#include <cmath>

namespace sandlane::scene {

namespace {

struct Region {
    Vec lower, upper;

    [[nodiscard]] Vec size() const { return upper - lower; }
};

Region region(const Scene& scene, const Grains& grains) {
    if (grains.lower == grains.upper) return {scene.domain.lower, scene.domain.upper};
    return {grains.lower, grains.upper};
}

class Maker {
public:
    Maker(const Scene& scene, std::size_t index)
        : scene_(scene), grains_(scene.grains[index]), index_(static_cast<std::uint32_t>(index)),
          name_(population_name(scene, index)), dimension_(scene.domain.dimension),
          region_(region(scene, grains_)) {
        prototype_.material = material_index(scene, grains_.material);
        prototype_.omega = grains_.omega;
        prototype_.angular_velocity = grains_.angular_velocity;
    }

    std::vector<GrainState> make(const std::vector<GrainState>& placed, const StandingWalls& walls) const {
        std::vector<GrainState> grains;
        switch (grains_.kind) {
        case GrainKind::lattice:
            grains = lattice();
            break;
        case GrainKind::random:
            grains = random(placed, walls);
            break;
        case GrainKind::pour:
        case GrainKind::factory:
            grains = pour();
            break;
        case GrainKind::list:
            grains = list();
            break;
        case GrainKind::file:
            grains = file();
            break;
        }
        for (GrainState& g : grains)
            if (g.mass == 0) g.mass = grain_mass(scene_, grains_, g.material, g.radius);
        add_velocities(grains);
        return grains;
    }

private:
    [[nodiscard]] Random stream(Stream use) const {
        return {static_cast<std::uint64_t>(scene_.seed), use, index_};
    }
    [[nodiscard]] double radius(std::size_t i) const {
        return radius_of(grains_.sizes, stream(Stream::radius).uniform(i));
    }
    [[nodiscard]] GrainState grain(Vec position, double r) const {
        GrainState g = prototype_;
        g.position = position;
        g.radius = r;
        return g;
    }

    [[nodiscard]] std::vector<GrainState> lattice() const {
        const Box box(scene_.domain);
        const Random displacement = stream(Stream::jitter);
        const std::int64_t columns = grains_.counts[0], rows = grains_.counts[1], layers = grains_.counts[2];
        std::vector<GrainState> grains;
        for (std::int64_t layer = 0; layer < layers; ++layer)
            for (std::int64_t row = 0; row < rows; ++row)
                for (std::int64_t column = 0; column < columns; ++column) {
                    const std::size_t n = grains.size();
                    const Vec at =
                        site(column, row, layer) + uniform_shift(displacement, n, grains_.jitter, dimension_);
                    grains.push_back(
                        grain(box.wrapped(grains_.lower + scaled(at, grains_.spacing)), radius(n)));
                }
        return grains;
    }

    // In units of the spacing.
    [[nodiscard]] Vec site(std::int64_t column, std::int64_t row, std::int64_t layer) const {
        const double across = grains_.staggered && layer % 2 != 0 ? 0.5 : 0;
        const double along = grains_.triangular && row % 2 != 0 ? 0.5 : across;
        return {static_cast<double>(column) + along, static_cast<double>(row) + across,
                static_cast<double>(layer)};
    }

    [[nodiscard]] std::vector<GrainState> random(const std::vector<GrainState>& placed,
                                                 const StandingWalls& walls) const {
        PackingTask task{name_, Box(scene_.domain),      region_.lower, region_.upper, random_radii(), {},
                         walls, stream(Stream::position)};
        for (const GrainState& g : placed)
            if (!std::isfinite(g.insert_at)) task.fixed.push_back({g.position, g.radius});
        const std::vector<Vec> centres = pack(task);
        std::vector<GrainState> grains;
        for (std::size_t i = 0; i < centres.size(); ++i) grains.push_back(grain(centres[i], task.radii[i]));
        return grains;
    }

    // `count` radii, or as many as come closest to the packing fraction.
    [[nodiscard]] std::vector<double> random_radii() const {
        const double wanted = grains_.packing_fraction * content(region_.size(), dimension_);
        std::vector<double> radii;
        double filled = 0;
        for (std::size_t i = 0;; ++i) {
            const double r = radius(i), next = grain_content(r, dimension_);
            if (grains_.count > 0 ? static_cast<std::int64_t>(i) >= grains_.count
                                  : filled + 0.5 * next > wanted)
                return radii;
            radii.push_back(r);
            filled += next;
        }
    }

    // Whether a grain finds room is known only when its time has come.
    [[nodiscard]] std::vector<GrainState> pour() const {
        const Random place = stream(Stream::pour);
        std::vector<GrainState> grains;
        for (std::int64_t n = 0; n < grains_.count; ++n) {
            const Vec u = uniform_point(place, static_cast<std::uint64_t>(n), dimension_);
            grains.push_back(grain(region_.lower + scaled(u, region_.size()), radius(grains.size())));
            grains.back().insert_at = grains_.start + static_cast<double>(n) / grains_.rate;
            if (grains_.kind == GrainKind::factory) grains.back().factory = static_cast<int>(index_);
        }
        return grains;
    }

    [[nodiscard]] std::vector<GrainState> list() const {
        std::vector<GrainState> grains;
        for (const GrainItem& item : grains_.items) {
            grains.push_back(grain(item.position, item.radius));
            grains.back().velocity = item.velocity;
            grains.back().angle = item.angle;
            grains.back().omega += item.omega;
            grains.back().angular_velocity = grains.back().angular_velocity + item.angular_velocity;
            grains.back().mass = item.mass;
        }
        return grains;
    }

    [[nodiscard]] std::vector<GrainState> file() const {
        std::vector<GrainState> grains =
            parse_grains(read_file(grains_.file), grains_.file, scene_, grains_, prototype_);
        for (std::size_t i = 0; i < grains.size(); ++i)
            if (grains[i].radius == 0) grains[i].radius = radius(i);
        return grains;
    }

    // The common velocity, and thermal parts whose sum is zero.
    void add_velocities(std::vector<GrainState>& grains) const {
        Vec mean;
        if (grains_.thermal_speed > 0 && grains.size() > 1) {
            const Random thermal = stream(Stream::velocity);
            for (std::size_t i = 0; i < grains.size(); ++i) {
                const Vec part = grains_.thermal_speed * normal_vector(thermal, i, dimension_);
                grains[i].velocity = grains[i].velocity + part;
                mean = mean + (1 / static_cast<double>(grains.size())) * part;
            }
        }
        for (GrainState& g : grains) g.velocity = g.velocity + grains_.velocity - mean;
    }

    const Scene& scene_;
    const Grains& grains_;
    std::uint32_t index_;
    std::string name_;
    std::int64_t dimension_;
    Region region_;
    GrainState prototype_;
};

} // namespace

double expected_grains(const Scene& scene, std::size_t index) {
    const Grains& g = scene.grains[index];
    const std::int64_t dimension = scene.domain.dimension;
    switch (g.kind) {
    case GrainKind::lattice:
        return static_cast<double>(g.counts[0]) * static_cast<double>(g.counts[1]) *
               static_cast<double>(g.counts[2]);
    case GrainKind::random:
        if (g.count == 0)
            return g.packing_fraction * content(region(scene, g).size(), dimension) /
                   grain_content(std::sqrt(g.sizes.min * g.sizes.max), dimension);
        return static_cast<double>(g.count);
    case GrainKind::pour:
    case GrainKind::factory:
        return static_cast<double>(g.count);
    case GrainKind::list:
        return static_cast<double>(g.items.size());
    case GrainKind::file:
        return 0;
    }
    return 0;
}

Vec factory_place(const Scene& scene, std::size_t index, std::int64_t id, std::uint64_t attempt) {
    const Region where = region(scene, scene.grains[index]);
    const Random place(static_cast<std::uint64_t>(scene.seed), Stream::factory,
                       static_cast<std::uint32_t>(id));
    return where.lower + scaled(uniform_point(place, attempt, scene.domain.dimension), where.size());
}

std::string population_name(const Scene& scene, std::size_t index) {
    const std::string& name = scene.grains[index].name;
    return name.empty() ? fmt::format("grains[{}]", index) : fmt::format("grains[{}] \"{}\"", index, name);
}

std::vector<GrainState> population(const Scene& scene, std::size_t index,
                                   const std::vector<GrainState>& placed, const StandingWalls& walls) {
    return Maker(scene, index).make(placed, walls);
}

} // namespace sandlane::scene
