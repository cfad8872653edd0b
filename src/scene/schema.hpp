// The schema: every key of a scene, once. A key is one line in schema.cpp, or schema_bodies.cpp for grains,
// walls and motions, that points at a member of a scene struct; parsing, ranges, units, the effective scene,
// help and the reference tables follow from it.
#pragma once

#include "scene/scene.hpp"
#include "scene/units.hpp"
#include "scene/value.hpp"

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::scene {

struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool open = false; // low itself is excluded

    [[nodiscard]] bool contains(double x) const { return (open ? x > low : x >= low) && x <= high; }
    [[nodiscard]] std::string text() const;
};

inline constexpr Range any{};
[[nodiscard]] constexpr Range positive() {
    return {0, std::numeric_limits<double>::infinity(), true};
}
[[nodiscard]] constexpr Range not_negative() {
    return {0, std::numeric_limits<double>::infinity(), false};
}
[[nodiscard]] constexpr Range between(double low, double high) {
    return {low, high, false};
}

inline constexpr Range dimensions = between(2, 3);

// One key of a table. Reading and writing know the dimension of the scene, 2 or 3: a vector has as many
// components.
template <class T> struct Field {
    std::string name, type, unit, range, doc;
    bool required = false;
    std::function<void(T&, const Value&, const std::string& path, std::int64_t dimension)> read;
    // TOML text of the value; empty: leave out.
    std::function<std::string(const T&, std::int64_t dimension)> write;
    std::string type_in_space{}; // in three dimensions; empty: the same
    std::int64_t only = 0;       // 2 or 3: a key of scenes of this dimension
    std::string instead{};       // what scenes of the other dimension use

    [[nodiscard]] bool exists(std::int64_t dimension) const { return only == 0 || only == dimension; }
    [[nodiscard]] const std::string& type_in(std::int64_t dimension) const {
        return dimension == 3 && !type_in_space.empty() ? type_in_space : type;
    }
};

// Spellings of the choices of an enum, in the order of its enumerators.
using Choices = std::vector<std::string_view>;

template <class T> class Table {
public:
    explicit Table(std::string doc) : doc_(std::move(doc)) {}

    Table& number(std::string name, double T::*member, Unit unit, Range range, std::string doc);
    Table& integer(std::string name, std::int64_t T::*member, Range range, std::string doc);
    Table& flag(std::string name, bool T::*member, std::string doc);
    Table& text(std::string name, std::string T::*member, std::string doc);
    Table& vector(std::string name, Vec T::*member, Unit unit, std::string doc);
    Table& vectors(std::string name, std::vector<Vec> T::*member, Unit unit, std::string doc);
    template <class E> Table& choice(std::string name, E T::*member, const Choices& choices, std::string doc);
    template <class E>
    Table& choices(std::string name, std::vector<E> T::*member, const Choices& choices, std::string doc);
    Table& custom(Field<T> field);
    // Of the last key:
    Table& required();
    Table& only(std::int64_t dimension, const std::string& instead = {});

    void read(T& object, const Value& value, const std::string& path, std::int64_t dimension) const;
    // One line for each key, or all of them in braces.
    [[nodiscard]] std::string write(const T& object, std::int64_t dimension) const;
    [[nodiscard]] std::string write_inline(const T& object, std::int64_t dimension) const;
    // Markdown. note: a sentence after what the table is for, or nothing.
    [[nodiscard]] std::string reference(const std::string& heading, const std::string& note = {}) const;
    [[nodiscard]] const std::vector<Field<T>>& fields() const { return fields_; }

private:
    [[nodiscard]] const Field<T>& find(const std::string& key, const Value& value, const std::string& path,
                                       std::int64_t dimension) const;
    // "key = value" of every key that has one.
    [[nodiscard]] std::vector<std::string> entries(const T& object, std::int64_t dimension) const;

    std::string doc_;
    std::vector<Field<T>> fields_;
};

// Choices that others spell too: the command line, outputs, messages.
const Choices& engine_choices();
const Choices& normal_choices();
const Choices& tangential_choices();
const Choices& wall_choices();
const Choices& neighbour_choices();
const Choices& colour_choices();
const Choices& trajectory_choices();

const Table<Domain>& domain_table();
const Table<Material>& material_table();
const Table<MaterialPair>& pair_table();
const Table<Grains>& grains_table();
const Table<GrainItem>& item_table();
const Table<Wall>& wall_table();
const Table<Sink>& sink_table();
const Table<Motion>& motion_table();
const Table<Md>& md_table();
const Table<Sandpile>& sandpile_table();
const Table<Heap>& heap_table();
const Table<Ripples>& ripples_table();
const Table<LatticeGas>& lattice_gas_table();
const Table<Obstacle>& obstacle_table();
const Table<PipeFlow>& pipe_flow_table();
const Table<Gas>& gas_table();
const Table<GasSide>& side_table();
const Table<Dsmc>& dsmc_table();
const Table<Species>& species_table();
const Table<GasPair>& gas_pair_table();
const Table<Edmd>& edmd_table();
const Table<CurvedWall>& curved_wall_table();
const Table<Watch>& watch_table();
const Table<AnalysisSpec>& analysis_table();
const Table<Output>& output_table();
const Table<Scene>& scene_table(); // the keys outside any table

// Throws Error(invalid_input) "origin: path: message".
[[noreturn]] void fail_at(const Value& value, const std::string& path, const std::string& message);
[[noreturn]] void fail_unknown(const Value& value, const std::string& path,
                               const std::vector<std::string>& known);

// What one key cannot know alone, by the engine of the scene. Throws Error(invalid_input).
void validate(const Scene& scene, const std::string& file);
#define ENGINE(choice, name, what) void validate_##choice(const Scene& scene, const std::string& file);
#include "scene/engines.def"
// Of md.accuracy, and of [watch].
void check_accuracy(const Scene& scene, const std::string& file);
void check_watch(const Scene& scene, const std::string& file);

} // namespace sandlane::scene
