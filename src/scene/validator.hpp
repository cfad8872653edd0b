// What the checks of all scenes share: how they refuse, and the domain.
#pragma once

#include "core/error.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace sandlane::scene {

struct Validator {
    const Scene& scene;
    const std::string& file;

    // Throws Error(invalid_input) that names the file.
    template <class... Args>
    [[noreturn]] void reject(fmt::format_string<Args...> format, Args&&... args) const {
        fail(Exit::invalid_input, "{}: {}", file, fmt::format(format, std::forward<Args>(args)...));
    }

    void check_domain() const;
    // Whether domain.shear_rate, if there is one, is a number and goes with periods and gravity.
    void check_shear() const;
};

} // namespace sandlane::scene
