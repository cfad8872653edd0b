#include "laws/wall_times.hpp"

#include "laws/elementary.hpp"
#include "laws/pair_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace sandlane::laws {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

struct Turn {
    double sine, cosine;
};
Turn turn_at(const Oscillation& wall, double t) {
    const double turns = wall.frequency * t + wall.phase;
    const double part = turns - std::floor(turns);
    Turn r{};
    sine_cosine_of_turn(part < 1 ? part : 0.0, r.sine, r.cosine);
    return r;
}

} // namespace

double flat_wall_time(double h, double v, double g) {
    if (h <= 0) {
        if (v < 0) return 0;
        return g < 0 ? 2 * v / -g : never;
    }
    if (g == 0) return v < 0 ? -h / v : never;
    if (g < 0) {
        const double root = std::sqrt(v * v - 2 * g * h);
        return v >= 0 ? (v + root) / -g : 2 * h / (root - v);
    }
    const double square = v * v - 2 * g * h;
    return v < 0 && square >= 0 ? 2 * h / (std::sqrt(square) - v) : never;
}

namespace {

// c0 + c1 t + ... of degree at most four.
struct Polynomial {
    std::array<double, 5> c{};
    int degree = 0;

    [[nodiscard]] double at(double t) const {
        double sum = c[static_cast<std::size_t>(degree)];
        for (int k = degree; k-- > 0;) sum = sum * t + c[static_cast<std::size_t>(k)];
        return sum;
    }
    [[nodiscard]] Polynomial derivative() const {
        Polynomial d;
        d.degree = std::max(degree - 1, 0);
        for (int k = 1; k <= degree; ++k)
            d.c[static_cast<std::size_t>(k - 1)] = k * c[static_cast<std::size_t>(k)];
        return d;
    }
};

// Where p changes its sign for t > 0, in order.
std::vector<double> sign_changes(Polynomial p) {
    while (p.degree > 0 && p.c[static_cast<std::size_t>(p.degree)] == 0) --p.degree;
    if (p.degree == 0) return {};
    // All of them lie below it (Cauchy).
    double last = 0;
    for (int k = 0; k < p.degree; ++k)
        last = std::max(last,
                        std::abs(p.c[static_cast<std::size_t>(k)] / p.c[static_cast<std::size_t>(p.degree)]));
    last = std::min(1 + last, 1e300);
    std::vector<double> edges = sign_changes(p.derivative()), found;
    edges.insert(edges.begin(), 0.0);
    edges.push_back(std::max(last, edges.back()));
    // Between two edges p is monotonous.
    for (std::size_t n = 1; n < edges.size(); ++n) {
        double low = edges[n - 1], high = edges[n];
        const bool positive = p.at(low) > 0;
        if ((p.at(high) > 0) == positive) continue;
        constexpr int most_halvings = 2200; // from the largest number to the least
        for (int k = 0; k < most_halvings; ++k) {
            const double middle = low + 0.5 * (high - low);
            if (!(middle > low && middle < high)) break;
            ((p.at(middle) > 0) == positive ? low : high) = middle;
        }
        found.push_back(high);
    }
    return found;
}

// First time at which the gap h(t) closes.
double first_closing(Polynomial h) {
    if (h.c[0] <= 0) {
        if (h.c[1] < 0 || (h.c[1] == 0 && h.c[2] <= 0)) return h.c[1] == 0 && h.c[2] == 0 ? never : 0;
        // It opens now: h/t closes when h does next.
        for (std::size_t k = 0; k + 1 < h.c.size(); ++k) h.c[k] = h.c[k + 1];
        h.c[4] = 0;
        --h.degree;
    }
    double before = 0;
    for (const double t : sign_changes(h)) {
        if (h.at(0.5 * (before + t)) > 0) return t;
        before = t;
    }
    return never;
}

} // namespace

double curved_wall_time(const Vector<double>& r, const Vector<double>& v, const Vector<double>& g,
                        double distance, bool container) {
    const double field = dot(g, g);
    if (field == 0 && !container) return meeting<3>(r, v, distance, never);
    const double a = dot(v, v), b = dot(r, v), c = dot(r, r) - distance * distance;
    if (field == 0) {
        if (a == 0) return never;
        const double inside = std::min(c, 0.0), root = std::sqrt(b * b - a * inside);
        return b <= 0 ? (root - b) / a : -inside / (b + root);
    }
    const double sign = container ? -1 : 1;
    return first_closing(
        {{sign * c, sign * 2 * b, sign * (a + dot(r, g)), sign * dot(v, g), sign * 0.25 * field}, 4});
}

double Oscillation::displacement(double t) const {
    return amplitude * turn_at(*this, t).sine;
}

double Oscillation::velocity(double t) const {
    return 2 * std::numbers::pi * frequency * amplitude * turn_at(*this, t).cosine;
}

double oscillating_wall_time(double h, double v, double g, const Oscillation& wall, double now,
                             double limit) {
    const double omega = 2 * std::numbers::pi * wall.frequency;
    const double bound = std::abs(g) + wall.amplitude * omega * omega; // of |h''|
    const double close = 1e-13 * wall.amplitude;
    double t = 0;
    constexpr int most_steps = 10000;
    for (int step = 0; step < most_steps && t <= limit; ++step) {
        const double height = h + v * t + 0.5 * g * t * t;
        if (height > wall.amplitude) { // out of reach: to where it comes back, if it does
            const double back = flat_wall_time(height - wall.amplitude, v + g * t, g);
            if (back == never) return never;
            if (t + back > t) {
                t += back;
                continue;
            }
        }
        const Turn turn = turn_at(wall, now + t);
        const double gap = height - wall.amplitude * turn.sine;
        const double rate = v + g * t - wall.amplitude * omega * turn.cosine;
        if (gap <= close && rate < 0) return t;
        if (!(bound > 0)) return never;
        const double above = gap > close ? gap : 0;
        const double next = (rate + std::sqrt(rate * rate + 2 * bound * above)) / bound;
        if (!(next > 0)) return t; // rides on the wall
        t += next;
    }
    return never;
}

std::array<double, 2> normal_pair(double u, double w) {
    const double radius = std::sqrt(-2.0 * logarithm(1.0 - u));
    double sine = 0, cosine = 0;
    sine_cosine_of_turn(w, sine, cosine);
    return {radius * cosine, radius * sine};
}

double flux_speed(double u) {
    return std::sqrt(-2.0 * logarithm(1.0 - u));
}

} // namespace sandlane::laws
