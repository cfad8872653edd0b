// [[analysis]]: what is read, written back and refused.
#include "scene/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::scene;

TEST(AnalysisScene, KeysAreReadAndWritten) {
    const Scene s =
        scene_with("[[analysis]]\nname = \"out\"\nkind = \"flow\"\nevery = \"5 ms\"\nstart = 0.5\n"
                   "from = [0.1, 0.2]\nto = [\"30 cm\", 0.2]\n"
                   "[[analysis]]\nname = \"g\"\nkind = \"pair-correlation\"\nrange = 0.25\nbins = 7\n");
    ASSERT_EQ(s.analyses.size(), 2U);
    EXPECT_EQ(s.analyses[0].kind, AnalysisKind::flow);
    EXPECT_EQ(s.analyses[0].every, 5e-3);
    EXPECT_EQ(s.analyses[0].to.x, 0.3);
    const Scene again = parse_scene(write_scene(s), "again");
    EXPECT_EQ(write_scene(again), write_scene(s));
    EXPECT_EQ(again.analyses[1].bins, 7);
    EXPECT_EQ(again.analyses[1].range, 0.25);
}

TEST(AnalysisScene, Mistakes) {
    const auto mistake = [](const std::string& keys) {
        return refusal_of(scene_text("[[analysis]]\n" + keys));
    };
    EXPECT_SAYS(mistake("name = \"a\"\n"), "analysis[0].kind: is missing");
    EXPECT_SAYS(mistake("kind = \"map\"\n"), "analysis[0].name: is missing");
    EXPECT_SAYS(mistake("name = \"a\"\nkind = \"histogram\"\n"), "pair-correlation");
    EXPECT_SAYS(mistake("name = \"../a\"\nkind = \"map\"\n"), "cannot name a file");
    EXPECT_SAYS(mistake("name = \"log\"\nkind = \"map\"\n"), "another output");
    EXPECT_SAYS(mistake("name = \"a\"\nkind = \"flow\"\n"), "analysis[0].to");
    EXPECT_SAYS(mistake("name = \"a\"\nkind = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\n"), "span no area");
    EXPECT_SAYS(mistake("name = \"a\"\nkind = \"pair-correlation\"\nrange = 1.5\n"), "up to 1 m");
    EXPECT_SAYS(mistake("name = \"a\"\nkind = \"map\"\n[[analysis]]\nname = \"a\"\nkind = \"map\"\n"),
                "analysis[1].name: \"a\" is used twice");
}
