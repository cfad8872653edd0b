#include "output/checkpoint.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::output;

namespace {

Checkpoint sample_checkpoint() {
    Checkpoint c;
    c.scene = "title = \"x\"\n";
    c.engine_state = std::string("state\0with zeros", 16);
    c.step = 123456789;
    c.wall_seconds = 1.5;
    c.bookmarks = {{"log", "77"}, {"vtp", "1 0 0.5"}};
    return c;
}

std::string sample_bytes(const sample::Folder& folder) {
    const Checkpoint c = sample_checkpoint();
    write_checkpoint(folder / "c", c, [&](ByteWriter& out) { out.put_bytes(c.engine_state); });
    return read_file(folder / "c");
}

std::string refusal_of_bytes(const std::string& bytes) {
    std::string message = refusal(Exit::io, [&] { (void)parse_checkpoint(bytes, "some.checkpoint"); });
    EXPECT_TRUE(has(message, "some.checkpoint: ")) << message;
    return message;
}

} // namespace

TEST(Checkpoint, RoundTrip) {
    const sample::Folder folder("checkpoint");
    (void)sample_bytes(folder);
    const Checkpoint read = read_checkpoint(folder / "c"), wrote = sample_checkpoint();
    EXPECT_EQ(read.scene, wrote.scene);
    EXPECT_EQ(read.engine_state, wrote.engine_state);
    EXPECT_EQ(read.step, wrote.step);
    EXPECT_EQ(read.wall_seconds, wrote.wall_seconds);
    EXPECT_EQ(read.bookmarks, wrote.bookmarks);
}

TEST(Checkpoint, EveryTruncationIsRefused) {
    const sample::Folder folder("truncated");
    const std::string bytes = sample_bytes(folder);
    for (std::size_t length = 0; length < bytes.size(); ++length) refusal_of_bytes(bytes.substr(0, length));
    refusal_of_bytes(bytes + '\0');
}

TEST(Checkpoint, EveryFlippedBitIsRefused) {
    const sample::Folder folder("flipped");
    const std::string bytes = sample_bytes(folder);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string flipped = bytes;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        refusal_of_bytes(flipped);
    }
}

TEST(Checkpoint, TheReasonIsTold) {
    const sample::Folder folder("reasons");
    std::string bytes = sample_bytes(folder);
    EXPECT_TRUE(
        has(refusal_of_bytes("title = \"a scene, and long enough to be something else\""), "start like one"));
    EXPECT_TRUE(has(refusal_of_bytes(bytes.substr(0, bytes.size() - 1)), "truncated"));
    bytes[8] = 9; // the version follows the eight letters of the name
    EXPECT_TRUE(has(refusal_of_bytes(bytes), "another version"));
    EXPECT_TRUE(
        has(refusal(Exit::invalid_input, [&] { (void)read_checkpoint(folder / "none"); }), "no such file"));
}
