// What one time step costs per grain at least, counted from the code: bytes that must pass between the
// working set and the registers, and operations. Together with the measured rates of machine.hpp this gives
// the roofline of a case. Keep it in step with simd/md/*.ipp, src/md/lattice.cpp, src/md/link_cells.cpp and
// src/md/pair_lists.cpp.
#pragma once

#include "machine.hpp"
#include "md/simulation.hpp"

#include <algorithm>

namespace sandlane::bench {

struct StepCost {
    double bytes = 0;
    double arithmetic = 0, single_arithmetic = 0; // additions, multiplications, comparisons, blends
    double divide = 0, square_root = 0;
};

inline StepCost operator+(const StepCost& a, const StepCost& b) {
    return {a.bytes + b.bytes, a.arithmetic + b.arithmetic, a.single_arithmetic + b.single_arithmetic,
            a.divide + b.divide, a.square_root + b.square_root};
}

// The integrator (motion.ipp).
inline StepCost motion_cost(const md::Plan& plan) {
    const double order = plan.order, dofs = simd::degrees_of_freedom(plan.dimension, md::turns(plan));
    const double spins = plan.dimension == 3 && md::turns(plan) ? simd::spin_fields : 0;
    StepCost c;
    c.bytes = 2 * 8 * (order - 2) * dofs            // state, read and written
              + 8 * (simd::record_fields + spins)   // records, written; read with the forces
              + 8;                                  // 1/m
    const double predict = order * (order - 1) / 2; // gear_predict
    const double correct = 4 + 2 * order;           // acceleration, difference, gear_correct
    const double record = 2 + 4 + 4 + 4;            // velocities, largest speed, inside, wrap
    c.arithmetic = dofs * (predict + correct) + record + (md::turns(plan) ? 2 : 0);
    return c;
}

// One evaluation of the laws for a contact away from periodic sides (contact.hpp, tangential.hpp): in the
// plane, and in space. Each adds to `targets` grains.
inline StepCost plane_law(const md::Plan& plan, bool viscoelastic, double targets) {
    const double combine = 7 + 12;         // differences, sums; nearest image in x and y
    const double geometry = 3 + 1 + 4 + 2; // d^2, overlap, rate, touching
    const double normal = viscoelastic ? 5 : 4;
    const double tangential = plan.tangential != 0 ? 4 + 6 : 0; // v_t, clamp
    const double result = 5 + 4 + 1 + 1;                        // F_x, F_y, f_t, largest overlap
    return {0, combine + geometry + normal + tangential + result + 3 * targets, 0, 1,
            viscoelastic ? 2.0 : 1.0};
}

inline StepCost space_law(const md::Plan& plan, bool viscoelastic, double targets) {
    const bool friction = plan.tangential != 0, remembers = plan.memory > 0;
    const double combine = 8 + (friction ? 6 : 0) + (remembers ? 3 : 0); // records, spins, twist
    const double geometry = 5 + 3 + 1 + 3 + 1 + 6 + 2; // d^2, dv, 1/d, n, overlap, rate, touching
    const double normal = viscoelastic ? 8 : 4;        // and R_eff
    const double surface = friction ? 3 + 9 + 9 : 0;   // R omega, its cross product, u_t
    const double sliding = 5 + 1 + 1 + 4;              // |u_t|^2, mu f, min, force
    const double spring = 10 + 5 + 11 + 15 + 5 + 9 + 4 + 6 + 12 + 8 + 9; // twist, carried, trial, limit, held
    const double tangential = !friction ? 0 : remembers ? spring : sliding;
    const double result = 3 + 3 + 1 + (friction ? 3 + 9 + 3 : 0); // force, torque over R, largest overlap
    return {0, combine + geometry + normal + surface + tangential + result + (friction ? 6 : 3) * targets, 0,
            1.0 + (friction ? 1 : 0), 1.0 + (viscoelastic ? 1 : 0) + (friction && !remembers ? 1 : 0)};
}

// `evaluations` of the laws per grain (pairs.ipp).
inline StepCost law_cost(const md::Simulation& simulation, double evaluations, double targets) {
    const md::Plan& plan = simulation.plan();
    const bool viscoelastic = simulation.scene().md.normal == scene::NormalLaw::viscoelastic;
    const bool space = plan.dimension == 3;
    const StepCost one =
        space ? space_law(plan, viscoelastic, targets) : plane_law(plan, viscoelastic, targets);
    const double spins = space && md::turns(plan) ? simd::spin_fields : 0;
    return {8 * (simd::record_fields + spins), // records, read
            evaluations * one.arithmetic, 0, evaluations * one.divide, evaluations * one.square_root};
}

// What lattice and cells need and lists do not: forces kept in memory (read and written by pairs and by
// motion), and the site or cell of each grain, two each of -, *, floor, min and of the position in the site.
inline StepCost placed_cost() {
    return {4 * 8 * 4, 14, 0, 0, 0};
}

// Per site, in single precision (lattice.ipp). The scalar reference looks at the owners of sites and computes
// in double (src/md/reference).
inline StepCost lattice_cost(const md::Simulation& simulation, double contacts) {
    const md::Plan& plan = simulation.plan();
    const bool half = plan.neighbours == scene::NeighbourMethod::lattice_half;
    const double side = 2 * plan.reach + 1, offsets = (side * side - 1) / (half ? 2 : 1);
    const double sites =
        static_cast<double>(plan.columns) * plan.rows / static_cast<double>(simulation.state().size());
    StepCost c = placed_cost();
    c.bytes += sites * 4 * (plan.many_radii ? 4 : 3) // L-vectors and owners
               + 2 * (4 + 4 + 8 + 1) + 2 * 8;        // site, next site, position in it, edge
    if (plan.isa == simd::Isa::scalar)
        c.arithmetic += offsets / sites * (2 + 4 + 3 + 1 + 2 + 1);
    else
        c.single_arithmetic = sites * offsets * (4 + 3 + 1 + (plan.many_radii ? 2 : 0));
    return c + law_cost(simulation, half ? contacts : 2 * contacts, half ? 2 : 1);
}

// Per candidate in the nine cells around a grain (cells.ipp, link_cells.cpp).
inline StepCost cells_cost(const md::Simulation& simulation, double contacts) {
    const double edge = 2 * simulation.state().largest_radius();
    const Vec size = simulation.plan().upper - simulation.plan().lower;
    const double candidates =
        9 * edge * edge * static_cast<double>(simulation.state().size()) / (size.x * size.y);
    StepCost c = placed_cost();
    c.bytes += 2 * (3 * 8 + 4) + 2 * 4 + 3 * 4; // sorted columns, written and read; cell; counting sort
    c.arithmetic += candidates * (2 + 12 + 1 + 5 + 1);
    return c + law_cost(simulation, 2 * contacts, 1);
}

// Per listed pair (tiles.ipp), as if only contacts were listed, and lists cost nothing to make. Rows of
// memory are read and written.
inline StepCost lists_cost(const md::Simulation& simulation, double contacts) {
    StepCost c;
    c.bytes = contacts * (2 * 4 + 2 * 8 * simd::memory_row(simulation.plan().memory));
    return c + law_cost(simulation, contacts, 2);
}

// contacts: touching pairs per grain.
inline StepCost step_cost(const md::Simulation& simulation, double contacts) {
    const StepCost motion = motion_cost(simulation.plan());
    switch (simulation.plan().neighbours) {
    case scene::NeighbourMethod::lattice:
    case scene::NeighbourMethod::lattice_half:
        return motion + lattice_cost(simulation, contacts);
    case scene::NeighbourMethod::link_cells:
        return motion + cells_cost(simulation, contacts);
    default:
        return motion + lists_cost(simulation, contacts);
    }
}

// Particle-steps per second that the machine allows.
struct Bound {
    double bytes = 0, compute = 0;
    [[nodiscard]] double least() const { return std::min(bytes, compute); }
};

// Additions and multiplications of both precisions share their ports; divisions and square roots share the
// divider, which works beside them.
inline Bound bound(const StepCost& cost, const md::Simulation& simulation) {
    const md::Plan& plan = simulation.plan();
    const Rates& r = rates(plan.isa, plan.threads);
    const double ports = cost.arithmetic / r.arithmetic + cost.single_arithmetic / r.single_arithmetic;
    const double divider = cost.divide / r.divide + cost.square_root / r.square_root;
    return {bandwidth(plan.isa, plan.threads, simulation.bytes()) / cost.bytes, 1 / std::max(ports, divider)};
}

} // namespace sandlane::bench
