#include "output/text.hpp"

#include <array>
#include <charconv>
#include <system_error>

namespace sandlane::output {

namespace {

template <class Number> void append_number(std::string& text, Number value) {
    std::array<char, 40> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end);
}

template <class Number> bool parse_number(std::string_view text, Number& value) {
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc{} && end == text.data() + text.size();
}

} // namespace

void append(std::string& text, double value) {
    append_number(text, value);
}
void append(std::string& text, std::int64_t value) {
    append_number(text, value);
}
bool read_number(std::string_view text, double& value) {
    return parse_number(text, value);
}
bool read_number(std::string_view text, std::int64_t& value) {
    return parse_number(text, value);
}

} // namespace sandlane::output
