// Start states of dense packings.
#include "scene/packing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::scene {

namespace {

// Columns, rows and layers of sites; every second row of a plane is shifted by half a column, every second
// layer of space by half a column and half a row.
struct Sites {
    std::int64_t columns = 1, rows = 1, layers = 1;
    double least_distance = -1; // of two of them

    [[nodiscard]] std::int64_t count() const { return columns * rows * layers; }
};

Vec spacing(const Sites& sites, Vec size) {
    return {size.x / static_cast<double>(sites.columns), size.y / static_cast<double>(sites.rows),
            size.z / static_cast<double>(sites.layers)};
}

std::int64_t divided_up(std::int64_t n, std::int64_t by) {
    return (n + by - 1) / by;
}

// The numbers of sites along an axis that come into question.
struct Candidates {
    std::int64_t first, last;

    Candidates(double length, double ideal, std::int64_t around) {
        const auto middle = static_cast<std::int64_t>(length / ideal);
        first = std::max<std::int64_t>(1, middle - around);
        last = middle + around;
    }
};

// The closest two sites should be as far apart as possible.
Sites sites_in_plane(const PackingTask& task, std::int64_t n) {
    const Vec size = task.size();
    const double ideal = std::sqrt(2 * size.x * size.y / (std::sqrt(3.0) * static_cast<double>(n)));
    const Candidates columns(size.x, ideal, 8);
    Sites best;
    for (std::int64_t c = columns.first; c <= columns.last; ++c) {
        Sites sites{c, divided_up(n, c), 1};
        if (task.wraps(space_axes[1])) sites.rows += sites.rows % 2; // they alternate around the period
        const Vec step = spacing(sites, size);
        sites.least_distance = std::min(step.x, std::hypot(0.5 * step.x, step.y));
        if (sites.least_distance > best.least_distance) best = sites;
    }
    return best;
}

// Square layers of edge a, a/sqrt(2) apart, are a face-centred cubic lattice. Thin regions decide the layers
// first.
Sites sites_in_space(const PackingTask& task, std::int64_t n) {
    const Vec size = task.size();
    const double grains = static_cast<double>(n);
    const double ideal = std::cbrt(std::numbers::sqrt2 * content(size, 3) / grains);
    const Candidates layers(size.z, ideal / std::numbers::sqrt2, 4);
    Sites best;
    for (std::int64_t l = layers.first; l <= layers.last; ++l) {
        if (task.wraps(space_axes[2]) && l % 2 != 0) continue;
        const Candidates columns(size.x, std::sqrt(size.x * size.y * static_cast<double>(l) / grains), 4);
        for (std::int64_t c = columns.first; c <= columns.last; ++c) {
            Sites sites{c, divided_up(n, c * l), l};
            const Vec step = spacing(sites, size);
            const double across = l > 1 ? std::hypot(0.5 * step.x, 0.5 * step.y, step.z) : step.x;
            sites.least_distance = std::min({step.x, step.y, across});
            if (sites.least_distance > best.least_distance) best = sites;
        }
    }
    return best;
}

// In units of the spacing.
Vec site_in_plane(std::int64_t column, std::int64_t row) {
    return {static_cast<double>(column) + 0.25 + 0.5 * static_cast<double>(row % 2),
            static_cast<double>(row) + 0.5, 0.5};
}

Vec site_in_space(std::int64_t column, std::int64_t row, std::int64_t layer) {
    const double shift = 0.25 + 0.5 * static_cast<double>(layer % 2);
    return {static_cast<double>(column) + shift, static_cast<double>(row) + shift,
            static_cast<double>(layer) + 0.5};
}

} // namespace

std::vector<Vec> jittered_lattice(const PackingTask& task, double jitter) {
    const bool spatial = task.dimension() == 3;
    const auto n = static_cast<std::int64_t>(task.radii.size());
    const Sites sites = spatial ? sites_in_space(task, n) : sites_in_plane(task, n);
    const Vec step = spacing(sites, task.size());
    std::vector<Vec> centres;
    for (std::int64_t k = 0; k < n; ++k) {
        const std::int64_t site = k * sites.count() / n, line = site / sites.columns;
        const std::int64_t column = site % sites.columns;
        const Vec at = spatial ? site_in_space(column, line % sites.rows, line / sites.rows)
                               : site_in_plane(column, line);
        const Vec shift = uniform_shift(task.random, static_cast<std::uint64_t>(k), jitter, task.dimension());
        centres.push_back(task.lower + scaled(at + shift, step));
    }
    return centres;
}

} // namespace sandlane::scene
