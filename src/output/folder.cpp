#include "output/folder.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace sandlane::output {

namespace fs = std::filesystem;

namespace {

constexpr const char* way_out = "Choose another folder with --out or remove it; --resume FILE continues it.";

// Returns the topmost folder that had to be created; empty if all were there.
fs::path make_folder(const fs::path& path) {
    fs::path made;
    std::error_code status;
    for (fs::path p = path; !p.empty() && !fs::exists(p, status); p = p.parent_path()) made = p;
    fs::create_directories(path, status);
    if (!status && !fs::is_directory(path, status) && !status)
        status = std::make_error_code(std::errc::not_a_directory);
    if (status)
        fail(Exit::io, "{}: cannot create the folder: {}. Choose another one with --out.", path.string(),
             status.message());
    return made;
}

// What stands in the file: "process N on HOST", and the origin.
struct Mark {
    std::string owner = "another process", origin;
};

Mark read_mark(int file) {
    std::array<char, 400> bytes{};
    const ssize_t length = ::pread(file, bytes.data(), bytes.size(), 0);
    const std::string text(bytes.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
    const std::size_t end = std::min(text.find('\n'), text.size());
    Mark mark;
    if (end > 0) mark.owner = text.substr(0, end);
    if (end < text.size()) mark.origin = text.substr(end + 1, text.find('\n', end + 1) - end - 1);
    return mark;
}

std::string this_process() {
    std::array<char, 100> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return fmt::format("process {} on {}\n", ::getpid(), host[0] == '\0' ? "this machine" : host.data());
}

} // namespace

RunFolder::RunFolder(fs::path path, Start start, std::string origin)
    : path_(std::move(path)), origin_(std::move(origin)) {
    if (!path_.has_filename()) path_ = path_.parent_path(); // "results/"
    made_ = make_folder(path_);
    try {
        lock(start);
    } catch (...) {
        if (lock_ >= 0) ::close(lock_);
        remove_empty();
        throw;
    }
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), made_(std::exchange(other.made_, {})), origin_(std::move(other.origin_)),
      lock_(std::exchange(other.lock_, -1)) {}

RunFolder& RunFolder::operator=(RunFolder&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(made_, other.made_);
    std::swap(origin_, other.origin_);
    std::swap(lock_, other.lock_);
    return *this;
}

// From the folder upwards to the topmost that was made here, as far as they are empty.
void RunFolder::remove_empty() const noexcept {
    std::error_code status;
    for (fs::path p = path_; !made_.empty() && !status; p = p.parent_path()) {
        fs::remove(p, status);
        if (p == made_) return;
    }
}

// The lock is ours, and so is all that lies beside it in a folder that we made.
void RunFolder::discard() noexcept {
    std::error_code ignored;
    if (made_.empty())
        fs::remove(path_ / ".lock", ignored);
    else
        fs::remove_all(path_, ignored);
    remove_empty();
}

RunFolder::~RunFolder() {
    if (lock_ >= 0) ::close(lock_); // releases the flock; the file stays and marks the folder as used
}

// Creation with O_EXCL decides between two runs that start at the same time.
void RunFolder::lock(Start start) {
    const fs::path file = path_ / ".lock";
    lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    const bool created = lock_ >= 0;
    if (!created && errno == EEXIST) lock_ = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    if (lock_ < 0) fail(Exit::io, "{}: cannot create the file: {}", file.string(), std::strerror(errno));
    const Mark mark = created ? Mark{} : read_mark(lock_);
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK)
            fail(Exit::invalid_input, "{}: {} is writing a run here. {}", path_.string(), mark.owner,
                 way_out);
        fail(Exit::io, "{}: cannot lock the file: {}", file.string(), std::strerror(errno));
    }
    if (!created && start == Start::fresh)
        fail(Exit::invalid_input, "{}: already holds a run, by {}. {}", path_.string(), mark.owner, way_out);
    if (origin_.empty()) origin_ = mark.origin;
    if (!mark.origin.empty() && mark.origin != origin_)
        fail(
            Exit::io,
            "{}: holds a run of another scene than the checkpoint does. Choose another folder with --out, or "
            "take a checkpoint of this run.",
            path_.string());
    const std::string text = this_process() + origin_ + "\n";
    if (::ftruncate(lock_, 0) == 0 && ::pwrite(lock_, text.data(), text.size(), 0) >= 0) return;
    const int cause = errno;
    if (created) ::unlink(file.c_str());
    fail(Exit::io, "{}: cannot write: {}", file.string(), std::strerror(cause));
}

fs::path RunFolder::checkpoints() const {
    make_folder(path_ / "checkpoints");
    return path_ / "checkpoints";
}

} // namespace sandlane::output
