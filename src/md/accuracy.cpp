#include "md/accuracy.hpp"

#include "core/error.hpp"
#include "md/collision_error.hpp"
#include "md/law_traits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::md {

using scene::ContactOnset;
using scene::Integrator;
using scene::Scene;

namespace {

// ns per particle-step, linear dashpot with friction and viscoelastic: `tools/bench accuracy`, "Cost of a
// step". Only ratios count. Those that mostly win come first: what cannot be cheaper need not be tried.
struct Row {
    Integrator integrator;
    ContactOnset onset;
    double linear, hertz;
};
constexpr Row rows[] = {
    {Integrator::velocity_verlet, ContactOnset::resolved, 5.9, 6.5},
    {Integrator::velocity_verlet, ContactOnset::step, 5.2, 5.8},
    {Integrator::gear4, ContactOnset::step, 5.8, 6.1},
    {Integrator::gear5, ContactOnset::step, 6.1, 6.3},
    {Integrator::gear6, ContactOnset::step, 8.4, 8.6},
};

constexpr double shortest_step = 1.0 / 30000; // of the shortest contact
constexpr double stride = 1.15;               // from one step of the scan to the next

struct Case {
    Impact impact;
    double exact; // restitution coefficient
};

class Cases {
public:
    Cases(const Scene& scene, const Needs& needs) : normal_(static_cast<int>(scene.md.normal)) {
        struct Body {
            double mass, radius;
        };
        std::vector<Body> bodies = {{0.5 * needs.mass_min, 0.5 * needs.radius_min}};
        const bool various = needs.mass_max > needs.mass_min || needs.many_radii;
        if (various) bodies.push_back({0.5 * needs.mass_max, 0.5 * needs.radius_max});
        if (needs.walls) bodies.push_back({needs.mass_min, needs.radius_min});
        if (needs.walls && various) bodies.push_back({needs.mass_max, needs.radius_max});
        const std::vector<double> table = pair_table(scene);
        const std::size_t materials = scene.materials.size();
        for (std::size_t a = 0; a < materials; ++a)
            for (std::size_t b = a; b < materials; ++b)
                for (const Body& body : bodies)
                    for (const double part : {1.0, 0.1})
                        add(make_impact(normal_,
                                        laws::coefficients_from<double>(
                                            table.data() + (a * materials + b) * laws::pair_coefficients),
                                        body.mass, body.radius, part * scene.md.max_speed));
    }

    [[nodiscard]] double shortest() const { return shortest_; }

    // The largest error of all; cases that were the worst come first from then on.
    double error(Stepping stepping, double dt, double enough) {
        double worst = 0;
        for (std::size_t n = 0; n < cases_.size(); ++n) {
            const double error = largest(cases_[n], stepping, dt, enough);
            if (error > worst && n > 0) std::swap(cases_[0], cases_[n]);
            worst = std::max(worst, error);
            if (!(worst <= enough)) return worst;
        }
        return worst;
    }

    // Of the case that was the worst at the last look.
    [[nodiscard]] double error_of_worst(Stepping stepping, double dt) const {
        return largest(cases_[0], stepping, dt, std::numeric_limits<double>::infinity());
    }

private:
    void add(const Impact& impact) {
        const double exact = exact_restitution(normal_, impact);
        shortest_ = std::min(shortest_, impact.time);
        cases_.push_back({impact, exact});
    }

    // Also with a quarter, half and three quarters of a step more in the contact.
    [[nodiscard]] double largest(const Case& c, Stepping stepping, double dt, double enough) const {
        const double steps = c.impact.time / dt;
        double worst = 0;
        for (const double more : {0.0, 0.25, 0.5, 0.75}) {
            const double part = dt * steps / (steps + more);
            worst = std::max(worst, collision_error(normal_, stepping, c.impact, c.exact, part, enough));
            if (!(worst <= enough)) break;
        }
        return worst;
    }

    int normal_;
    std::vector<Case> cases_;
    double shortest_ = std::numeric_limits<double>::infinity();
};

Scene stepped_by(const Scene& scene, Integrator integrator, ContactOnset onset) {
    Scene with = scene;
    with.md.integrator = integrator;
    with.md.contact_onset = onset;
    return with;
}

Stepping stepping_of(const Scene& scene, Integrator integrator, ContactOnset onset) {
    return {scheme_of(stepped_by(scene, integrator, onset).md), onset == ContactOnset::resolved};
}

// Those that the scene allows.
bool is_allowed(const Scene& scene, const Needs& needs, const Row& row) {
    const ContactOnset wanted = scene.md.contact_onset;
    if (wanted != ContactOnset::automatic) return row.onset == wanted;
    return row.onset == ContactOnset::step || why_not_resolved(scene, needs).empty();
}

double cost_of(const Scene& scene, const Row& row) {
    const bool hertz = with_normal_law(static_cast<int>(scene.md.normal),
                                       []<class Law>(Type<Law>) { return Law::needs_radius; });
    return hertz ? row.hertz : row.linear;
}

// Steps that dense packings and the guards of a run bear (docs/physics.md 8).
double longest_step(const Scene& scene, const Needs& needs, const Row& row) {
    const double critical = derive(stepped_by(scene, row.integrator, row.onset), needs).critical_dt;
    return std::min(0.25 * critical, 0.05 * needs.radius_min / scene.md.max_speed);
}

// Three digits, not more than x: no library's rounding is seen in it.
double rounded_down(double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2);
    return std::floor(x / unit) * unit;
}

