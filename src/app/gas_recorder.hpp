// What only a run of a gas leaves in its folder: profiles, velocity distribution, pictures, trajectories.
#pragma once

#include "analysis/gas_samples.hpp"
#include "app/gas_engine.hpp"
#include "app/timer.hpp"
#include "output/picture_series.hpp"
#include "output/writers.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace sandlane::app {

class GasRecorder final : public Recorder {
public:
    GasRecorder(const std::filesystem::path& folder, const GasEngine& engine,
                const output::Checkpoint* resume);

    [[nodiscard]] std::int64_t next_due(std::int64_t step) const override;
    [[nodiscard]] double next_time() const override;
    void write_due(bool all) override;
    void add_bookmarks(std::map<std::string, std::string>& bookmarks) override;
    void finish() override { write_tables(); }
    [[nodiscard]] std::int64_t pictures() const override { return pictures_.count(); }
    void add_to_report(output::ReportInput& report) const override;

private:
    void write_tables() const;

    const GasEngine& engine_;
    std::filesystem::path folder_;
    Timer sample_timer_, structure_timer_, picture_timer_, trajectory_timer_;
    analysis::GasSamples samples_;
    analysis::GasStructure structure_;
    output::PictureSeries pictures_;
    std::map<std::string, std::unique_ptr<output::TrajectoryWriter>> trajectories_; // by name of bookmark
};

} // namespace sandlane::app
