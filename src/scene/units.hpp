// Numbers with units: "5 mm", "2.5 g/cm^3", "60 rpm", or plain SI numbers.
#pragma once

#include <string>
#include <string_view>

namespace sandlane::scene {

enum class Unit {
    none,
    length,
    time,
    angle,
    speed,
    angular_speed,
    acceleration,
    stiffness,
    damping,
    rolling_damping,
    rolling_stiffness,
    pressure,
    density,
    mass,
    rate,
    energy,
    heating // of velocities by noise, m^2/s^3
};

[[nodiscard]] std::string_view unit_symbol(Unit unit); // SI: "m", "kg/m^3", ...; "" for none

// Converts `text` to SI. Returns an empty string on success, else what is wrong and what would be right.
[[nodiscard]] std::string parse_quantity(std::string_view text, Unit unit, double& value);

} // namespace sandlane::scene
