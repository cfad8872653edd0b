#include "edmd/start.hpp"

#include "core/error.hpp"
#include "core/rng.hpp"
#include "edmd/grow.hpp"
#include "edmd/physics.hpp"
#include "laws/wall_times.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::edmd {

namespace {

constexpr std::uint32_t start_stream = 5;

std::array<double, 2> draw(const Setup& setup, std::uint32_t block, std::uint32_t id, std::uint32_t attempt) {
    const PhiloxCounter w =
        philox({block, id, attempt, start_stream},
               {static_cast<std::uint32_t>(setup.seed), static_cast<std::uint32_t>(setup.seed >> 32)});
    return {unit_number(w[0], w[1]), unit_number(w[2], w[3])};
}

double size_of(const Setup& setup, double radius) {
    constexpr double pi = std::numbers::pi;
    return setup.dimension == 3 ? 4 * pi / 3 * radius * radius * radius : pi * radius * radius;
}

// Where centres may be, clear of walls wherever they oscillate to.
struct Room {
    std::array<double, 3> lower{}, upper{};
    Room(const Setup& setup, double radius) {
        for (std::size_t d = 0; d < static_cast<std::size_t>(setup.dimension); ++d) {
            lower[d] = setup.lower[d];
            upper[d] = setup.upper[d];
            if (setup.periodic[d]) continue;
            lower[d] += radius + setup.side[d][0].motion.amplitude;
            upper[d] -= radius + setup.side[d][1].motion.amplitude;
        }
    }
};

// Particles placed so far, by cells as long as the largest diameter.
class Placed {
public:
    Placed(const Setup& setup, std::vector<Particle>& particles) : setup_(setup), particles_(particles) {
        std::size_t cells = 1;
        const double edge = 2 * setup.largest_radius();
        for (std::size_t d = 0; d < 3; ++d) {
            count_[d] = 1;
            if (d < static_cast<std::size_t>(setup.dimension))
                count_[d] = std::clamp<std::int64_t>(
                    static_cast<std::int64_t>(setup.length(static_cast<int>(d)) / edge), 1, 1024);
            cells *= static_cast<std::size_t>(count_[d]);
        }
        first_.assign(cells, -1);
        next_.assign(particles.size(), -1);
    }
    [[nodiscard]] bool is_free(const Particle& p) const {
        const double radius = setup_.classes[p.kind].radius;
        for (const Curved& c : setup_.curved) {
            const Vector<double> r = from_centre(setup_, c, {p.place[0], p.place[1], p.place[2]});
            const double distance = std::sqrt(dot(r, r));
            if (c.container ? distance > c.radius - radius : distance < c.radius + radius) return false;
        }
        std::array<std::int64_t, 3> at{}, from{}, to{};
        for (std::size_t d = 0; d < 3; ++d) {
            at[d] = cell(p, d);
            const std::int64_t reach = count_[d] > 2 ? 1 : 0;
            from[d] = reach == 1 ? at[d] - 1 : 0;
            to[d] = reach == 1 ? at[d] + 1 : count_[d] - 1;
        }
        for (std::int64_t z = from[2]; z <= to[2]; ++z)
            for (std::int64_t y = from[1]; y <= to[1]; ++y)
                for (std::int64_t x = from[0]; x <= to[0]; ++x)
                    if (!clear_of(p, {x, y, z})) return false;
        return true;
    }
    void add(std::size_t n) {
        std::int64_t number = 0;
        for (std::size_t d = 3; d-- > 0;) number = number * count_[d] + cell(particles_[n], d);
        next_[n] = first_[static_cast<std::size_t>(number)];
        first_[static_cast<std::size_t>(number)] = static_cast<std::int64_t>(n);
    }

private:
    [[nodiscard]] std::int64_t cell(const Particle& p, std::size_t d) const {
        const int k = static_cast<int>(d);
        if (count_[d] == 1) return 0;
        const double at = (p.place[d] - setup_.lower[k]) / setup_.length(k) * static_cast<double>(count_[d]);
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(at), 0, count_[d] - 1);
    }
    [[nodiscard]] bool clear_of(const Particle& p, std::array<std::int64_t, 3> at) const {
        std::int64_t number = 0;
        for (std::size_t d = 3; d-- > 0;) {
            if (at[d] < 0 || at[d] >= count_[d]) {
                if (!setup_.periodic[d]) return true;
                at[d] = (at[d] + count_[d]) % count_[d];
            }
            number = number * count_[d] + at[d];
        }
        for (std::int64_t n = first_[static_cast<std::size_t>(number)]; n >= 0;
             n = next_[static_cast<std::size_t>(n)]) {
            const Particle& other = particles_[static_cast<std::size_t>(n)];
            double square = 0;
            for (int d = 0; d < setup_.dimension; ++d) {
                const auto k = static_cast<std::size_t>(d);
                double apart = p.place[k] - other.place[k];
                if (setup_.periodic[d]) apart -= setup_.length(d) * std::rint(apart / setup_.length(d));
                square += apart * apart;
            }
            const double reach = setup_.classes[p.kind].radius + setup_.classes[other.kind].radius;
            if (square < reach * reach) return false;
        }
        return true;
    }

