// The commands of the program. Each returns an exit code or throws Error.
#pragma once

#include "scene/reader.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace sandlane::app {

// Options that several commands share.
struct Common {
    std::filesystem::path scene;
    scene::Overrides overrides;
    int threads = 0; // 0: automatic
    std::string isa = "auto";
    bool quiet = false;
    bool json = false;
};

struct RunOptions {
    std::filesystem::path out;    // empty: results/<scene name>
    std::filesystem::path resume; // checkpoint
    std::int64_t steps = -1;
    std::int64_t check_every = 0;
    double walltime = 0; // s
    bool dry_run = false;
    std::string bench_json;
};

struct CompareOptions {
    std::int64_t steps = 100;
    std::string second = "scalar"; // instruction set of the other side
    double tolerance = 0;          // largest relative difference allowed; 0: bit for bit
};

int run(const Common& common, const RunOptions& options);
int check(const Common& common);
int compare(const Common& common, const CompareOptions& options);
int bench(const Common& common, std::int64_t steps);
int info(const Common& common);
int render(const std::filesystem::path& checkpoint, const std::filesystem::path& png,
           const std::string& colour, int width);
int convert(const std::filesystem::path& from, const std::filesystem::path& to);

} // namespace sandlane::app
