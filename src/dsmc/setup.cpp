#include "dsmc/setup.hpp"

#include "core/error.hpp"
#include "core/rng.hpp"
#include "dsmc/theory.hpp"
#include "laws/collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::dsmc {

double Setup::volume() const {
    const double area = (upper[0] - lower[0]) * (upper[1] - lower[1]);
    return dimension == 3 ? area * (upper[2] - lower[2]) : area;
}
double Setup::cell_volume() const {
    const double count = static_cast<double>(cells[0]) * cells[1] * (dimension == 3 ? cells[2] : 1);
    return volume() / count;
}
double Setup::cross_section() const {
    double longest = diameter;
    for (const Kind& k : others) longest = std::max(longest, k.diameter);
    return dimension == 3 ? std::numbers::pi * longest * longest : 2 * longest;
}
double Setup::particle_volume() const {
    double sum = 0;
    for (std::size_t n = 0; n < kinds(); ++n) {
        const Kind k = kind(n);
        const double square = std::numbers::pi * k.diameter * k.diameter;
        sum += k.fraction * (dimension == 3 ? square * k.diameter / 6 : square / 4);
    }
    return sum;
}
Kind Setup::kind(std::size_t k) const {
    if (k > 0) return others[k - 1];
    double rest = 1;
    for (const Kind& other : others) rest -= other.fraction;
    return {mass, diameter, rest};
}
laws::Restitution Setup::restitution_of(std::size_t i, std::size_t j) const {
    laws::Restitution law = restitution;
    for (const PairRestitution& p : pairs)
        if ((p.first == i && p.second == j) || (p.first == j && p.second == i)) {
            law.eps = p.eps;
            law.dissipation = p.dissipation;
        }
    return law;
}

simd::GasMixture mixture_of(const Setup& setup) {
    simd::GasMixture m{};
    double longest = setup.diameter;
    for (const Kind& k : setup.others) longest = std::max(longest, k.diameter);
    m.largest_contact = 0.5 * longest;
    m.dense = setup.enskog;
    const double part =
        setup.weight * std::numbers::pi / (setup.dimension == 3 ? 6 : 4) / setup.cell_volume();
    for (std::size_t i = 0; i < setup.kinds(); ++i) {
        const Kind a = setup.kind(i);
        m.radius[i] = 0.5 * a.diameter;
        m.lower_moment[i] = part * (setup.dimension == 3 ? a.diameter * a.diameter : a.diameter);
        m.upper_moment[i] = m.lower_moment[i] * a.diameter;
        for (std::size_t j = 0; j < setup.kinds(); ++j) {
            const Kind b = setup.kind(j);
            const std::size_t pair = simd::most_kinds * i + j;
            const double reach = 0.5 * (a.diameter + b.diameter) / longest;
            m.section[pair] = setup.dimension == 3 ? reach * reach : reach;
            m.contact[pair] = a.diameter * b.diameter / (a.diameter + b.diameter);
            m.share[pair] = b.mass / (a.mass + b.mass);
            const laws::Restitution law = setup.restitution_of(i, j);
            m.coefficient[pair] =
                law.model == laws::Restitution::Model::viscoelastic ? std::sqrt(law.dissipation) : law.eps;
        }
    }
    return m;
}

