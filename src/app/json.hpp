// Values as JSON.
#pragma once

#include "scene/fields.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

namespace sandlane::app {

// TOML's basic strings are escaped as JSON's.
[[nodiscard]] inline std::string json_text(std::string_view text) {
    return scene::quoted(text);
}

// JSON has neither infinities nor NaN.
[[nodiscard]] inline std::string json_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

} // namespace sandlane::app
