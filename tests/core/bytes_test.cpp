// Byte strings: what was put comes back, and nothing is read beyond the end.
#include "core/bytes.hpp"

#include "core/column.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace sandlane {

namespace {

TEST(Bytes, RoundTrip) {
    ByteWriter w;
    w.put(std::int32_t{-5});
    w.put(1.5);
    w.put_text("grains\0more");
    const Column<double> column(5, 2.5);
    w.put_array(column.data(), column.size());
    w.put_text("");
    ByteReader r(w.bytes());
    EXPECT_EQ(r.get<std::int32_t>(), -5);
    EXPECT_EQ(r.get<double>(), 1.5);
    EXPECT_EQ(r.get_text(), "grains\0more");
    Column<double> again;
    r.get_array(again);
    ASSERT_EQ(again.size(), 5U);
    EXPECT_EQ(again[4], 2.5);
    EXPECT_FALSE(r.at_end());
    EXPECT_EQ(r.get_text(), "");
    EXPECT_TRUE(r.at_end());
}

TEST(Bytes, EveryTruncationIsAnError) {
    ByteWriter w;
    w.put(std::uint8_t{1});
    w.put_text("text");
    const std::vector<double> values = {1, 2, 3};
    w.put_array(values.data(), values.size());
    const std::string bytes = w.bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const auto read = [&] {
            ByteReader r(std::string_view(bytes).substr(0, size));
            (void)r.get<std::uint8_t>();
            (void)r.get_text();
            std::vector<double> out;
            r.get_array(out);
        };
        EXPECT_THROW(read(), Error) << size;
    }
}

TEST(Bytes, CountsThatCannotBeAreErrorsBeforeMemoryIsAskedFor) {
    for (const std::uint64_t count :
         {std::uint64_t{100}, std::uint64_t{1} << 61, std::numeric_limits<std::uint64_t>::max()}) {
        ByteWriter w;
        w.put(count);
        w.put(1.0);
        std::vector<double> out;
        ByteReader r(w.bytes());
        EXPECT_THROW(r.get_array(out), Error) << count;
    }
}

} // namespace

} // namespace sandlane
