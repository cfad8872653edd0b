// Text inside the report: nothing that comes from a scene can become markup or script.
#pragma once

#include <string>
#include <string_view>

namespace sandlane::output {

[[nodiscard]] std::string html_text(std::string_view text); // for elements and quoted attributes
// A JSON string with its quotes, harmless inside <script>: no "<" stays.
[[nodiscard]] std::string json_text(std::string_view text);
// Nine digits; null where JSON has no number for it.
[[nodiscard]] std::string json_number(double value);
[[nodiscard]] std::string base64(std::string_view bytes);

} // namespace sandlane::output
