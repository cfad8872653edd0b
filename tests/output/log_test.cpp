#include "output/log.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

using namespace sandlane;
using namespace sandlane::output;

namespace {

const std::vector<analysis::LogColumn> columns{{"time", "s"}, {"kinetic_energy", "J"}, {"note", ""}};

std::string refusal_of_text(const sample::Folder& folder, const std::string& text) {
    write_file_atomically(folder / "log.csv", text);
    std::string message = refusal(Exit::invalid_input, [&] { (void)read_log(folder / "log.csv"); });
    EXPECT_TRUE(has(message, (folder / "log.csv").string())) << message;
    return message;
}

} // namespace

TEST(Log, HeaderNamesColumnsAndUnits) {
    const sample::Folder folder("log-header");
    const LogWriter writer(folder / "log.csv", columns);
    EXPECT_EQ(lines_of(folder / "log.csv"), (std::vector<std::string>{"time[s],kinetic_energy[J],note"}));
    const analysis::Log log = read_log(folder / "log.csv");
    ASSERT_EQ(log.columns.size(), 3U);
    EXPECT_EQ(log.columns[1].name, "kinetic_energy");
    EXPECT_EQ(log.columns[1].unit, "J");
    EXPECT_EQ(log.columns[2].unit, "");
    EXPECT_TRUE(log.rows.empty());
}

TEST(Log, NumbersReadBackToTheSameBits) {
    const sample::Folder folder("log-bits");
    using limits = std::numeric_limits<double>;
    const std::vector<std::vector<double>> rows{
        {0.1, -0.0, 1.0 / 3},
        {limits::max(), limits::min(), limits::denorm_min()},
        {std::nextafter(1.0, 2.0), -1e-300, 6.02214076e23},
        {limits::infinity(), -limits::infinity(), 12345678901234567.0}};
    LogWriter(folder / "log.csv", columns).write(rows);
    const analysis::Log log = read_log(folder / "log.csv");
    ASSERT_EQ(log.rows.size(), rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(std::bit_cast<std::uint64_t>(log.rows[r][c]), std::bit_cast<std::uint64_t>(rows[r][c]));
}

TEST(Log, GarbledFilesAreRefusedWithTheLine) {
    const sample::Folder folder("log-garbled");
    EXPECT_TRUE(has(refusal_of_text(folder, ""), "empty"));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b"), "log.csv:1: "));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n1,2\n3,x\n"), "log.csv:3: \"x\""));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n1,2\n3\n"), "log.csv:3: 1 numbers for 2"));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n1,2,3\n"), "log.csv:2: 3 numbers for 2"));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n1, 2\n"), "log.csv:2: "));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n1,\n"), "log.csv:2: "));
    EXPECT_TRUE(has(refusal_of_text(folder, "a,b\n\n"), "log.csv:2: "));
}

TEST(Log, TruncatedFilesAreRefusedUnlessWholeLinesRemain) {
    const sample::Folder folder("log-truncated");
    const std::string whole = "a[s],b\n1,2.5\n3,4\n";
    for (std::size_t length = 1; length < whole.size(); ++length) {
        const std::string part = whole.substr(0, length);
        if (part.back() != '\n') {
            EXPECT_TRUE(has(refusal_of_text(folder, part), "incomplete")) << part;
            continue;
        }
        write_file_atomically(folder / "log.csv", part);
        EXPECT_EQ(read_log(folder / "log.csv").rows.size(), part == "a[s],b\n" ? 0U : 1U);
    }
}
