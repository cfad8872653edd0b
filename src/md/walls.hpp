// Walls: analytic elements and prescribed wall grains (docs/physics.md 6), in 3D pieces of surface. Contacts
// use the same formula text as pairs. A list of near (grain, element) pairs is kept while nothing can have
// closed the skin.
#pragma once

#include "analysis/snapshot.hpp"
#include "laws/contact.hpp"
#include "md/contact_memory.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "motion/prescribed.hpp"
#include "scene/surfaces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace sandlane::md {

// One element in the coordinates of its reference time; a moving wall transforms it. `surface` stands for all
// pieces of a wall in 3D: scene::Surfaces knows their geometry, and grains are seen from the frame of the
// wall.
struct WallElement {
    enum class Kind { plane, segment, vertex, arc, disc, surface };
    Kind kind = Kind::segment;
    Vec a, b;          // plane: point, normal; segment: ends; vertex, disc: a; arc: a = centre
    double radius = 0; // arc, disc
    double angle_from = 0, angle_span = 0; // arc, counter-clockwise
    Vec along;                             // segment: from a to b
    // Segment, vertex: the contacts of grains whose centres lie behind the line through a across `after` and
    // before the line through b across `before` are its own, with `open_end` all behind the first. Elements
    // that meet at a point share these vectors, bit for bit, so that every contact is somebody's.
    Vec after, before;
    bool open_end = false;
    double omega = 0; // disc: own spin in addition to the motion
    int wall = 0, material = 0, motion = -1;
};

// Closest point of an element to a grain.
struct WallContact {
    double distance = 0;  // from the grain's centre to the surface (disc: to its centre)
    Vec direction;        // unit vector from the grain to the element
    Vec velocity;         // of the wall at the contact (disc: of its centre)
    Vec angular_velocity; // of the wall
    double radius = 0, spin = 0, inverse_radius = 0; // disc: R_j, R_j omega_j, 1/R_j
    bool valid = false;
};

// R_i^2 - R_j^2 of a contact's lever arms; flat walls count as so large that the lever arm is the distance.
[[nodiscard]] inline double flat_or_round(const WallContact& c, double radius) {
    return c.radius > 0 ? radius * radius - c.radius * c.radius : c.distance * c.distance;
}

[[nodiscard]] inline Vec closest_on_segment(const WallElement& e, Vec p) {
    const double s = std::clamp(dot(p - e.a, e.along) / dot(e.along, e.along), 0.0, 1.0);
    return e.a + s * e.along;
}

struct WallResult {
    double largest_ratio = 0; // overlap over the grain's radius
    std::int64_t grain = -1;  // where, storage index
    int wall = -1;
    double power = 0; // W, given by moving walls to the grains

    // One contact.
    void see(double ratio, std::size_t of_grain, int with_wall) {
        if (ratio <= largest_ratio) return;
        largest_ratio = ratio;
        grain = static_cast<std::int64_t>(of_grain);
        wall = with_wall;
    }
    // Those of other grains.
    void add(const WallResult& other) {
        power += other.power;
        if (other.grain >= 0) see(other.largest_ratio, static_cast<std::size_t>(other.grain), other.wall);
    }
};

// One near grain and element of the candidate list.
struct NearWall {
    std::uint32_t grain, element;
};

// Contacts of one grain with the pieces of walls in 3D; kept by callers to save allocations.
struct SurfaceContacts {
    struct Entry {
        std::uint32_t element;
        WallContact contact;
    };
    std::vector<scene::Touch> found; // in the frames of the walls
    std::vector<Entry> entries;
};

class Walls;
// Grains and coefficients for wall forces; `force` is the accumulator of grain `first`.
struct WallInput {
    const double* records;
    const std::int32_t* material;
    const double* coefficients;
    int materials;
    double* force;
    std::size_t first;
    // Of laws that remember, beside the list of candidates: number f of candidate n at
    // memory[f * stride + n].
    const NearWall* near = nullptr;
    double* memory = nullptr;
    std::ptrdiff_t stride = 0;
    double dt = 0, inverse_dt = 0;
    const double* spins = nullptr; // 3D: records of spins, null without
    int force_stride = simd::force_stride(2, simd::Rotation::none);
};
// Adds the forces of a range of candidates; compiled per law (wall_forces.cpp, surface_forces.cpp).
using WallKernel = WallResult (*)(const Walls&, const WallInput&, const NearWall* begin, const NearWall* end);
[[nodiscard]] WallKernel wall_kernel(const Plan& plan);
[[nodiscard]] WallKernel surface_kernel(const Plan& plan); // 3D

class Walls {
public:
    Walls() = default;
    Walls(const scene::Scene& scene, const Plan& plan, const Needs& needs);

