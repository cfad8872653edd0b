// How each type of key is read, checked, written and documented: the member templates of Table.
#pragma once

#include "core/error.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::scene {

[[nodiscard]] double read_number(const Value& value, const std::string& path, Unit unit, const Range& range);
[[nodiscard]] std::int64_t read_integer(const Value& value, const std::string& path, const Range& range);
[[nodiscard]] std::string read_text(const Value& value, const std::string& path);
[[nodiscard]] Vec read_vector(const Value& value, const std::string& path, Unit unit);
[[nodiscard]] int read_choice(const Value& value, const std::string& path, const Choices& choices);
[[nodiscard]] std::string quoted(std::string_view text);
[[nodiscard]] std::string written(double value);
[[nodiscard]] std::string written(Vec value);
[[nodiscard]] std::string joined(const std::vector<std::string>& items);

template <class T> Table<T>& Table<T>::custom(Field<T> field) {
    fields_.push_back(std::move(field));
    return *this;
}
template <class T> Table<T>& Table<T>::required() {
    fields_.back().required = true;
    return *this;
}
template <class T>
Table<T>& Table<T>::number(std::string name, double T::*member, Unit unit, Range range, std::string doc) {
    return custom({std::move(name), "number", std::string(unit_symbol(unit)), range.text(), std::move(doc),
                   false,
                   [=](T& t, const Value& v, const std::string& path) {
                       t.*member = read_number(v, path, unit, range);
                   },
                   [=](const T& t) { return written(t.*member); }});
}
template <class T>
Table<T>& Table<T>::integer(std::string name, std::int64_t T::*member, Range range, std::string doc) {
    return custom(
        {std::move(name), "integer", "", range.text(), std::move(doc), false,
         [=](T& t, const Value& v, const std::string& path) { t.*member = read_integer(v, path, range); },
         [=](const T& t) { return fmt::format("{}", t.*member); }});
}
template <class T> Table<T>& Table<T>::flag(std::string name, bool T::*member, std::string doc) {
    return custom({std::move(name), "true or false", "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path) {
                       if (v.kind != Value::Kind::flag) fail_at(v, path, "must be true or false");
                       t.*member = v.flag;
                   },
                   [=](const T& t) { return std::string(t.*member ? "true" : "false"); }});
}
template <class T> Table<T>& Table<T>::text(std::string name, std::string T::*member, std::string doc) {
    return custom({std::move(name), "text", "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path) { t.*member = read_text(v, path); },
                   [=](const T& t) { return quoted(t.*member); }});
}
template <class T> Table<T>& Table<T>::vector(std::string name, Vec T::*member, Unit unit, std::string doc) {
    return custom(
        {std::move(name), "[x, y]", std::string(unit_symbol(unit)), "", std::move(doc), false,
         [=](T& t, const Value& v, const std::string& path) { t.*member = read_vector(v, path, unit); },
         [=](const T& t) { return written(t.*member); }});
}
template <class T>
Table<T>& Table<T>::vectors(std::string name, std::vector<Vec> T::*member, Unit unit, std::string doc) {
    return custom(
        {std::move(name), "list of [x, y]", std::string(unit_symbol(unit)), "", std::move(doc), false,
         [=](T& t, const Value& v, const std::string& path) {
             if (v.kind != Value::Kind::array) fail_at(v, path, "must be a list of points [[x, y], ...]");
             (t.*member).clear();
             for (std::size_t n = 0; n < v.items.size(); ++n)
                 (t.*member).push_back(read_vector(v.items[n], fmt::format("{}[{}]", path, n), unit));
         },
         [=](const T& t) {
             std::vector<std::string> items;
             for (const Vec& p : t.*member) items.push_back(written(p));
             return items.empty() ? std::string() : joined(items);
         }});
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
                   [=](T& t, const Value& v, const std::string& path) {
                       t.*member = static_cast<E>(read_choice(v, path, choices));
                   },
                   [=](const T& t) { return quoted(choices[static_cast<std::size_t>(t.*member)]); }});
}
template <class T>
template <class E>
Table<T>& Table<T>::choices(std::string name, std::vector<E> T::*member, const Choices& choices,
                            std::string doc) {
    return custom({std::move(name), "list of " + choice_type(choices), "", "", std::move(doc), false,
                   [=](T& t, const Value& v, const std::string& path) {
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
                   [=](const T& t) {
                       std::vector<std::string> items;
                       for (const E e : t.*member)
                           items.push_back(quoted(choices[static_cast<std::size_t>(e)]));
                       return joined(items);
                   }});
}

template <class T> void Table<T>::read(T& object, const Value& value, const std::string& path) const {
    if (value.kind != Value::Kind::table) fail_at(value, path, "must be a table");
    const std::string prefix = path.empty() ? "" : path + ".";
    for (const auto& [key, item] : value.members) {
        const Field<T>* found = nullptr;
        for (const Field<T>& field : fields_)
            if (field.name == key) found = &field;
        if (found == nullptr) {
            std::vector<std::string> known;
            for (const Field<T>& field : fields_) known.push_back(field.name);
            fail_unknown(item, prefix + key, known);
        }
        found->read(object, item, prefix + key);
    }
    for (const Field<T>& field : fields_)
        if (field.required && value.find(field.name) == nullptr)
            fail_at(value, prefix + field.name,
                    fmt::format("is missing; it is required ({}: {})", field.type, field.doc));
}

template <class T> std::string Table<T>::write(const T& object) const {
    std::string text;
    for (const Field<T>& field : fields_)
        if (const std::string value = field.write(object); !value.empty())
            text += fmt::format("{} = {}\n", field.name, value);
    return text;
}

template <class T> std::string Table<T>::reference(const std::string& heading) const {
    std::string text = fmt::format(
        "## `{}`\n\n{}\n\n| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n",
        heading, doc_);
    const T defaults{};
    for (const Field<T>& field : fields_) {
        const std::string value = field.required ? "required" : field.write(defaults);
        text +=
            fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", field.name, field.type, field.unit,
                        value.empty() || field.required ? value : "`" + value + "`", field.range, field.doc);
    }
    return text + "\n";
}

} // namespace sandlane::scene
