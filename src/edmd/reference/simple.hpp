// The simple algorithm: every pair of particles, after every event. The oracle of the improved one, and what
// runs boxes too small for cells.
#pragma once

#include "edmd/algorithm.hpp"
#include "edmd/epochs.hpp"
#include "edmd/physics.hpp"

#include <limits>
#include <vector>

namespace sandlane::edmd {

class SimpleAlgorithm final : public Algorithm {
public:
    SimpleAlgorithm(Setup setup, const std::vector<Particle>& particles);

    std::int64_t run(std::int64_t events, double until = std::numeric_limits<double>::infinity()) override;
    [[nodiscard]] std::size_t size() const override { return states_.size(); }
    [[nodiscard]] std::size_t bytes() const override;
    [[nodiscard]] std::vector<RawState> raw_states() const override;
    [[nodiscard]] std::string serialise() const override;
    void restore(const std::string& bytes) override;

private:
    struct State {
        laws::Flight<double> flight;
        Vector<double> spin;
        std::uint32_t kind;
        std::array<std::int64_t, 3> turns; // boxes crossed until the last fold
        std::int64_t last;                 // partner of the last event; -1: none, or a wall
        double last_time;
        std::uint32_t hits;
    };
    // What comes next of two particles, or of one and a wall; CHECK: to be looked at again by then, since
    // images that were not considered might meet.
    struct Next {
        double time = std::numeric_limits<double>::infinity();
        enum class Kind { check = 0, wall = 2, pair = 3 } kind = Kind::check;
        std::size_t first = 0, second = 0; // ids, or id and side
        std::array<std::int64_t, 3> boxes{};
    };

    [[nodiscard]] std::string frame() const;
    [[nodiscard]] Next next_of_pair(std::size_t i, std::size_t j) const;
    [[nodiscard]] Next next_at_wall(std::size_t i, int wall) const;
    [[nodiscard]] static bool before(const Next& a, const Next& b);
    [[nodiscard]] Next earliest() const;
    void predict(std::size_t i);
    void execute(const Next& next);
    [[nodiscard]] Body body_of(std::size_t i) const;
    void settle(std::size_t i, const Body& body, std::int64_t partner);
    void fold(State& s) const;
    void synchronise(); // all to the present, the start of an epoch
    void predict_all();
    void begin_epoch();
    void kick();

    std::vector<State> states_;
    std::vector<Next> pairs_; // of i < j: [j (j - 1)/2 + i]
    std::vector<Next> walls_; // [walls() i + wall]
};

} // namespace sandlane::edmd
