#include "app/timer.hpp"

#include <cmath>

namespace sandlane::app {

namespace {

// Of an interval: a run stops at a time but for rounding.
constexpr double slack = 1e-6;
constexpr double per_decade = 20; // outputs at growing distances

} // namespace

Timer::Timer(double seconds, double parts, const Engine& engine, Spacing spacing) {
    const Pace pace = engine.pace(seconds > 0);
    if (pace.kind == Pace::Kind::steps) {
        steps_ = interval(seconds, engine.duration(), parts, engine.time_step(), engine.stride());
        return;
    }
    if (seconds < 0 || (seconds == 0 && parts <= 0)) return;
    const bool grows = pace.kind == Pace::Kind::log_time && spacing == Spacing::paced;
    every_ = seconds > 0 ? seconds : grows ? pace.first : engine.duration() / parts;
    if (grows) growth_ = std::pow(10, 1 / per_decade);
    done_ = marks(engine.time());
}

std::int64_t Timer::marks(double time) const {
    if (growth_ == 1) return static_cast<std::int64_t>(time / every_ + slack);
    if (time < every_ * (1 - slack)) return 0;
    return 1 + static_cast<std::int64_t>(per_decade * std::log10(time / every_) + slack);
}

double Timer::mark(std::int64_t n) const {
    return every_ * (growth_ == 1 ? static_cast<double>(n) : std::pow(growth_, static_cast<double>(n - 1)));
}

std::int64_t Timer::next_step(std::int64_t step) const {
    return next_multiple(step, steps_);
}

double Timer::next_time() const {
    return every_ > 0 ? mark(done_ + 1) : std::numeric_limits<double>::infinity();
}

bool Timer::is_due(const Engine& engine, bool all) {
    if (every_ == 0) return app::is_due(engine.step(), steps_, all);
    const std::int64_t now = marks(engine.time());
    const bool due = all || now > done_;
    done_ = now;
    return due;
}

} // namespace sandlane::app