// The longest step that meets the target, as two shorter ones of the scan do; up to a hundredth.
Candidate search(const Scene& scene, const Needs& needs, Cases& cases, const Row& row, double most_cost) {
    const double target = scene.md.accuracy, cost = cost_of(scene, row);
    const Stepping stepping = stepping_of(scene, row.integrator, row.onset);
    const auto meets = [&](double dt) { return cases.error(stepping, dt, target) <= target; };
    const double longest = longest_step(scene, needs, row);
    const double least = std::max(shortest_step * cases.shortest(), cost * cases.shortest() / most_cost);
    double good = 0, bad = 0;
    int in_a_row = 0;
    for (double dt = longest; dt >= least && in_a_row < 3; dt /= stride) {
        if (!meets(dt)) {
            bad = dt;
            in_a_row = 0;
        } else if (in_a_row++ == 0) {
            good = dt;
        }
    }
    Candidate found{row.integrator, row.onset, 0, 0, 0, cost, longest};
    if (in_a_row == 0) return found;
    while (bad > 1.01 * good) {
        const double middle = std::sqrt(good * bad);
        (meets(middle) ? good : bad) = middle;
    }
    found.dt = rounded_down(good);
    while (!meets(found.dt)) found.dt = rounded_down(0.99 * found.dt);
    found.error = cases.error(stepping, found.dt, std::numeric_limits<double>::infinity());
    found.cost = cost * cases.shortest() / found.dt;
    return found;
}

[[noreturn]] void fail_unreachable(const Scene& scene, const Needs& needs, Cases& cases) {
    double reached = std::numeric_limits<double>::infinity();
    for (const Row& row : rows) {
        if (!is_allowed(scene, needs, row)) continue;
        const double dt = std::min(longest_step(scene, needs, row), shortest_step * cases.shortest());
        reached = std::min(reached, cases.error_of_worst(stepping_of(scene, row.integrator, row.onset), dt));
    }
    fail(Exit::invalid_input,
         "md.accuracy = {}: no integrator meets it with up to {:.0f} steps in a contact; the best error with "
         "so many is {:.2g}. Allowed here: about {:.2g} to 0.1",
         scene.md.accuracy, 1 / shortest_step, reached, 1.3 * reached);
}

void explain(const Scene& scene, AccuracyChoice& choice) {
    const auto text = [&](const Candidate& c) {
        return fmt::format("{}, dt = {:.3g} s = t_c/{:.4g}, error {:.2g}, {:.3g} ns per grain and t_c",
                           name_of(c), c.dt, choice.contact_time / c.dt, c.error, c.cost);
    };
    choice.reasons.push_back(
        fmt::format("accuracy: {} asked for; cheapest: {}", scene.md.accuracy, text(choice.best)));
    for (const Candidate& c : choice.all)
        if (name_of(c) != name_of(choice.best))
            choice.reasons.push_back("accuracy: not " +
                                     (c.dt > 0 ? text(c) : name_of(c) + ", it would cost more"));
    choice.reasons.emplace_back("accuracy: double precision, the only one of this engine");
}

} // namespace

std::string name_of(const Candidate& c) {
    const char* onset = c.onset == ContactOnset::resolved ? ", resolved" : "";
    return fmt::format("{}{}", integrator_name(c.integrator), onset);
}

double scene_error(const Scene& scene, const Needs& needs, Integrator integrator, ContactOnset onset,
                   double dt, double enough) {
    return Cases(scene, needs).error(stepping_of(scene, integrator, onset), dt, enough);
}

AccuracyChoice choose_by_accuracy(const Scene& scene, const Needs& needs) {
    const std::size_t grains = needs.grains + needs.poured;
    if (grains == 0 || (grains == 1 && !needs.walls))
        fail(
            Exit::invalid_input,
            "md.accuracy = {}: there are no contacts with {} and no wall, of which it is the error; leave it "
            "out",
            scene.md.accuracy, grains == 0 ? "no grain" : "one grain");
    Cases cases(scene, needs);
    AccuracyChoice choice;
    choice.contact_time = cases.shortest();
    choice.best.cost = std::numeric_limits<double>::infinity();
    for (const Row& row : rows) {
        if (!is_allowed(scene, needs, row)) continue;
        choice.all.push_back(search(scene, needs, cases, row, choice.best.cost));
        const Candidate& found = choice.all.back();
        if (found.dt > 0 && found.cost < choice.best.cost) choice.best = found;
    }
    if (!(choice.best.dt > 0)) fail_unreachable(scene, needs, cases);
    explain(scene, choice);
    return choice;
}

Scene with_choice(const Scene& scene, const AccuracyChoice& choice) {
    Scene chosen = stepped_by(scene, choice.best.integrator, choice.best.onset);
    chosen.md.dt = choice.best.dt;
    return chosen;
}

} // namespace sandlane::md
