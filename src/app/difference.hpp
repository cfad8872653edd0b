// Comparison of two results quantity by quantity: largest absolute, relative and ULP difference, and where.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::app {

struct Difference {
    std::string quantity, unit;
    double absolute = 0, relative = 0;
    std::uint64_t ulps = 0;
    std::int64_t id = -1; // grain or site with the largest absolute difference
};

[[nodiscard]] std::uint64_t ulp_distance(double a, double b);

// Both vectors have one value per id.
[[nodiscard]] Difference difference(std::string quantity, std::string unit,
                                    const std::vector<std::int64_t>& ids, const std::vector<double>& a,
                                    const std::vector<double>& b);

[[nodiscard]] std::string difference_table(const std::vector<Difference>& differences,
                                           const std::string& thing = "grain");
[[nodiscard]] double worst_relative(const std::vector<Difference>& differences);

} // namespace sandlane::app