    [[nodiscard]] bool empty() const { return elements_.empty(); }
    [[nodiscard]] const std::vector<WallElement>& elements() const { return elements_; }
    [[nodiscard]] const WallElement& element(std::size_t e) const {
        return elements_[surfaces_ ? static_cast<std::size_t>(surfaces_->wall(e)) : e];
    }
    // Positions and velocities of the walls at time t.
    void move_to(double time);
    [[nodiscard]] WallContact contact(std::size_t element, Vec position) const;
    // What torques on the element refer to: the centre that its motion turns about, else the origin.
    [[nodiscard]] Vec pivot(const WallElement& element) const;

    // The grains moved by at most `distance` since the last call.
    void account(double distance) { budget_ -= distance; }
    // Before the storage order changes.
    void invalidate(const State& state);
    [[nodiscard]] ContactMemory memory(const State& state) const;
    void adopt(ContactMemory memory);
    [[nodiscard]] double fastest() const { return fastest_; }
    // Makes the candidate list if something may have closed its skin since the last time.
    void update(const State& state, const double* records);
    // Adds the wall forces on the grains of one tile; `list` = false looks at every element (reference).
    [[nodiscard]] WallResult add_forces(WallInput input, std::size_t tile, std::size_t grains, bool list);
    [[nodiscard]] std::size_t list_size() const { return near_.size(); }
    // Of the candidates of one tile: what their contacts remember, and whether one of them moves.
    [[nodiscard]] std::vector<double> memory_of_tile(std::size_t tile) const;
    [[nodiscard]] bool moves_near(std::size_t tile) const;
    [[nodiscard]] std::int64_t builds() const { return builds_; }

    [[nodiscard]] std::vector<analysis::WallShape> shapes(double time) const;
    // Calls body(element) for the elements that may touch a grain of radius R at p.
    template <class Body> void for_touching(Vec p, double radius, const Body& body) const {
        if (surfaces_) {
            for (const auto& [e, c] : touching_surfaces(p, radius)) body(std::size_t{e}, c);
            return;
        }
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const WallContact c = contact(e, p);
            if (c.valid && c.distance < radius + c.radius) body(e, c);
        }
    }

    // 3D: contacts of a grain of radius R at p with the pieces listed for it, by wall, then distance.
    void find_contacts(Vec p, double radius, const NearWall* begin, const NearWall* end,
                       SurfaceContacts& contacts) const;
    // Point of a piece of a surface or of a polyline, where it stands now, that is closest to p.
    [[nodiscard]] Vec closest_point(std::size_t element, Vec p) const;
    // Whether a contact may pass from one to the other.
    [[nodiscard]] bool of_one_surface(std::size_t first, std::size_t second) const {
        return element(first).wall == element(second).wall && element(first).kind != WallElement::Kind::disc;
    }
    // Numbers that a contact remembers.
    [[nodiscard]] int fields() const { return fields_; }

private:
    void build_surfaces(const scene::Scene& scene);
    [[nodiscard]] Vec closest_on_surface(std::size_t element, Vec p) const;
    [[nodiscard]] double domain_reach(const scene::Motion& motion) const;
    [[nodiscard]] const motion::RigidState* rigid_of(std::size_t element) const;
    [[nodiscard]] Vec in_frame(std::size_t frame, Vec p) const;
    void own_contacts(Vec p, double radius, SurfaceContacts& contacts) const;
    [[nodiscard]] std::vector<SurfaceContacts::Entry> touching_surfaces(Vec p, double radius) const;
    void list_near_surfaces(const State& state, const double* records);
    [[nodiscard]] WallResult add_surface_forces(const WallInput& input, std::size_t begin,
                                                std::size_t end) const;
    [[nodiscard]] std::vector<analysis::WallShape> surface_shapes() const;

    struct Places {
        std::array<Vec, 8> at; // one periodic image per direction at most
        std::size_t count = 1;
        [[nodiscard]] const Vec* begin() const { return at.data(); }
        [[nodiscard]] const Vec* end() const { return at.data() + count; }
    };
    [[nodiscard]] Places places(Vec p) const;
    void rebuild(const State& state, const double* records);
    void list_near_elements(const State& state, const double* records);
    void add_wall(const scene::Scene& scene, std::size_t index);
    void add_chain(const std::vector<Vec>& points, bool closed, WallElement prototype);
    void add_grains(const scene::Wall& wall, WallElement prototype);

    std::vector<WallElement> elements_, reference_;
    std::shared_ptr<const scene::Surfaces> surfaces_; // 3D, else null
    std::vector<scene::Motion> motions_;
    std::vector<motion::RigidState> rigid_; // per motion, at the current time
    std::vector<NearWall> near_;            // ordered by grain, then element
    std::vector<std::size_t> tile_begin_;   // first list entry of each tile of grains
    std::vector<double> near_memory_;       // [field][list entry]
    WallKernel kernel_ = nullptr;
    ContactMemory remembered_; // while there is no list
    int fields_ = 0;           // numbers that a contact remembers
    bool stale_ = true;
    std::int64_t builds_ = 0;
    Vec lower_, upper_;
    std::array<bool, 3> periodic_{};
    double skin_ = 0, budget_ = -1, fastest_ = 0, radius_max_ = 0;
    int threads_ = 1;
};

} // namespace sandlane::md
