// Walls in 3D: pieces of surface at rest in the frames of their motions, from which grains are seen.
#include "md/walls.hpp"

#include "core/parallel.hpp"
#include "md/records.hpp"
#include "scene/lookup.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

// The motion of a frame, -1 at rest.
int motion_of_frame(std::size_t frame) {
    return static_cast<int>(frame) - 1;
}

} // namespace

// Follows Walls::Walls.
void Walls::build_surfaces(const scene::Scene& scene) {
    for (std::size_t w = 0; w < scene.walls.size(); ++w) {
        WallElement e;
        e.kind = WallElement::Kind::surface;
        e.wall = static_cast<int>(w);
        e.material = scene::material_index(scene, scene.walls[w].material);
        e.motion = scene::motion_index(scene, scene.walls[w].motion);
        elements_.push_back(e);
    }
    surfaces_ = std::make_shared<const scene::Surfaces>(scene);
    for (std::size_t m = 0; m < motions_.size(); ++m) {
        const double extent =
            surfaces_->farthest(scene::Surfaces::frame_of(static_cast<int>(m)), motions_[m].centre);
        const double reach = std::min(extent, domain_reach(motions_[m]));
        fastest_ = std::max(fastest_, motion::largest_speed(motions_[m], reach));
    }
}

// No grain is farther from the pivot.
double Walls::domain_reach(const scene::Motion& m) const {
    const Vec far{std::max(m.centre.x - lower_.x, upper_.x - m.centre.x),
                  std::max(m.centre.y - lower_.y, upper_.y - m.centre.y),
                  std::max(m.centre.z - lower_.z, upper_.z - m.centre.z)};
    return norm(far) + m.orbit_radius + radius_max_;
}

const motion::RigidState* Walls::rigid_of(std::size_t e) const {
    const int motion = element(e).motion;
    return motion < 0 ? nullptr : &rigid_[static_cast<std::size_t>(motion)];
}

Vec Walls::in_frame(std::size_t frame, Vec p) const {
    const int motion = motion_of_frame(frame);
    return motion < 0 ? p : rigid_[static_cast<std::size_t>(motion)].reference_of(p);
}

Vec Walls::closest_on_surface(std::size_t e, Vec p) const {
    const motion::RigidState* rigid = rigid_of(e);
    if (rigid == nullptr) return scene::closest_point(surfaces_->piece(e), p);
    return rigid->position_of(scene::closest_point(surfaces_->piece(e), rigid->reference_of(p)));
}

// ---- contacts

// From those found, in the frames of their walls, to contacts in space.
void Walls::own_contacts(Vec p, double radius, SurfaceContacts& contacts) const {
    surfaces_->keep_own(radius, contacts.found);
    contacts.entries.clear();
    for (const scene::Touch& touch : contacts.found) {
        WallContact c;
        c.valid = true;
        c.distance = touch.foot.distance;
        c.direction = touch.foot.direction;
        if (const motion::RigidState* rigid = rigid_of(touch.piece)) {
            c.direction = rigid->rotate(c.direction);
            c.velocity = rigid->velocity_at(p + c.distance * c.direction);
            c.angular_velocity = rigid->angular_velocity;
        }
        contacts.entries.push_back({touch.piece, c});
    }
}

void Walls::find_contacts(Vec p, double radius, const NearWall* begin, const NearWall* end,
                          SurfaceContacts& contacts) const {
    contacts.found.clear();
    const motion::RigidState* rigid = nullptr;
    Vec seen = p;
    for (const NearWall* n = begin; n != end; ++n) {
        if (const motion::RigidState* own = rigid_of(n->element); own != rigid) {
            rigid = own;
            seen = rigid == nullptr ? p : rigid->reference_of(p);
        }
        surfaces_->add_touch(n->element, seen, radius, contacts.found);
    }
    own_contacts(p, radius, contacts);
}

