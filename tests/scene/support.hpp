// What scene tests share: the text of a small valid scene, and errors as values.
#pragma once

#include "core/error.hpp"
#include "scene/reader.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>

#include <string>

namespace sandlane::scene {

inline const std::string domain_text = "[domain]\nlower = [0, 0]\nupper = [1, 1]\n";
inline const std::string material_text = "[[materials]]\nname = \"glass\"\nyoung = 1e8\n";

// Line 1 of `rest` is line 7 of the file.
inline std::string scene_text(const std::string& rest) {
    return domain_text + material_text + rest;
}

inline Scene scene_with(const std::string& rest, const Overrides& overrides = {}) {
    return parse_scene(scene_text(rest), "test.toml", overrides);
}

// The message of the Error(invalid_input) that the action throws.
template <class Action> std::string refusal(const Action& action) {
    try {
        action();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::invalid_input) << e.what();
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

inline std::string refusal_of(const std::string& text, const Overrides& overrides = {}) {
    return refusal([&] { (void)parse_scene(text, "test.toml", overrides); });
}

} // namespace sandlane::scene
