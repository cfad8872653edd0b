// Ripples of Nishimori and Ouchi (docs/automata.md 3): saltation along the wind, then creep, in numbers of
// 2^-32 that conserve the sand exactly, or in double precision.
#pragma once

#include "automata/model.hpp"
#include "core/column.hpp"
#include "core/rng.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::automata {

inline constexpr double ripple_unit = 4294967296.0; // heights of `fixed` arithmetic per unit

struct RippleRules {
    double transport = 0.1, wind = 1, length = 10.5, creep = 0.4; // q, b, L_0, D
    scene::RippleLanding landing = scene::RippleLanding::interpolated;
    PhiloxKey seed{};

    [[nodiscard]] std::int64_t fixed_transport() const {
        return static_cast<std::int64_t>(transport * ripple_unit);
    }
};

// Steps of a bed [rows][columns] of fixed numbers.
class RippleStepper {
public:
    RippleStepper(std::int32_t columns, std::int32_t rows, const RippleRules& rules, const Means& means);
    // Returns the number of sites whose length was clamped to 0. Throws Error(unstable) for heights beyond
    // 2^18.
    std::int64_t step(Column<std::int64_t>& heights, std::uint32_t t);

private:
    std::int32_t columns_, rows_;
    RippleRules rules_;
    Means means_;
    Column<std::int64_t> landed_;       // after saltation
    Column<std::int64_t> scratch_;      // [threads]
    std::vector<std::int64_t> clamped_; // by tile
    std::vector<std::uint8_t> high_;    // by tile: a height is too large
};

class RippleModel final : public Model {
public:
    RippleModel(const scene::Scene& scene, const Means& means);

    void run(std::int64_t steps) override;
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] std::size_t sites() const override {
        return static_cast<std::size_t>(ripples_.columns * ripples_.rows);
    }
    [[nodiscard]] std::string serialise() const override;
    void restore(const std::string& state) override;
    [[nodiscard]] std::vector<Quantity> quantities() const override;
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override;
    [[nodiscard]] std::vector<double> log_row() const override;
    [[nodiscard]] std::vector<Field> fields() const override;
    [[nodiscard]] std::vector<Table> final_tables() const override;
    [[nodiscard]] Facts facts() const override;

private:
    [[nodiscard]] std::vector<double> heights() const;

    scene::Ripples ripples_;
    Means means_;
    RippleRules rules_;
    std::int32_t columns_, rows_;
    RippleStepper stepper_;
    Column<std::int64_t> fixed_; // one of the two is empty
    std::vector<double> floating_;
    std::int64_t step_ = 0, clamped_ = 0;
};

// Power of the modes 1, 2, ... columns/2 along x, averaged over at most 32 rows.
[[nodiscard]] std::vector<double> mode_powers(const std::vector<double>& heights, std::int32_t columns,
                                              std::int32_t rows);
// Mean distance of upward crossings of the mean along the rows; 0 if there are none.
[[nodiscard]] double crest_distance(const std::vector<double>& heights, std::int32_t columns,
                                    std::int32_t rows);

} // namespace sandlane::automata
