#include "scene/reader.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/fields.hpp"

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

template <class T>
void read_list(std::vector<T>& list, const Table<T>& table, const Value& value, const std::string& name,
               std::int64_t dimension) {
    if (value.kind != Value::Kind::array)
        fail_at(value, name, fmt::format("must be a list of tables: write [[{}]]", name));
    for (std::size_t n = 0; n < value.items.size(); ++n)
        table.read(list.emplace_back(), value.items[n], fmt::format("{}[{}]", name, n), dimension);
}

Scene scene_from(const Value& root) {
    Scene scene;
    const std::int64_t dimension = dimension_of(root);
    if (dimension == 3) scene.md.inertia = Inertia::sphere; // the default
    Value rest = root;
    rest.members.clear();
    for (const auto& [key, value] : root.members) {
        if (key == "domain")
            domain_table().read(scene.domain, value, key, dimension);
        else if (key == "materials")
            read_list(scene.materials, material_table(), value, key, dimension);
        else if (key == "pairs")
            read_list(scene.pairs, pair_table(), value, key, dimension);
        else if (key == "grains")
            read_list(scene.grains, grains_table(), value, key, dimension);
        else if (key == "walls")
            read_list(scene.walls, wall_table(), value, key, dimension);
        else if (key == "sinks")
            read_list(scene.sinks, sink_table(), value, key, dimension);
        else if (key == "motions")
            read_list(scene.motions, motion_table(), value, key, dimension);
        else if (key == "md")
            md_table().read(scene.md, value, key, dimension);
        else if (key == "analysis")
            read_list(scene.analyses, analysis_table(), value, key, dimension);
        else if (key == "output")
            output_table().read(scene.output, value, key, dimension);
        else
            rest.members.push_back({key, value});
    }
    std::vector<std::string> known = {"domain", "materials", "pairs", "grains",   "walls",
                                      "sinks",  "motions",   "md",    "analysis", "output"};
    for (const Field<Scene>& field : scene_table().fields()) known.push_back(field.name);
    for (const auto& [key, value] : rest.members) {
        bool found = false;
        for (const std::string& k : known) found = found || k == key;
        if (!found) fail_unknown(value, key, known);
    }
    scene_table().read(scene, rest, "", dimension);
    if (root.find("domain") == nullptr)
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
    const std::int64_t dimension = scene.domain.dimension;
    std::string text = scene_table().write(scene, dimension);
    text += "\n[domain]\n" + domain_table().write(scene.domain, dimension);
    write_list(text, "materials", material_table(), scene.materials, dimension);
    write_list(text, "pairs", pair_table(), scene.pairs, dimension);
    write_list(text, "grains", grains_table(), scene.grains, dimension);
    write_list(text, "walls", wall_table(), scene.walls, dimension);
    write_list(text, "sinks", sink_table(), scene.sinks, dimension);
    write_list(text, "motions", motion_table(), scene.motions, dimension);
    text += "\n[md]\n" + md_table().write(scene.md, dimension);
    write_list(text, "analysis", analysis_table(), scene.analyses, dimension);
    text += "\n[output]\n" + output_table().write(scene.output, dimension);
    return text;
}

} // namespace sandlane::scene
