#include "output/plot_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sandlane::output {

namespace {

PlotAxis axis_of(bool logarithmic, std::initializer_list<double> values) {
    PlotAxis axis(logarithmic);
    for (const double v : values) axis.include(v);
    axis.finish();
    return axis;
}

} // namespace

TEST(PlotAxis, TicksAreRoundNumbersWithinIt) {
    const PlotAxis axis = axis_of(false, {0, 10});
    EXPECT_DOUBLE_EQ(axis.share(2.5), 0.25);
    const auto ticks = axis.ticks();
    ASSERT_EQ(ticks.size(), 6U);
    EXPECT_EQ(ticks[1].label, "2");
    EXPECT_DOUBLE_EQ(ticks[1].share, 0.2);
    EXPECT_EQ(axis_of(false, {-1, 1}).ticks()[2].label, "0");
}

TEST(PlotAxis, LogarithmicOnesShowWholeDecades) {
    const PlotAxis axis = axis_of(true, {3, 200});
    EXPECT_NEAR(axis.share(10), 1.0 / 3, 1e-12);
    const auto ticks = axis.ticks();
    ASSERT_EQ(ticks.size(), 4U);
    EXPECT_EQ(ticks.front().label, "1e0");
    EXPECT_EQ(ticks.back().label, "1e3");
}

TEST(PlotAxis, EqualValuesHaveRoom) {
    for (const bool logarithmic : {false, true}) {
        const PlotAxis axis = axis_of(logarithmic, {10, 10});
        EXPECT_DOUBLE_EQ(axis.share(10), 0);
        EXPECT_TRUE(std::isfinite(axis.share(11)));
        EXPECT_FALSE(axis.ticks().empty());
    }
}

TEST(PlotAxis, WhatItCannotShow) {
    const PlotAxis linear(false), logarithmic(true);
    EXPECT_TRUE(linear.empty());
    EXPECT_FALSE(linear.shows(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_TRUE(linear.shows(-1));
    EXPECT_FALSE(logarithmic.shows(0));
}

} // namespace sandlane::output
