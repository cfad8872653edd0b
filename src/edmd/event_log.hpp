// What both algorithms keep of a run beside the particles: the clock, sums over events, the log.
#pragma once

#include "edmd/physics.hpp"

#include <bit>
#include <cstdint>
#include <vector>

namespace sandlane::edmd {

// Time in epochs: times of states and events count from the start of the present one, so that they stay
// small and precise.
struct Clock {
    double epoch = 0, carry = 0; // start of the epoch, and what rounding cut off from it
    double now = 0;              // since then

    [[nodiscard]] double time() const { return epoch + (now + carry); }
    // A time of the clock in this epoch.
    [[nodiscard]] double until(double time) const { return (time - epoch) - carry; }
    // `now` becomes the start of an epoch.
    void begin_epoch() {
        const double step = now + carry, sum = epoch + step;
        const double part = sum - epoch;
        carry = (epoch - (sum - part)) + (step - part);
        epoch = sum;
        now = 0;
    }
};

// One executed event: two particles, or a particle and wall 2 axis + upper.
struct Event {
    enum class Kind : std::uint32_t { wall = 2, pair = 3 };
    double time; // of its epoch, s
    Kind kind;
    std::uint32_t first, second; // ids, the smaller first; or id and wall
    friend bool operator==(const Event&, const Event&) = default;
};

// Hash of all events up to now; equal hashes mean the same events at the same times, bit for bit.
class EventLog {
public:
    void add(const Event& e) {
        mix(std::bit_cast<std::uint64_t>(e.time));
        mix(std::uint64_t{e.first} << 32 | e.second);
        ++count_;
        if (record_ != nullptr) record_->push_back({e});
    }
    [[nodiscard]] std::uint64_t hash() const { return state_ ^ count_; }
    [[nodiscard]] std::uint64_t count() const { return count_; }
    // From now on every event is added there, too.
    void record(std::vector<Event>* to) { record_ = to; }
    void restore(std::uint64_t state, std::uint64_t count) { state_ = state, count_ = count; }
    [[nodiscard]] std::uint64_t state() const { return state_; }

private:
    void mix(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x9E3779B97F4A7C15u;
        state_ ^= state_ >> 29;
    }
    std::uint64_t state_ = 0x243F6A8885A308D3u, count_ = 0;
    std::vector<Event>* record_ = nullptr;
};

// Sums over events, in their order.
struct Tally {
    std::int64_t collisions = 0, wall_hits = 0;
    std::int64_t elastic = 0; // made so by the rules against inelastic collapse
    double kept = 0;          // energy that they kept, J
    double virial = 0;        // sum of R_ij |P_n|, J s
    double shear = 0;         // sum of R_ij e_y P_x, J s
    double lost = 0;          // energy that collisions took, J
    double wall_energy = 0;   // that walls gave, J
    double heat = 0;          // that the thermostat gave, J
    double smallest_gap = 0;  // of surfaces that met, m; rounding

    SANDLANE_INLINE void add(const Impact& impact, const Class& a, const Class& b) {
        ++collisions;
        const double part = (a.radius + b.radius) * (a.mass * b.mass / (a.mass + b.mass));
        virial += part * impact.push;
        shear += part * impact.across;
        smallest_gap = min(smallest_gap, impact.gap);
        elastic += impact.elastic ? 1 : 0;
        kept += impact.kept;
        lost += impact.lost;
    }
    // Of a particle that had the velocity v.
    void add_kick(double mass, const Vector<double>& v, const Vector<double>& kick) {
        heat += mass * (dot(v, kick) + 0.5 * dot(kick, kick));
    }
    // Those of another run.
    void add(const Tally& t) {
        collisions += t.collisions, wall_hits += t.wall_hits, elastic += t.elastic;
        kept += t.kept, virial += t.virial, shear += t.shear;
        lost += t.lost, wall_energy += t.wall_energy, heat += t.heat;
        smallest_gap = min(smallest_gap, t.smallest_gap);
    }
    void add(const WallEffect& effect) {
        ++wall_hits;
        wall_energy += effect.energy;
        elastic += effect.elastic ? 1 : 0;
    }
};

// Looks for infinitely many collisions in a finite time: a thousand events for each particle within 1e-9 of
// the mean time between two of a particle so far.
class CollapseGuard {
public:
    // At the end of an epoch: `time` on the clock, events so far. True: this is a collapse.
    [[nodiscard]] bool sees(double time, std::int64_t events, std::size_t particles) {
        if (events - events_ < 1000 * static_cast<std::int64_t>(particles)) return false;
        const double mean = time * static_cast<double>(particles) / (2 * static_cast<double>(events));
        const bool collapsed = time - time_ < 1e-9 * mean;
        time_ = time;
        events_ = events;
        return collapsed;
    }

private:
    double time_ = 0; // where the present thousand began
    std::int64_t events_ = 0;
};

// What the improved algorithm did for it.
struct Work {
    std::int64_t crossings = 0, searches = 0, stale = 0, epochs = 0;
};

} // namespace sandlane::edmd