std::vector<SurfaceContacts::Entry> Walls::touching_surfaces(Vec p, double radius) const {
    SurfaceContacts contacts;
    for (std::size_t frame = 0; frame < surfaces_->frames(); ++frame) {
        const Vec seen = in_frame(frame, p);
        surfaces_->for_near(frame, seen, radius,
                            [&](std::uint32_t e) { surfaces_->add_touch(e, seen, radius, contacts.found); });
    }
    own_contacts(p, radius, contacts);
    return contacts.entries;
}

// ---- the list of candidates

// Tiles on all threads, each with a list of its own, joined in order.
void Walls::list_near_surfaces(const State& state, const double* records) {
    std::vector<std::vector<NearWall>> lists(state.tiles());
    for_tiles_dynamic(state.tiles(), threads_, [&](std::size_t tile) {
        std::vector<NearWall>& list = lists[tile];
        for (std::size_t i = tile * tile_size; i < std::min(state.size(), (tile + 1) * tile_size); ++i) {
            const RecordedGrain g = recorded_grain<3>(records + i * simd::record_fields, nullptr, 0);
            const auto first = static_cast<std::ptrdiff_t>(list.size());
            const double reach = g.radius + skin_;
            for (const Vec place : places(g.position))
                for (std::size_t frame = 0; frame < surfaces_->frames(); ++frame) {
                    const Vec seen = in_frame(frame, place);
                    surfaces_->for_near(frame, seen, reach, [&](std::uint32_t e) {
                        if (scene::distance_from(surfaces_->piece(e), seen) < reach)
                            list.push_back({static_cast<std::uint32_t>(i), e});
                    });
                }
            std::sort(list.begin() + first, list.end(),
                      [](const NearWall& a, const NearWall& b) { return a.element < b.element; });
            list.erase(
                std::unique(list.begin() + first, list.end(),
                            [](const NearWall& a, const NearWall& b) { return a.element == b.element; }),
                list.end());
        }
    });
    for (const std::vector<NearWall>& list : lists) {
        near_.insert(near_.end(), list.begin(), list.end());
        tile_begin_.push_back(near_.size());
    }
}

// Of the reference: every piece is a candidate for every grain.
WallResult Walls::add_surface_forces(const WallInput& input, std::size_t begin, std::size_t end) const {
    std::vector<NearWall> all(surfaces_->size());
    WallResult worst;
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t e = 0; e < all.size(); ++e)
            all[e] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(e)};
        worst.add(kernel_(*this, input, all.data(), all.data() + all.size()));
    }
    return worst;
}

// ---- outputs

std::vector<analysis::WallShape> Walls::surface_shapes() const {
    std::vector<scene::OutlineTriangle> outline = surfaces_->outline();
    for (scene::OutlineTriangle& t : outline)
        if (const int motion = elements_[static_cast<std::size_t>(t.wall)].motion; motion >= 0)
            for (Vec* corner : {&t.a, &t.b, &t.c})
                *corner = rigid_[static_cast<std::size_t>(motion)].position_of(*corner);
    for (const std::uint32_t e : surfaces_->endless()) {
        const auto& plane = std::get<scene::PlanePiece>(surfaces_->piece(e));
        const motion::RigidState* rigid = rigid_of(e);
        const Vec point = rigid != nullptr ? rigid->position_of(plane.point) : plane.point;
        const Vec normal = rigid != nullptr ? rigid->rotate(plane.normal) : plane.normal;
        scene::outline_plane(point, normal, {lower_, upper_}, surfaces_->wall(e), outline);
    }
    std::vector<analysis::WallShape> result;
    for (const scene::OutlineTriangle& t : outline) {
        analysis::WallShape shape;
        shape.kind = analysis::WallShape::Kind::triangle;
        shape.a = t.a;
        shape.b = t.b;
        shape.c = t.c;
        shape.wall = t.wall;
        shape.material = elements_[static_cast<std::size_t>(t.wall)].material;
        result.push_back(shape);
    }
    return result;
}

} // namespace sandlane::md