std::vector<Particle> maxwellian(const Setup& setup, std::uint32_t count, double temperature,
                                 double spin_temperature) {
    std::vector<Particle> particles(count);
    const PhiloxKey key{static_cast<std::uint32_t>(setup.seed), static_cast<std::uint32_t>(setup.seed >> 32)};
    const auto draw = [&](std::uint32_t block, std::uint32_t id) {
        const PhiloxCounter w =
            philox({block, id, 0, static_cast<std::uint32_t>(simd::GasStream::start)}, key);
        return std::array<double, 2>{unit_number(w[0], w[1]), unit_number(w[2], w[3])};
    };
    const auto d = static_cast<std::size_t>(setup.dimension);
    const auto normals = [&](std::uint32_t block, std::uint32_t id) {
        const auto [u, w] = draw(block, id);
        const auto [u2, w2] = draw(block + 1, id);
        const auto a = laws::normal_pair(u, w), b = laws::normal_pair(u2, w2);
        return std::array<double, 3>{a[0], a[1], setup.dimension == 3 ? b[0] : 0.0};
    };
    std::array<double, 3> mean{};
    double masses = 0; // of all, over that of the first
    // The first kind takes what rounding leaves of the others.
    std::vector<std::uint32_t> end(setup.kinds(), count);
    for (std::size_t k = setup.kinds() - 1; k > 0; --k)
        end[k - 1] = end[k] - static_cast<std::uint32_t>(std::lround(setup.kind(k).fraction * count));
    std::vector<double> mass_ratio(setup.kinds());
    for (std::size_t k = 0; k < setup.kinds(); ++k) mass_ratio[k] = setup.kind(k).mass / setup.mass;
    for (std::uint32_t id = 0; id < count; ++id) {
        Particle& p = particles[id];
        p.id = id;
        while (id >= end[p.kind]) ++p.kind;
        const double ratio = mass_ratio[p.kind], slower = 1 / std::sqrt(ratio);
        masses += ratio;
        p.velocity = normals(0, id);
        for (double& v : p.velocity) v *= slower;
        const auto xy = draw(2, id), z = draw(3, id);
        const double unit[3] = {xy[0], xy[1], z[0]};
        for (std::size_t c = 0; c < d; ++c) {
            double from = setup.lower[c], to = setup.upper[c];
            if (!setup.walls.periodic[c]) { // clear of walls that oscillate
                from += setup.walls.side[c][0].motion.amplitude;
                to -= setup.walls.side[c][1].motion.amplitude;
            }
            p.place[c] = from + unit[c] * (to - from);
            mean[c] += ratio * p.velocity[c];
        }
        if (spin_temperature > 0) {
            const Kind kind = setup.kind(p.kind);
            const double radius = 0.5 * kind.diameter;
            const double speed = std::sqrt(spin_temperature / (setup.inertia * kind.mass * radius * radius));
            const auto w = normals(4, id);
            for (std::size_t c = 0; c < 3; ++c) p.spin[c] = speed * w[c];
            if (setup.dimension == 2) p.spin = {0, 0, speed * w[0]};
        }
    }
    double square = 0;
    for (Particle& p : particles)
        for (std::size_t c = 0; c < d; ++c) {
            p.velocity[c] -= mean[c] / masses;
            square += mass_ratio[p.kind] * (p.velocity[c] * p.velocity[c]);
        }
    const double wanted = static_cast<double>(count) * static_cast<double>(d) * temperature / setup.mass;
    const double scale = square > 0 ? std::sqrt(wanted / square) : std::sqrt(temperature / setup.mass);
    for (Particle& p : particles) {
        for (std::size_t c = 0; c < d; ++c) p.velocity[c] *= scale;
        if (setup.shear != 0) p.velocity[0] += setup.flow(p.place[1]);
    }
    return particles;
}

analysis::GasFrame frame_of(const Setup& setup) {
    analysis::GasFrame f;
    f.dimension = setup.dimension;
    for (int d = 0; d < 3; ++d) {
        f.lower[d] = setup.lower[d];
        f.upper[d] = setup.upper[d];
    }
    f.particle_volume = setup.particle_volume();
    f.weight = setup.weight;
    f.mass = setup.mass;
    f.rough = setup.rough;
    f.moment = setup.inertia * setup.mass * 0.25 * setup.diameter * setup.diameter;
    return f;
}

analysis::GasVessel vessel_of(const Setup& setup, double time) {
    analysis::GasVessel v = frame_of(setup).box();
    for (int d = 0; d < setup.dimension; ++d) {
        const auto moved = [&](int upper) {
            const simd::GasSide& side = setup.walls.side[d][upper];
            return side.moves() ? side.motion.displacement(time) : 0.0;
        };
        v.lower[d] += moved(0);
        v.upper[d] -= moved(1);
    }
    return v;
}

