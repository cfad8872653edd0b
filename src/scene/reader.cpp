#include "scene/reader.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/fields.hpp"

#include <algorithm>
#include <charconv>

namespace sandlane::scene {

namespace {

// ---- overrides

std::vector<std::string> split_path(const std::string& path) {
    std::vector<std::string> parts(1);
    for (const char c : path)
        if (c == '.' || c == '[' || c == ']') {
            if (!parts.back().empty()) parts.emplace_back();
        } else {
            parts.back() += c;
        }
    if (parts.back().empty()) parts.pop_back();
    return parts;
}

void set_origin(Value& value, const std::string& origin) {
    value.origin = origin;
    for (Value& item : value.items) set_origin(item, origin);
    for (auto& [name, member] : value.members) set_origin(member, origin);
}

// The right-hand side is TOML; a bare word that is not TOML is a text.
Value override_value(const std::string& text, const std::string& origin) {
    Value table;
    try {
        table = parse_toml("value = " + text + "\n", origin);
    } catch (const Error&) {
        table = {};
    }
    if (table.members.size() != 1) table = parse_toml("value = " + scene::quoted(text) + "\n", origin);
    Value value = std::move(table.members.front().value);
    set_origin(value, origin);
    return value;
}

void apply_override(Value& root, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        fail(Exit::invalid_input,
             "--set {}: must be path=value, for example md.dt=1e-6 or materials.0.friction=0.3", text);
    const std::string path = text.substr(0, equals), origin = "--set " + path;
    Value* at = &root;
    for (const std::string& part : split_path(path)) {
        if (at->kind == Value::Kind::array) {
            std::size_t index = 0;
            const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), index);
            if (error != std::errc{} || stop != part.data() + part.size() || index >= at->items.size())
                fail(Exit::invalid_input, "{}: \"{}\" is not an entry of the list; allowed: 0 to {}", origin,
                     part, static_cast<std::int64_t>(at->items.size()) - 1);
            at = &at->items[index];
            continue;
        }
        if (at->kind != Value::Kind::table)
            fail(Exit::invalid_input, "{}: there is nothing below \"{}\"", origin, part);
        if (at->find(part) == nullptr) {
            at->members.push_back({part, Value{}});
            at->members.back().value.origin = origin;
        }
        at = at->find(part);
    }
    *at = override_value(text.substr(equals + 1), origin);
}

// ---- from the tree to the structs

// Vectors cannot be read without it.
std::int64_t dimension_of(const Value& root) {
    Domain domain;
    if (const Value* table = root.find("domain"); table != nullptr)
        if (const Value* value = table->find("dimension"); value != nullptr)
            domain.dimension = read_integer(*value, "domain.dimension", dimensions);
    return domain.dimension;
}

// Which tables are read depends on it.
Engine method_of(const Value& root) {
    const Value* value = root.find("method");
    return value == nullptr ? Engine::md
                            : static_cast<Engine>(read_choice(*value, "method", engine_choices()));
}

// "md" or "edmd", for messages.
std::string names_of(EngineSet engines) {
    std::string names;
    for (std::size_t n = 0; n < engine_choices().size(); ++n)
        if (engines.contains(static_cast<Engine>(n)))
            names += fmt::format("{}\"{}\"", names.empty() ? "" : " or ", engine_choices()[n]);
    return names;
}

void check_engine(Engine method, EngineSet readers, const Value& value, const std::string& table) {
    if (readers.contains(method)) return;
    fail_at(value, table,
            fmt::format("is not read by method = \"{}\"; it goes with method = {}",
                        engine_choices()[static_cast<std::size_t>(method)], names_of(readers)));
}

template <class T>
void read_list(std::vector<T>& list, const Table<T>& table, const Value& value, const std::string& name,
               std::int64_t dimension) {
    if (value.kind != Value::Kind::array)
        fail_at(value, name, fmt::format("must be a list of tables: write [[{}]]", name));
    for (std::size_t n = 0; n < value.items.size(); ++n)
        table.read(list.emplace_back(), value.items[n], fmt::format("{}[{}]", name, n), dimension);
}

