// What a run says of the errors that it watches: columns of the log, the largest of the run, warnings, a
// stop.
#pragma once

#include "analysis/snapshot.hpp"
#include "analysis/watched.hpp"
#include "core/bytes.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::app {

class Watcher {
public:
    explicit Watcher(const scene::Watch& limits) : limits_(limits) {}

    // Of the state that a row of the log is made of.
    void see(analysis::Watched now, std::int64_t step, double time);
    // Throws Error(unstable) if what was seen last is above a limit.
    void judge() const;
    // Warnings since the last call.
    [[nodiscard]] std::vector<std::string> take_news() { return std::exchange(news_, {}); }

    void add_columns(std::vector<analysis::LogColumn>& columns) const;
    void add_row(std::vector<double>& row) const;
    // Member "watch" of summary.json, the largest values of the run and when; nothing if none is watched.
    [[nodiscard]] std::string json() const;
    void add_report_rows(std::vector<std::pair<std::string, std::string>>& rows) const;

    void serialise(ByteWriter& out) const;
    void restore(ByteReader& in);

private:
    template <class Body> void for_asked(const Body& body) const;
    [[nodiscard]] std::string exceeded(std::size_t quantity, double limit) const;

    scene::Watch limits_;
    analysis::Watched now_;
    std::int64_t step_ = 0;
    double time_ = 0;
    struct Peaks {
        double value[analysis::watched::count] = {}, time[analysis::watched::count] = {};
    } peaks_;
    bool warned_[analysis::watched::count] = {};
    std::vector<std::string> news_;
};

} // namespace sandlane::app
