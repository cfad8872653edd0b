// PNG pictures of a snapshot: grains coloured by a quantity, walls, scale bar, colour bar and time. Grains in
// space are seen through their walls.
#pragma once

#include "analysis/snapshot.hpp"
#include "output/camera.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace sandlane::output {

struct PictureStyle {
    scene::Colour colour = scene::Colour::speed;
    int width = 800;      // pixels; the height follows from the domain
    double scale_max = 0; // upper end of the colour scale; 0: usual_high() of the snapshot, rounded up
    Camera camera{};      // 3D
};
[[nodiscard]] PictureStyle picture_style(const scene::Scene& scene);

void write_picture(const std::filesystem::path& path, const analysis::Snapshot& snapshot,
                   const PictureStyle& style);

// Joins pictures/000000.png, 000001.png, ... to movie.mp4 when ffmpeg is installed. Returns an empty string
// on success, otherwise the command a user can type.
[[nodiscard]] std::string write_movie(const std::filesystem::path& folder);

} // namespace sandlane::output
