#include "scene/validator.hpp"

#include "scene/space.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::scene {

void Validator::check_domain() const {
    const Domain& d = scene.domain;
    const Vec size = d.upper - d.lower;
    const auto fits = [&](const AxisOfSpace& axis) {
        const double length = size.*axis.component;
        return length > 0 && std::isfinite(length);
    };
    if (!std::ranges::all_of(axes(d.dimension), fits))
        reject("domain: upper = [{}] must lie above lower = [{}] in {} directions, at a finite distance",
               components(d.upper, d.dimension), components(d.lower, d.dimension),
               d.dimension == 3 ? "all" : "both");
}

void Validator::check_shear() const {
    const Domain& d = scene.domain;
    if (d.shear_rate == 0) return;
    if (!std::isfinite(d.shear_rate)) reject("domain.shear_rate: {} is no number", d.shear_rate);
    if (!d.periodic[0] || !d.periodic[1])
        reject("domain.shear_rate: {} needs periodic = [\"x\", \"y\"]: the flow is along x and its images "
               "stand beyond the y sides",
               d.shear_rate);
    if (d.gravity.x != 0 || d.gravity.y != 0)
        reject(
            "domain.shear_rate: {} and gravity [{}]: a sheared cell falls along x and y; leave gravity out",
            d.shear_rate, components(d.gravity, d.dimension));
}

} // namespace sandlane::scene
