#include "scene/packing.hpp"

#include "core/error.hpp"
#include "scene/sized_grids.hpp"

#include <numeric>

namespace sandlane::scene {

namespace {

// Sequential insertion of equal discs ends at a fraction of 0.547 (Feder 1980), of equal spheres at 0.384
// (Cooper 1988); close to it almost every attempt fails, so denser targets start from the lattice.
double sequential_limit(std::int64_t dimension) {
    return dimension == 3 ? 0.34 : 0.51;
}
constexpr std::uint64_t attempts_per_grain = 20000;

// Small grains fill what the classes of larger ones leave.
bool sequence_may_reach(const PackingTask& task) {
    const auto classes = size_classes(task.radii.size(), [&](std::size_t i) { return task.radii[i]; });
    std::vector<double> grains(classes.size());
    for (const double radius : task.radii)
        grains[class_of(classes, radius)] += grain_content(radius, task.dimension());
    double room = content(task.size(), task.dimension());
    for (std::size_t c = classes.size(); c-- > 0; room -= grains[c])
        if (!(grains[c] <= sequential_limit(task.dimension()) * room)) return false;
    return true;
}

// Relaxation aims at radii that are larger by this factor, so that it ends in finite time with no overlap.
constexpr double clearance = 1.002;
constexpr double skin = 0.15; // of its lists, per grain in units of the largest radius of its class
constexpr int most_sweeps = 3000;
constexpr double accepted_overlap = 0.01; // of the smaller radius, once the sweeps are spent

// Nearest point that keeps a grain of radius R inside the region.
Vec confined(const PackingTask& task, Vec p, double radius) {
    for (const AxisOfSpace& axis : axes(task.dimension()))
        if (double& x = p.*axis.component; !task.wraps(axis))
            x = std::clamp(x, task.lower.*axis.component + radius, task.upper.*axis.component - radius);
    return task.box.wrapped(p);
}

// ---- sequential insertion

// Between the sides of the region and the centres.
Vec margin_of(const PackingTask& task, double radius) {
    Vec margin;
    for (const AxisOfSpace& axis : axes(task.dimension()))
        margin.*axis.component = task.wraps(axis) ? 0 : radius;
    return margin;
}

// Largest grains first: they find room only while there is plenty. Empty if some grain found none.
std::vector<Vec> insert_sequentially(const PackingTask& task) {
    std::vector<std::size_t> order(task.radii.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return task.radii[a] > task.radii[b]; });
    std::vector<Ball> placed = task.fixed;
    const std::size_t fixed = placed.size();
    SizedGrids grids(task.box, fixed + order.size(),
                     [&](std::size_t n) { return n < fixed ? task.fixed[n].radius : task.radii[n - fixed]; });
    for (const Ball& ball : task.fixed) grids.insert(ball.centre, ball.radius);

    const auto free = [&](Vec p, double radius) {
        bool room = true;
        grids.for_near(p, radius, [&](std::size_t n) {
            const Vec d = task.box.separation(p, placed[n].centre);
            const double reach = radius + placed[n].radius;
            room = room && dot(d, d) >= reach * reach;
        });
        if (room) task.walls.for_near(p, radius, [&](std::size_t) { room = false; });
        return room;
    };
    std::vector<Vec> centres(order.size());
    for (const std::size_t i : order) {
        const double radius = task.radii[i];
        const Vec margin = margin_of(task, radius);
        const Vec low = task.lower + margin, size = task.upper - margin - low;
        bool found = false;
        for (std::uint64_t attempt = 0; attempt < attempts_per_grain && !found; ++attempt) {
            const Vec u = uniform_point(task.random, attempt << 32 | i, task.dimension());
            const Vec p = task.box.wrapped(low + scaled(u, size));
            if (!free(p, radius)) continue;
            placed.push_back({p, radius});
            grids.insert(p, radius);
            centres[i] = p;
            found = true;
        }
        if (!found) return {};
    }
    return centres;
}

// ---- relaxation

class Relaxation {
public:
    Relaxation(const PackingTask& task, std::vector<Vec> centres)
        : task_(task), centres_(std::move(centres)), radii_(task.radii), movable_(task.radii.size()) {
        for (std::size_t i = 0; i < movable_; ++i) centres_[i] = confined(task, centres_[i], radii_[i]);
        for (const Ball& ball : task.fixed) {
            centres_.push_back(ball.centre);
            radii_.push_back(ball.radius);
        }
        const auto classes = size_classes(radii_.size(), [&](std::size_t i) { return radii_[i]; });
        for (const double r : radii_)
            skins_.push_back(skin * clearance * classes[class_of(classes, r)].largest);
    }

    // True once nothing overlaps.
    bool run() {
        list_neighbours();
        for (int n = 0; n < most_sweeps; ++n) {
            sweep();
            if (moved_too_far()) list_neighbours();
            if (n % 4 == 3 && worst_overlap() <= 0) return true;
        }
        return worst_overlap() <= accepted_overlap;
    }

    [[nodiscard]] std::vector<Vec> centres() const {
        return {centres_.begin(), centres_.begin() + static_cast<std::ptrdiff_t>(movable_)};
    }

