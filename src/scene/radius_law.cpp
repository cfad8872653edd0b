#include "scene/radius_law.hpp"

#include <cmath>
#include <numbers>

namespace sandlane::scene {

namespace {

double normal_cdf(double z) {
    return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// Normal deviate cut at two standard deviations, by bisection of its distribution function.
double cut_normal(double uniform) {
    double low = -2, high = 2;
    const double target = normal_cdf(low) + uniform * (normal_cdf(high) - normal_cdf(low));
    while (high - low > 1e-14) {
        const double middle = 0.5 * (low + high);
        (normal_cdf(middle) < target ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace

double radius_of(const Sizes& sizes, double uniform) {
    const double a = sizes.min, b = sizes.max;
    if (a == b) return a; // no rounding
    switch (sizes.law) {
    case SizeLaw::constant:
        return a;
    case SizeLaw::uniform:
        return a + uniform * (b - a);
    case SizeLaw::inverse_square: // pdf = ab/(b-a) / R^2
        return a * b / (b - uniform * (b - a));
    case SizeLaw::lognormal: // ln R has mean ln sqrt(ab) and standard deviation ln(b/a)/4
        return std::sqrt(a * b) * std::exp(0.25 * std::log(b / a) * cut_normal(uniform));
    }
    return a;
}

} // namespace sandlane::scene
