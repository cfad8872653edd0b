#include "core/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace sandlane {

void tell(std::string_view text) {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

std::string clock_text(double seconds) {
    const std::int64_t whole = std::llround(seconds);
    const std::int64_t hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, rest)
                     : fmt::format("{}:{:02}", minutes, rest);
}

Progress::Progress(std::int64_t first, std::int64_t total, bool quiet, std::string work, std::string unit)
    : first_(first), total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0),
      work_name_(std::move(work)), unit_(std::move(unit)), interval_(terminal_ ? 0.25 : 30.0),
      next_(interval_), last_step_(first) {}

Progress::~Progress() {
    if (printed_ && terminal_) tell("\n");
}

void Progress::update(std::int64_t step, double time, std::size_t things) {
    work_ += static_cast<double>(step - last_step_) * static_cast<double>(things);
    last_step_ = step;
    if (quiet_ || clock_.seconds() < next_) return;
    next_ = clock_.seconds() + interval_;
    print(step, time);
}

void Progress::print(std::int64_t step, double time) {
    printed_ = true;
    const double spent = clock_.seconds();
    const double done =
        std::min(1.0, static_cast<double>(step - first_) / static_cast<double>(total_ - first_));
    const std::string at = unit_.empty() ? "" : fmt::format(" t={:.4g} {}", time, unit_);
    const std::string text =
        fmt::format("{:3.0f}% step {:.3g}/{:.3g}{} {:.2g} {}/s ETA {}", 100 * done, static_cast<double>(step),
                    static_cast<double>(total_), at, work_ / spent, work_name_,
                    clock_text(done > 0 ? spent * (1 - done) / done : 0));
    tell(terminal_ ? fmt::format("\r{:<78}", text) : text + "\n");
}

} // namespace sandlane
