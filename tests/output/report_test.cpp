// The text of report.html. What a browser makes of it: tests/output/readers/browser_shows_report.py.
#include "output/report.hpp"

#include "core/rng.hpp"
#include "output/escape.hpp"
#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace sandlane;
using namespace sandlane::output;

namespace {

std::string page_of(const ReportInput& input) {
    const sample::Folder folder("report");
    write_report(folder / "report.html", input);
    return read_file(folder / "report.html");
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

} // namespace

TEST(Escape, Html) {
    EXPECT_EQ(html_text("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
}

TEST(Escape, Json) {
    EXPECT_EQ(json_text("a\"b\\c\n</script>"), "\"a\\\"b\\\\c\\u000a\\u003c/script>\"");
    EXPECT_EQ(json_text("\xC3\xA4"), "\"\xC3\xA4\"");
    EXPECT_EQ(json_number(0.5), "0.5");
    EXPECT_EQ(json_number(NAN), "null");
    EXPECT_EQ(json_number(-INFINITY), "null");
}

// RFC 4648, section 10.
TEST(Escape, Base64) {
    const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                   {"f", "Zg=="},
                                                                   {"fo", "Zm8="},
                                                                   {"foo", "Zm9v"},
                                                                   {"foob", "Zm9vYg=="},
                                                                   {"fooba", "Zm9vYmE="},
                                                                   {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, coded] : vectors) EXPECT_EQ(base64(plain), coded);
    EXPECT_EQ(base64("\xFB\xFF\xFE"), "+//+");
}

TEST(Report, IsOneFileWithoutNetwork) {
    const std::string page = page_of({});
    EXPECT_TRUE(
        has(page, "content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline';"));
    for (const char* way_out : {"src=", "href=", "url(", "@import", "fetch(", "XMLHttpRequest", "WebSocket"})
        EXPECT_FALSE(has(page, way_out)) << way_out;
}

TEST(Report, NothingFromTheSceneIsMarkup) {
    const std::string attack = "</script></title></pre><script>alert(1)</script>{{data}}";
    ReportInput input;
    input.scene.title = input.scene.description = input.plan = input.scene_text = attack;
    input.summary = {{attack, attack}};
    input.log.columns = {{attack, attack}};
    const std::string page = page_of(input), plain = page_of({});
    for (const char* tag : {"<script", "</script", "</title", "</pre"})
        EXPECT_EQ(count(page, tag), count(plain, tag));
    EXPECT_EQ(count(page, "{{data}}"),
              9U); // texts, twice the title, and both texts of the row and the column
}

TEST(Report, StaysBelowFiveMegabytes) {
    ReportInput input;
    const Random random(3, Stream::position);
    std::uint64_t next = 0;
    // 64 frames of the largest size, all bytes random: 9 bytes of 10000 grains in each.
    for (int n = 0; n < 64; ++n) {
        ReplayFrame f;
        f.time = n;
        f.grains = 10'000;
        for (std::size_t i = 0; i < most_replayed; ++i) {
            const auto draw = [&] { return static_cast<std::uint16_t>(65536 * random.uniform(next++)); };
            f.x.push_back(draw());
            f.y.push_back(draw());
            f.angle.push_back(static_cast<std::uint8_t>(draw()));
            for (auto& level : f.level)
                level.push_back(static_cast<std::uint8_t>(f.x.back() ^ f.y.back() >> 3));
        }
        input.replay.push_back(std::move(f));
    }
    input.log.columns.resize(15, {"a_column", "J"});
    input.log.rows.assign(20'000, std::vector<double>(15, -1.23456789e-100));
    EXPECT_LT(page_of(input).size(), 5'000'000U);
}

TEST(Report, AFolderThatIsNotThereIsNamed) {
    EXPECT_TRUE(
        has(refusal(Exit::io, [] { write_report("/nowhere/at/all/report.html", {}); }), "/nowhere/at/all"));
}
