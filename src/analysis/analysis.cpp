#include "analysis/analysis.hpp"

namespace sandlane::analysis {

void Average::save(ByteWriter& bytes) const {
    bytes.put(frames_);
    bytes.put_array(sums_.data(), sums_.size());
}

void Average::load(ByteReader& bytes) {
    frames_ = bytes.get<std::int64_t>();
    const std::size_t expected = sums_.size();
    bytes.get_array(sums_);
    if (frames_ < 0 || sums_.size() != expected)
        fail(Exit::io, "the checkpoint holds the sums of another analysis");
}

std::unique_ptr<Analysis> make_analysis(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    switch (spec.kind) {
#define ANALYSIS(name, choice)                                                                               \
    case scene::AnalysisKind::name:                                                                          \
        return make_##name(scene, spec);
#include "scene/analyses.def"
    }
    fail(Exit::internal, "analysis {}: its kind is not registered", spec.name);
}

} // namespace sandlane::analysis
