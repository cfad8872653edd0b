// The rows of log.csv of event-driven dynamics: of one run, or means of several with their errors.
#pragma once

#include "analysis/analysis.hpp"
#include "analysis/gas_mixture.hpp"
#include "core/bytes.hpp"
#include "edmd/ensemble.hpp"
#include "edmd/plan.hpp"

#include <memory>
#include <vector>

namespace sandlane::app {

class EdmdLog {
public:
    EdmdLog(const edmd::Plan& plan, double temperature);

    [[nodiscard]] std::vector<analysis::LogColumn> columns() const;
    // seen: observables of the runs. Rates count since the row before.
    [[nodiscard]] std::vector<double> row(const edmd::Ensemble& runs,
                                          const std::vector<edmd::Observables>& seen);

    void serialise(ByteWriter& out) const { out.put_array(marks_.data(), marks_.size()); }
    void restore(ByteReader& in); // throws Error(io)

private:
    // Sums at the last row.
    struct Mark {
        double time = 0, virial = 0, temperature = 0, shear = 0, flux = 0;
        std::int64_t collisions = 0;
    };
    [[nodiscard]] std::vector<analysis::LogColumn> measured_columns() const;
    [[nodiscard]] std::vector<double> measured(const edmd::Algorithm& run, const edmd::Observables& o,
                                               Mark& mark) const;
    void add_theory(std::vector<double>& row, double time) const;
    [[nodiscard]] bool guards() const {
        return plan_.setup.contact_time > 0 || plan_.setup.elastic_speed > 0;
    }

    const edmd::Plan& plan_;
    double temperature_;           // of the start, J
    analysis::MixtureGas mixture_; // no kinds: theory knows nothing
    std::vector<Mark> marks_;      // of the runs
};

} // namespace sandlane::app
