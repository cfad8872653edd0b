#include "edmd/setup.hpp"

#include <algorithm>
#include <numbers>

namespace sandlane::edmd {

namespace {

double content(const Setup& setup, const Curved& c) {
    constexpr double pi = std::numbers::pi;
    if (setup.dimension == 2) return pi * c.radius * c.radius;
    return c.axis < 0 ? 4 * pi / 3 * c.radius * c.radius * c.radius
                      : pi * c.radius * c.radius * setup.length(c.axis);
}

} // namespace

double Setup::volume() const {
    double volume = length(0) * length(1) * (dimension == 3 ? length(2) : 1);
    for (const Curved& c : curved)
        if (c.container) volume = std::min(volume, content(*this, c));
    for (const Curved& c : curved)
        if (!c.container) volume -= content(*this, c);
    return volume;
}

double Setup::largest_radius() const {
    double largest = 0;
    for (const Class& c : classes) largest = std::max(largest, c.radius);
    return largest;
}

double Setup::smallest_radius() const {
    double smallest = classes[0].radius;
    for (const Class& c : classes) smallest = std::min(smallest, c.radius);
    return smallest;
}

bool Setup::has_walls() const {
    for (int d = 0; d < dimension; ++d)
        if (!periodic[d]) return true;
    return !curved.empty();
}

bool Setup::has_room_for_cells() const {
    const double edge = 1.000001 * std::max(2 * largest_radius(), cell_edge);
    for (int d = 0; d < dimension; ++d)
        if (periodic[d] && length(d) < (shear != 0 && d == 0 ? 4 : 3) * edge) return false;
    return true;
}

bool Setup::dissipates() const {
    const auto loses = [](const laws::Restitution& law) {
        return law.model != laws::Restitution::Model::constant || law.eps < 1;
    };
    return rough || loses(restitution) || std::any_of(pairs.begin(), pairs.end(), loses);
}

bool Setup::is_plain() const {
    return classes.size() == 1 && !rough && !has_walls() && !falls() && contact_time == 0 &&
           elastic_speed == 0 && growth == 0 && shear == 0 &&
           restitution.model == laws::Restitution::Model::constant;
}

} // namespace sandlane::edmd
