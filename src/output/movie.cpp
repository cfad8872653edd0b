// movie.mp4 by the program ffmpeg, started without a shell.
#include "output/picture.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sandlane::output {

namespace fs = std::filesystem;

namespace {

std::size_t count_pictures(const fs::path& folder) {
    std::error_code status;
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder / "pictures", status))
        count += entry.path().extension() == ".png" ? 1 : 0;
    return count;
}

// The folder as a part of ffmpeg's pattern of names, where % is written twice.
std::string escaped(const fs::path& folder) {
    std::string out;
    for (const char c : folder.string()) out += c == '%' ? std::string("%%") : std::string(1, c);
    return out;
}

std::vector<std::string> arguments(const fs::path& folder) {
    // About ten seconds, neither jerky nor a blur.
    const std::size_t rate = std::clamp<std::size_t>(count_pictures(folder) / 10, 5, 30);
    return {"ffmpeg",
            "-y",
            "-loglevel",
            "error",
            "-framerate",
            std::to_string(rate),
            "-i",
            escaped(folder / "pictures") + "/%06d.png",
            "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-pix_fmt",
            "yuv420p",
            "-movflags",
            "+faststart",
            (folder / "movie.mp4").string()};
}

std::string quoted(const std::string& word) {
    const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./%+:=";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string out(1, '\'');
    for (const char c : word) {
        if (c == '\'') out += "'\\'";
        out += c;
    }
    out += '\'';
    return out;
}

bool run_silently(const std::vector<std::string>& words) {
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const bool started = ::posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ) == 0;
    ::posix_spawn_file_actions_destroy(&files);
    int status = 0;
    return started && ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

std::string write_movie(const fs::path& folder) {
    const std::vector<std::string> words = arguments(folder);
    if (count_pictures(folder) > 0) {
        if (run_silently(words)) return {};
        std::error_code status;
        fs::remove(folder / "movie.mp4", status); // half of one
    }
    std::string command;
    for (const std::string& word : words) {
        if (!command.empty()) command += ' ';
        command += quoted(word);
    }
    return command;
}

} // namespace sandlane::output
