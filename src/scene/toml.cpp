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

} // namespace

Value parse_toml(const std::string& text, const std::string& file) {
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
