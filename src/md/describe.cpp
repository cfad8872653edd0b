// The text of `sandlane check`: derived quantities and the plan.
#include "md/accuracy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace sandlane::md {

namespace {

const char* method_name(scene::NeighbourMethod method) {
    switch (method) {
    case scene::NeighbourMethod::automatic:
        return "auto";
    case scene::NeighbourMethod::brute_force:
        return "brute force";
    case scene::NeighbourMethod::link_cells:
        return "link cells";
    case scene::NeighbourMethod::lattice:
        return "lattice, full mask";
    case scene::NeighbourMethod::lattice_half:
        return "lattice, half mask";
    case scene::NeighbourMethod::verlet:
        return "Verlet lists, tiles of 1024 grains, forces and motion in one pass";
    }
    return "";
}

bool on_lattice(const Plan& plan) {
    return plan.neighbours == scene::NeighbourMethod::lattice ||
           plan.neighbours == scene::NeighbourMethod::lattice_half;
}

// What that leaves of the error of a collision; nothing without contacts.
std::string resolved_error(const scene::Scene& scene, const Needs& needs, const Plan& plan) {
    const std::size_t grains = needs.grains + needs.poured;
    if (scene.md.accuracy > 0 || grains == 0 || (grains == 1 && !needs.walls)) return {};
    const double error = scene_error(scene, needs, scene.md.integrator, scene.md.contact_onset, plan.dt,
                                     std::numeric_limits<double>::infinity());
    return fmt::format("; error of a collision at md.max_speed or a tenth of it: up to {:.2g}", error);
}

std::string integrator_text(const Plan& plan) {
    switch (plan.scheme) {
    case 3:
        return "velocity Verlet";
    case motion::verlet_with_slope:
        return "velocity Verlet, forces at velocities of second order";
    default:
        return fmt::format("Gear predictor-corrector, {} values", plan.order);
    }
}

} // namespace

double memory_bytes(const Needs& needs, const Plan& plan) {
    const int dofs = simd::degrees_of_freedom(plan.dimension, turns(plan));
    const bool lists = plan.neighbours == scene::NeighbourMethod::verlet;
    const double records = simd::record_fields + (plan.dimension == 3 && turns(plan) ? simd::spin_fields : 0);
    const double doubles = (plan.order - 2) * dofs + (lists ? 2 * records : records) + 2 +
                           (lists ? 0 : simd::force_stride(plan.dimension, plan.rotation));
    const double state = 8.0 * doubles + 12;
    const double per_grain = state + (on_lattice(plan) ? 8 : 32);
    const double sites = on_lattice(plan) ? static_cast<double>(plan.columns) * plan.rows : 0;
    return static_cast<double>(needs.grains + needs.poured) * per_grain + sites * 28;
}

std::string describe(const scene::Scene& scene, const Needs& needs, const Derived& d, const Plan& plan) {
    std::string text;
    const auto line = [&](const char* label, const std::string& value) {
        text += fmt::format("  {:<26}{}\n", label, value);
    };
    text += fmt::format("{}\n\nScene\n", scene.title.empty() ? "(untitled)" : scene.title);
    line("grains", fmt::format("{} at the start, {} poured", needs.grains, needs.poured));
    line("radii", fmt::format("{:.4g} .. {:.4g} m", needs.radius_min, needs.radius_max));
    line("masses", fmt::format("{:.4g} .. {:.4g} kg", needs.mass_min, needs.mass_max));
    line("packing fraction", fmt::format("{:.4g} of the whole domain", needs.packing_fraction));
    text += "\nDerived\n";
    line("collision time t_c", fmt::format("{:.4g} s", d.collision_time));
    line("time step", fmt::format("{:.4g} s = t_c/{:.3g}; critical {:.4g} s, recommended {:.4g} s", plan.dt,
                                  d.collision_time / plan.dt, d.critical_dt, d.recommended_dt));
    line("steps", fmt::format("{} ({:.4g} s)", plan.steps, static_cast<double>(plan.steps) * plan.tick));
    line("restitution coefficient", fmt::format("{:.4f} .. {:.4f} at {:.3g} m/s", d.restitution_min,
                                                d.restitution_max, scene.md.max_speed));
    line("largest overlap",
         fmt::format("about {:.3g} R_min at {:.3g} m/s", d.overlap_ratio, scene.md.max_speed));
    line("memory", fmt::format("about {:.3g} MB", memory_bytes(needs, plan) / 1e6));
    text += "\nPlan\n";
    line("engine", plan.dimension == 3 ? "md, three dimensions" : "md, two dimensions");
    line("neighbours", method_name(plan.neighbours));
    if (on_lattice(plan))
        line("lattice", fmt::format("{} x {} sites of {:.4g} x {:.4g} m, mask {}x{}", plan.columns, plan.rows,
                                    plan.site_x, plan.site_y, 2 * plan.reach + 1, 2 * plan.reach + 1));
    line("integrator", integrator_text(plan));
    if (plan.resolved) line("contact onset", "resolved inside the step" + resolved_error(scene, needs, plan));
    for (const std::string& reason : plan.chosen) text += "  " + reason + "\n";
    text += "\nSkipped, because the scene does not need it\n";
    for (const std::string& reason : plan.skipped) text += "  " + reason + "\n";
    const double least = plan.resolved ? 8 : 20; // steps per contact
    if (plan.dt > d.collision_time / least)
        text += fmt::format("\nWarning: the time step is above t_c/{}; dense packings may become unstable.\n",
                            least);
    if (d.overlap_ratio > 0.05)
        text += "\nWarning: overlaps above 5 % of the smallest radius are expected; stiffen the material or "
                "lower md.max_speed.\n";
    return text;
}

} // namespace sandlane::md
