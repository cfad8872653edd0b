// How each type of key is read, checked, written and documented: the member templates of Table.
#pragma once

#include "core/error.hpp"
#include "scene/schema.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::scene {

[[nodiscard]] double read_number(const Value& value, const std::string& path, Unit unit, const Range& range);
[[nodiscard]] std::int64_t read_integer(const Value& value, const std::string& path, const Range& range);
[[nodiscard]] std::string read_text(const Value& value, const std::string& path);
[[nodiscard]] Vec read_vector(const Value& value, const std::string& path, Unit unit, std::int64_t dimension);
[[nodiscard]] constexpr std::string_view vector_form(std::int64_t dimension) {
    return dimension == 3 ? "[x, y, z]" : "[x, y]";
}
[[nodiscard]] int read_choice(const Value& value, const std::string& path, const Choices& choices);
[[nodiscard]] std::string quoted(std::string_view text);
[[nodiscard]] std::string written(double value);
[[nodiscard]] std::string written(Vec value, std::int64_t dimension);
[[nodiscard]] std::string joined(const std::vector<std::string>& items);

// A key of scenes of the other dimension; `instead`: what this one has in its place.
[[noreturn]] void fail_wrong_dimension(const Value& value, const std::string& path, std::int64_t dimension,
                                       const std::string& instead);

template <class T> Table<T>& Table<T>::custom(Field<T> field) {
    fields_.push_back(std::move(field));
    return *this;
}
template <class T> Table<T>& Table<T>::required() {
    fields_.back().required = true;
    return *this;
}
template <class T> Table<T>& Table<T>::only(std::int64_t dimension, const std::string& instead) {
    fields_.back().only = dimension;
    fields_.back().instead = instead;
    return *this;
}
template <class T>
Table<T>& Table<T>::number(std::string name, double T::*member, Unit unit, Range range, std::string doc) {
    return custom({std::move(name), "number", std::string(unit_symbol(unit)), range.text(), std::move(doc),
                   false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t) {
                       t.*member = read_number(v, path, unit, range);
                   },
                   [=](const T& t, std::int64_t) { return written(t.*member); }});
}
template <class T>
Table<T>& Table<T>::integer(std::string name, std::int64_t T::*member, Range range, std::string doc) {
    return custom({std::move(name), "integer", "", range.text(), std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t) {
                       t.*member = read_integer(v, path, range);
                   },
                   [=](const T& t, std::int64_t) { return fmt::format("{}", t.*member); }});
}
template <class T> Table<T>& Table<T>::flag(std::string name, bool T::*member, std::string doc) {
    return custom({std::move(name), "true or false", "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t) {
                       if (v.kind != Value::Kind::flag) fail_at(v, path, "must be true or false");
                       t.*member = v.flag;
                   },
                   [=](const T& t, std::int64_t) { return std::string(t.*member ? "true" : "false"); }});
}
template <class T> Table<T>& Table<T>::text(std::string name, std::string T::*member, std::string doc) {
    return custom(
        {std::move(name), "text", "", "", std::move(doc), false,
         [=](T& t, const Value& v, const std::string& path, std::int64_t) { t.*member = read_text(v, path); },
         [=](const T& t, std::int64_t) { return scene::quoted(t.*member); }});
}
template <class T> Table<T>& Table<T>::vector(std::string name, Vec T::*member, Unit unit, std::string doc) {
    return custom({std::move(name), std::string(vector_form(2)), std::string(unit_symbol(unit)), "",
                   std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t dimension) {
                       t.*member = read_vector(v, path, unit, dimension);
                   },
                   [=](const T& t, std::int64_t dimension) { return written(t.*member, dimension); },
                   std::string(vector_form(3))});
}
template <class T>
Table<T>& Table<T>::vectors(std::string name, std::vector<Vec> T::*member, Unit unit, std::string doc) {
    return custom({std::move(name), fmt::format("list of {}", vector_form(2)), std::string(unit_symbol(unit)),
                   "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t dimension) {
                       if (v.kind != Value::Kind::array)
                           fail_at(v, path,
                                   fmt::format("must be a list of points [{}, ...]", vector_form(dimension)));
                       (t.*member).clear();
                       for (std::size_t n = 0; n < v.items.size(); ++n)
                           (t.*member).push_back(
                               read_vector(v.items[n], fmt::format("{}[{}]", path, n), unit, dimension));
                   },
                   [=](const T& t, std::int64_t dimension) {
                       std::vector<std::string> items;
                       for (const Vec& p : t.*member) items.push_back(written(p, dimension));
                       return items.empty() ? std::string() : joined(items);
                   },
                   fmt::format("list of {}", vector_form(3))});
}

