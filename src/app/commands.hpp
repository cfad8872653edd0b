// The commands of the program. Each returns an exit code or throws Error.
#pragma once

#include "scene/reader.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

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

// Of a picture; empty or 0: what the scene says.
struct Look {
    std::string colour;
    int width = 0;            // pixels
    std::vector<double> view; // 3D: direction to the viewer
};

struct RenderOptions {
    std::filesystem::path from; // checkpoint or scene
    std::filesystem::path png;
    Look look;
};

struct ConvertOptions {
    std::filesystem::path from, to;
    std::int64_t frame = -1; // of a file of snapshots; -1: the last
    bool snapshot = false;   // write a snapshot frame instead of an init file
};

int run(const Common& common, const RunOptions& options);
int check(const Common& common);
int compare(const Common& common, const CompareOptions& options);
int bench(const Common& common, std::int64_t steps);
int info(const Common& common);
int render(const RenderOptions& options);
int convert(const ConvertOptions& options);

} // namespace sandlane::app
