#include "core/file.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace sandlane {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail_io(const char* action, const fs::path& path, int cause) {
    fail(Exit::io, "{}: cannot {}: {}. Choose another place, or free space there.", path.string(), action,
         std::strerror(cause));
}

bool write_pieces(std::FILE* handle, std::initializer_list<std::string_view> pieces) {
    return std::all_of(pieces.begin(), pieces.end(), [&](std::string_view piece) {
        return piece.empty() || std::fwrite(piece.data(), 1, piece.size(), handle) == piece.size();
    });
}

// A device or a pipe: there is nothing to replace.
void write_directly(const fs::path& path, std::initializer_list<std::string_view> pieces) {
    std::FILE* handle = std::fopen(path.c_str(), "wb");
    if (handle == nullptr) fail_io("open", path, errno);
    const bool written = write_pieces(handle, pieces);
    const int cause = errno;
    if (std::fclose(handle) != 0 || !written) fail_io("write", path, written ? errno : cause);
}

} // namespace

std::string read_file(const fs::path& path) {
    std::error_code status;
    if (!fs::exists(path, status)) fail(Exit::invalid_input, "{}: no such file", path.string());
    if (fs::is_directory(path, status))
        fail(Exit::invalid_input, "{}: is a folder, not a file", path.string());
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail(Exit::invalid_input, "{}: cannot be read: {}", path.string(), std::strerror(errno));
    std::ostringstream content;
    content << stream.rdbuf();
    if (stream.bad())
        fail(Exit::invalid_input, "{}: reading failed: {}", path.string(), std::strerror(errno));
    return std::move(content).str();
}

void write_file_atomically(const fs::path& path, std::string_view content) {
    write_file_atomically(path, {content});
}

void write_file_atomically(const fs::path& path, std::initializer_list<std::string_view> pieces) {
    std::error_code ignored, dangling;
    const bool link = fs::is_symlink(path, ignored);
    const fs::path target = link ? fs::canonical(path, dangling) : path;
    if (dangling || fs::is_other(target, ignored)) return write_directly(path, pieces);
    const fs::path temporary = target.string() + ".tmp";
    const auto give_up = [&](const char* action, int cause) {
        fs::remove(temporary, ignored);
        fail_io(action, path, cause);
    };
    std::FILE* handle = std::fopen(temporary.c_str(), "wb");
    if (handle == nullptr) give_up("create the file", errno);
    bool written = write_pieces(handle, pieces);
    written = written && std::fflush(handle) == 0;
    written = written && ::fsync(::fileno(handle)) == 0;
    const int cause = errno;
    written = std::fclose(handle) == 0 && written;
    if (!written) give_up("write", cause);
    if (std::rename(temporary.c_str(), target.c_str()) != 0) give_up("rename the finished file", errno);
}

OutputFile::OutputFile(fs::path path, std::int64_t append_at) : path_(std::move(path)) {
    if (append_at >= 0) {
        std::error_code status;
        const auto size = fs::file_size(path_, status);
        if (status || static_cast<std::int64_t>(size) < append_at)
            fail(Exit::io,
                 "{}: is shorter than the checkpoint says ({} bytes wanted); it cannot be continued",
                 path_.string(), append_at);
        if (::truncate(path_.c_str(), append_at) != 0) fail_io("truncate", path_, errno);
        position_ = append_at;
    }
    handle_ = std::fopen(path_.c_str(), append_at >= 0 ? "ab" : "wb");
    if (handle_ == nullptr) fail_io("open", path_, errno);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), handle_(std::exchange(other.handle_, nullptr)),
      position_(other.position_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(handle_, other.handle_);
    std::swap(position_, other.position_);
    return *this;
}

OutputFile::~OutputFile() {
    close();
}

void OutputFile::close() noexcept {
    if (handle_ != nullptr) std::fclose(handle_);
    handle_ = nullptr;
}

void OutputFile::write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), handle_) != text.size()) fail_io("write", path_, errno);
    position_ += static_cast<std::int64_t>(text.size());
}

void OutputFile::flush() {
    if (std::fflush(handle_) != 0) fail_io("write", path_, errno);
}

} // namespace sandlane
