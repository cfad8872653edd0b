// The files of analyses: columns with units, averages that hold all frames so far, maps as pictures, and a
// resumed run that leaves the files of an undisturbed one.
#include "output/analysis_file.hpp"
#include "output/log.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::output;
using scene::AnalysisKind;
namespace fs = std::filesystem;

namespace {

constexpr AnalysisKind all_kinds[] = {
    AnalysisKind::profile, AnalysisKind::pair_correlation, AnalysisKind::force_chains, AnalysisKind::map,
    AnalysisKind::flow,    AnalysisKind::stress,           AnalysisKind::mixing};

scene::AnalysisSpec spec_of(AnalysisKind kind) {
    scene::AnalysisSpec spec;
    spec.name = "measured";
    spec.kind = kind;
    spec.bins = 5;
    if (kind == AnalysisKind::flow || kind == AnalysisKind::profile) {
        spec.from = {0.0613, 0, 0};
        spec.to = {0.2, 0.1, 0};
    }
    return spec;
}

scene::Scene scene_of_row() {
    scene::Scene scene = sample::scene();
    scene.domain.upper = {0.2, 0.1, 0};
    scene.output.picture_width = 100;
    return scene;
}

void write_frame(AnalysisFile& file, int n) {
    const analysis::Snapshot s = sample::walled_row(n);
    analysis::Contact c;
    c.j = 1;
    c.normal = {1, 0, 0};
    c.force = {-1.0 - n, 0.5, 0};
    c.point = {0.03, 0.03, 0};
    const analysis::Contacts contacts{c};
    file.write({s, contacts});
}

} // namespace

TEST(AnalysisFile, HoldsAHeaderWithUnitsAndNumbers) {
    for (const AnalysisKind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const sample::Folder folder("analysis");
        AnalysisFile file(folder.path(), scene_of_row(), spec_of(kind));
        write_frame(file, 0);
        write_frame(file, 1);
        (void)file.bookmark();
        const analysis::Log table = read_log(folder / "measured.csv");
        EXPECT_FALSE(table.rows.empty());
        for (const analysis::LogColumn& column : table.columns)
            EXPECT_FALSE(column.unit.empty()) << column.name;
    }
}

TEST(AnalysisFile, AResumedRunLeavesTheSameBytes) {
    for (const AnalysisKind kind : all_kinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        const sample::Folder folder("analysis");
        std::string bookmark;
        std::map<std::string, std::string> at_bookmark;
        {
            AnalysisFile file(folder.path(), scene_of_row(), spec_of(kind));
            for (int n = 0; n < 3; ++n) write_frame(file, n);
            bookmark = file.bookmark();
            at_bookmark = files_of(folder.path());
            for (int n = 3; n < 5; ++n) write_frame(file, n);
            EXPECT_NE(file.bookmark(), bookmark);
            file.draw(sample::walled_row(4));
        }
        const auto undisturbed = files_of(folder.path());
        AnalysisFile file(folder.path(), scene_of_row(), spec_of(kind), bookmark);
        EXPECT_EQ(file.bookmark(), bookmark);
        EXPECT_EQ(read_file(folder / "measured.csv"), at_bookmark.at("measured.csv"));
        for (int n = 3; n < 5; ++n) write_frame(file, n);
        (void)file.bookmark();
        file.draw(sample::walled_row(4));
        EXPECT_EQ(files_of(folder.path()), undisturbed);
        EXPECT_EQ(undisturbed.size(), kind == AnalysisKind::map ? 4U : 1U);
    }
}

TEST(AnalysisFile, BookmarksThatFitNothingAreRefused) {
    const sample::Folder folder("analysis");
    for (const AnalysisKind kind : all_kinds)
        for (const std::string bookmark : {"x", "12345678", "a longer text that is no bookmark"})
            EXPECT_TRUE(
                has(refusal(Exit::io,
                            [&] { AnalysisFile(folder.path(), scene_of_row(), spec_of(kind), bookmark); }),
                    "measured.csv"));
}
