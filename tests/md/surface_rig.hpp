// Spheres and walls in space without a simulation around them: forces at given places, and a plain velocity
// Verlet integrator.
#pragma once

#include "core/parallel.hpp"
#include "md/plan.hpp"
#include "md/walls.hpp"
#include "support/stl_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sandlane::test {

struct Sphere {
    Vec position{}, velocity{}, angular_velocity{};
    double radius = 0.01, mass = 0.01;
    int material = 0;
    Vec force{}, torque{};
};

inline scene::Scene space() {
    scene::Scene s;
    s.domain.dimension = 3;
    s.domain.lower = {-2, -2, -2};
    s.domain.upper = {2, 2, 2};
    s.materials = {scene::Material{}};
    s.materials[0].name = "m";
    s.md.normal = scene::NormalLaw::linear_dashpot;
    s.md.tangential = scene::TangentialLaw::none;
    return s;
}

inline scene::Wall plane_wall(Vec point, Vec normal) {
    scene::Wall w;
    w.kind = scene::WallKind::plane;
    w.points = {point};
    w.normal = normal;
    return w;
}

inline scene::Wall mesh_wall(const std::string& name, const Triangles& triangles) {
    scene::Wall w;
    w.kind = scene::WallKind::mesh;
    w.file = stl_file("md_" + name, stl_text(triangles));
    return w;
}

inline scene::Scene springs_and_friction() {
    scene::Scene s = space();
    s.md.tangential = scene::TangentialLaw::cundall_strack;
    s.materials[0].stiffness = 1e5;
    s.materials[0].friction = 0.5;
    s.materials[0].tangential_stiffness = 3e4;
    s.materials[0].tangential_damping = 0.3;
    return s;
}

// What walls want to know of a state besides its records.
inline md::State numbered(std::size_t grains) {
    md::State state;
    state.dimension = 3;
    state.mass.resize(grains);
    state.id.resize(grains);
    for (std::size_t i = 0; i < grains; ++i) state.id[i] = static_cast<std::int64_t>(i);
    return state;
}

class SurfaceRig {
public:
    SurfaceRig(const scene::Scene& scene, std::vector<Sphere> grains, double time_step, int thread_count = 1)
        : spheres(std::move(grains)), dt(time_step), threads(thread_count),
          coefficients_(md::pair_table(scene)), materials_(static_cast<int>(scene.materials.size())),
          gravity_(scene.domain.gravity), state_(numbered(spheres.size())) {
        md::Plan plan;
        plan.normal = static_cast<int>(scene.md.normal);
        plan.tangential = static_cast<int>(scene.md.tangential);
        const bool springs = scene.md.tangential == scene::TangentialLaw::cundall_strack;
        plan.memory = springs ? laws::CundallStrack::memory_in_space : 0;
        plan.lower = scene.domain.lower;
        plan.upper = scene.domain.upper;
        plan.threads = thread_count;
        md::Needs needs;
        needs.radius_min = needs.radius_max = spheres.front().radius;
        for (const Sphere& s : spheres) {
            needs.radius_min = std::min(needs.radius_min, s.radius);
            needs.radius_max = std::max(needs.radius_max, s.radius);
        }
        walls = md::Walls(scene, plan, needs);
    }

    // Forces and torques on the spheres at time t; whether candidates come from the list.
    void evaluate(double time, bool list = true) {
        fill_records();
        walls.move_to(time);
        walls.account(largest_displacement());
        walls.update(state_, records_.data());
        forces_.assign(spheres.size() * 8, 0.0);
        std::vector<md::WallResult> results(state_.tiles());
        for_tiles(state_.tiles(), threads, [&](std::size_t tile) {
            results[tile] = walls.add_forces(input(tile), tile, spheres.size(), list);
        });
        power = 0;
        for (const md::WallResult& r : results) power += r.power;
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const double* f = forces_.data() + 8 * i;
            spheres[i].force = {f[0], f[1], f[2]};
            spheres[i].torque = spheres[i].radius * Vec{f[4], f[5], f[6]};
        }
    }

    // One time step; the first call starts at t = 0 with evaluate(0).
    void step() {
        if (steps_ == 0) evaluate(0);
        const std::vector<Sphere> old = spheres;
        for (Sphere& s : spheres) {
            const Vec a = acceleration(s), b = spin_up(s);
            s.position = s.position + dt * s.velocity + (0.5 * dt * dt) * a;
            s.velocity = s.velocity + dt * a;
            s.angular_velocity = s.angular_velocity + dt * b;
        }
        const double power_before = power;
        evaluate(static_cast<double>(++steps_) * dt);
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            Sphere& s = spheres[i];
            s.velocity = old[i].velocity + (0.5 * dt) * (acceleration(old[i]) + acceleration(s));
            s.angular_velocity = old[i].angular_velocity + (0.5 * dt) * (spin_up(old[i]) + spin_up(s));
        }
        work += 0.5 * dt * (power_before + power);
    }

    [[nodiscard]] const std::vector<double>& forces() const { return forces_; }
    void forget_list() { walls.invalidate(state_); }

    std::vector<Sphere> spheres;
    md::Walls walls;
    double dt, power = 0, work = 0; // s, W, J
    int threads;

private:
    [[nodiscard]] Vec acceleration(const Sphere& s) const { return (1 / s.mass) * s.force + gravity_; }
    [[nodiscard]] static Vec spin_up(const Sphere& s) {
        return (2.5 / (s.mass * s.radius * s.radius)) * s.torque;
    }

    void fill_records() {
        before_.swap(records_);
        records_.clear();
        spins_.clear();
        material_.clear();
        for (const Sphere& s : spheres) {
            const Vec p = s.position, v = s.velocity, w = s.angular_velocity;
            records_.insert(records_.end(),
                            {p.x, p.y, p.z, v.x * dt, v.y * dt, v.z * dt, s.radius, 1 / s.radius});
            spins_.insert(spins_.end(), {w.x * dt, w.y * dt, w.z * dt, s.radius});
            material_.push_back(s.material);
        }
    }
    [[nodiscard]] double largest_displacement() const {
        double largest = 0;
        for (std::size_t i = 0; i < before_.size() / 8; ++i) {
            const double* a = before_.data() + 8 * i;
            const double* b = records_.data() + 8 * i;
            largest = std::max(largest, norm(Vec{b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
        }
        return largest + dt * walls.fastest();
    }
    [[nodiscard]] md::WallInput input(std::size_t tile) {
        md::WallInput in{records_.data(),
                         material_.data(),
                         coefficients_.data(),
                         materials_,
                         forces_.data() + 8 * tile * md::tile_size,
                         tile * md::tile_size};
        in.dt = dt;
        in.inverse_dt = 1 / dt;
        in.spins = spins_.data();
        in.force_stride = simd::force_stride(3, simd::Rotation::friction);
        return in;
    }

    std::vector<double> coefficients_;
    int materials_;
    Vec gravity_;
    md::State state_;
    std::vector<double> records_, before_, spins_, forces_;
    std::vector<std::int32_t> material_;
    std::int64_t steps_ = 0;
};

} // namespace sandlane::test
