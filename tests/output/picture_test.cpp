#include "output/picture.hpp"

#include "output/colours.hpp"
#include "output/image.hpp"
#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace sandlane;
using namespace sandlane::output;

namespace {

analysis::Snapshot unit_box() {
    analysis::Snapshot s = sample::empty();
    s.upper = {1, 1, 0};
    return s;
}

// Equal to the colour map at this place, up to the rounding to bytes.
void expect_map_colour(Pixel pixel, double unit) {
    const Rgb c = map_colour(unit);
    EXPECT_NEAR(pixel[0], 255 * c.r, 0.51);
    EXPECT_NEAR(pixel[1], 255 * c.g, 0.51);
    EXPECT_NEAR(pixel[2], 255 * c.b, 0.51);
}

// CIE lightness of an sRGB colour.
double lightness(Rgb c) {
    const auto linear = [](double v) {
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

} // namespace

TEST(Picture, BackgroundAndDomain) {
    const Image image = draw(unit_box(), {});
    EXPECT_EQ(image.width, 800);
    EXPECT_EQ(image.at(1, 1), (Pixel{255, 255, 255}));
    EXPECT_EQ(image.in_domain(0.3, 0.7), ground);
    EXPECT_EQ(image.right - image.left, image.bottom - image.top); // a square stays a square
}

TEST(Picture, GrainsHaveTheColourOfTheirValue) {
    analysis::Snapshot s = unit_box();
    sample::add_grain(s, 0.2, 0.8, 0.05, 0, -0.5, 3, 0, 40);
    sample::add_grain(s, 0.7, 0.3, 0.10, 1.5, 0, -8, 0, -7);
    struct Case {
        scene::Colour colour;
        double high, first, second; // end of the scale, values of the two grains
    };
    for (const Case c : {Case{scene::Colour::speed, 2, 0.5, 1.5}, Case{scene::Colour::pressure, 50, 40, 0},
                         Case{scene::Colour::spin, 8, 3, 8}}) {
        PictureStyle style;
        style.colour = c.colour;
        style.scale_max = c.high;
        const Image image = draw(s, style);
        expect_map_colour(image.in_domain(0.2, 0.8), c.first / c.high);
        expect_map_colour(image.in_domain(0.7, 0.3), c.second / c.high);
        EXPECT_EQ(image.in_domain(0.2, 0.3), ground);
    }
    // Radii of two sizes use the whole map.
    PictureStyle style;
    style.colour = scene::Colour::radius;
    const Image image = draw(s, style);
    expect_map_colour(image.in_domain(0.2, 0.8), 0);
    expect_map_colour(image.in_domain(0.7, 0.3), 1);
}

TEST(Picture, GrainsCoverTheirArea) {
    analysis::Snapshot s = unit_box();
    sample::add_grain(s, 0.5, 0.5, 0.2, 0, 0);
    const Image image = draw(s, {});
    int covered = 0;
    for (int y = image.top; y < image.bottom; ++y)
        for (int x = image.left; x < image.right; ++x) covered += image.at(x, y) == ground ? 0 : 1;
    const double side = image.right - image.left, r = 0.2 * side;
    // Pixels cut by the rim count whole: half a pixel more along the circumference, within a quarter.
    EXPECT_NEAR(covered, M_PI * r * r + M_PI * r, M_PI * r / 2);
}

TEST(Picture, WallsAreDrawn) {
    analysis::Snapshot s = unit_box();
    s.walls = {sample::segment({0.1, 0.2, 0}, {0.9, 0.6, 0}), sample::disc({0.5, 0.8, 0}, 0.1)};
    const Image image = draw(s, {});
    const auto dark = [](Pixel p) { return p[0] + p[1] + p[2] < 250; };
    for (const double t : {0.02, 0.3, 0.5, 0.98}) {
        EXPECT_TRUE(dark(image.in_domain(0.1 + 0.8 * t, 0.2 + 0.4 * t))) << t;
        EXPECT_EQ(image.in_domain(0.1 + 0.8 * t, 0.25 + 0.4 * t), ground) << t;
    }
    EXPECT_NE(image.in_domain(0.5, 0.8), ground);
    EXPECT_EQ(image.in_domain(0.5, 0.92), ground);
}

TEST(Picture, PeriodicGrainsShowOnBothSides) {
    analysis::Snapshot s = unit_box();
    sample::add_grain(s, 0.01, 0.99, 0.1, 0, 0);
    const std::vector<std::pair<double, double>> corners{
        {0.05, 0.95}, {0.95, 0.95}, {0.05, 0.05}, {0.95, 0.05}};
    for (const int periodic : {0, 1, 2, 3}) {
        s.periodic_x = (periodic & 1) != 0;
        s.periodic_y = (periodic & 2) != 0;
        const Image image = draw(s, {});
        for (int k = 0; k < 4; ++k) {
            const auto [x, y] = corners[static_cast<std::size_t>(k)];
            EXPECT_EQ(image.in_domain(x, y) != ground, (k & ~periodic) == 0) << periodic << " " << k;
        }
    }
}

TEST(Picture, DimensionsAreEven) {
    for (const int width : {64, 801, 333})
        for (const double high : {0.1, 0.777, 1.0, 5.0}) {
            analysis::Snapshot s = unit_box();
            s.upper.y = high;
            PictureStyle style;
            style.width = width;
            const Image image = draw(s, style);
            EXPECT_EQ(image.width, width / 2 * 2);
            EXPECT_EQ(image.height % 2, 0);
        }
}

TEST(Picture, BrokenNumbersDoNotBreakIt) {
    analysis::Snapshot s = unit_box();
    sample::add_grain(s, NAN, 0.5, 0.1, NAN, 0);
    sample::add_grain(s, 0.5, 0.5, 0.1, 0, INFINITY);
    EXPECT_EQ(draw(s, {}).width, 800);
}

TEST(Colours, MapRisesEvenlyInLightness) {
    const auto& map = colour_map();
    double smallest = 1e9, largest = 0;
    for (std::size_t k = 1; k < map.size(); ++k) {
        const double step = lightness(map[k]) - lightness(map[k - 1]);
        smallest = std::min(smallest, step);
        largest = std::max(largest, step);
    }
    EXPECT_GT(smallest, 0);
    // Even in Oklab; CIE lightness weighs hues differently, but no step stands out.
    EXPECT_LT(largest, 2 * (lightness(map[255]) - lightness(map[0])) / 255);
}

TEST(Colours, RoundUp) {
    EXPECT_EQ(round_up(1), 1);
    EXPECT_EQ(round_up(1.1), 1.5);
    EXPECT_EQ(round_up(7e-3), 8e-3);
    EXPECT_EQ(round_up(900), 1000);
    EXPECT_EQ(largest_finite({-3, NAN, INFINITY}), 0);
    EXPECT_EQ(largest_finite({2, NAN, 5, INFINITY, 1}), 5);
}

TEST(Colours, OneGrainInAHundredDoesNotSetTheScale) {
    std::vector<double> values(1000, 1.0);
    std::fill_n(values.begin(), 10, 100.0);
    EXPECT_EQ(usual_high(values), 1);
    values[10] = 100;
    EXPECT_EQ(usual_high(values), 100);
    EXPECT_EQ(usual_high(std::vector<double>(99, 1.0)), 1);
    EXPECT_EQ(usual_high({1, 2, 100}), 100); // of few, each counts
    std::vector<double> resting(1000, 0.0);
    resting[5] = 3;
    EXPECT_EQ(usual_high(resting), 3); // nothing to compare with
    std::vector<double> close(1000, 1.0);
    close[5] = 1.2;
    EXPECT_EQ(usual_high(close), 1.2);
    EXPECT_EQ(usual_high({NAN, INFINITY}), 0);
    EXPECT_EQ(usual_high({}), 0);
}

TEST(Picture, OneFastGrainDoesNotDarkenTheOthers) {
    analysis::Snapshot s = unit_box();
    for (int n = 0; n < 200; ++n)
        sample::add_grain(s, 0.05 * (n % 20) + 0.025, 0.05 * (n / 20) + 0.025, 0.02, n == 0 ? 50 : 1.0, 0);
    const Image image = draw(s, {});
    expect_map_colour(image.in_domain(0.525, 0.025), 1);
    expect_map_colour(image.in_domain(0.025, 0.025), 1);
}

TEST(Colours, PressureInAPlaneIsAForcePerLength) {
    EXPECT_EQ(quantity(scene::Colour::pressure, 2).unit, "N/m");
    EXPECT_EQ(quantity(scene::Colour::pressure, 3).unit, "Pa");
}
