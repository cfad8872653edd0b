// Times for people, and a silent progress line.
#include "core/progress.hpp"

#include <gtest/gtest.h>

namespace sandlane {

namespace {

TEST(Progress, ClockText) {
    EXPECT_EQ(clock_text(0), "0:00");
    EXPECT_EQ(clock_text(0.49), "0:00");
    EXPECT_EQ(clock_text(59.5), "1:00");
    EXPECT_EQ(clock_text(252), "4:12");
    EXPECT_EQ(clock_text(3599), "59:59");
    EXPECT_EQ(clock_text(3723), "1:02:03");
    EXPECT_EQ(clock_text(360000), "100:00:00");
}

TEST(Progress, QuietSaysNothing) {
    testing::internal::CaptureStderr();
    {
        Progress progress(0, 10, true);
        for (int step = 1; step <= 10; ++step) progress.update(step, 0.1 * step, 100);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace

} // namespace sandlane
