// Values on a lattice and tables of numbers, for pictures and files.
#pragma once

#include "analysis/snapshot.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace sandlane::analysis {

// Row by row from below.
struct Field {
    std::string name, label, unit;
    std::size_t columns = 0, rows = 0;
    std::vector<double> values;
    bool is_signed = false; // shown around zero
    double high = 0;        // end of the colour scale; 0: chosen from the values
    std::string caption{};  // under the picture, where the engine has no better one
};

struct Table {
    std::string name;
    std::vector<LogColumn> columns;
    std::vector<std::vector<double>> rows;
    // A picture of the table: column `y` over column `x`, both axes logarithmic or not; -1: none.
    int x = -1, y = -1;
    bool logarithmic = true;
};

} // namespace sandlane::analysis
