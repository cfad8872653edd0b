// Columns: alignment, padding, and values that survive growth.
#include "core/column.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <utility>

namespace sandlane {

namespace {

std::uintptr_t misalignment(const void* data, std::size_t alignment) {
    return reinterpret_cast<std::uintptr_t>(data) % alignment;
}

TEST(Column, IsAlignedAndPaddedToBlocks) {
    for (const std::size_t n : {1UL, 7UL, 8UL, 9UL, 1000UL}) {
        const Column<float> column(n, 3.0F);
        EXPECT_EQ(column.size(), n);
        EXPECT_EQ(misalignment(column.data(), column_alignment), 0U);
        for (std::size_t i = 0; i < padded(n); ++i) EXPECT_EQ(column.data()[i], 3.0F) << n;
    }
    EXPECT_EQ(padded(0), 0U);
    EXPECT_EQ(padded(8), 8U);
    EXPECT_EQ(padded(9), 16U);
}

TEST(Column, LargeOnesStartOnAHugePage) {
    const Column<double> column(std::size_t{1} << 18);
    EXPECT_EQ(misalignment(column.data(), std::size_t{2} << 20), 0U);
}

TEST(Column, GrowthKeepsValuesAndFillsTheRest) {
    Column<int> column(5);
    std::iota(column.begin(), column.end(), 10);
    for (const std::size_t n : {6UL, 8UL, 100UL, 5000UL}) {
        column.resize(n, -1);
        for (std::size_t i = 0; i < padded(n); ++i)
            EXPECT_EQ(column.data()[i], i < 5 ? 10 + static_cast<int>(i) : -1);
    }
    column.resize(3, -2);
    EXPECT_EQ(column.size(), 3U);
    EXPECT_EQ(column[2], 12);
    EXPECT_EQ(column.data()[3], -2); // padding
    column.resize(4, -3);
    EXPECT_EQ(column[3], -3);
}

TEST(Column, CopiesAreIndependentAndMovesAreNot) {
    Column<double> a(10, 1.0);
    Column<double> b = a;
    b[0] = 2;
    EXPECT_EQ(a[0], 1);
    const double* data = a.data();
    Column<double> c = std::move(a);
    EXPECT_EQ(c.data(), data);
    b = c;
    EXPECT_EQ(b[0], 1);
    EXPECT_NE(b.data(), c.data());
    EXPECT_TRUE(Column<double>(Column<double>()).empty());
}

TEST(Column, FillReachesThePadding) {
    Column<int> column(3, 1);
    column.fill(7);
    for (std::size_t i = 0; i < padded(3); ++i) EXPECT_EQ(column.data()[i], 7);
    EXPECT_EQ(column.view().size(), 3U);
    column.clear();
    EXPECT_TRUE(column.empty());
}

} // namespace

} // namespace sandlane
