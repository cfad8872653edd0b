// `sandlane compare`: the same scene by two instruction sets, side by side.
#include "app/json.hpp"
#include "app/prepare.hpp"
#include "core/error.hpp"

#include <cstdio>

namespace sandlane::app {

int compare(const Common& common, const CompareOptions& options) {
    const std::unique_ptr<Setup> setup = prepare(common);
    const simd::Isa other = simd::choose_isa(options.second);
    const std::unique_ptr<Engine> first = setup->start(), second = setup->start(other);
    const Words& words = first->words();
    const std::vector<Difference> kernels = first->compare_kernels(first->isa(), other);
    first->run(options.steps);
    second->run(options.steps);
    const std::vector<Difference> states = first->compare_state(*second);
    const std::string hashes[] = {first->state_hash().hex(), second->state_hash().hex()};
    const bool same_bits = hashes[0] == hashes[1];
    const double worst = std::max(worst_relative(kernels), worst_relative(states));
    const bool passed = options.tolerance > 0 ? worst <= options.tolerance : same_bits && worst == 0;
    if (common.json) {
        fmt::print(R"({{"first": "{}", "second": "{}", "steps": {}, "{}": {}, "same_bits": {}, )"
                   R"("worst_relative": {}, "state_hash": ["{}", "{}"]}})"
                   "\n",
                   simd::isa_name(first->isa()), simd::isa_name(other), options.steps, words.things,
                   first->size(), same_bits, json_number(worst), hashes[0], hashes[1]);
    } else {
        fmt::print("{} against {}, {} {}\n\n{}\n{}\nState after {} {}\n{}\nstate_hash {} {}\n{}\n",
                   simd::isa_name(first->isa()), simd::isa_name(other), first->size(), words.things,
                   first->kernels_compared(), difference_table(kernels, words.thing), options.steps,
                   words.steps, difference_table(states, words.thing), hashes[0], hashes[1],
                   same_bits ? "identical, bit for bit"
                   : passed  ? "within the tolerance"
                             : "DIFFERENT");
    }
    return static_cast<int>(passed ? Exit::ok : Exit::comparison_failed);
}

} // namespace sandlane::app
