#include "app/gas_engine.hpp"

#include "app/commands.hpp"
#include "core/error.hpp"
#include "output/picture.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::app {

analysis::Snapshot snapshot_of_box(const scene::Scene& scene) {
    analysis::Snapshot s;
    s.dimension = static_cast<int>(scene.domain.dimension);
    s.lower = scene.domain.lower;
    s.upper = scene.domain.upper;
    s.periodic_x = scene.domain.periodic[0];
    s.periodic_y = scene.domain.periodic[1];
    s.periodic_z = scene.domain.periodic[2];
    return s;
}

double counting_cell(double free_path, double volume, std::size_t particles, int dimension) {
    const double edge = std::pow(10 * volume / static_cast<double>(particles), 1.0 / dimension);
    return std::isfinite(free_path) ? std::max(free_path, edge) : edge;
}

void GasEngine::draw(const std::filesystem::path& png, const Look& look) const {
    scene::Scene turned = scene();
    if (!look.view.empty()) {
        if (turned.domain.dimension != 3)
            fail(Exit::invalid_input, "--view goes with three-dimensional scenes only");
        turned.output.view = {look.view[0], look.view[1], look.view[2]};
    }
    output::PictureStyle style = output::picture_style(turned);
    const scene::Choices& colours = scene::colour_choices();
    const auto colour = std::find(colours.begin(), colours.end(), look.colour);
    if (colour != colours.end()) style.colour = static_cast<scene::Colour>(colour - colours.begin());
    if (look.width > 0) style.width = look.width;
    output::write_picture(png, snapshot(), style);
}

} // namespace sandlane::app
