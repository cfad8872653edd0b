#include "core/file.hpp"

#include "core/error.hpp"

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

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    std::error_code ignored, dangling;
    target_ = fs::is_symlink(path_, ignored) ? fs::canonical(path_, dangling) : path_;
    // A device or a pipe: there is nothing to replace.
    const bool direct = dangling || fs::is_other(target_, ignored);
    if (direct) target_ = path_;
    written_ = direct ? target_ : fs::path(target_.string() + ".tmp");
    handle_ = std::fopen(written_.c_str(), "wb");
    if (handle_ == nullptr) give_up("create the file", errno);
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::write(std::string_view piece) {
    if (!piece.empty() && std::fwrite(piece.data(), 1, piece.size(), handle_) != piece.size())
        give_up("write", errno);
}

void AtomicFile::finish() {
    const bool direct = written_ == target_;
    if (std::fflush(handle_) != 0 || (!direct && ::fsync(::fileno(handle_)) != 0)) give_up("write", errno);
    if (std::fclose(std::exchange(handle_, nullptr)) != 0) give_up("write", errno);
    if (!direct && std::rename(written_.c_str(), target_.c_str()) != 0)
        give_up("rename the finished file", errno);
    finished_ = true;
}

void AtomicFile::give_up(const char* action, int cause) {
    discard();
    fail_io(action, path_, cause);
}

void AtomicFile::discard() noexcept {
    if (handle_ != nullptr) std::fclose(std::exchange(handle_, nullptr));
    std::error_code ignored;
    if (!finished_ && written_ != target_) fs::remove(written_, ignored);
}

void write_file_atomically(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content);
    file.finish();
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
