#include "analysis/gas_structure.hpp"

#include "analysis/sets.hpp"
#include "core/bytes.hpp"
#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace sandlane::analysis {

namespace {

// Waves of so many periods in the longest periodic direction, at most.
int most_periods(int dimension) {
    return dimension == 3 ? 8 : 20;
}

double wrapped(double distance, double period) {
    return distance - period * std::round(distance / period);
}

// Which cell of a row of equal ones; a place on the upper side belongs to the last.
std::size_t cell_at(double place, double lower, double length, std::size_t cells) {
    const double at = std::floor((place - lower) / length * static_cast<double>(cells));
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(cells - 1)));
}

} // namespace

GasStructure::GasStructure(const StructurePlan& plan) : plan_(plan) {
    const GasFrame& gas = plan_.gas;
    double longest = 0;
    int most[3] = {};
    const auto length = [&](int d) { return gas.upper[d] - gas.lower[d]; };
    for (int d = 0; d < gas.dimension; ++d)
        if (plan_.periodic[d]) longest = std::max(longest, length(d));
    for (int d = 0; d < gas.dimension; ++d)
        if (plan_.periodic[d]) most[d] = static_cast<int>(most_periods(gas.dimension) * length(d) / longest);
    k_.assign(static_cast<std::size_t>(2 * most_periods(gas.dimension) - 1), 0.0);
    count_ = k_;
    // Shells are half a wave number of the longest side thick, so that its longest waves are by themselves.
    // Of a wave and its opposite only one.
    for (int z = 0; z <= most[2]; ++z)
        for (int y = z > 0 ? -most[1] : 0; y <= most[1]; ++y)
            for (int x = z > 0 || y > 0 ? -most[0] : 1; x <= most[0]; ++x) {
                const int n[3] = {x, y, z};
                double square = 0;
                for (int d = 0; d < gas.dimension; ++d) {
                    const double k = 2 * std::numbers::pi * n[d] / length(d);
                    square += k * k;
                }
                const double k = std::sqrt(square), shell = std::round(k * longest / std::numbers::pi);
                if (shell < 2 || shell > 2.0 * most_periods(gas.dimension)) continue;
                const auto s = static_cast<std::size_t>(shell) - 2;
                waves_.push_back({{x, y, z}, s});
                k_[s] += k;
                count_[s] += 1;
            }
    for (std::size_t s = 0; s < k_.size(); ++s) k_[s] /= std::max(count_[s], 1.0);
    density_ = shear_ = density_sum_ = shear_sum_ = std::vector<double>(k_.size(), 0.0);
}

void GasStructure::add(double time, const std::vector<StructureParticle>& particles, const GasVessel& vessel,
                       bool counts) {
    if (particles.empty()) return;
    StructureRow row;
    row.time = time;
    take_spectra(particles, row);
    take_clusters(particles, row);
    take_fluctuation(particles, vessel, row);
    rows_.push_back(row);
    if (!counts) return;
    ++counted_;
    for (std::size_t s = 0; s < k_.size(); ++s) {
        density_sum_[s] += density_[s];
        shear_sum_[s] += shear_[s];
    }
}