    // Factor on all radii at which nothing would overlap.
    [[nodiscard]] double fitting_scale() const {
        double scale = 1;
        for (const auto& [i, j] : pairs_) scale = std::min(scale, distance(i, j) / (radii_[i] + radii_[j]));
        for (const auto& [i, w] : near_walls_)
            scale = std::min(scale, std::max(0.0, task_.walls.gap(w, centres_[i]).distance) / radii_[i]);
        return scale;
    }

private:
    struct Pair {
        std::size_t first, second;
    };

    [[nodiscard]] double distance(std::size_t i, std::size_t j) const {
        return norm(task_.box.separation(centres_[i], centres_[j]));
    }

    void list_neighbours() {
        pairs_.clear();
        near_walls_.clear();
        const auto reach = [&](std::size_t i) { return clearance * radii_[i] + skins_[i]; };
        SizedGrids grids(task_.box, centres_.size(), reach);
        for (std::size_t i = 0; i < centres_.size(); ++i) grids.insert(centres_[i], reach(i));
        for (std::size_t i = 0; i < movable_; ++i) {
            grids.for_near(centres_[i], reach(i), [&](std::size_t j) {
                const bool once = j > i; // fixed ones have the largest numbers
                if (once && distance(i, j) < reach(i) + reach(j)) pairs_.push_back({i, j});
            });
            task_.walls.for_near(centres_[i], reach(i), [&](std::size_t w) {
                near_walls_.push_back({i, w});
            });
        }
        listed_ = centres_;
    }

    [[nodiscard]] bool moved_too_far() const {
        for (std::size_t i = 0; i < movable_; ++i)
            if (norm(task_.box.separation(listed_[i], centres_[i])) > skins_[i]) return true;
        return false;
    }

    // Parts every overlapping pair along its line of centres, then every grain from walls and sides.
    void sweep() {
        for (const auto& [i, j] : pairs_) {
            const Vec d = task_.box.separation(centres_[i], centres_[j]);
            const double reach = clearance * (radii_[i] + radii_[j]), r2 = dot(d, d);
            if (r2 >= reach * reach) continue;
            const double r = std::sqrt(r2);
            const Vec along = r > 0 ? (1 / r) * d : Vec{1, 0, 0};
            const double share = j < movable_ ? 0.5 : 1;
            centres_[i] = centres_[i] - (share * (reach - r)) * along;
            if (j < movable_) centres_[j] = centres_[j] + (share * (reach - r)) * along;
        }
        for (const auto& [i, w] : near_walls_) {
            const Gap g = task_.walls.gap(w, centres_[i]);
            if (const double lacking = clearance * radii_[i] - g.distance; lacking > 0)
                centres_[i] = centres_[i] + lacking * g.away;
        }
        for (std::size_t i = 0; i < movable_; ++i) centres_[i] = confined(task_, centres_[i], radii_[i]);
    }

    // In units of the smaller radius.
    [[nodiscard]] double worst_overlap() const {
        double worst = 0;
        for (const auto& [i, j] : pairs_)
            worst =
                std::max(worst, (radii_[i] + radii_[j] - distance(i, j)) / std::min(radii_[i], radii_[j]));
        for (const auto& [i, w] : near_walls_)
            worst = std::max(worst, 1 - task_.walls.gap(w, centres_[i]).distance / radii_[i]);
        return worst;
    }

    const PackingTask& task_;
    std::vector<Vec> centres_, listed_;
    std::vector<double> radii_;
    std::size_t movable_;
    std::vector<double> skins_;            // m, how far a grain may move before the lists are made anew
    std::vector<Pair> pairs_, near_walls_; // near_walls_: grain and wall piece
};

void check_width(const PackingTask& task) {
    const double widest = 2 * *std::max_element(task.radii.begin(), task.radii.end());
    const Vec size = task.size();
    for (const AxisOfSpace& axis : axes(task.dimension()))
        if (!task.wraps(axis) && size.*axis.component < widest)
            fail(Exit::invalid_input,
                 "{}: the region of {} m does not hold a grain of diameter {} m; enlarge lower and upper",
                 task.name, extents(size, task.dimension()), widest);
}

} // namespace

double PackingTask::fraction() const {
    double grains = 0;
    for (const double radius : radii) grains += grain_content(radius, dimension());
    return grains / content(size(), dimension());
}

std::vector<Vec> pack(const PackingTask& task) {
    if (task.radii.empty()) return {};
    check_width(task);
    if (sequence_may_reach(task))
        if (std::vector<Vec> centres = insert_sequentially(task); !centres.empty()) return centres;
    // Order grows as the jitter shrinks; dense targets need some.
    double scale = 0;
    for (const double jitter : {0.5, 0.2, 0.05}) {
        Relaxation relaxation(task, jittered_lattice(task, jitter));
        if (relaxation.run()) return relaxation.centres();
        scale = std::max(scale, relaxation.fitting_scale());
    }
    const double reached = task.fraction() * scale * scale * (task.dimension() == 3 ? scale : 1);
    fail(Exit::invalid_input,
         "{}: {} grains of packing fraction {:.4g} do not fit without overlap; reached {:.4g}. Lower count "
         "or packing_fraction, or enlarge the region.",
         task.name, task.radii.size(), task.fraction(), reached);
}

} // namespace sandlane::scene
