#include "automata/equilibrium.hpp"

#include <cmath>
#include <limits>

namespace sandlane::automata {

namespace {

struct Direction {
    double x, y;
};

Direction direction(int i, int bits) {
    if (i == 6) return {0, 0};
    if (bits == 4) return {i == 0 ? 1.0 : i == 2 ? -1.0 : 0.0, i == 1 ? 1.0 : i == 3 ? -1.0 : 0.0};
    constexpr double x[] = {1, 0.5, -0.5, -1, -0.5, 0.5}, y[] = {0, 1, 1, 0, -1, -1};
    return {x[i], y[i] * std::sqrt(0.75)};
}

// Solves a 3 x 3 system by Cramer's rule.
std::array<double, 3> solve(const double (&m)[3][3], const std::array<double, 3>& b) {
    const auto det = [](const double(&a)[3][3]) {
        return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
               a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    const double whole = det(m);
    std::array<double, 3> x{};
    for (int k = 0; k < 3; ++k) {
        double replaced[3][3];
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) replaced[r][c] = c == k ? b[static_cast<std::size_t>(r)] : m[r][c];
        x[static_cast<std::size_t>(k)] = det(replaced) / whole;
    }
    return x;
}

} // namespace

std::array<double, 7> fermi_dirac(double density, double j_x, double j_y, int bits) {
    std::array<double, 7> n{};
    const double filling = density / bits;
    if (filling <= 0 || filling >= 1) {
        n.fill(filling <= 0 ? 0 : 1);
        if (j_x != 0 || j_y != 0) n.fill(std::numeric_limits<double>::quiet_NaN());
        return n;
    }
    std::array<double, 3> z{std::log(1 / filling - 1), 0, 0}; // alpha, beta
    double left = 1;
    for (int round = 0; round < 100; ++round) {
        double jacobian[3][3] = {};
        std::array<double, 3> off{density, j_x, j_y};
        for (int i = 0; i < bits; ++i) {
            const Direction c = direction(i, bits);
            const double v[3] = {1, c.x, c.y};
            const double occupied = 1 / (1 + std::exp(z[0] + z[1] * c.x + z[2] * c.y));
            n[static_cast<std::size_t>(i)] = occupied;
            for (std::size_t r = 0; r < 3; ++r) {
                off[r] -= occupied * v[r];
                for (std::size_t k = 0; k < 3; ++k) jacobian[r][k] -= occupied * (1 - occupied) * v[r] * v[k];
            }
        }
        left = std::abs(off[0]) + std::abs(off[1]) + std::abs(off[2]);
        if (left < 1e-14 * (1 + density)) return n;
        const std::array<double, 3> step = solve(jacobian, off);
        for (std::size_t k = 0; k < 3; ++k) z[k] += step[k];
    }
    if (!(left < 1e-10)) n.fill(std::numeric_limits<double>::quiet_NaN());
    return n;
}

} // namespace sandlane::automata
