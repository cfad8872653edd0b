#include "app/timer.hpp"

#include <cmath>

namespace sandlane::app {

namespace {

constexpr double slack = 1e-6;    // of an interval: a mark so near the end of the run is meant to be the end
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
    end_ = engine.duration();
    done_ = marks(engine.reached());
}

// A first guess, and then what mark() says to the last bit: whether a mark has passed must not depend on
// where a run was looked at.
std::int64_t Timer::marks(double time) const {
    std::int64_t n = 0;
    if (growth_ == 1)
        n = static_cast<std::int64_t>(time / every_);
    else if (time > every_)
        n = 1 + static_cast<std::int64_t>(per_decade * std::log10(time / every_));
    while (n > 0 && mark(n) > time) --n;
    while (mark(n + 1) <= time) ++n;
    return n;
}

double Timer::mark(std::int64_t n) const {
    const double time =
        every_ * (growth_ == 1 ? static_cast<double>(n) : std::pow(growth_, static_cast<double>(n - 1)));
    return std::abs(time - end_) < slack * every_ ? end_ : time;
}

std::int64_t Timer::next_step(std::int64_t step) const {
    return next_multiple(step, steps_);
}

double Timer::next_time() const {
    return every_ > 0 ? mark(done_ + 1) : std::numeric_limits<double>::infinity();
}

bool Timer::is_due(const Engine& engine, bool all) {
    if (every_ == 0) return app::is_due(engine.step(), steps_, all);
    const std::int64_t now = marks(engine.reached());
    const bool due = all || now > done_;
    done_ = now;
    return due;
}

} // namespace sandlane::app
