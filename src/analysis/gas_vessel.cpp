#include "analysis/gas_vessel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sandlane::analysis {

namespace {

struct Part {
    double from, to;
};

// A row of cells across one axis: its ends, in the vessel.
Part part_of(const GasVessel& v, const CellGrid& grid, int d, std::size_t n) {
    const double edge = grid.edge(d);
    const double from = n == 0 ? v.lower[d] : grid.lower[d] + static_cast<double>(n) * edge;
    const double to = n + 1 == grid.cells[d] ? v.upper[d] : grid.lower[d] + static_cast<double>(n + 1) * edge;
    return {std::max(from, v.lower[d]), std::min(to, v.upper[d])};
}

// What a round wall cuts out of a line along x through (y, z); empty: it does not meet it.
Part cut(const RoundWall& wall, double y, double z) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double dy = wall.axis == 1 ? 0 : y - wall.center[1], dz = wall.axis == 2 ? 0 : z - wall.center[2];
    const double rest = wall.radius * wall.radius - dy * dy - dz * dz;
    if (!(rest > 0)) return {0, 0};
    if (wall.axis == 0) return {-infinity, infinity};
    return {wall.center[0] - std::sqrt(rest), wall.center[0] + std::sqrt(rest)};
}

// Parts of a line along x that lie in the vessel.
void parts_of_line(const GasVessel& v, double y, double z, std::vector<Part>& parts) {
    Part inside{v.lower[0], v.upper[0]};
    for (const RoundWall& wall : v.round) {
        if (!wall.container) continue;
        const Part within = cut(wall, y, z);
        inside = {std::max(inside.from, within.from), std::min(inside.to, within.to)};
    }
    parts.assign(1, inside);
    for (const RoundWall& wall : v.round) {
        if (wall.container) continue;
        const Part out = cut(wall, y, z);
        if (!(out.to > out.from)) continue;
        for (std::size_t n = parts.size(); n-- > 0;) {
            const Part whole = parts[n];
            if (out.to <= whole.from || out.from >= whole.to) continue;
            parts[n].to = std::max(whole.from, out.from);
            parts.push_back({std::min(whole.to, out.to), whole.to});
        }
    }
}

// Lines through each cell in y and z: one where the vessel is a box.
std::array<std::size_t, 2> lines_across(const GasVessel& v, const CellGrid& grid) {
    if (v.round.empty()) return {1, 1};
    const auto& count = grid.cells;
    const std::size_t wanted = v.dimension == 3 ? 256 : 8192;
    std::array<std::size_t, 2> lines = {std::max<std::size_t>(4, wanted / count[1]),
                                        v.dimension == 3 ? std::max<std::size_t>(4, wanted / count[2]) : 1};
    constexpr std::size_t most = 40000000; // cells looked at: some tenths of a second
    while (count[0] * count[1] * count[2] * lines[0] * lines[1] > most && lines[0] * lines[1] > 1)
        (lines[0] > lines[1] ? lines[0] : lines[1]) /= 2;
    return lines;
}

} // namespace

std::vector<double> contents(const GasVessel& v, const CellGrid& grid) {
    const auto& count = grid.cells;
    std::vector<double> all(count[0] * count[1] * count[2], 0.0);
    std::vector<Part> parts;
    const auto [lines_y, lines_z] = lines_across(v, grid);
    for (std::size_t z = 0; z < count[2]; ++z)
        for (std::size_t y = 0; y < count[1]; ++y) {
            const Part in_y = part_of(v, grid, 1, y);
            const Part in_z = v.dimension == 3 ? part_of(v, grid, 2, z) : Part{0, 1};
            if (!(in_y.to > in_y.from && in_z.to > in_z.from)) continue;
            double* row = all.data() + count[0] * (y + count[1] * z);
            const double step_y = (in_y.to - in_y.from) / static_cast<double>(lines_y),
                         step_z = (in_z.to - in_z.from) / static_cast<double>(lines_z);
            for (std::size_t b = 0; b < lines_z; ++b)
                for (std::size_t a = 0; a < lines_y; ++a) {
                    const double at_y = in_y.from + (static_cast<double>(a) + 0.5) * step_y,
                                 at_z = in_z.from + (static_cast<double>(b) + 0.5) * step_z;
                    parts_of_line(v, at_y, v.dimension == 3 ? at_z : 0, parts);
                    for (std::size_t x = 0; x < count[0]; ++x) {
                        const Part cell = part_of(v, grid, 0, x);
                        for (const Part& p : parts)
                            row[x] += step_y * step_z *
                                      std::max(0.0, std::min(p.to, cell.to) - std::max(p.from, cell.from));
                    }
                }
        }
    return all;
}

} // namespace sandlane::analysis
