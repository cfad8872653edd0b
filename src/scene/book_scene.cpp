// An init file of the book's program as a scene (docs/physics.md 6).
#include "core/error.hpp"
#include "scene/book_format.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

namespace sandlane::scene {

namespace {

constexpr double poisson = 0.3; // the format has only the reduced modulus
constexpr double floor_height = 0.1, row_height = 0.02;
constexpr int drum_grains = 128;
constexpr Vec centre = {0.5, 0.5, 0};

// The motion of a type; the program's parameters hold in its unit box. Its clock reads t0 when ours reads 0.
std::optional<Motion> motion_of(int type, double t0) {
    Motion m;
    switch (type) {
    case 2: // x = 0.5 - 0.4 cos(10 t)
        m.name = "stirrer";
        m.kind = MotionKind::oscillate;
        m.amplitude = {-0.4, 0, 0};
        m.omega = 10;
        m.phase = m.omega * t0;
        m.wave = Wave::cosine;
        return m;
    case 3: // rotation by t - t0
        m.name = "drum";
        m.kind = MotionKind::rotate;
        m.centre = centre;
        m.omega = 1;
        return m;
    case 4: // spin 1 rad/s on an orbit of radius 0.1 m
        m.name = "planetary drum";
        m.kind = MotionKind::planetary;
        m.centre = centre;
        m.omega = m.orbit_omega = 1;
        m.orbit_radius = 0.1;
        m.phase = m.orbit_omega * t0;
        return m;
    case 5:
    case 6: // y = y0 + 0.02 sin(30 t)
        m.name = type == 5 ? "vibrating floor" : "vibrating side wall";
        m.kind = MotionKind::oscillate;
        m.amplitude = {0, 0.02, 0};
        m.omega = 30;
        m.phase = m.omega * t0;
        return m;
    default:
        return std::nullopt;
    }
}

// Where the motion's reference puts wall grain k; types 2, 4, 5 and 6 replace the file's coordinates.
Vec reference_position(const BookRecord& r, std::size_t k, double t0) {
    switch (r.type) {
    case 2:
        return {0.5, floor_height, 0};
    case 4: {
        const double angle = t0 + 2 * std::numbers::pi * static_cast<double>(k) / drum_grains;
        return centre + 0.4 * Vec{std::cos(angle), std::sin(angle), 0};
    }
    case 5:
        return {r.x, floor_height, 0};
    case 6: { // stored as pairs left, right
        const std::size_t pair = k / 2;
        return {r.x, floor_height + row_height * static_cast<double>(pair), 0};
    }
    default:
        return {r.x, r.y, 0};
    }
}

class Builder {
public:
    Builder(const Book& book, const std::string& file) : book_(book), file_(file) {}

    Scene build() {
        add_frame();
        for (std::size_t k = 0; k < book_.records.size(); ++k) {
            const BookRecord& r = book_.records[k];
            if (r.type < 0 || r.type > 6)
                fail(Exit::invalid_input,
                     "{}: record {}, column 9 (ptype): type {} is unknown; allowed: 0 to 6", file_, k + 1,
                     r.type);
            if (r.type == 0)
                add_grain(r);
            else
                add_wall_grain(r, k);
        }
        return std::move(scene_);
    }

private:
    void add_frame() {
        const BookHeader& h = book_.header;
        scene_.title = file_;
        scene_.domain.lower = {h.x_0, h.y_0, 0};
        scene_.domain.upper = scene_.domain.lower + Vec{h.lx, h.ly, 0};
        scene_.domain.periodic = {true, true};
        scene_.domain.gravity = h.gravity;
        scene_.md.dt = h.time_step;
        scene_.md.duration = static_cast<double>(h.steps) * h.time_step;
        scene_.output.trajectory_every = static_cast<double>(h.print_every) * h.time_step;
        scene_.output.log_every = static_cast<double>(h.energy_every) * h.time_step;
    }

    std::string material_of(const BookRecord& r) {
        const double young = 0.75 * (1 - poisson * poisson) * r.modulus;
        for (const Material& m : scene_.materials)
            if (std::tie(m.young, m.dissipation, m.friction, m.tangential_damping) ==
                std::tie(young, r.dissipation, r.friction, r.damping))
                return m.name;
        Material& m = scene_.materials.emplace_back();
        m.name = fmt::format("material {}", scene_.materials.size());
        m.young = young;
        m.poisson = poisson;
        m.dissipation = r.dissipation;
        m.friction = r.friction;
        m.tangential_damping = r.damping;
        return m.name;
    }

    // Neighbours in the file that share a material share a population: ids follow the file.
    void add_grain(const BookRecord& r) {
        const std::string material = material_of(r);
        if (scene_.grains.empty() || scene_.grains.back().material != material) {
            Grains& grains = scene_.grains.emplace_back();
            grains.kind = GrainKind::list;
            grains.material = material;
        }
        GrainItem& item = scene_.grains.back().items.emplace_back();
        item.position = {r.x, r.y, 0};
        item.velocity = {r.vx, r.vy, 0};
        item.angle = r.phi;
        item.omega = r.omega;
        item.radius = r.radius;
        item.mass = r.mass;
    }

    void add_wall_grain(const BookRecord& r, std::size_t k) {
        const double t0 = book_.header.time;
        const std::string name = fmt::format("type {}", r.type), material = material_of(r);
        Wall* wall = nullptr;
        for (Wall& w : scene_.walls)
            if (w.name == name && w.material == material) wall = &w;
        if (wall == nullptr) {
            wall = &scene_.walls.emplace_back();
            wall->name = name;
            wall->material = material;
            wall->kind = WallKind::grains;
            if (const std::optional<Motion> motion = motion_of(r.type, t0)) {
                wall->motion = motion->name;
                add_motion(*motion);
            }
        }
        GrainItem& item = wall->items.emplace_back();
        item.position = reference_position(r, k, t0);
        item.radius = r.radius;
    }

    void add_motion(const Motion& motion) {
        for (const Motion& m : scene_.motions)
            if (m.name == motion.name) return;
        scene_.motions.push_back(motion);
    }

    const Book& book_;
    const std::string& file_;
    Scene scene_;
};

} // namespace

Scene scene_from_book(const Book& book, const std::string& file) {
    return Builder(book, file).build();
}

} // namespace sandlane::scene
