// The book's init files and snapshots: what is read is written and read again without loss, and becomes a
// scene.
#include "core/error.hpp"
#include "scene/book_format.hpp"
#include "scene/reader.hpp"

#include <cstdlib>

using namespace sandlane;

namespace {

void read_init(const std::string& text) {
    const scene::Book book = scene::parse_book(text, "fuzz.book");
    if (scene::parse_book(scene::write_book(book), "written.book") != book) std::abort();
    const std::string written = scene::write_scene(scene::scene_from_book(book, "fuzz.book"));
    (void)scene::parse_scene(written, "written.toml");
}

void read_frames(const std::string& text) {
    std::string written;
    const std::vector<scene::Book> frames = scene::parse_book_frames(text, "fuzz.book");
    for (const scene::Book& frame : frames) written += scene::write_book_frame(frame);
    const std::vector<scene::Book> again = scene::parse_book_frames(written, "written.book");
    if (again.size() != frames.size()) std::abort();
    for (std::size_t n = 0; n < frames.size(); ++n)
        if (again[n].records != frames[n].records) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    for (const auto read : {read_init, read_frames}) try {
            read(text);
        } catch (const Error&) {
        }
    return 0;
}
