// Event-driven dynamics against the same in long double, for tools/bench accuracy. CSV on the standard
// output:
//   edmd_accuracy errors DIMENSION PHI PARTICLES EVENTS SHIFT GRAVITY SEED   event by event
//   edmd_accuracy cost ALGORITHM DIMENSION PHI PARTICLES EVENTS              energy and time after many
//   events
// SHIFT: distance of the box from the origin in diameters; GRAVITY above 0: a box with walls and a field.
#include "hard_reference.hpp"

#include "core/progress.hpp"
#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"
#include "edmd/start.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>

namespace {

using namespace sandlane;

edmd::Setup hard_gas(int dimension, double phi, std::uint32_t particles, double shift, double gravity) {
    edmd::Setup s;
    s.dimension = dimension;
    const double content = dimension == 3 ? std::numbers::pi / 6 : std::numbers::pi / 4;
    const double length = std::pow(particles * content / phi, 1.0 / dimension);
    for (int d = 0; d < dimension; ++d) {
        s.lower[d] = shift;
        s.upper[d] = shift + length;
        s.periodic[d] = gravity == 0;
    }
    if (gravity > 0) s.gravity[1] = -gravity;
    return s;
}

std::unique_ptr<edmd::Algorithm> make(bool simple, const edmd::Setup& setup,
                                      const std::vector<edmd::Particle>& start) {
    if (simple) return std::make_unique<edmd::SimpleAlgorithm>(setup, start);
    return std::make_unique<edmd::Simulation>(setup, start, simd::choose_isa("auto"), 1);
}

std::vector<bench::LongParticle> in_long(const std::vector<edmd::Particle>& all) {
    std::vector<bench::LongParticle> out(all.size());
    for (const edmd::Particle& p : all)
        for (std::size_t d = 0; d < 3; ++d) {
            out[p.id].place[d] = p.place[d];
            out[p.id].velocity[d] = p.velocity[d];
        }
    return out;
}
std::vector<bench::LongParticle> in_long(const std::vector<edmd::RawState>& all) {
    std::vector<bench::LongParticle> out(all.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
        for (std::size_t d = 0; d < 3; ++d) {
            out[n].place[d] = all[n].place[d];
            out[n].velocity[d] = all[n].velocity[d];
        }
        out[n].time = all[n].time;
    }
    return out;
}

bool same(const edmd::Event& e, const bench::LongEvent& r) {
    return (e.kind == edmd::Event::Kind::pair) == r.pair && e.first == r.first && e.second == r.second;
}

// One row for each event, until the first that is not that of the reference. error: of its time, from the
// start; predicted: of its time, from the state that the engine itself has before it.
void errors(const edmd::Setup& setup, std::uint32_t particles, std::int64_t count) {
    const auto start = edmd::make_particles(setup, {particles}, 1);
    const std::unique_ptr<edmd::Algorithm> gas = make(!setup.has_room_for_cells(), setup, start);
    std::vector<edmd::Event> events;
    gas->log().record(&events);
    bench::HardReference right(setup, in_long(start));
    const long double energy = bench::HardReference(setup, in_long(start)).energy(0);
    fmt::print("event,time,error,predicted,energy\n");
    double before = 0; // of the last event, of its epoch
    for (std::int64_t n = 1; n <= count; ++n) {
        const auto states = gas->raw_states();
        events.clear();
        if (gas->run(1) == 0) return;
        const bench::LongEvent expected = right.next();
        right.execute(expected);
        if (!same(events[0], expected)) return;
        // With the first event of an epoch the states of before are of the last one.
        const bool epoch = events[0].time < before;
        before = events[0].time;
        const bench::HardReference now(setup, in_long(states));
        const long double predicted = epoch ? 0 : std::abs(now.next().time - events[0].time);
        const bench::HardReference after(setup, in_long(gas->raw_states()));
        const long double drift = after.energy(events[0].time) / energy - 1;
        fmt::print("{},{},{},{},{}\n", n, gas->time(), static_cast<double>(gas->time() - expected.time),
                   static_cast<double>(predicted), static_cast<double>(drift));
    }
}

void cost(bool simple, const edmd::Setup& setup, std::uint32_t particles, std::int64_t count) {
    const auto start = edmd::make_particles(setup, {particles}, 1);
    const std::unique_ptr<edmd::Algorithm> gas = make(simple, setup, start);
    const long double energy = bench::HardReference(setup, in_long(gas->raw_states())).energy(0);
    gas->run(count / 10);
    const Stopwatch clock;
    const std::int64_t done = gas->run(count);
    const double seconds = clock.seconds();
    const long double drift = bench::HardReference(setup, in_long(gas->particles())).energy(0) / energy - 1;
    fmt::print("events,ns,energy,gap,hash\n{},{},{},{},{:016x}\n", done,
               1e9 * seconds / static_cast<double>(done), static_cast<double>(drift),
               gas->tally().smallest_gap, gas->log().hash());
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    const auto number = [&](int n) { return std::atof(argv[n]); };
    if (what == "errors" && argc == 9) {
        const auto n = static_cast<std::uint32_t>(number(4));
        edmd::Setup s = hard_gas(std::atoi(argv[2]), number(3), n, number(6), number(7));
        s.seed = static_cast<std::uint64_t>(number(8));
        errors(s, n, static_cast<std::int64_t>(number(5)));
    } else if (what == "cost" && argc == 7) {
        const auto n = static_cast<std::uint32_t>(number(5));
        cost(std::string(argv[2]) == "simple", hard_gas(std::atoi(argv[3]), number(4), n, 0, 0), n,
             static_cast<std::int64_t>(number(6)));
    } else {
        fmt::print(stderr, "see the head of edmd_accuracy.cpp\n");
        return 2;
    }
    return 0;
}
