// Reading a simulation: particles by id, sums, hash, checkpoints.
#include "dsmc/simulation.hpp"

#include "core/bytes.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sandlane::dsmc {

using simd::gas_row;

namespace {

// Identity and kind, which the last numbers of the rows hold.
Particle particle_at(const double* place, const double* velocity) {
    Particle p;
    std::uint64_t word = 0, images = 0;
    std::memcpy(&word, place + 3, sizeof word);
    std::memcpy(&images, velocity + 3, sizeof images);
    p.id = static_cast<std::uint32_t>(word);
    p.kind = static_cast<std::uint32_t>(images >> 60);
    return p;
}

} // namespace

template <class Body> void Simulation::for_rows(const Body& body) const {
    for (const Tile& tile : tiles_) {
        const simd::GasRows rows = const_cast<Tile&>(tile).rows.view();
        for (std::ptrdiff_t i = 0; i < tile.count; ++i)
            body(rows.place + i * gas_row, rows.velocity + i * gas_row,
                 rows.spin == nullptr ? nullptr : rows.spin + i * gas_row);
    }
}

std::vector<Particle> Simulation::particles() const {
    std::vector<Particle> all;
    all.reserve(size_);
    for_rows([&](const double* place, const double* velocity, const double* spin) {
        Particle p = particle_at(place, velocity);
        std::uint64_t images = 0;
        std::memcpy(&images, velocity + 3, sizeof images);
        for (std::size_t d = 0; d < 3; ++d) {
            p.place[d] = place[d];
            p.velocity[d] = velocity[d];
            if (spin != nullptr) p.spin[d] = spin[d];
            const std::uint64_t count = images >> 20 * d & 0xfffff; // 20 bits with a sign
            p.image[d] = static_cast<std::int32_t>(count) - (count >= 0x80000 ? 0x100000 : 0);
        }
        all.push_back(p);
    });
    std::sort(all.begin(), all.end(), [](const Particle& a, const Particle& b) { return a.id < b.id; });
    return all;
}

Observables Simulation::observe() const {
    Observables o;
    std::vector<Particle> all = particles();
    if (setup_.shear != 0) // velocities relative to the flow
        for (Particle& p : all) p.velocity[0] -= setup_.flow(p.place[1]);
    if (all.empty()) return o;
    const auto n = static_cast<double>(all.size());
    const auto d = static_cast<std::size_t>(setup_.dimension);
    std::vector<double> mass, inertia, count(setup_.kinds(), 0.0);
    for (std::size_t k = 0; k < setup_.kinds(); ++k) {
        const Kind kind = setup_.kind(k);
        mass.push_back(kind.mass);
        inertia.push_back(setup_.inertia * kind.mass * 0.25 * kind.diameter * kind.diameter);
    }
    double masses = 0;
    for (const Particle& p : all) {
        masses += mass[p.kind];
        for (std::size_t c = 0; c < d; ++c) o.drift[c] += mass[p.kind] * p.velocity[c];
    }
    for (double& u : o.drift) u /= masses;
    const auto dimension = static_cast<double>(setup_.dimension);
    double fourth = 0, spins = 0, squares = 0;
    o.of_kind.assign(setup_.kinds(), 0.0);
    for (const Particle& p : all) {
        double square = 0;
        for (std::size_t c = 0; c < d; ++c) {
            const double v = p.velocity[c] - o.drift[c];
            o.directions[c] += mass[p.kind] * v * v / n;
            square += mass[p.kind] * v * v;
            squares += mass[p.kind] * p.velocity[c] * p.velocity[c];
        }
        o.shear_stress -= mass[p.kind] * (p.velocity[0] - o.drift[0]) * (p.velocity[1] - o.drift[1]);
        fourth += square * square / n;
        o.of_kind[p.kind] += square / dimension;
        count[p.kind] += 1;
        for (const double w : p.spin) spins += inertia[p.kind] * w * w;
    }
    for (std::size_t c = 0; c < d; ++c) o.temperature += o.directions[c] / dimension;
    for (std::size_t k = 0; k < count.size(); ++k) o.of_kind[k] /= std::max(count[k], 1.0);
    if (o.temperature > 0)
        o.fourth = fourth / (dimension * (dimension + 2) * o.temperature * o.temperature) - 1;
    if (setup_.rough) o.spin_temperature = spins / n / (setup_.dimension == 3 ? 3 : 1);
    o.shear_stress *= setup_.weight / setup_.volume();
    o.energy = 0.5 * setup_.weight * (squares + (setup_.rough ? spins : 0));
    return o;
}

Hash128 Simulation::state_hash() const {
    ByteWriter out;
    for (const Particle& p : particles()) {
        out.put(p.id);
        if (!setup_.others.empty()) out.put(p.kind);
        for (std::size_t d = 0; d < 3; ++d) {
            out.put(p.place[d]);
            out.put(p.velocity[d]);
            out.put(p.spin[d]);
            out.put(p.image[d]);
        }
    }
    return hash_bytes(out.bytes().data(), out.bytes().size());
}

