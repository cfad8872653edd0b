// What the cellular automata have in common, for the program: steps, state, and what can be told of it.
#pragma once

#include "analysis/field.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "scene/scene.hpp"
#include "simd/automata/tables.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::automata {

using analysis::Field;
using analysis::Table;

// A number per site, for comparisons.
struct Quantity {
    std::string name, unit;
    std::vector<double> values;
};

using Facts = std::vector<std::pair<std::string, std::string>>;

class Model {
public:
    virtual ~Model() = default;

    virtual void run(std::int64_t steps) = 0;
    [[nodiscard]] virtual std::int64_t step() const = 0;
    [[nodiscard]] virtual bool finished() const { return false; } // nothing will change any more
    [[nodiscard]] virtual std::size_t sites() const = 0;          // of a heap: heaps

    // The same for every thread count and instruction set. restore() throws Error(io) for the state of
    // another lattice.
    [[nodiscard]] virtual std::string serialise() const = 0;
    virtual void restore(const std::string& state) = 0;
    [[nodiscard]] Hash128 state_hash() const {
        const std::string state = serialise();
        return hash_bytes(state.data(), state.size());
    }
    [[nodiscard]] virtual std::vector<Quantity> quantities() const = 0;

    [[nodiscard]] virtual std::vector<analysis::LogColumn> log_columns() const = 0;
    [[nodiscard]] virtual std::vector<double> log_row() const = 0;
    // The first is what pictures show.
    [[nodiscard]] virtual std::vector<Field> fields() const = 0;
    // Of the whole run, at its end.
    [[nodiscard]] virtual std::vector<Field> final_fields() const { return {}; }
    [[nodiscard]] virtual std::vector<Table> final_tables() const { return {}; }
    [[nodiscard]] virtual Facts facts() const = 0; // of the plan
};

// What a scene of automata is made for.
struct Means {
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
};

// Of the model of a scene, before it is made.
[[nodiscard]] double memory_bytes(const scene::Scene& scene);
[[nodiscard]] std::unique_ptr<Model> make_model(const scene::Scene& scene, const Means& means);

} // namespace sandlane::automata
