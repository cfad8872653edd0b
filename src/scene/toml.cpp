// The only file that knows toml++: TOML text to a tree of values with their lines.
#include "core/error.hpp"
#include "scene/value.hpp"

#include <toml++/toml.h>

namespace sandlane::scene {

namespace {

Value convert(const toml::node& node, const std::string& file, std::uint32_t parent_line) {
    Value v;
    const std::uint32_t line = node.source().begin.line != 0 ? node.source().begin.line : parent_line;
    v.origin = line != 0 ? fmt::format("{}:{}", file, line) : file;
    if (const auto* table = node.as_table()) {
        for (const auto& [key, item] : *table)
            v.members.push_back({std::string(key.str()), convert(item, file, line)});
    } else if (const auto* array = node.as_array()) {
        v.kind = Value::Kind::array;
        for (const toml::node& item : *array) v.items.push_back(convert(item, file, line));
    } else if (const auto* flag = node.as_boolean()) {
        v.kind = Value::Kind::flag;
        v.flag = flag->get();
    } else if (const auto* integer = node.as_integer()) {
        v.kind = Value::Kind::integer;
        v.integer = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
        v.kind = Value::Kind::number;
        v.number = number->get();
    } else if (const auto* text = node.as_string()) {
        v.kind = Value::Kind::text;
        v.text = text->get();
    } else {
        fail(Exit::invalid_input, "{}: dates and times have no meaning in a scene", v.origin);
    }
    return v;
}

// toml++ limits the depth of values but not of dotted keys, for which it recurses too.
void check_depth_of_keys(std::string_view text, const std::string& file) {
    constexpr int deepest = 100;
    int line = 1, parts = 1;
    bool in_text = false;
    char last = '\n';
    for (const char c : text) {
        if (c == '\n') {
            ++line;
            in_text = false;
        }
        if (c == '"' && last != '\\') in_text = !in_text;
        if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) parts = 1;
        if (c == '.' && last != '.' && !in_text && ++parts > deepest)
            fail(Exit::invalid_input, "{}:{}: a key of more than {} parts", file, line, deepest);
        last = c;
    }
}

} // namespace

Value parse_toml(const std::string& text, const std::string& file) {
    check_depth_of_keys(text, file);
    try {
        const toml::table table = toml::parse(text, file);
        Value root = convert(table, file, 0);
        root.origin = file;
        return root;
    } catch (const toml::parse_error& e) {
        fail(Exit::invalid_input, "{}:{}:{}: syntax error: {}", file, e.source().begin.line,
             e.source().begin.column, e.description());
    }
}

} // namespace sandlane::scene
