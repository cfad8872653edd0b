#include "laws/restitution.hpp"

#include <cmath>

namespace sandlane::laws {

double linear_dashpot_contact_time(double z) {
    if (z < 1) return 2 * std::acos(z) / std::sqrt(1 - z * z);
    if (z > 1) return 2 * std::acosh(z) / std::sqrt(z * z - 1);
    return 2;
}

double linear_dashpot_restitution(double z) {
    return std::exp(-z * linear_dashpot_contact_time(z));
}

double viscoelastic_restitution(double x) {
    constexpr double c1 = 0.501086, b2 = 1.15345, b3 = 0.577977, b4 = 0.532178;
    const double s = std::sqrt(x);
    return (1 + c1 * s) / (1 + s * (c1 + s * (b2 + s * (b3 + s * b4))));
}

} // namespace sandlane::laws