// |sum exp(-i k r)|^2/N; and of the momentum across k, over (d - 1) T sum m.
void GasStructure::take_spectra(const std::vector<StructureParticle>& particles, StructureRow& row) {
    using Complex = std::complex<double>;
    if (waves_.empty()) return;
    const GasFrame& gas = plan_.gas;
    const auto d = static_cast<std::size_t>(gas.dimension);
    double masses = 0, mean[3] = {}, temperature = 0;
    for (const StructureParticle& p : particles) {
        masses += p.mass;
        for (std::size_t c = 0; c < d; ++c) mean[c] += p.mass * p.velocity[c];
    }
    for (double& u : mean) u /= masses;
    for (const StructureParticle& p : particles)
        for (std::size_t c = 0; c < d; ++c)
            temperature += p.mass * (p.velocity[c] - mean[c]) * (p.velocity[c] - mean[c]);
    temperature /= static_cast<double>(d * particles.size());

    const int most = most_periods(gas.dimension);
    struct Sum {
        Complex density, momentum[3];
    };
    std::vector<Sum> sums(waves_.size());
    std::vector<Complex> power[3]; // exp(-2 pi i n x/L), n = -most to most
    for (auto& p : power) p.assign(static_cast<std::size_t>(2 * most + 1), Complex(1, 0));
    for (const StructureParticle& p : particles) {
        for (std::size_t c = 0; c < d; ++c) {
            const double turn =
                -2 * std::numbers::pi * (p.place[c] - gas.lower[c]) / (gas.upper[c] - gas.lower[c]);
            const Complex step(std::cos(turn), std::sin(turn));
            const auto middle = static_cast<std::size_t>(most);
            for (std::size_t n = 1; n <= middle; ++n) {
                power[c][middle + n] = power[c][middle + n - 1] * step;
                power[c][middle - n] = std::conj(power[c][middle + n]);
            }
        }
        double momentum[3] = {};
        for (std::size_t c = 0; c < d; ++c) momentum[c] = p.mass * (p.velocity[c] - mean[c]);
        for (std::size_t w = 0; w < waves_.size(); ++w) {
            const auto at = [&](std::size_t c) {
                return power[c][static_cast<std::size_t>(waves_[w].n[c] + most)];
            };
            Complex phase = at(0) * at(1);
            if (d == 3) phase *= at(2);
            sums[w].density += phase;
            for (std::size_t c = 0; c < d; ++c) sums[w].momentum[c] += momentum[c] * phase;
        }
    }
    std::fill(density_.begin(), density_.end(), 0.0);
    std::fill(shear_.begin(), shear_.end(), 0.0);
    for (std::size_t w = 0; w < waves_.size(); ++w) {
        double k[3] = {}, square = 0, all = 0;
        Complex along(0, 0);
        for (std::size_t c = 0; c < d; ++c) {
            k[c] = waves_[w].n[c] / (gas.upper[c] - gas.lower[c]);
            square += k[c] * k[c];
        }
        for (std::size_t c = 0; c < d; ++c) {
            along += k[c] / std::sqrt(square) * sums[w].momentum[c];
            all += std::norm(sums[w].momentum[c]);
        }
        const std::size_t s = waves_[w].shell;
        density_[s] += std::norm(sums[w].density) / static_cast<double>(particles.size()) / count_[s];
        if (temperature > 0)
            shear_[s] +=
                (all - std::norm(along)) / (static_cast<double>(d - 1) * temperature * masses) / count_[s];
    }
    row.density = density_.front();
    row.shear = shear_.front();
}

void GasStructure::take_clusters(const std::vector<StructureParticle>& particles, StructureRow& row) {
    const GasFrame& gas = plan_.gas;
    const auto d = static_cast<std::size_t>(gas.dimension);
    double widest = 0;
    for (const StructureParticle& p : particles) widest = std::max(widest, p.radius);
    std::size_t cells[3] = {1, 1, 1}, total = 1;
    double length[3] = {1, 1, 1};
    const double room = std::pow(static_cast<double>(particles.size()), 1.0 / gas.dimension) + 1;
    for (std::size_t c = 0; c < d; ++c) {
        length[c] = gas.upper[c] - gas.lower[c];
        // Not many more cells than particles.
        const double most = std::min(length[c] / (2 * plan_.reach * widest), 2 * room);
        cells[c] = static_cast<std::size_t>(std::max(1.0, std::floor(most)));
        total *= cells[c];
    }
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> first(total, none), next(particles.size(), none);
    const auto cell_of = [&](const StructureParticle& p, std::size_t c) {
        return cell_at(p.place[c], gas.lower[c], length[c], cells[c]);
    };
    const auto number = [&](const std::array<std::size_t, 3>& at) {
        return at[0] + cells[0] * (at[1] + cells[1] * at[2]);
    };
    const auto place = [&](const StructureParticle& p) {
        std::array<std::size_t, 3> at{};
        for (std::size_t c = 0; c < d; ++c) at[c] = cell_of(p, c);
        return at;
    };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::size_t& head = first[number(place(particles[i]))];
        next[i] = head;
        head = i;
    }
    Sets sets(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const StructureParticle& p = particles[i];
        const auto at = place(p);
        for (int direction = 0; direction < (d == 3 ? 27 : 9); ++direction) {
            std::array<std::size_t, 3> to{};
            bool exists = true;
            const int step[3] = {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
            for (std::size_t c = 0; c < d; ++c) {
                const auto count = static_cast<std::int64_t>(cells[c]);
                std::int64_t n = static_cast<std::int64_t>(at[c]) + step[c];
                if (plan_.periodic[c]) n = (n + count) % count;
                exists = exists && n >= 0 && n < count;
                to[c] = static_cast<std::size_t>(std::max<std::int64_t>(n, 0));
            }
            for (std::size_t j = exists ? first[number(to)] : none; j != none; j = next[j]) {
                if (j <= i) continue;
                double square = 0;
                for (std::size_t c = 0; c < d; ++c) {
                    double apart = p.place[c] - particles[j].place[c];
                    if (plan_.periodic[c]) apart = wrapped(apart, length[c]);
                    square += apart * apart;
                }
                const double together = plan_.reach * (p.radius + particles[j].radius);
                if (square < together * together) sets.join(i, j);
            }
        }
    }
    std::vector<std::uint64_t> size(particles.size(), 0);
    for (std::size_t i = 0; i < particles.size(); ++i) ++size[sets.root(i)];
    sizes_.assign(1, 0.0);
    double largest = 0, squares = 0;
    for (const std::uint64_t n : size) {
        if (n == 0) continue;
        const auto bin = static_cast<std::size_t>(std::bit_width(n) - 1);
        if (bin >= sizes_.size()) sizes_.resize(bin + 1, 0.0);
        sizes_[bin] += 1;
        largest = std::max(largest, static_cast<double>(n));
        squares += static_cast<double>(n) * static_cast<double>(n);
    }
    row.largest = largest / static_cast<double>(particles.size());
    row.mean_size = squares / static_cast<double>(particles.size());
}

