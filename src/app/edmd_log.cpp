#include "app/edmd_log.hpp"

#include "analysis/gas_theory.hpp"
#include "core/error.hpp"

#include <cmath>

namespace sandlane::app {

namespace {

// What theory knows the temperatures of: smooth particles of several kinds, constant restitution, nothing
// else. Empty: something else.
analysis::MixtureGas mixture_of(const edmd::Plan& plan) {
    const edmd::Setup& s = plan.setup;
    analysis::MixtureGas gas;
    if (s.classes.size() == 1 || s.rough || s.has_walls() || s.falls() || s.shear != 0 ||
        s.restitution.model != laws::Restitution::Model::constant)
        return gas;
    gas.dimension = s.dimension;
    gas.dense = true;
    gas.kicks = s.kicks;
    for (std::size_t k = 0; k < s.classes.size(); ++k)
        gas.kinds.push_back({plan.amounts[k] / s.volume(), s.classes[k].mass, 2 * s.classes[k].radius});
    for (std::size_t i = 0; i < gas.size(); ++i)
        for (std::size_t j = 0; j < gas.size(); ++j) gas.restitution.push_back(s.restitution_of(i, j));
    return gas;
}

} // namespace

EdmdLog::EdmdLog(const edmd::Plan& plan, double temperature)
    : plan_(plan), temperature_(temperature), mixture_(mixture_of(plan)),
      marks_(static_cast<std::size_t>(plan.replicas)) {}

void EdmdLog::restore(ByteReader& in) {
    std::vector<Mark> marks;
    in.get_array(marks);
    if (marks.size() != marks_.size())
        fail(Exit::io, "the state is of {} replicas instead of {}", marks.size(), marks_.size());
    marks_ = marks;
}

std::vector<analysis::LogColumn> EdmdLog::columns() const {
    std::vector<analysis::LogColumn> columns = {{"time", "s"}, {"event", "1"}};
    const auto measured = measured_columns();
    columns.insert(columns.end(), measured.begin(), measured.end());
    if (plan_.homogeneous) columns.push_back({"theory_temperature", "J"});
    for (std::size_t k = 0; k < mixture_.size(); ++k)
        columns.push_back({fmt::format("theory_temperature_{}", k), "J"});
    if (marks_.size() > 1)
        for (const analysis::LogColumn& c : measured) columns.push_back({c.name + "_error", c.unit});
    return columns;
}

std::vector<double> EdmdLog::row(const edmd::Ensemble& runs, const std::vector<edmd::Observables>& seen) {
    std::vector<std::vector<double>> rows;
    double events = 0;
    for (std::size_t n = 0; n < runs.size(); ++n) {
        rows.push_back(measured(runs[n], seen[n], marks_[n]));
        events += static_cast<double>(runs[n].log().count());
    }
    std::vector<double> row = {runs.first().time(), events}, errors;
    for (std::size_t c = 0; c < rows.front().size(); ++c) {
        std::vector<double> values;
        values.reserve(rows.size());
        for (const auto& of_run : rows) values.push_back(of_run[c]);
        const edmd::MeanError mean = edmd::mean_of(values);
        row.push_back(runs.size() > 1 ? mean.mean : values.front());
        errors.push_back(mean.error);
    }
    add_theory(row, runs.first().time());
    if (runs.size() > 1) row.insert(row.end(), errors.begin(), errors.end());
    return row;
}

void EdmdLog::add_theory(std::vector<double>& row, double time) const {
    if (plan_.homogeneous)
        row.push_back(analysis::cooling_curve(edmd::gas_of(plan_), temperature_, {time}).front());
    if (mixture_.size() == 0) return;
    const auto of_kind = analysis::cooling_curves(mixture_, temperature_, {time}).front();
    row.insert(row.end(), of_kind.begin(), of_kind.end());
}

std::vector<analysis::LogColumn> EdmdLog::measured_columns() const {
    const edmd::Setup& s = plan_.setup;
    std::vector<analysis::LogColumn> columns = {{"temperature", "J"}};
    for (std::size_t k = 0; k < s.classes.size() && s.classes.size() > 1; ++k)
        columns.push_back({fmt::format("temperature_{}", k), "J"});
    columns.insert(columns.end(), {{"a2", "1"}, {"energy", "J"}, {"wall_energy", "J"}});
    if (s.dissipates()) columns.push_back({"lost_energy", "J"});
    if (s.kicks > 0) columns.push_back({"heating_energy", "J"});
    for (int d = 0; d < s.dimension; ++d) columns.push_back({fmt::format("velocity_{}", "xyz"[d]), "m/s"});
    if (s.rough) columns.push_back({"spin_temperature", "J"});
    if (s.shear != 0) columns.push_back({"shear_stress", s.dimension == 3 ? "Pa" : "N/m"});
    columns.insert(columns.end(),
                   {{"collisions_per_particle", "1"}, {"collision_rate", "1/s"}, {"compressibility", "1"}});
    if (guards()) columns.push_back({"elastic_collisions", "1"});
    return columns;
}

std::vector<double> EdmdLog::measured(const edmd::Algorithm& run, const edmd::Observables& o,
                                      Mark& mark) const {
    const edmd::Setup& s = plan_.setup;
    const edmd::Tally& t = run.tally();
    const auto n = static_cast<double>(run.size());
    std::vector<double> row = {o.temperature};
    if (s.classes.size() > 1) row.insert(row.end(), o.of_class.begin(), o.of_class.end());
    row.insert(row.end(), {o.fourth, o.energy, t.wall_energy});
    if (s.dissipates()) row.push_back(t.lost);
    if (s.kicks > 0) row.push_back(t.heat);
    for (int d = 0; d < s.dimension; ++d) row.push_back(o.drift[static_cast<std::size_t>(d)]);
    if (s.rough) row.push_back(o.spin_temperature);
    const double interval = run.time() - mark.time;
    // -p_xy: of the flights, the mean of both ends of the interval, and of its collisions.
    if (s.shear != 0)
        row.push_back(interval > 0
                          ? -(0.5 * (o.flux + mark.flux) + (t.shear - mark.shear) / interval) / s.volume()
                          : -o.flux / s.volume());
    const double rate =
        interval > 0 ? 2 * static_cast<double>(t.collisions - mark.collisions) / (n * interval) : 0;
    // p/(n T) = 1 + sum of R_ij |P_n| / (d N T t), T in the middle of the interval.
    const double mean = 0.5 * (o.temperature + mark.temperature);
    const double z =
        interval > 0 && mean > 0 ? 1 + (t.virial - mark.virial) / (s.dimension * n * mean * interval) : 1;
    row.insert(row.end(), {2 * static_cast<double>(t.collisions) / n, rate, z});
    if (guards()) row.push_back(static_cast<double>(t.elastic));
    mark = {run.time(), t.virial, o.temperature, t.shear, o.flux, t.collisions};
    return row;
}

} // namespace sandlane::app
