#include "edmd/setup.hpp"

#include <algorithm>

namespace sandlane::edmd {

double Setup::volume() const {
    return length(0) * length(1) * (dimension == 3 ? length(2) : 1);
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
    return false;
}

bool Setup::is_plain() const {
    return classes.size() == 1 && !rough && !has_walls() && !falls() && contact_time == 0 &&
           elastic_speed == 0 && restitution.model == laws::Restitution::Model::constant;
}

} // namespace sandlane::edmd
