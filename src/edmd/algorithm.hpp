// What both algorithms can do: run, tell their state, take one up.
#pragma once

#include "core/bytes.hpp"
#include "core/hash.hpp"
#include "edmd/epochs.hpp"
#include "edmd/event_log.hpp"
#include "edmd/setup.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::edmd {

// Sums over all particles, in the order of their ids, without the flow of a sheared gas.
struct Observables {
    double temperature = 0;        // m <(v - u)^2>/d, J
    std::vector<double> of_class;  // the same of each class
    double spin_temperature = 0;   // J <w^2> per component, J; 0: smooth
    double energy = 0;             // kinetic, of translation and spin, J
    double fourth = 0;             // a2 of the thermal energies
    std::array<double, 3> drift{}; // u of the centre of mass, m/s
    double flux = 0;               // of x momentum along y: sum of m v_x v_y, J
};
[[nodiscard]] Observables observe(const Setup& setup, const std::vector<Particle>& particles);
// Without the flow of a sheared gas.
[[nodiscard]] std::vector<Particle> thermal_particles(const Setup& setup, std::vector<Particle> particles);

// A particle as it was left by its last event.
struct RawState {
    std::array<double, 3> place{}, velocity{}, spin{};
    double time = 0, last_time = 0; // of the epoch; of the last event
    std::array<std::int64_t, 3> boxes{};
    std::uint32_t last = 0, hits = 0, kind = 0; // last: partner by id, or none
};

class Algorithm {
public:
    virtual ~Algorithm() = default;

    // Takes so many events, collisions and hits of walls, but none later than `until` on the clock; returns
    // how many. The clock stands at the last one, or at `until` if it was reached. Throws Error(unstable) for
    // inelastic collapse, and for particles that overlap by more than rounding.
    virtual std::int64_t run(std::int64_t events, double until = std::numeric_limits<double>::infinity()) = 0;

    [[nodiscard]] const Setup& setup() const { return setup_; }
    [[nodiscard]] double time() const { return clock_.time(); }
    [[nodiscard]] const Tally& tally() const { return tally_; }
    [[nodiscard]] const EventLog& log() const { return log_; }
    [[nodiscard]] EventLog& log() { return log_; }

    [[nodiscard]] virtual std::size_t size() const = 0;
    [[nodiscard]] virtual std::size_t bytes() const = 0;
    [[nodiscard]] virtual std::vector<RawState> raw_states() const = 0; // by id
    // At the time of the clock, by id.
    [[nodiscard]] std::vector<Particle> particles() const;
    // The same for both algorithms, all instruction sets and numbers of threads.
    [[nodiscard]] Hash128 state_hash() const;

    // Complete state for checkpoints; restore() needs the same algorithm, particles and box.
    [[nodiscard]] virtual std::string serialise() const = 0;
    virtual void restore(const std::string& bytes) = 0; // throws Error(io) for a state of something else

protected:
    explicit Algorithm(Setup setup) : setup_(std::move(setup)) {}
    Algorithm(const Algorithm&) = default;

    // What a state must share with the simulation that takes it up.
    void put_frame(ByteWriter& out) const;
    // Clock, sums and log of a checkpoint.
    void put_course(ByteWriter& out) const;
    void get_course(ByteReader& in);
    // Of what was read: numbers, at a time that has been, of a class that there is.
    [[nodiscard]] bool suits(const RawState& s) const;
    // At the start of an epoch: throws Error(unstable) if the run makes no sense any more.
    void check_course(const Drift& drift);

    Setup setup_;
    Clock clock_;
    Tally tally_;
    EventLog log_;
    std::int64_t epoch_events_ = 0; // in this epoch
    double epoch_end_ = 0;          // of this epoch at the latest
    CollapseGuard guard_;
    std::int64_t kicks_ = 0; // of the thermostat, so far

    // When the next kick is due, of this epoch.
    [[nodiscard]] double next_kick() const {
        return setup_.kicks > 0 ? clock_.until(static_cast<double>(kicks_ + 1) * setup_.kick_interval)
                                : std::numeric_limits<double>::infinity();
    }
    // The present becomes the start of an epoch.
    void restart_clock() {
        setup_.scale += setup_.growth * clock_.now;
        if (setup_.shear != 0) {
            setup_.offset = setup_.offset_at(clock_.now);
            setup_.offset -= std::floor(setup_.offset / setup_.length(0)) * setup_.length(0);
        }
        clock_.begin_epoch();
    }
};

} // namespace sandlane::edmd
