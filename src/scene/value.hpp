// A parsed file as a tree of values that know where they stand, so that every message can name file and line.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::scene {

struct Member;

struct Value {
    enum class Kind { flag, integer, number, text, array, table };
    Kind kind = Kind::table;
    bool flag = false;
    std::int64_t integer = 0;
    double number = 0;
    std::string text;
    std::vector<Value> items;    // array
    std::vector<Member> members; // table, in the order of the file
    std::string origin;          // "heap.toml:14" or "--set md.dt"

    // The member of a table; null if it has none of that name.
    [[nodiscard]] const Value* find(const std::string& key) const;
    [[nodiscard]] Value* find(const std::string& key);
    [[nodiscard]] bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
    [[nodiscard]] double as_number() const {
        return kind == Kind::integer ? static_cast<double>(integer) : number;
    }
};

struct Member {
    std::string name;
    Value value;
};

inline const Value* Value::find(const std::string& key) const {
    for (const auto& [name, value] : members)
        if (name == key) return &value;
    return nullptr;
}

inline Value* Value::find(const std::string& key) {
    return const_cast<Value*>(std::as_const(*this).find(key));
}

// Throws Error(invalid_input) for a syntax error or a duplicated key, with file and line.
[[nodiscard]] Value parse_toml(const std::string& text, const std::string& file);

} // namespace sandlane::scene
