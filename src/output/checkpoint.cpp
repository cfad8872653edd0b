#include "output/checkpoint.hpp"

#include "core/bytes.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"

#include <string_view>

namespace sandlane::output {

namespace {

constexpr std::string_view magic = "SANDLANE";
constexpr std::uint32_t version = 4;
constexpr std::size_t header_size = magic.size() + sizeof(std::uint32_t) + 3 * sizeof(std::uint64_t);

Checkpoint read_content(std::string_view content) {
    ByteReader reader(content);
    Checkpoint c;
    c.scene = reader.get_text();
    c.engine_state = reader.get_text();
    c.step = reader.get<std::int64_t>();
    c.wall_seconds = reader.get<double>();
    const auto bookmarks = reader.get<std::uint64_t>();
    for (std::uint64_t n = 0; n < bookmarks; ++n) {
        const std::string key = reader.get_text();
        c.bookmarks[key] = reader.get_text();
    }
    if (!reader.at_end()) fail(Exit::io, "bytes too many");
    return c;
}

} // namespace

std::string bookmark_in(const Checkpoint* checkpoint, const std::string& name) {
    if (checkpoint == nullptr) return {};
    const auto found = checkpoint->bookmarks.find(name);
    return found == checkpoint->bookmarks.end() ? std::string() : found->second;
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& c) {
    // The state is most of it, and in memory once.
    ByteWriter before, after;
    before.put_text(c.scene);
    before.put(static_cast<std::uint64_t>(c.engine_state.size()));
    after.put(c.step);
    after.put(c.wall_seconds);
    after.put(static_cast<std::uint64_t>(c.bookmarks.size()));
    for (const auto& [name, value] : c.bookmarks) {
        after.put_text(name);
        after.put_text(value);
    }
    const Hash128 hash = hash_pieces({before.bytes(), c.engine_state, after.bytes()});
    ByteWriter header;
    header.put(version);
    header.put(
        static_cast<std::uint64_t>(before.bytes().size() + c.engine_state.size() + after.bytes().size()));
    header.put(hash.high);
    header.put(hash.low);
    write_file_atomically(path, {magic, header.bytes(), before.bytes(), c.engine_state, after.bytes()});
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    return parse_checkpoint(read_file(path), path.string());
}

Checkpoint parse_checkpoint(const std::string& bytes, const std::string& name) {
    const auto damaged = [&](const char* what) {
        fail(Exit::io, "{}: not a usable checkpoint: {}. Take an older one from the same folder.", name,
             what);
    };
    if (bytes.size() < header_size || std::string_view(bytes).substr(0, magic.size()) != magic)
        damaged("it does not start like one");
    ByteReader header(std::string_view(bytes).substr(magic.size(), header_size - magic.size()));
    if (header.get<std::uint32_t>() != version) damaged("it was written by another version");
    const auto size = header.get<std::uint64_t>();
    const auto high = header.get<std::uint64_t>(), low = header.get<std::uint64_t>();
    if (size != bytes.size() - header_size) damaged("it is truncated or has bytes too many");
    const std::string_view content = std::string_view(bytes).substr(header_size);
    if (hash_bytes(content.data(), content.size()) != Hash128{high, low})
        damaged("its checksum does not match");
    Checkpoint checkpoint;
    try {
        checkpoint = read_content(content);
    } catch (const Error&) {
        damaged("its content is inconsistent");
    }
    return checkpoint;
}

} // namespace sandlane::output
