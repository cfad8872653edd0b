// What engines of gases share: samples of frames, pictures of particles.
#pragma once

#include "analysis/gas_samples.hpp"
#include "analysis/gas_structure.hpp"
#include "app/engine.hpp"

namespace sandlane::app {

// When frames for profile.csv and distribution.csv are taken [s]; every as for interval().
struct GasSampling {
    double every = 0, start = 0;
    double structure_every = 0; // s; 0 or less: never
};

class GasEngine : public Engine {
public:
    [[nodiscard]] virtual analysis::Snapshot snapshot() const = 0;
    [[nodiscard]] virtual GasSampling sampling() const = 0;
    [[nodiscard]] virtual analysis::GasSamples make_samples() const = 0;
    virtual void sample(analysis::GasSamples& samples) const = 0;
    [[nodiscard]] virtual analysis::GasVessel vessel() const = 0; // where the particles are now
    [[nodiscard]] virtual analysis::GasStructure make_structure() const = 0;
    [[nodiscard]] virtual std::vector<analysis::StructureParticle> structure_particles() const = 0;

    void draw(const std::filesystem::path& png, const Look& look) const override;
};

// Cells to count particles in: a mean free path long, but ten particles each at least.
[[nodiscard]] double counting_cell(double free_path, double volume, std::size_t particles, int dimension);

// An empty snapshot of the box of a scene.
[[nodiscard]] analysis::Snapshot snapshot_of_box(const scene::Scene& scene);
// Adds a particle with place, velocity, spin and image, arrays of three numbers.
template <class Particle>
void add_particle(analysis::Snapshot& s, const Particle& p, double radius, double mass, std::int32_t kind) {
    s.id.push_back(p.id);
    s.x.push_back(p.place[0]);
    s.y.push_back(p.place[1]);
    s.vx.push_back(p.velocity[0]);
    s.vy.push_back(p.velocity[1]);
    s.omega.push_back(p.spin[2]);
    s.image_x.push_back(static_cast<std::int32_t>(p.image[0]));
    s.image_y.push_back(static_cast<std::int32_t>(p.image[1]));
    if (s.dimension == 3) {
        s.z.push_back(p.place[2]);
        s.vz.push_back(p.velocity[2]);
        s.omega_x.push_back(p.spin[0]);
        s.omega_y.push_back(p.spin[1]);
        s.image_z.push_back(static_cast<std::int32_t>(p.image[2]));
    }
    s.angle.push_back(0);
    s.radius.push_back(radius);
    s.mass.push_back(mass);
    s.pressure.push_back(0);
    s.material.push_back(kind);
}

} // namespace sandlane::app