// What a state is bound to: bytes that equal setups share.
std::string Simulation::frame() const {
    ByteWriter out;
    out.put(setup_.dt);
    out.put(setup_.shear);
    for (int d = 0; d < setup_.dimension; ++d) {
        out.put(setup_.cells[d]);
        out.put(setup_.lower[d]);
        out.put(setup_.upper[d]);
    }
    for (const Kind& k : setup_.others) {
        out.put(k.mass);
        out.put(k.diameter);
        out.put(k.fraction);
    }
    return std::move(out).bytes();
}

std::string Simulation::serialise() const {
    ByteWriter out;
    out.put_text(frame());
    out.put(step_);
    for (const double value : {time_, dt_, next_dt_, square_sum_, first_square_sum_, wall_energy_})
        out.put(value);
    for (const std::int64_t value :
         {counts_.candidates, counts_.collisions, counts_.violations, counts_.stuck})
        out.put(value);
    out.put(static_cast<std::uint64_t>(tiles_.size()));
    for (const Tile& tile : tiles_) {
        const auto rows = static_cast<std::size_t>(tile.count) * gas_row;
        out.put_array(tile.rows.place.data(), rows);
        out.put_array(tile.rows.velocity.data(), rows);
        if (setup_.rough) out.put_array(tile.rows.spin.data(), rows);
    }
    return std::move(out).bytes();
}

namespace {

// What a step relies on: numbers, kinds that there are, and no way of more boxes than images are counted.
bool suits(const Setup& setup, double dt, const double* place, const double* velocity, const double* spin) {
    constexpr double most_boxes = 1 << 16; // collisions may make it some times as fast
    std::uint64_t images = 0;
    std::memcpy(&images, velocity + 3, sizeof images);
    if ((images >> 60) >= setup.kinds()) return false;
    for (int d = 0; d < 3; ++d) {
        const double surface = spin != nullptr ? 0.5 * setup.diameter * std::abs(spin[d]) : 0;
        const double way = std::abs(place[d] - setup.lower[d]) + std::abs(velocity[d]) * dt;
        if (!std::isfinite(place[d]) || !std::isfinite(velocity[d]) ||
            !(surface * dt < most_boxes * (setup.upper[0] - setup.lower[0])) ||
            (d < setup.dimension && !(way < most_boxes * (setup.upper[d] - setup.lower[d]))))
            return false;
    }
    return true;
}

} // namespace

void Simulation::restore(const std::string& bytes) {
    ByteReader in(bytes);
    const auto belongs = [&](bool condition) {
        if (!condition) fail(Exit::io, "the state belongs to another scene");
    };
    belongs(in.get_text() == frame());
    step_ = in.get<std::int64_t>();
    for (double* value : {&time_, &dt_, &next_dt_, &square_sum_, &first_square_sum_, &wall_energy_})
        *value = in.get<double>();
    for (std::int64_t* value :
         {&counts_.candidates, &counts_.collisions, &counts_.violations, &counts_.stuck})
        *value = in.get<std::int64_t>();
    belongs(in.get<std::uint64_t>() == tiles_.size());
    std::size_t total = 0;
    for (Tile& tile : tiles_) {
        std::vector<double> place, velocity, spin;
        in.get_array(place);
        in.get_array(velocity);
        if (setup_.rough) in.get_array(spin);
        belongs(place.size() % gas_row == 0 && velocity.size() == place.size() &&
                (!setup_.rough || spin.size() == place.size()));
        const std::size_t count = place.size() / gas_row;
        tile.rows.require(count, setup_.rough, false);
        std::copy(place.begin(), place.end(), tile.rows.place.begin());
        std::copy(velocity.begin(), velocity.end(), tile.rows.velocity.begin());
        if (setup_.rough) std::copy(spin.begin(), spin.end(), tile.rows.spin.begin());
        tile.count = static_cast<std::int32_t>(count);
        total += count;
    }
    belongs(total == size_ && in.at_end());
    belongs(step_ >= 0 && std::isfinite(time_) && dt_ > 0 && std::isfinite(dt_) && next_dt_ > 0 &&
            std::isfinite(next_dt_));
    double longest = std::max(dt_, next_dt_); // step of the next two
    if (setup_.adaptive) {
        double squares = 0;
        for (const Particle& p : particles()) {
            const double mass = mass_.empty() || p.kind >= mass_.size() ? 1.0 : mass_[p.kind];
            for (const double v : p.velocity) squares += mass * v * v;
        }
        for (const double known : {square_sum_, squares})
            if (known > 0) longest = std::max(longest, setup_.dt * std::sqrt(first_square_sum_ / known));
        belongs(first_square_sum_ >= 0 && std::isfinite(longest));
    }
    std::vector<bool> seen(size_, false);
    for_rows([&](const double* place, const double* velocity, const double* spin) {
        const std::uint32_t id = particle_at(place, velocity).id;
        belongs(id < size_ && !seen[id] && suits(setup_, longest, place, velocity, spin));
        seen[id] = true;
    });
    find_maxwell_rate();
}

} // namespace sandlane::dsmc