    const Setup& setup_;
    std::vector<Particle>& particles_;
    std::array<std::int64_t, 3> count_{};
    std::vector<std::int64_t> first_, next_;
};

// Sites of a lattice of rectangular cells with two sites in the plane, four in space.
struct Lattice {
    std::array<std::int64_t, 3> cells{1, 1, 1};
    std::array<double, 3> edge{};
    double nearest = 0; // distance of sites, m
    std::int64_t sites = 0;
};

Lattice lattice_of(const Setup& setup, const Room& room, std::array<std::int64_t, 3> cells) {
    Lattice l;
    l.cells = cells;
    l.sites = setup.dimension == 3 ? 4 : 2;
    double half[3] = {0, 0, 0}, shortest = 1e300;
    for (std::size_t d = 0; d < static_cast<std::size_t>(setup.dimension); ++d) {
        // Between walls the last half cell is empty.
        const double parts = static_cast<double>(cells[d]) - (setup.periodic[d] ? 0 : 0.5);
        l.edge[d] = (room.upper[d] - room.lower[d]) / parts;
        half[d] = 0.5 * l.edge[d];
        l.sites *= cells[d];
        if (!(setup.periodic[d] && cells[d] == 1)) shortest = std::min(shortest, l.edge[d]);
    }
    if (setup.dimension == 2) {
        l.nearest = std::min(shortest, std::hypot(half[0], half[1]));
    } else {
        l.nearest = std::min({shortest, std::hypot(half[0], half[1]), std::hypot(half[0], half[2]),
                              std::hypot(half[1], half[2])});
    }
    return l;
}

// The lattice of at least `count` sites whose nearest ones are farthest apart.
Lattice widest_lattice(const Setup& setup, const Room& room, std::int64_t count) {
    const auto d = static_cast<std::size_t>(setup.dimension);
    double volume = 1;
    for (std::size_t c = 0; c < d; ++c) volume *= room.upper[c] - room.lower[c];
    const double share = volume / static_cast<double>(count) * (d == 3 ? 4 : 2);
    // A cell of the regular lattice: 1 x sqrt(3), and a cube.
    const double edge[2] = {d == 3 ? std::cbrt(share) : std::sqrt(share / std::sqrt(3.0)),
                            d == 3 ? std::cbrt(share) : std::sqrt(share * std::sqrt(3.0))};
    std::int64_t ideal[2];
    for (std::size_t c = 0; c < 2; ++c)
        ideal[c] = std::max<std::int64_t>(1, std::llround((room.upper[c] - room.lower[c]) / edge[c]));
    const std::int64_t per_cell = d == 3 ? 4 : 2;
    Lattice best;
    for (std::int64_t x = std::max<std::int64_t>(1, ideal[0] - 3); x <= ideal[0] + 3; ++x)
        for (std::int64_t y = std::max<std::int64_t>(1, ideal[1] - 3); y <= ideal[1] + 3; ++y) {
            std::int64_t z = 1;
            if (d == 3) z = (count + per_cell * x * y - 1) / (per_cell * x * y);
            if (per_cell * x * y * z < count) continue;
            const Lattice l = lattice_of(setup, room, {x, y, z});
            if (l.nearest > best.nearest) best = l;
        }
    return best;
}

void place_on_lattice(const Setup& setup, std::vector<Particle>& particles) {
    const double radius = setup.largest_radius();
    const Room room(setup, radius);
    const auto count = static_cast<std::int64_t>(particles.size());
    const Lattice l = widest_lattice(setup, room, count);
    if (l.nearest < 2 * radius * (1 + 1e-12))
        fail(Exit::invalid_input,
             "gas: {} particles of diameter {} m do not fit into the domain, not even on a lattice (sites "
             "{:.6g} m apart). Take fewer or smaller ones, or a larger domain",
             count, 2 * radius, l.nearest);
    const bool space = setup.dimension == 3;
    const std::int64_t per_cell = space ? 4 : 2;
    for (std::int64_t n = 0; n < count; ++n) {
        // Sites that stay empty are spread evenly.
        const auto site = static_cast<std::int64_t>(static_cast<double>(n) * static_cast<double>(l.sites) /
                                                    static_cast<double>(count));
        const std::int64_t cell = site / per_cell, in = site % per_cell;
        const std::int64_t at[3] = {cell % l.cells[0], cell / l.cells[0] % l.cells[1],
                                    cell / (l.cells[0] * l.cells[1])};
        // Halves of a cell: (0 0 0), (1 1 0), (1 0 1), (0 1 1).
        const std::int64_t half[3] = {in == 1 || in == 2, in == 1 || in == 3, in == 2 || in == 3};
        for (std::size_t d = 0; d < (space ? 3U : 2U); ++d)
            particles[static_cast<std::size_t>(n)].place[d] =
                room.lower[d] +
                (static_cast<double>(at[d]) + 0.5 * static_cast<double>(half[d])) * l.edge[d] +
                (setup.periodic[d] ? 0.25 * l.edge[d] : 0);
    }
}

} // namespace

