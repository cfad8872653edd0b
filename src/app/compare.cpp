// `sandlane compare`: the same scene by two instruction sets, side by side.
#include "app/json.hpp"
#include "app/prepare.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cstdio>

namespace sandlane::app {

namespace {

// Decisions of two runs, one beside the other, up to the first that differs.
struct Streams {
    bool exist = false;
    std::int64_t same = 0;
    bool differ = false;
    std::string first, second; // what either decided there
};

// Both runs, in pieces whose decisions fit into memory.
Streams run_both(Engine& first, Engine& second, std::int64_t steps) {
    Streams streams;
    streams.exist = first.keep_decisions() && second.keep_decisions();
    if (!streams.exist) {
        first.run(steps);
        second.run(steps);
        return streams;
    }
    constexpr std::size_t enough = 1 << 20;
    for (std::int64_t left = steps, piece = 1; left > 0;) {
        piece = std::min(piece, left);
        first.run(piece);
        second.run(piece);
        left -= piece;
        const std::vector<Decision> a = first.take_decisions(), b = second.take_decisions();
        if (a.size() < enough / 2) piece *= 2;
        if (streams.differ) continue;
        const auto [at_a, at_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
        streams.same += at_a - a.begin();
        streams.differ = at_a != a.end() || at_b != b.end();
        if (!streams.differ) continue;
        streams.first = at_a != a.end() ? first.tell(*at_a) : "nothing more";
        streams.second = at_b != b.end() ? second.tell(*at_b) : "nothing more";
    }
    return streams;
}

std::string text_of(const Streams& s) {
    if (!s.exist) return {};
    if (!s.differ) return fmt::format("\nDecisions\n{} of them, the same\n", s.same);
    return fmt::format("\nDecisions\n{} of them are the same, then\n  {}\n  {}\n", s.same, s.first, s.second);
}

std::string json_of(const Streams& s) {
    if (!s.exist) return {};
    return fmt::format(R"("same_decisions": {}, "first_different_decision": {}, )", s.same,
                       s.differ ? fmt::format("[{}, {}]", json_text(s.first), json_text(s.second)) : "null");
}

} // namespace

int compare(const Common& common, const CompareOptions& options) {
    const std::unique_ptr<Setup> setup = prepare(common);
    const simd::Isa other = simd::choose_isa(options.second);
    const std::unique_ptr<Engine> first = setup->start(), second = setup->start(other);
    const Words& words = first->words();
    const std::vector<Difference> kernels = first->compare_kernels(first->isa(), other);
    const Streams streams = run_both(*first, *second, options.steps);
    const std::vector<Difference> states = first->compare_state(*second);
    const std::string hashes[] = {first->state_hash().hex(), second->state_hash().hex()};
    const bool same_bits = hashes[0] == hashes[1];
    const double worst = std::max(worst_relative(kernels), worst_relative(states));
    const bool passed =
        options.tolerance > 0 ? worst <= options.tolerance : same_bits && worst == 0 && !streams.differ;
    if (common.json) {
        fmt::print(R"({{"first": "{}", "second": "{}", "steps": {}, "{}": {}, "same_bits": {}, {})"
                   R"("worst_relative": {}, "state_hash": ["{}", "{}"]}})"
                   "\n",
                   simd::isa_name(first->isa()), simd::isa_name(other), options.steps, words.things,
                   first->size(), same_bits, json_of(streams), json_number(worst), hashes[0], hashes[1]);
    } else {
        fmt::print("{} against {}, {} {}\n\n{}\n{}{}\nState after {} {}\n{}\nstate_hash {} {}\n{}\n",
                   simd::isa_name(first->isa()), simd::isa_name(other), first->size(), words.things,
                   first->kernels_compared(), difference_table(kernels, words.thing), text_of(streams),
                   options.steps, words.steps, difference_table(states, words.thing), hashes[0], hashes[1],
                   same_bits && !streams.differ ? "identical, bit for bit"
                   : passed                     ? "within the tolerance"
                                                : "DIFFERENT");
    }
    return static_cast<int>(passed ? Exit::ok : Exit::comparison_failed);
}

} // namespace sandlane::app
