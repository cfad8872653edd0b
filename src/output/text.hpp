// Numbers as text: shortest form that reads back to the same bits, independent of the locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sandlane::output {

void append(std::string& text, double value);
void append(std::string& text, std::int64_t value);

// Appends the values, each followed by a blank.
template <class... Values> void append_numbers(std::string& text, Values... values) {
    ((append(text, values), text += ' '), ...);
}
// Appends the values separated by blanks, and a line end.
template <class... Values> void append_line(std::string& text, Values... values) {
    append_numbers(text, values...);
    text.back() = '\n';
}

// Reads a whole number or a real number that fills `text`; false if it does not.
[[nodiscard]] bool read_number(std::string_view text, double& value);
[[nodiscard]] bool read_number(std::string_view text, std::int64_t& value);

} // namespace sandlane::output
