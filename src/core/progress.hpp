// Progress of a long run: one rewritten line on a terminal, a sparse line in a pipe, nothing when quiet.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace sandlane {

class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Progress {
public:
    // total: steps of the run; quiet: print nothing; work: what rates count; unit: of times, empty for none.
    Progress(std::int64_t first, std::int64_t total, bool quiet, std::string work = "particle-steps",
             std::string unit = "s");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // things: particles or sites, present number, for the rate. Cheap; prints when due.
    void update(std::int64_t step, double time, std::size_t things);

private:
    void print(std::int64_t step, double time);

    std::int64_t first_, total_;
    bool quiet_, terminal_, printed_ = false;
    std::string work_name_, unit_;
    double interval_, next_;
    std::int64_t last_step_;
    double work_ = 0; // things times steps
    Stopwatch clock_;
};

// Writes to standard error. That it cannot be written is no reason to end a run.
void tell(std::string_view text);

// "4:12", "1:02:03"
[[nodiscard]] std::string clock_text(double seconds);

} // namespace sandlane