double packing_fraction(const Setup& setup, const Amounts& amounts) {
    double sum = 0;
    for (std::size_t k = 0; k < amounts.size(); ++k)
        sum += amounts[k] * size_of(setup, setup.classes[k].radius);
    return sum / setup.volume();
}

// The largest ones first: the others find room between them.
bool place_at_random(const Setup& setup, std::vector<Particle>& particles) {
    std::vector<std::size_t> order(particles.size());
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return setup.classes[particles[a].kind].radius > setup.classes[particles[b].kind].radius;
    });
    Placed placed(setup, particles);
    constexpr std::uint32_t most_attempts = 20000;
    for (const std::size_t n : order) {
        Particle& p = particles[n];
        const Room room(setup, setup.classes[p.kind].radius);
        std::uint32_t attempt = 0;
        for (;; ++attempt) {
            if (attempt == most_attempts) return false;
            const auto xy = draw(setup, 2, p.id, attempt), z = draw(setup, 3, p.id, attempt);
            const double unit[3] = {xy[0], xy[1], z[0]};
            for (std::size_t d = 0; d < static_cast<std::size_t>(setup.dimension); ++d)
                p.place[d] = room.lower[d] + unit[d] * (room.upper[d] - room.lower[d]);
            if (placed.is_free(p)) break;
        }
        placed.add(n);
    }
    return true;
}

void place(const Setup& setup, std::vector<Particle>& particles, const Start& start) {
    if (start.kind == Start::Kind::growth) return grow(setup, particles, start);
    if (start.kind == Start::Kind::lattice) return place_on_lattice(setup, particles);
    Amounts amounts(setup.classes.size());
    for (const Particle& p : particles) ++amounts[p.kind];
    const double packing = packing_fraction(setup, amounts);
    const bool random = start.kind == Start::Kind::random || !setup.curved.empty();
    const bool loose = packing <= (setup.dimension == 3 ? 0.25 : 0.4);
    if ((random || loose) && place_at_random(setup, particles)) return;
    if (random)
        fail(Exit::invalid_input,
             "gas: {} particles, packing fraction {:.4g}, find no room at random{}. Take fewer or smaller "
             "ones, or a larger domain{}",
             particles.size(), packing, setup.curved.empty() ? "" : " between curved walls",
             setup.curved.empty() ? "; or edmd.start = \"growth\"" : "");
    place_on_lattice(setup, particles);
}

void heat(const Setup& setup, std::vector<Particle>& particles, double temperature, double spin_temperature) {
    const auto d = static_cast<std::size_t>(setup.dimension);
    const auto normals = [&](std::uint32_t block, std::uint32_t id) {
        const auto [u, w] = draw(setup, block, id, 0);
        const auto [u2, w2] = draw(setup, block + 1, id, 0);
        const auto a = laws::normal_pair(u, w), b = laws::normal_pair(u2, w2);
        return std::array<double, 3>{a[0], a[1], setup.dimension == 3 ? b[0] : 0.0};
    };
    std::array<double, 3> momentum{};
    double mass = 0;
    for (Particle& p : particles) {
        const Class& c = setup.classes[p.kind];
        p.velocity = normals(0, p.id);
        for (double& v : p.velocity) v /= std::sqrt(c.mass);
        for (std::size_t k = 0; k < d; ++k) momentum[k] += c.mass * p.velocity[k];
        mass += c.mass;
        if (!(spin_temperature > 0)) continue;
        const double speed = std::sqrt(spin_temperature / (c.inertia * c.mass)) / c.radius;
        const auto w = normals(4, p.id);
        for (std::size_t k = 0; k < 3; ++k) p.spin[k] = speed * w[k];
        if (d == 2) p.spin = {0, 0, speed * w[0]};
    }
    double energy = 0;
    for (Particle& p : particles)
        for (std::size_t k = 0; k < d; ++k) {
            p.velocity[k] -= momentum[k] / mass;
            energy += setup.classes[p.kind].mass * p.velocity[k] * p.velocity[k];
        }
    const double wanted = static_cast<double>(particles.size()) * static_cast<double>(d) * temperature;
    const double scale = energy > 0 ? std::sqrt(wanted / energy) : std::sqrt(temperature);
    for (Particle& p : particles)
        for (double& v : p.velocity) v *= scale;
}

std::vector<Particle> make_particles(const Setup& setup, const Amounts& amounts, double temperature,
                                     double spin_temperature, const Start& start) {
    std::vector<Particle> particles;
    for (std::uint32_t kind = 0; kind < amounts.size(); ++kind)
        for (std::uint32_t n = 0; n < amounts[kind]; ++n) {
            Particle p;
            p.id = static_cast<std::uint32_t>(particles.size());
            p.kind = kind;
            particles.push_back(p);
        }
    place(setup, particles, start);
    heat(setup, particles, temperature, spin_temperature);
    if (setup.shear != 0)
        for (Particle& p : particles) p.velocity[0] += setup.flow(p.place[1]);
    return particles;
}

} // namespace sandlane::edmd