// By chance the number in a cell with the part p of the volume has the variance N p (1 - p).
void GasStructure::take_fluctuation(const std::vector<StructureParticle>& particles, const GasVessel& vessel,
                                    StructureRow& row) {
    const GasFrame& gas = plan_.gas;
    const auto d = static_cast<std::size_t>(gas.dimension);
    CellGrid grid;
    std::copy_n(gas.lower, 3, grid.lower);
    std::copy_n(gas.upper, 3, grid.upper);
    for (std::size_t c = 0; c < d; ++c)
        grid.cells[c] = static_cast<std::size_t>(
            std::clamp(std::floor((gas.upper[c] - gas.lower[c]) / plan_.cell), 1.0, 4096.0));
    const std::size_t total = grid.cells[0] * grid.cells[1] * grid.cells[2];
    if (total < 2) return;
    if (volumes_.size() != total || !(vessel == vessel_)) {
        volumes_ = contents(vessel, grid);
        vessel_ = vessel;
    }
    std::vector<double> count(total, 0.0);
    for (const StructureParticle& p : particles) {
        std::size_t at = 0;
        for (std::size_t c = d; c-- > 0;)
            at = at * grid.cells[c] +
                 cell_at(p.place[c], gas.lower[c], gas.upper[c] - gas.lower[c], grid.cells[c]);
        count[at] += 1;
    }
    const double volume = std::accumulate(volumes_.begin(), volumes_.end(), 0.0),
                 n = static_cast<double>(particles.size());
    double variance = 0, of_chance = 0;
    for (std::size_t at = 0; at < total; ++at) {
        const double part = volumes_[at] / volume;
        variance += (count[at] - n * part) * (count[at] - n * part);
        of_chance += n * part * (1 - part);
    }
    row.fluctuation = of_chance > 0 ? variance / of_chance : 1;
}

std::vector<GasStructure::Shell> GasStructure::shells() const {
    std::vector<Shell> all;
    const auto n = static_cast<double>(std::max<std::int64_t>(counted_, 1));
    for (std::size_t s = 0; s < k_.size(); ++s)
        if (count_[s] > 0)
            all.push_back({k_[s], density_[s], shear_[s], density_sum_[s] / n, shear_sum_[s] / n});
    return all;
}

std::string GasStructure::clusters_csv() const {
    std::string text = "time[s],largest_cluster[1],mean_cluster[1],density_spectrum[1],shear_spectrum[1],"
                       "number_fluctuation[1]\n";
    for (const StructureRow& r : rows_)
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", r.time, r.largest, r.mean_size,
                            r.density, r.shear, r.fluctuation);
    return text;
}

std::string GasStructure::structure_csv() const {
    std::string text = "k[1/m],structure_factor[1],shear_spectrum[1],mean_structure_factor[1],"
                       "mean_shear_spectrum[1]\n";
    for (const Shell& s : shells())
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", s.k, s.density, s.shear, s.mean_density,
                            s.mean_shear);
    return text;
}

std::string GasStructure::sizes_csv() const {
    std::string text = "size_from[1],size_to[1],clusters[1]\n";
    for (std::size_t n = 0; n < sizes_.size(); ++n)
        text += fmt::format("{},{},{:.9g}\n", std::uint64_t{1} << n, (std::uint64_t{2} << n) - 1, sizes_[n]);
    return text;
}

std::string GasStructure::serialise() const {
    ByteWriter out;
    out.put(counted_);
    out.put_array(rows_.data(), rows_.size());
    for (const auto* column : {&density_, &shear_, &density_sum_, &shear_sum_, &sizes_})
        out.put_array(column->data(), column->size());
    return std::move(out).bytes();
}

void GasStructure::restore(const std::string& bytes) {
    ByteReader in(bytes);
    counted_ = in.get<std::int64_t>();
    in.get_array(rows_);
    for (auto* column : {&density_, &shear_, &density_sum_, &shear_sum_, &sizes_}) in.get_array(*column);
    for (const auto* column : {&density_, &shear_, &density_sum_, &shear_sum_})
        if (column->size() != k_.size()) fail(Exit::io, "structure of the gas: damaged, or of another scene");
    if (!in.at_end()) fail(Exit::io, "structure of the gas: damaged, or of another scene");
}

} // namespace sandlane::analysis
