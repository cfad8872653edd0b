// Fields as pictures and .npy files, tables as plots.
#include "output/field_picture.hpp"
#include "output/npy.hpp"
#include "output/plot.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace sandlane::output {

namespace {

analysis::Field field() {
    return {"height", "height", "m", 3, 2, {0, 1, 2, 3, 4, 5.5}, false, 0};
}

TEST(Npy, HeaderAndNumbers) {
    const std::string bytes = npy_bytes(field());
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const auto length = static_cast<std::size_t>(static_cast<unsigned char>(bytes[8])) |
                        static_cast<std::size_t>(static_cast<unsigned char>(bytes[9])) << 8;
    EXPECT_EQ((10 + length) % 64, 0U);
    const std::string header = bytes.substr(10, length);
    EXPECT_NE(header.find("'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"), std::string::npos);
    EXPECT_EQ(header.back(), '\n');
    ASSERT_EQ(bytes.size(), 10 + length + 6 * 4);
    float last = 0;
    std::memcpy(&last, bytes.data() + bytes.size() - 4, 4);
    EXPECT_EQ(last, 5.5F);
}

TEST(FieldPicture, ScaleEndsAtWhatIsUsual) {
    EXPECT_EQ(scale_of(field()), 6); // 5.5 rounded up
    analysis::Field fixed = field();
    fixed.high = 3;
    EXPECT_EQ(scale_of(fixed), 3);
    analysis::Field empty = field();
    empty.values.assign(6, 0);
    EXPECT_EQ(scale_of(empty), 1);
}

TEST(FieldPicture, IsAPicture) {
    const std::string png = draw_field(field(), "step 7", 6, 120);
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_NE(png, draw_field(field(), "step 7", 12, 120));
}

TEST(Plot, NeedsTwoPoints) {
    analysis::Table table{"t", {{"x", "1"}, {"y", "m"}}, {{1, 2}, {0, 5}, {-1, 3}}, 0, 1, true};
    EXPECT_EQ(draw_plot(table, 200), ""); // logarithms of one point only
    table.logarithmic = false;
    EXPECT_EQ(draw_plot(table, 200).substr(1, 3), "PNG");
    table.logarithmic = true;
    table.rows.push_back({100, 1e-9});
    EXPECT_EQ(draw_plot(table, 200).substr(1, 3), "PNG");
}

} // namespace

} // namespace sandlane::output
