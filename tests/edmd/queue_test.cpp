// The queue of buckets against an ordered list, and the bookkeeping of epochs, each by itself.
#include "core/rng.hpp"
#include "edmd/epochs.hpp"
#include "edmd/event_log.hpp"
#include "edmd/queue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

using namespace sandlane;

namespace {

constexpr double never = simd::never_meets;

// Particles in the queue, and what an ordered list says of them.
class Waiting {
public:
    Waiting(std::uint32_t particles, double events_per_second, double now = 0) : events_(particles) {
        queue_.restart(now, events_per_second, particles);
        for (simd::HardEvents& e : events_) {
            e = {};
            e.first_time = e.crossing_time = never;
            e.bucket = edmd::Queue::nowhere;
        }
    }

    void put(std::uint32_t i, double contact, double crossing = never) {
        const double old = key(i);
        if (old < never) expected_.erase({old, i});
        events_[i].first_time = contact;
        events_[i].crossing_time = crossing;
        if (key(i) < never) expected_.insert({key(i), i});
        queue_.put(i, events_[i]);
    }

    // The particle whose turn it is, out of the queue; false: nobody waits. Checks the time.
    bool take(std::uint32_t& particle, double& time) {
        for (;;) {
            if (queue_.sorted().empty()) {
                if (queue_.advance(events_.data())) continue;
                EXPECT_TRUE(expected_.empty());
                return false;
            }
            const edmd::Queue::Entry top = queue_.sorted().back();
            queue_.pop();
            simd::HardEvents& e = events_[top.particle];
            if (e.bucket != edmd::Queue::present || key(top.particle) != top.time) continue;
            particle = top.particle;
            time = top.time;
            EXPECT_FALSE(expected_.empty());
            if (!expected_.empty()) {
                EXPECT_EQ(expected_.begin()->first, time);
            }
            expected_.erase({time, particle});
            e.bucket = edmd::Queue::nowhere;
            e.first_time = e.crossing_time = never;
            return true;
        }
    }
    [[nodiscard]] double key(std::uint32_t i) const {
        return std::min(events_[i].first_time, events_[i].crossing_time);
    }
    [[nodiscard]] std::size_t size() const { return expected_.size(); }

private:
    edmd::Queue queue_;
    std::vector<simd::HardEvents> events_;
    std::set<std::pair<double, std::uint32_t>> expected_;
};

double number(std::uint32_t n, std::uint32_t stream) {
    const auto w = philox({n, stream, 0, 0}, {1, 2});
    return unit_number(w[0], w[1]);
}

} // namespace

// Everybody waits, is taken, waits again; now and then another one changes its mind. Whatever the width of
// the buckets, a thousand times too wide or too narrow.
TEST(EdmdQueue, TakesTheEarliest) {
    for (const std::uint32_t n : {1U, 7U, 100U, 3000U})
        for (const double rate : {1e-3, 1.0, 1e3}) {
            SCOPED_TRACE(testing::Message() << n << " particles, " << rate);
            Waiting queue(n, rate * n);
            for (std::uint32_t i = 0; i < n; ++i) queue.put(i, -std::log1p(-number(i, 0)), 2 * number(i, 1));
            std::uint32_t i = 0, steps = 0;
            double now = 0;
            for (; steps < 20000; ++steps) {
                double time = 0;
                ASSERT_TRUE(queue.take(i, time));
                ASSERT_GE(time, now);
                now = time;
                queue.put(i, now - std::log1p(-number(steps, 2)));
                if (steps % 3 != 0) continue;
                const auto other = static_cast<std::uint32_t>(n * number(steps, 3));
                queue.put(other, now - 3 * std::log1p(-number(steps, 4)));
            }
        }
}

// A queue that is not refilled gives out everything, however late, and then says so.
TEST(EdmdQueue, ComesToAnEnd) {
    Waiting queue(500, 500);
    for (std::uint32_t i = 0; i < 500; ++i)
        queue.put(i, i % 5 == 0 ? never : std::pow(10, 12 * number(i, 0) - 6));
    EXPECT_EQ(queue.size(), 400U);
    std::uint32_t i = 0, taken = 0;
    double time = 0;
    while (queue.take(i, time)) ++taken;
    EXPECT_EQ(taken, 400U);
    // And goes on when somebody comes.
    queue.put(3, 2e6);
    ASSERT_TRUE(queue.take(i, time));
    EXPECT_EQ(i, 3U);
    EXPECT_FALSE(queue.take(i, time));
}

