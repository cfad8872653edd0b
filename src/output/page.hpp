// The files of src/output/page, embedded at build time by CMake (page.cpp.in).
#pragma once

#include <string_view>

namespace sandlane::output {

extern const std::string_view page_html, page_css, page_script;

} // namespace sandlane::output
