// Files: whole-file reads and atomic writes with errors that name the path and the cause.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sandlane {

// Throws Error(invalid_input) naming the path if it is missing, a folder or unreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

// Writes to a temporary file beside `path`, flushes it to the disk and renames it: a reader sees the old or
// the new content, never half of it. A link keeps pointing where it does; a device or a pipe is written as it
// is. Throws Error(io); the temporary file is removed.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);
// Of pieces that need not be put together in memory.
void write_file_atomically(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

// A file that grows during a run (log, trajectory). Every error is an Error(io) naming the path.
class OutputFile {
public:
    OutputFile() = default;
    // append_at < 0: create or truncate. Otherwise keep the first append_at bytes (resume) and go on after
    // them.
    explicit OutputFile(std::filesystem::path path, std::int64_t append_at = -1);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    ~OutputFile();

    void write(std::string_view text);
    void flush();
    [[nodiscard]] std::int64_t position() const noexcept { return position_; }
    [[nodiscard]] bool is_open() const noexcept { return handle_ != nullptr; }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    void close() noexcept;

    std::filesystem::path path_;
    std::FILE* handle_ = nullptr;
    std::int64_t position_ = 0;
};

} // namespace sandlane