[[nodiscard]] inline std::string choice_type(const Choices& choices) {
    std::string type;
    for (const std::string_view c : choices) type += fmt::format("{}`\"{}\"`", type.empty() ? "" : ", ", c);
    return type;
}

template <class T>
template <class E>
Table<T>& Table<T>::choice(std::string name, E T::*member, const Choices& choices, std::string doc) {
    return custom({std::move(name), choice_type(choices), "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t) {
                       t.*member = static_cast<E>(read_choice(v, path, choices));
                   },
                   [=](const T& t, std::int64_t) {
                       return scene::quoted(choices[static_cast<std::size_t>(t.*member)]);
                   }});
}
template <class T>
template <class E>
Table<T>& Table<T>::choices(std::string name, std::vector<E> T::*member, const Choices& choices,
                            std::string doc) {
    return custom({std::move(name), "list of " + choice_type(choices), "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path, std::int64_t) {
                       if (v.kind != Value::Kind::array)
                           fail_at(v, path, "must be a list of " + choice_type(choices));
                       (t.*member).clear();
                       for (const Value& item : v.items) {
                           const E chosen = static_cast<E>(read_choice(item, path, choices));
                           if (std::count((t.*member).begin(), (t.*member).end(), chosen) > 0)
                               fail_at(item, path, fmt::format("\"{}\" is there twice", item.text));
                           (t.*member).push_back(chosen);
                       }
                   },
                   [=](const T& t, std::int64_t) {
                       std::vector<std::string> items;
                       for (const E e : t.*member)
                           items.push_back(scene::quoted(choices[static_cast<std::size_t>(e)]));
                       return joined(items);
                   }});
}

template <class T>
const Field<T>& Table<T>::find(const std::string& key, const Value& value, const std::string& path,
                               std::int64_t dimension) const {
    for (const Field<T>& field : fields_) {
        if (field.name != key) continue;
        if (!field.exists(dimension)) fail_wrong_dimension(value, path, dimension, field.instead);
        return field;
    }
    std::vector<std::string> known;
    for (const Field<T>& field : fields_)
        if (field.exists(dimension)) known.push_back(field.name);
    fail_unknown(value, path, known);
}

template <class T>
void Table<T>::read(T& object, const Value& value, const std::string& path, std::int64_t dimension) const {
    if (value.kind != Value::Kind::table) fail_at(value, path, "must be a table");
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const auto& [key, item] : value.members)
        find(key, item, prefix + key, dimension).read(object, item, prefix + key, dimension);
    for (const Field<T>& field : fields_)
        if (field.required && value.find(field.name) == nullptr)
            fail_at(value, prefix + field.name,
                    fmt::format("is missing; it is required ({}: {})", field.type_in(dimension), field.doc));
}

template <class T> std::vector<std::string> Table<T>::entries(const T& object, std::int64_t dimension) const {
    std::vector<std::string> entries;
    for (const Field<T>& field : fields_) {
        if (!field.exists(dimension)) continue;
        if (const std::string value = field.write(object, dimension); !value.empty())
            entries.push_back(fmt::format("{} = {}", field.name, value));
    }
    return entries;
}

template <class T> std::string Table<T>::write(const T& object, std::int64_t dimension) const {
    std::string text;
    for (const std::string& entry : entries(object, dimension)) text += entry + "\n";
    return text;
}

template <class T> std::string Table<T>::write_inline(const T& object, std::int64_t dimension) const {
    return fmt::format("{{ {} }}", fmt::join(entries(object, dimension), ", "));
}

template <class T>
std::string Table<T>::reference(const std::string& heading, const std::string& note) const {
    std::string text = fmt::format("## `{}`\n\n{}{}{}\n\n| key | type | unit | default | allowed | meaning "
                                   "|\n|---|---|---|---|---|---|\n",
                                   heading, doc_, note.empty() ? "" : " ", note);
    const T defaults{};
    for (const Field<T>& field : fields_) {
        const std::int64_t dimension = field.only == 3 ? 3 : 2;
        const std::string value = field.required ? "required" : field.write(defaults, dimension);
        text += fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", field.name, field.type_in(dimension),
                            field.unit, value.empty() || field.required ? value : "`" + value + "`",
                            field.range, field.only == 0 ? "" : fmt::format("{}D: ", field.only), field.doc);
    }
    return text + "\n";
}

} // namespace sandlane::scene
