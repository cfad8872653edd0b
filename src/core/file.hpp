// Files: whole-file reads and atomic writes with errors that name the path and the cause.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace sandlane {

// Throws Error(invalid_input) naming the path if it is missing, a folder or unreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

// A file that others see only when it is finished: a temporary file beside `path`, flushed to the disk and
// renamed, so that a reader finds the old or the new content, never half of it. A link keeps pointing where
// it does; a device or a pipe is written as it is. Throws Error(io); what was not finished is removed.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view piece);
    void finish();

private:
    [[noreturn]] void give_up(const char* action, int cause);
    void discard() noexcept;

    std::filesystem::path path_, target_, written_; // as named, behind links, and where the bytes go
    std::FILE* handle_ = nullptr;
    bool finished_ = false;
};

void write_file_atomically(const std::filesystem::path& path, std::string_view content);

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
