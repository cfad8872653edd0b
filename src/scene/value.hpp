// A parsed file as a tree of values that know where they stand, so that every message can name file and line.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::scene {

struct Value {
    enum class Kind { flag, integer, number, text, array, table };
    Kind kind = Kind::table;
    bool flag = false;
    std::int64_t integer = 0;
    double number = 0;
    std::string text;
    std::vector<Value> items;                           // array
    std::vector<std::pair<std::string, Value>> members; // table, in the order of the file
    std::string origin;                                 // "heap.toml:14" or "--set md.dt"

    [[nodiscard]] const Value* find(const std::string& key) const {
        for (const auto& [name, value] : members)
            if (name == key) return &value;
        return nullptr;
    }
    [[nodiscard]] Value* find(const std::string& key) {
        for (auto& [name, value] : members)
            if (name == key) return &value;
        return nullptr;
    }
    [[nodiscard]] bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
    [[nodiscard]] double as_number() const {
        return kind == Kind::integer ? static_cast<double>(integer) : number;
    }
};

// Throws Error(invalid_input) for a syntax error or a duplicated key, with file and line.
[[nodiscard]] Value parse_toml(const std::string& text, const std::string& file);

} // namespace sandlane::scene
