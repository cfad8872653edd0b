#include "output/checkpoint.hpp"

#include "core/bytes.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"

#include <string_view>

namespace sandlane::output {

namespace {

constexpr std::string_view magic = "SANDLANE";
constexpr std::size_t header_size = magic.size() + sizeof checkpoint_version;
constexpr std::size_t trailer_size = 3 * sizeof(std::uint64_t);

Checkpoint read_content(std::string_view content) {
    ByteReader reader(content);
    Checkpoint c;
    c.scene = reader.get_text();
    c.step = reader.get<std::int64_t>();
    c.wall_seconds = reader.get<double>();
    const auto bookmarks = reader.get<std::uint64_t>();
    for (std::uint64_t n = 0; n < bookmarks; ++n) {
        const std::string key = reader.get_text();
        c.bookmarks[key] = reader.get_text();
    }
    c.engine_state = reader.rest();
    return c;
}

} // namespace

std::string bookmark_in(const Checkpoint* checkpoint, const std::string& name) {
    if (checkpoint == nullptr) return {};
    const auto found = checkpoint->bookmarks.find(name);
    return found == checkpoint->bookmarks.end() ? std::string() : found->second;
}

void write_checkpoint(const std::filesystem::path& path, const Progress& p,
                      const std::function<void(ByteWriter&)>& state) {
    AtomicFile file(path);
    Hasher hasher;
    std::uint64_t size = 0;
    ByteWriter content([&](std::string_view piece) {
        file.write(piece);
        hasher.add(piece);
        size += piece.size();
    });
    ByteWriter header, trailer;
    header.put_bytes(magic);
    header.put(checkpoint_version);
    file.write(header.bytes());
    content.put_text(p.scene);
    content.put(p.step);
    content.put(p.wall_seconds);
    content.put(static_cast<std::uint64_t>(p.bookmarks.size()));
    for (const auto& [name, value] : p.bookmarks) {
        content.put_text(name);
        content.put_text(value);
    }
    state(content);
    content.flush();
    const Hash128 hash = hasher.result();
    trailer.put(size);
    trailer.put(hash.high);
    trailer.put(hash.low);
    file.write(trailer.bytes());
    file.finish();
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    return parse_checkpoint(read_file(path), path.string());
}

Checkpoint parse_checkpoint(const std::string& bytes, const std::string& name) {
    const auto damaged = [&](const char* what) {
        fail(Exit::io, "{}: not a usable checkpoint: {}. Take an older one from the same folder.", name,
             what);
    };
    const std::string_view all = bytes;
    if (all.substr(0, magic.size()) != magic) damaged("it does not start like one");
    if (all.size() < header_size + trailer_size) damaged("it is truncated or has bytes too many");
    ByteReader header(all.substr(magic.size()));
    if (header.get<std::uint32_t>() != checkpoint_version) damaged("it was written by another version");
    const std::string_view content = all.substr(header_size, all.size() - header_size - trailer_size);
    ByteReader trailer(all.substr(all.size() - trailer_size));
    const auto size = trailer.get<std::uint64_t>();
    const auto high = trailer.get<std::uint64_t>(), low = trailer.get<std::uint64_t>();
    if (size != content.size()) damaged("it is truncated or has bytes too many");
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
