// `sandlane compare`: the same scene by two instruction sets, side by side.
#include "app/difference.hpp"
#include "app/json.hpp"
#include "app/prepare.hpp"
#include "core/error.hpp"

#include <cstdio>

namespace sandlane::app {

int compare(const Common& common, const CompareOptions& options) {
    const Prepared prepared = prepare(common);
    const simd::Isa other = simd::choose_isa(options.second);
    Prepared reference = prepared;
    reference.plan.isa = other;
    md::Simulation first = prepared.simulation(), second = reference.simulation();
    std::vector<Difference> forces = compare_forces(first, prepared.plan.isa, other);
    first.run(options.steps);
    second.run(options.steps);
    const std::vector<Difference> states = compare_snapshots(first.snapshot(), second.snapshot());
    const bool same_bits = first.state_hash() == second.state_hash();
    const double worst = std::max(worst_relative(forces), worst_relative(states));
    const bool passed = options.tolerance > 0 ? worst <= options.tolerance : same_bits && worst == 0;
    if (common.json) {
        fmt::print(R"({{"first": "{}", "second": "{}", "steps": {}, "grains": {}, "same_bits": {}, )"
                   R"("worst_relative": {}, "state_hash": ["{}", "{}"]}})"
                   "\n",
                   simd::isa_name(prepared.plan.isa), simd::isa_name(other), options.steps,
                   first.state().size(), same_bits, json_number(worst), first.state_hash().hex(),
                   second.state_hash().hex());
    } else {
        fmt::print("{} against {}, {} grains\n\nForces of the initial state\n{}\nState after {} "
                   "steps\n{}\nstate_hash {} {}\n{}\n",
                   simd::isa_name(prepared.plan.isa), simd::isa_name(other), first.state().size(),
                   difference_table(forces), options.steps, difference_table(states),
                   first.state_hash().hex(), second.state_hash().hex(),
                   same_bits ? "identical, bit for bit"
                   : passed  ? "within the tolerance"
                             : "DIFFERENT");
    }
    return static_cast<int>(passed ? Exit::ok : Exit::comparison_failed);
}

} // namespace sandlane::app