// False if the scene has no table of this name.
bool read_table(Scene& scene, const std::string& key, const Value& value, std::int64_t dimension) {
    using enum Engine;
#define TABLE(member, name, table, engines)                                                                  \
    if (key == (name)) {                                                                                     \
        check_engine(scene.method, engines, value, key);                                                     \
        table().read(scene.member, value, key, dimension);                                                   \
        return true;                                                                                         \
    }
#define LIST(member, name, table, engines)                                                                   \
    if (key == (name)) {                                                                                     \
        check_engine(scene.method, engines, value, key);                                                     \
        read_list(scene.member, table(), value, key, dimension);                                             \
        return true;                                                                                         \
    }
#include "scene/engines.def"
    return false;
}

// What may stand outside any table: the tables that the engine reads, and keys.
std::vector<std::string> known_names(Engine method) {
    using enum Engine;
    std::vector<std::string> known;
#define TABLE(member, name, table, engines)                                                                  \
    if (EngineSet(engines).contains(method)) known.emplace_back(name);
#define LIST(member, name, table, engines) TABLE(member, name, table, engines)
#include "scene/engines.def"
    for (const Field<Scene>& field : scene_table().fields()) known.push_back(field.name);
    return known;
}

bool reads_domain(Engine method) {
    const std::vector<std::string> known = known_names(method);
    return std::find(known.begin(), known.end(), "domain") != known.end();
}

Scene scene_from(const Value& root) {
    Scene scene;
    scene.method = method_of(root);
    const std::int64_t dimension = dimension_of(root);
    if (dimension == 3) scene.md.inertia = Inertia::sphere; // the default
    Value rest = root;
    rest.members.clear();
    for (const auto& [key, value] : root.members)
        if (!read_table(scene, key, value, dimension)) rest.members.push_back({key, value});
    const std::vector<std::string> known = known_names(scene.method);
    for (const auto& [key, value] : rest.members)
        if (std::find(known.begin(), known.end(), key) == known.end()) fail_unknown(value, key, known);
    scene_table().read(scene, rest, "", dimension);
    if (reads_domain(scene.method) && root.find("domain") == nullptr)
        fail_at(root, "domain", "is missing; write [domain] with lower and upper");
    return scene;
}

template <class T>
void write_list(std::string& text, const char* name, const Table<T>& table, const std::vector<T>& list,
                std::int64_t dimension) {
    for (const T& entry : list) text += fmt::format("\n[[{}]]\n{}", name, table.write(entry, dimension));
}

} // namespace

Scene parse_scene(std::string_view text, const std::string& name, const Overrides& overrides) {
    Value root = parse_toml(std::string(text), name);
    for (const std::string& override_text : overrides) apply_override(root, override_text);
    Scene scene = scene_from(root);
    validate(scene, name);
    return scene;
}

Scene read_scene(const std::filesystem::path& path, const Overrides& overrides) {
    Scene scene = parse_scene(read_file(path), path.string(), overrides);
    const auto find = [&](std::string& file, const char* list, std::size_t n) {
        if (file.empty()) return;
        const std::string given = file;
        file = std::filesystem::absolute(path.parent_path() / file).lexically_normal().string();
        std::error_code unreadable;
        if (!std::filesystem::exists(file, unreadable))
            fail(
                Exit::invalid_input,
                "{}: {}[{}].file: \"{}\" does not exist; a name is relative to the folder of the scene file, "
                "so this is {}",
                path.string(), list, n, given, file);
    };
    // Absolute names: a checkpoint is continued from another folder.
    for (std::size_t n = 0; n < scene.grains.size(); ++n) find(scene.grains[n].file, "grains", n);
    for (std::size_t n = 0; n < scene.walls.size(); ++n) find(scene.walls[n].file, "walls", n);
    return scene;
}

std::string write_scene(const Scene& scene) {
    using enum Engine;
    const std::int64_t dimension = scene.domain.dimension;
    std::string text = scene_table().write(scene, dimension);
#define TABLE(member, name, table, engines)                                                                  \
    if (EngineSet(engines).contains(scene.method))                                                           \
        text += "\n[" name "]\n" + table().write(scene.member, dimension);
#define LIST(member, name, table, engines)                                                                   \
    if (EngineSet(engines).contains(scene.method)) write_list(text, name, table(), scene.member, dimension);
#include "scene/engines.def"
    return text;
}

} // namespace sandlane::scene