// All at the same time, in one bucket that overflows; and an entry for the present, or for what is past by
// rounding, comes next.
TEST(EdmdQueue, ManyInOneBucket) {
    Waiting queue(1000, 1000, 5);
    for (std::uint32_t i = 0; i < 1000; ++i) queue.put(i, 5.5);
    std::set<std::uint32_t> taken;
    std::uint32_t i = 0;
    double time = 0;
    for (int k = 0; k < 999; ++k) {
        ASSERT_TRUE(queue.take(i, time));
        EXPECT_EQ(time, 5.5);
        taken.insert(i);
    }
    queue.put(*taken.begin(), std::nextafter(5.5, 0.0));
    ASSERT_TRUE(queue.take(i, time));
    EXPECT_EQ(i, *taken.begin());
    ASSERT_TRUE(queue.take(i, time));
    taken.insert(i);
    EXPECT_EQ(taken.size(), 1000U);
    EXPECT_FALSE(queue.take(i, time));
}

// Moved to and fro, a particle is given out once, at its last time.
TEST(EdmdQueue, OnlyTheLastTimeCounts) {
    Waiting queue(10, 10);
    for (int k = 0; k < 1000; ++k) queue.put(4, 1 + number(static_cast<std::uint32_t>(k), 0));
    queue.put(4, never);
    queue.put(5, 7);
    queue.put(4, 1.25);
    std::uint32_t i = 0;
    double time = 0;
    ASSERT_TRUE(queue.take(i, time));
    EXPECT_EQ(i, 4U);
    EXPECT_EQ(time, 1.25);
    ASSERT_TRUE(queue.take(i, time));
    EXPECT_EQ(i, 5U);
    EXPECT_FALSE(queue.take(i, time));
}

// A million epochs of 0.1 s: the sum is exact to the last digit but one, that of plain additions is not.
TEST(EdmdEpochs, TheClockDoesNotLoseTime) {
    edmd::Clock clock;
    double plain = 0;
    for (int k = 0; k < 1000000; ++k) {
        clock.now = 0.1;
        plain += clock.now;
        clock.begin_epoch();
        EXPECT_EQ(clock.now, 0);
    }
    EXPECT_NEAR(clock.time(), 1e5, 3e-11);
    EXPECT_GT(std::abs(plain - 1e5), 1e-7);
    // A time and back.
    clock.now = clock.until(100000.3);
    EXPECT_NEAR(clock.time(), 100000.3, 3e-11);
}

TEST(EdmdEpochs, LastSoLong) {
    EXPECT_EQ(edmd::events_of_epoch(0), 40);
    EXPECT_EQ(edmd::events_of_epoch(1000), 20000);
    edmd::Setup s;
    s.upper[0] = 10;
    s.upper[1] = s.upper[2] = 20;
    // A thousand times the shortest edge.
    EXPECT_DOUBLE_EQ(edmd::longest_epoch(s, 4), 5000);
    EXPECT_EQ(edmd::longest_epoch(s, 0), never);
    // A field: what falls from rest takes sqrt(2 s/g) for a way s, and bounces about at sqrt(g L).
    s.gravity[1] = -0.1;
    EXPECT_DOUBLE_EQ(edmd::longest_epoch(s, 0), std::sqrt(1e4 / 0.1));
}

TEST(EdmdEpochs, Drift) {
    const auto of = [](double together, double apart) {
        edmd::Drift drift;
        drift.add(1, {together, apart, 0});
        drift.add(3, {together, -apart / 3, 0});
        return drift.is_too_fast();
    };
    EXPECT_FALSE(of(0, 1));
    EXPECT_FALSE(of(0, 0));
    EXPECT_FALSE(of(1, 3e-4));
    EXPECT_TRUE(of(1, 3e-5));
    EXPECT_TRUE(of(1e-100, 0));
    edmd::Drift alone;
    alone.add(1, {1, 0, 0});
    EXPECT_FALSE(alone.is_too_fast());
}
