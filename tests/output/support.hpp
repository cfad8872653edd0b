// What the tests of outputs share: whole folders as values, lines and words of files, errors as values.
#pragma once

#include "core/error.hpp"
#include "core/file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::output {

// Path inside the folder -> content, for every file.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
    return files;
}

inline std::vector<std::string> lines_of(const std::filesystem::path& path) {
    std::istringstream stream(read_file(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

inline std::vector<std::string> words_of(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

// The numbers of a line, read by the C library and not by our own code.
inline std::vector<double> numbers_of(const std::string& line) {
    std::vector<double> numbers;
    for (const std::string& word : words_of(line)) numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
}

// The message of the Error with this code that the action throws.
template <class Action> std::string refusal(Exit code, const Action& action) {
    try {
        action();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), code) << e.what();
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

inline bool has(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

} // namespace sandlane::output
