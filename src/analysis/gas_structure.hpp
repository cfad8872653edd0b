// Structure of a gas of particles: the spectra of density and of transverse momentum, clusters of particles
// that are close, fluctuations of the number in cells. All are one, or what they are by chance, in a uniform
// gas.
#pragma once

#include "analysis/gas_samples.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::analysis {

struct StructurePlan {
    GasFrame gas;
    bool periodic[3] = {true, true, true};
    double reach =
        1.2;         // particles belong together if their distance is below this times the sum of their radii
    double cell = 1; // m, about: of the cells whose particles are counted
};

// A particle as it is seen here.
struct StructureParticle {
    std::array<double, 3> place{}, velocity{}; // m, m/s
    double mass = 1, radius = 0.5;             // kg, m: of the volume of those that it stands for
};

// What a frame is, in one row of a table.
struct StructureRow {
    double time = 0;
    double largest = 0;     // fraction of the particles in the largest cluster
    double mean_size = 0;   // of the cluster of a particle
    double density = 1;     // S(k) of the longest waves
    double shear = 1;       // the same of transverse momentum, over its value in equilibrium
    double fluctuation = 1; // variance of the number of particles in a cell over that of chance
};

class GasStructure {
public:
    explicit GasStructure(const StructurePlan& plan);

    // vessel: where the particles are now. counts: the frame takes part in averages.
    void add(double time, const std::vector<StructureParticle>& particles, const GasVessel& vessel,
             bool counts);

    [[nodiscard]] const std::vector<StructureRow>& rows() const { return rows_; }
    // By shell of wave numbers, ascending: the last frame, and the mean of those that count.
    struct Shell {
        double k = 0; // mean of its waves, 1/m
        double density = 0, shear = 0, mean_density = 0, mean_shear = 0;
    };
    [[nodiscard]] std::vector<Shell> shells() const;
    // Clusters of the last frame whose sizes are 2^n to 2^(n + 1) - 1.
    [[nodiscard]] const std::vector<double>& sizes() const { return sizes_; }

    // Tables with a header, as CSV.
    [[nodiscard]] std::string clusters_csv() const; // a row per frame
    [[nodiscard]] std::string structure_csv() const;
    [[nodiscard]] std::string sizes_csv() const;

    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes);

private:
    struct Wave {
        std::array<int, 3> n{}; // periods in the box
        std::size_t shell = 0;
    };
    void take_spectra(const std::vector<StructureParticle>& particles, StructureRow& row);
    void take_clusters(const std::vector<StructureParticle>& particles, StructureRow& row);
    void take_fluctuation(const std::vector<StructureParticle>& particles, const GasVessel& vessel,
                          StructureRow& row);

    StructurePlan plan_;
    std::vector<Wave> waves_;
    std::vector<double> k_, count_; // of the shells: mean wave number, number of waves
    std::vector<double> density_, shear_, density_sum_, shear_sum_, sizes_;
    std::vector<StructureRow> rows_;
    std::int64_t counted_ = 0;
    GasVessel vessel_;            // of the last frame
    std::vector<double> volumes_; // of the cells in it
};

} // namespace sandlane::analysis
