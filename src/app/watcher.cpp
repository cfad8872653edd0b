#include "app/watcher.hpp"

#include "app/json.hpp"
#include "core/error.hpp"

#include <fmt/format.h>

namespace sandlane::app {

namespace watched = analysis::watched;

namespace {

struct Quantity {
    const char *key, *column, *title, *what, *advice;
    scene::WatchLimit scene::Watch::*limit;
};

// In the order of analysis::watched.
constexpr const char* shorter = "Lower the time step, or give md.accuracy in its place.";
constexpr Quantity quantities[watched::count] = {
    {"largest_overlap", "overlap_peak", "Largest overlap of the run", "the largest overlap",
     "The material is soft for this load, or the time step too large: raise its stiffness or lower md.dt.",
     &scene::Watch::overlap},
    {"energy_residual", "energy_residual", "Largest residual of the energy balance",
     "the residual of the energy balance", shorter, &scene::Watch::energy},
    {"momentum_error", "momentum_error", "Largest error of the momentum balance",
     "the error of the momentum balance", shorter, &scene::Watch::momentum},
    {"step_error", "step_error", "Largest error of a collision by halving the step",
     "the error of a collision by halving the step", shorter, &scene::Watch::step},
};

} // namespace

template <class Body> void Watcher::for_asked(const Body& body) const {
    for (std::size_t n = 0; n < watched::count; ++n)
        if ((limits_.*quantities[n].limit).asked) body(n);
}

void Watcher::see(analysis::Watched now, std::int64_t step, double time) {
    now_ = std::move(now);
    step_ = step;
    time_ = time;
    for_asked([&](std::size_t n) {
        if (!(now_.value[n] <= peaks_.value[n])) {
            peaks_.value[n] = now_.value[n];
            peaks_.time[n] = now_.time[n];
        }
        const double warn = (limits_.*quantities[n].limit).warn;
        if (warned_[n] || !(warn > 0 && now_.value[n] > warn)) return;
        warned_[n] = true;
        news_.push_back(exceeded(n, warn));
    });
}

std::string Watcher::exceeded(std::size_t n, double limit) const {
    const Quantity& q = quantities[n];
    const std::string& where = now_.where[n];
    return fmt::format("step {}, t = {:.6g} s: {} is {:.3g}, above {:.3g} of watch.{}{}{}. {}", step_, time_,
                       q.what, now_.value[n], limit, q.key, where.empty() ? "" : "; ", where, q.advice);
}

void Watcher::judge() const {
    for_asked([&](std::size_t n) {
        const double stop = (limits_.*quantities[n].limit).stop;
        if (stop > 0 && !(now_.value[n] <= stop)) fail(Exit::unstable, "{}", exceeded(n, stop));
    });
}

void Watcher::add_columns(std::vector<analysis::LogColumn>& columns) const {
    for_asked([&](std::size_t n) { columns.push_back({quantities[n].column, "1"}); });
}

void Watcher::add_row(std::vector<double>& row) const {
    for_asked([&](std::size_t n) { row.push_back(now_.value[n]); });
}

std::string Watcher::json() const {
    std::string members;
    for_asked([&](std::size_t n) {
        members += fmt::format(R"({}"{}": {{"largest": {}, "time": {}}})", members.empty() ? "" : ", ",
                               quantities[n].key, json_number(peaks_.value[n]), json_number(peaks_.time[n]));
    });
    return members.empty() ? members : fmt::format(R"("watch": {{{}}}, )", members);
}

void Watcher::add_report_rows(std::vector<std::pair<std::string, std::string>>& rows) const {
    for_asked([&](std::size_t n) {
        rows.emplace_back(quantities[n].title,
                          fmt::format("{:.3g} at {:.4g} s", peaks_.value[n], peaks_.time[n]));
    });
}

void Watcher::serialise(ByteWriter& out) const {
    out.put_array(&peaks_, 1);
}

void Watcher::restore(ByteReader& in) {
    std::vector<Peaks> peaks;
    in.get_array(peaks);
    if (peaks.size() != 1) fail(Exit::io, "damaged state");
    peaks_ = peaks[0];
}

} // namespace sandlane::app
