// Files that a resumed run and its report read back, and averages that a checkpoint keeps. The first byte
// chooses the reader, the rest is the file.
#include "analysis/gas_samples.hpp"
#include "analysis/gas_structure.hpp"
#include "core/error.hpp"
#include "output/log.hpp"
#include "output/replay.hpp"

#include <cstdlib>

using namespace sandlane;

namespace {

void read_log(const std::string& text) {
    const analysis::Log log = output::parse_log(text, "fuzz.csv");
    for (const auto& row : log.rows)
        if (row.size() != log.columns.size()) std::abort();
    const std::string written = output::log_text(log);
    if (output::log_text(output::parse_log(written, "written.csv")) != written) std::abort();
}

void read_replay(const std::string& bytes) {
    const std::vector<output::ReplayFrame> frames = output::parse_replay(bytes, "fuzz.bin");
    if (frames.size() < 100) (void)output::pack_replay(frames, std::size_t{1} << 20);
}

void read_averages(const std::string& bytes) {
    analysis::GasSamples samples(analysis::GasFrame{}, 1, 3);
    samples.restore(bytes);
    (void)samples.profile();
    (void)samples.distribution();
}

void read_structure(const std::string& bytes) {
    analysis::StructurePlan plan;
    plan.periodic[0] = plan.periodic[1] = plan.periodic[2] = true;
    analysis::GasStructure structure(plan);
    structure.restore(bytes);
    (void)structure.clusters_csv();
    (void)structure.structure_csv();
    (void)structure.sizes_csv();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr void (*readers[])(const std::string&) = {read_log, read_replay, read_averages, read_structure};
    if (size == 0) return 0;
    try {
        readers[data[0] % std::size(readers)](std::string(reinterpret_cast<const char*>(data + 1), size - 1));
    } catch (const Error&) {
    }
    return 0;
}
