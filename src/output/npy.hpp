// Fields as NumPy's .npy files, version 1.0, single precision, rows from below.
#pragma once

#include "analysis/field.hpp"

#include <filesystem>
#include <string>

namespace sandlane::output {

[[nodiscard]] std::string npy_bytes(const analysis::Field& field);
void write_npy(const std::filesystem::path& path, const analysis::Field& field);

} // namespace sandlane::output