Scales scales(const Setup& setup, std::size_t particles, double temperature) {
    Scales s;
    s.density = static_cast<double>(particles) * setup.weight / setup.volume();
    s.packing = s.density * setup.particle_volume();
    if (setup.enskog && s.packing < 1) s.correlation = laws::contact_correlation(setup.dimension, s.packing);
    const double t = temperature / setup.mass, pi = std::numbers::pi;
    s.speed = std::sqrt((setup.dimension == 3 ? 8 / pi : pi / 2) * t);
    double eps = laws::restitution(setup.restitution, 2 * std::sqrt(t)), loss = 1 - eps * eps;
    if (setup.others.empty()) {
        const double relative = setup.dimension == 3 ? 4 * std::sqrt(t / pi) : std::sqrt(pi * t);
        s.collision_rate = s.density * s.correlation * setup.cross_section() * relative;
    } else {
        s.collision_rate = analysis::collision_rate(mixture_gas(setup, particles), temperature);
        double speed = 0; // mean of the kinds
        for (std::size_t k = 0; k < setup.kinds(); ++k)
            speed += setup.kind(k).fraction * s.speed * std::sqrt(setup.mass / setup.kind(k).mass);
        s.speed = speed;
        for (const PairRestitution& p : setup.pairs) {
            eps = laws::restitution(setup.restitution_of(p.first, p.second), 2 * std::sqrt(t));
            loss = std::max(loss, 1 - eps * eps);
        }
    }
    s.free_path = s.collision_rate > 0 ? s.speed / s.collision_rate : std::numeric_limits<double>::infinity();
    s.cooling = s.collision_rate * loss / setup.dimension;
    return s;
}

std::vector<std::string> warnings(const Setup& setup, std::size_t particles, double temperature,
                                  double drift) {
    std::vector<std::string> found;
    const Scales s = scales(setup, particles, temperature);
    double longest = 0, shortest = 0, count = 1;
    for (int d = 0; d < setup.dimension; ++d) {
        count *= setup.cells[d];
        if (setup.cells[d] == 1) continue; // the same everywhere along it
        longest = std::max(longest, setup.edge(d));
        shortest = shortest > 0 ? std::min(shortest, setup.edge(d)) : setup.edge(d);
    }
    if (longest > 0 && 3 * longest > s.free_path)
        found.push_back(
            fmt::format("cells of {:.3g} m are longer than a third of the mean free path, {:.3g} m: "
                        "transport coefficients come out too large",
                        longest, s.free_path));
    if (s.collision_rate * setup.dt > 0.2)
        found.push_back(fmt::format("{:.3g} collisions per particle and step, above 0.2: use dt <= {:.3g} s",
                                    s.collision_rate * setup.dt, 0.2 / s.collision_rate));
    double lightest = setup.mass;
    for (const Kind& k : setup.others) lightest = std::min(lightest, k.mass);
    const double reach = (drift + 2 * std::sqrt(2 * temperature / lightest)) * setup.dt;
    if (shortest > 0 && 2 * reach > shortest)
        found.push_back(
            fmt::format("fast particles cross {:.2g} cells in a step, more than half of one: use dt "
                        "<= {:.3g} s",
                        reach / shortest, 0.5 * shortest * setup.dt / reach));
    const double per_cell = static_cast<double>(particles) / count;
    if (per_cell < 5)
        found.push_back(
            fmt::format("{:.3g} particles per cell, fewer than 5: fluctuations bias the result", per_cell));
    if (setup.adaptive && s.cooling * setup.dt > 0.02)
        found.push_back(
            fmt::format("the gas loses {:.2g} of its temperature in a step, more than 0.02: use dt <= "
                        "{:.3g} s",
                        s.cooling * setup.dt, 0.02 / s.cooling));
    if (!setup.enskog && s.packing > 0.01)
        found.push_back(fmt::format(
            "packing fraction {:.3g}: without the Enskog factor collisions are too rare by "
            "a factor {:.3g}",
            s.packing, s.packing < 0.7 ? laws::contact_correlation(setup.dimension, s.packing) : 99));
    return found;
}

} // namespace sandlane::dsmc
