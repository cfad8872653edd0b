#include "output/picture_space.hpp"

#include "output/depth_canvas.hpp"
#include "output/wall_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sandlane::output {

using analysis::Snapshot;
using analysis::WallShape;

namespace {

constexpr Rgb box_grey{0.72F, 0.75F, 0.79F}, edge_grey{0.42F, 0.45F, 0.50F};
constexpr float wall_opacity = 0.28F, wall_opacity_before = 0.07F;

class SpacePicture {
public:
    SpacePicture(Canvas& canvas, const View& view, const Camera& camera)
        : depth_(canvas), view_(view), camera_(camera) {}

    // Pixels, z towards the viewer.
    [[nodiscard]] Vec place(Vec p) const {
        const Vec seen = camera_.project(p);
        return {view_.px(seen.x), view_.py(seen.y), seen.z * view_.scale};
    }

    void draw_grains(const Snapshot& s, const std::vector<Rgb>& colours) {
        std::vector<Vec> places(s.size());
        for (std::size_t i = 0; i < s.size(); ++i) places[i] = place(s.position(i));
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < s.size(); ++i)
            if (std::isfinite(places[i].z)) order.push_back(i);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t i, std::size_t j) { return places[i].z < places[j].z; });
        for (const std::size_t i : order) depth_.sphere(places[i], s.radius[i] * view_.scale, colours[i]);
    }

    void draw_domain(Vec lower, Vec upper) {
        const auto corner = [&](int n) { // bits of n: x, y, z
            return place({(n & 1) != 0 ? upper.x : lower.x, (n & 2) != 0 ? upper.y : lower.y,
                          (n & 4) != 0 ? upper.z : lower.z});
        };
        for (int n = 0; n < 8; ++n)
            for (const int axis : {1, 2, 4})
                if ((n & axis) == 0) depth_.line(corner(n), corner(n | axis), view_.unit, box_grey);
    }

    void draw_walls(const std::vector<WallShape>& walls) {
        struct Face {
            std::array<Vec, 3> corners;
            double height;
            Rgb colour;
        };
        std::vector<Face> faces;
        for (const WallShape& w : walls) {
            if (w.kind != WallShape::Kind::triangle) continue;
            const std::array<Vec, 3> at{place(w.a), place(w.b), place(w.c)};
            faces.push_back({at, at[0].z + at[1].z + at[2].z, colour_of(w)});
        }
        std::stable_sort(faces.begin(), faces.end(),
                         [](const Face& a, const Face& b) { return a.height < b.height; });
        for (const Face& face : faces)
            depth_.triangle(face.corners, face.colour, wall_opacity, wall_opacity_before);
        for (const WallEdge& edge : wall_edges(walls))
            if (edge.is_sharp() || edge.is_outline(camera_.towards))
                depth_.line(place(edge.a), place(edge.b), 1.2 * view_.unit, edge_grey);
    }

private:
    // Lit from the side that is seen.
    [[nodiscard]] Rgb colour_of(const WallShape& triangle) const {
        const Vec n = camera_.project(cross(triangle.b - triangle.a, triangle.c - triangle.a));
        const double length = norm(n), factor = length > 0 ? (n.z < 0 ? -1 : 1) / length : 0;
        const auto light = static_cast<float>(light_on(factor * n));
        return {light * wall_grey.r, light * wall_grey.g, light * wall_grey.b};
    }

    DepthCanvas depth_;
    const View& view_;
    const Camera& camera_;
};

} // namespace

View make_space_view(const Snapshot& s, const Camera& camera, int wanted_width) {
    const ProjectedBox box = project_box(camera, s.lower, s.upper);
    return make_view(box.lower, box.upper, wanted_width);
}

void draw_space(Canvas& canvas, const View& view, const Snapshot& s, const Camera& camera,
                const std::vector<Rgb>& colours) {
    SpacePicture picture(canvas, view, camera);
    picture.draw_grains(s, colours); // what follows passes before or behind them
    picture.draw_domain(s.lower, s.upper);
    picture.draw_walls(s.walls);
}

} // namespace sandlane::output
