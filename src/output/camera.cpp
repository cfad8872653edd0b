#include "output/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::output {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double usual_azimuth = 25 * degree, usual_elevation = 20 * degree;

Vec unit(Vec v) {
    return (1 / norm(v)) * v;
}

// The part of v across an axis.
Vec across(Vec v, Vec axis) {
    return v - dot(v, axis) * axis;
}

bool is_parallel(Vec unit_a, Vec unit_b) {
    return norm(cross(unit_a, unit_b)) < 1e-9;
}

} // namespace

Camera look_from(Vec direction, Vec world_up) {
    const Vec vertical = norm(world_up) > 0 ? unit(world_up) : Vec{0, 0, 1};
    const Vec x{1, 0, 0}, y{0, 1, 0};
    const Vec side = unit(across(is_parallel(x, vertical) ? y : x, vertical));
    const Vec front = cross(side, vertical);
    if (!(norm(direction) > 0))
        direction =
            std::cos(usual_elevation) * (std::cos(usual_azimuth) * front + std::sin(usual_azimuth) * side) +
            std::sin(usual_elevation) * vertical;
    Camera camera;
    camera.towards = unit(direction);
    camera.vertical = vertical;
    const bool along = is_parallel(camera.towards, vertical);
    const Vec upwards = !along ? vertical : dot(camera.towards, vertical) > 0 ? -1.0 * front : front;
    camera.up = unit(across(upwards, camera.towards));
    camera.right = cross(camera.up, camera.towards);
    return camera;
}

Camera camera_of(const scene::Scene& scene) {
    return look_from(scene.output.view, -1.0 * scene.domain.gravity);
}

ProjectedBox project_box(const Camera& camera, Vec lower, Vec upper) {
    ProjectedBox box{camera.project(lower), camera.project(lower)};
    for (const double x : {lower.x, upper.x})
        for (const double y : {lower.y, upper.y})
            for (const double z : {lower.z, upper.z}) {
                const Vec p = camera.project({x, y, z});
                box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                             std::min(box.lower.z, p.z)};
                box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                             std::max(box.upper.z, p.z)};
            }
    return box;
}

} // namespace sandlane::output
