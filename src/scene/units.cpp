#include "scene/units.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace sandlane::scene {

namespace {

// Powers of metre, kilogram and second; angles have no dimension.
struct Dimension {
    int length = 0, mass = 0, time = 0;
    friend bool operator==(const Dimension&, const Dimension&) = default;
};

struct Named {
    std::string_view name;
    double factor;
    Dimension dimension;
};

constexpr double pi = std::numbers::pi;
constexpr Named units[] = {
    {"m", 1, {1, 0, 0}},
    {"km", 1e3, {1, 0, 0}},
    {"cm", 1e-2, {1, 0, 0}},
    {"mm", 1e-3, {1, 0, 0}},
    {"um", 1e-6, {1, 0, 0}},
    {"kg", 1, {0, 1, 0}},
    {"g", 1e-3, {0, 1, 0}},
    {"mg", 1e-6, {0, 1, 0}},
    {"t", 1e3, {0, 1, 0}},
    {"s", 1, {0, 0, 1}},
    {"ms", 1e-3, {0, 0, 1}},
    {"us", 1e-6, {0, 0, 1}},
    {"ns", 1e-9, {0, 0, 1}},
    {"min", 60, {0, 0, 1}},
    {"h", 3600, {0, 0, 1}},
    {"Hz", 1, {0, 0, -1}},
    {"rpm", pi / 30, {0, 0, -1}},
    {"N", 1, {1, 1, -2}},
    {"mN", 1e-3, {1, 1, -2}},
    {"kN", 1e3, {1, 1, -2}},
    {"MN", 1e6, {1, 1, -2}},
    {"Pa", 1, {-1, 1, -2}},
    {"kPa", 1e3, {-1, 1, -2}},
    {"MPa", 1e6, {-1, 1, -2}},
    {"GPa", 1e9, {-1, 1, -2}},
    {"J", 1, {2, 1, -2}},
    {"rad", 1, {}},
    {"deg", pi / 180, {}},
    {"%", 0.01, {}},
    {"1", 1, {}},
};

struct Declared {
    std::string_view symbol, example;
    Dimension dimension;
};

const Declared& declared(Unit unit) {
    static constexpr std::array<Declared, 17> table = {{{"", "0.5", {}},
                                                        {"m", "5 mm", {1, 0, 0}},
                                                        {"s", "2 ms", {0, 0, 1}},
                                                        {"rad", "30 deg", {}},
                                                        {"m/s", "10 cm/s", {1, 0, -1}},
                                                        {"rad/s", "60 rpm", {0, 0, -1}},
                                                        {"m/s^2", "9.81 m/s^2", {1, 0, -2}},
                                                        {"N/m", "10 kN/m", {0, 1, -2}},
                                                        {"kg/s", "3 g/s", {0, 1, -1}},
                                                        {"N m s", "1e-6 N m s", {2, 1, -1}},
                                                        {"N m", "1e-3 N m", {2, 1, -2}},
                                                        {"Pa", "100 MPa", {-1, 1, -2}},
                                                        {"kg/m^3", "2.5 g/cm^3", {-3, 1, 0}},
                                                        {"kg", "3 g", {0, 1, 0}},
                                                        {"1/s", "20 Hz", {0, 0, -1}},
                                                        {"J", "1e-6 J", {2, 1, -2}},
                                                        {"m^2/s^3", "0.01 m^2/s^3", {2, 0, -3}}}};
    return table[static_cast<std::size_t>(unit)];
}

// Reads "g/cm^3", "N s/m", "1/s": factors and dimension of a product of powers.
bool parse_unit(std::string_view text, bool angular, double& factor, Dimension& dimension) {
    factor = 1;
    int sign = 1;
    while (!text.empty()) {
        if (text.front() == ' ' || text.front() == '*') {
            text.remove_prefix(1);
            continue;
        }
        if (text.front() == '/') {
            sign = -1;
            text.remove_prefix(1);
            continue;
        }
        const std::size_t end = text.find_first_of(" */^");
        const std::string_view name = text.substr(0, end);
        text.remove_prefix(name.size());
        int power = 1;
        if (!text.empty() && text.front() == '^') {
            const auto [stop, error] = std::from_chars(text.data() + 1, text.data() + text.size(), power);
            if (error != std::errc{} || std::abs(power) > 9) return false;
            text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
        }
        const Named* found = nullptr;
        for (const Named& unit : units)
            if (unit.name == name) found = &unit;
        if (found == nullptr) return false;
        const int exponent = sign * power;
        factor *= std::pow(found->factor * (angular && name == "Hz" ? 2 * pi : 1), exponent);
        dimension.length += exponent * found->dimension.length;
        dimension.mass += exponent * found->dimension.mass;
        dimension.time += exponent * found->dimension.time;
        sign = 1;
    }
    return true;
}

} // namespace

std::string_view unit_symbol(Unit unit) {
    return declared(unit).symbol;
}

std::string parse_quantity(std::string_view text, Unit unit, double& value) {
    const Declared& wanted = declared(unit);
    const auto explain = [&] {
        return fmt::format("\"{}\" is not a {}; write a plain SI number or for example \"{}\"", text,
                           wanted.symbol.empty() ? "number" : fmt::format("quantity in {}", wanted.symbol),
                           wanted.example);
    };
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return explain();
    std::string_view rest = text.substr(static_cast<std::size_t>(stop - text.data()));
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    if (rest.empty()) return {};
    double factor = 1;
    Dimension dimension;
    if (!parse_unit(rest, unit == Unit::angular_speed, factor, dimension)) return explain();
    if (!(dimension == wanted.dimension)) return explain();
    value *= factor;
    return {};
}

} // namespace sandlane::scene
