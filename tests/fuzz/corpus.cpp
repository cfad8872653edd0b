// fuzz_corpus TARGET FOLDER: gives every file of the folder to one fuzz target. Crashes and aborts are
// failures.
#include "core/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#define TARGET(name) extern "C" int read_##name(const std::uint8_t* data, std::size_t size);
#include "targets.def"
#undef TARGET

namespace {

struct Target {
    const char* name;
    int (*read)(const std::uint8_t*, std::size_t);
};

constexpr Target targets[] = {
#define TARGET(name) {#name, read_##name},
#include "targets.def"
#undef TARGET
};

} // namespace

int main(int count, char** arguments) {
    if (count != 3) return 2;
    const auto* target = std::find_if(std::begin(targets), std::end(targets),
                                      [&](const Target& t) { return t.name == std::string(arguments[1]); });
    if (target == std::end(targets)) return 2;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[2])) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
        fmt::print("{}\n", file.string());
        std::fflush(stdout); // so that the last name is the one that fails
        const std::string content = sandlane::read_file(file);
        (void)target->read(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
    }
    return files.empty() ? 1 : 0;
}
