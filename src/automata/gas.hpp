// Lattice gases: the lattice of bits, its rules, and the model (docs/automata.md 4).
#pragma once

#include "automata/model.hpp"
#include "core/bytes.hpp"
#include "core/column.hpp"
#include "core/rng.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::automata {

using simd::GasModel;

// Directions 0 to 5, then the rest particle; one bit per site and direction.
class GasLattice {
public:
    GasLattice(std::int32_t columns, std::int32_t rows);

    [[nodiscard]] bool get(int direction, std::int32_t x, std::int32_t y) const {
        return (plane[static_cast<std::size_t>(direction)][word(x, y)] >> (x & 63) & 1) != 0;
    }
    void set(int direction, std::int32_t x, std::int32_t y, bool value) {
        assign(plane[static_cast<std::size_t>(direction)][word(x, y)], x, value);
    }
    [[nodiscard]] bool is_solid(std::int32_t x, std::int32_t y) const {
        return !solid.empty() && (solid[word(x, y)] >> (x & 63) & 1) != 0;
    }
    void make_solid(std::int32_t x, std::int32_t y);
    [[nodiscard]] std::uint64_t particles(int direction) const;

    std::int32_t columns, rows, words, stride;
    std::array<Column<std::uint64_t>, simd::gas_planes> plane;
    Column<std::uint64_t> solid; // empty: none

private:
    [[nodiscard]] std::size_t word(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) +
               static_cast<std::size_t>(x >> 6);
    }
    static void assign(std::uint64_t& word, std::int32_t x, bool value) {
        const std::uint64_t bit = std::uint64_t{1} << (x & 63);
        word = value ? word | bit : word & ~bit;
    }
};

struct GasRules {
    GasModel model = GasModel::fhp1;
    bool alternating = false; // chirality (x + y + t) mod 2
    bool closed = false;      // walls below the first and above the last row
    bool counted = false;     // of a pipe: any number of rest particles, those beyond the first elsewhere
    std::uint32_t dissipation = 0, gravity = 0, roughness = 0; // P of P/2^16
    PhiloxKey seed{};

    [[nodiscard]] int directions() const { return model == GasModel::hpp ? 4 : 6; }
    [[nodiscard]] bool has_rest() const { return model != GasModel::hpp && model != GasModel::fhp1; }
    [[nodiscard]] int planes() const { return has_rest() ? 7 : directions(); }
};

// round(p 2^16).
[[nodiscard]] std::uint32_t sixteenths(double probability);

// Steps of a lattice by kernels, in tiles of rows.
class GasStepper {
public:
    // active_tiles: pass over segments of rows without particles. by_planes: FHP-III by Boolean expressions
    // also where a table of bytes is faster.
    GasStepper(const GasLattice& lattice, const GasRules& rules, const Means& means,
               bool active_tiles = false, bool by_planes = false);
    // Steps t, t + 1, ..., two in one pass over the memory where that can be done.
    void run(GasLattice& lattice, std::uint32_t t, std::int64_t steps);
    // counted: of rules with any number of rest particles.
    void step(GasLattice& lattice, std::uint32_t t, const simd::CountedView* counted = nullptr);
    [[nodiscard]] bool by_bytes() const { return by_bytes_; }
    void visit_all() { live_.fill(1); } // after particles were put anywhere

private:
    // Rows that one step of a tile sends to the tiles below and above, [tiles][2][stride].
    struct Edges {
        Column<std::uint64_t> into_first, into_last;
    };

    void one_step(Crew& crew, GasLattice& lattice, std::uint32_t t, const simd::CountedView* counted);
    void two_steps(Crew& crew, GasLattice& lattice, std::uint32_t t);
    [[nodiscard]] simd::GasView view(GasLattice& lattice, std::uint32_t t) const;
    [[nodiscard]] std::int32_t first_row(std::size_t tile) const {
        return static_cast<std::int32_t>(tile) * simd::gas_tile_rows;
    }
    // Rows of a tile; what leaves it goes to `edges`.
    [[nodiscard]] simd::GasTile tile(const GasLattice& lattice, std::size_t tile, Edges& edges) const;
    [[nodiscard]] std::uint64_t* scratch();
    void put_edges(GasLattice& lattice, const Edges& edges, std::size_t lower) const;
    void finish_pair(GasLattice& lattice, const simd::GasView& later, std::size_t lower);
    void spread_activity(const GasLattice& lattice, std::size_t tile);

    GasRules rules_;
    Means means_;
    simd::GasKernel kernel_ = nullptr;   // null: the reference
    simd::GasPairKernel pair_ = nullptr; // null: steps are taken one by one
    bool by_bytes_ = false;
    std::int32_t rows_;
    std::size_t tiles_;
    int crew_; // threads that find a tile
    std::size_t scratch_words_;
    Column<std::uint64_t> scratch_; // [crew][2][scratch_words]
    Edges edges_, second_;
    Column<std::uint8_t> live_, occupied_; // [rows][segments]; empty: all rows are whole
};

class GasFlow : public Model {
public:
    GasFlow(GasLattice lattice, const GasRules& rules, const Means& means, bool active_tiles = false)
        : lattice_(std::move(lattice)), rules_(rules), means_(means),
          stepper_(lattice_, rules, means, active_tiles) {}

    void run(std::int64_t steps) override;
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] std::size_t sites() const override {
        return static_cast<std::size_t>(lattice_.columns) * static_cast<std::size_t>(lattice_.rows);
    }
    [[nodiscard]] std::string serialise() const override;
    void restore(const std::string& state) override;
    [[nodiscard]] std::vector<Quantity> quantities() const override;
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override;
    [[nodiscard]] std::vector<double> log_row() const override;
    [[nodiscard]] std::vector<Field> fields() const override;
    [[nodiscard]] Facts facts() const override;
    [[nodiscard]] const GasLattice& lattice() const { return lattice_; }

protected:
    virtual void look() {}                                     // after each step
    [[nodiscard]] virtual bool looks() const { return false; } // look() does something
    virtual void save(ByteWriter&) const {}
    virtual void load(ByteReader&) {}

    GasLattice lattice_;
    GasRules rules_;
    Means means_;
    GasStepper stepper_;
    std::int64_t step_ = 0;
};

[[nodiscard]] std::unique_ptr<Model> make_lattice_gas(const scene::Scene& scene, const Means& means);
[[nodiscard]] std::unique_ptr<Model> make_pipe_flow(const scene::Scene& scene, const Means& means);

} // namespace sandlane::automata
