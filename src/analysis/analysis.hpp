// Analyses of a run: each takes the frames that are due, one after the other, and gives a table. A kind is
// one file here and one line in scene/analyses.def.
#pragma once

#include "analysis/contacts.hpp"
#include "analysis/snapshot.hpp"
#include "core/bytes.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sandlane::analysis {

// What analyses see of one moment.
struct Frame {
    const Snapshot& grains;
    std::span<const Contact> contacts; // of these grains
};

using Rows = std::vector<std::vector<double>>;

// Values on a rectangular grid, row by row from the lower left corner, to be drawn as a picture.
struct Grid {
    std::string name, label, unit;
    Vec lower, upper; // m
    std::size_t columns = 0, rows = 0;
    std::vector<double> values;
};

class Analysis {
public:
    virtual ~Analysis() = default;

    // true: a row per frame, as a log. false: one table, an average over all frames so far.
    [[nodiscard]] virtual bool series() const = 0;
    [[nodiscard]] virtual std::vector<LogColumn> columns() const = 0;
    virtual void add(const Frame& frame) = 0;
    // A series: rows of the last frame, none where it takes two. An average: the whole table.
    [[nodiscard]] virtual Rows rows() const = 0;
    [[nodiscard]] virtual std::vector<Grid> grids() const { return {}; }

    // What a resumed run must know. load throws Error(io) for bytes of another analysis.
    virtual void save(ByteWriter&) const {}
    virtual void load(ByteReader&) {}
};

// One row per frame; frames do not depend on each other.
class Series : public Analysis {
public:
    [[nodiscard]] bool series() const override { return true; }
    [[nodiscard]] Rows rows() const override { return rows_; }

protected:
    Rows rows_;
};

// Sums over frames.
class Average : public Analysis {
public:
    [[nodiscard]] bool series() const override { return false; }
    void save(ByteWriter& bytes) const override;
    void load(ByteReader& bytes) override;

protected:
    explicit Average(std::size_t sums) : sums_(sums, 0.0) {}
    [[nodiscard]] double per_frame(double sum) const {
        return frames_ > 0 ? sum / static_cast<double>(frames_) : 0.0;
    }

    std::int64_t frames_ = 0;
    std::vector<double> sums_;
};

[[nodiscard]] std::unique_ptr<Analysis> make_analysis(const scene::Scene& scene,
                                                      const scene::AnalysisSpec& spec);

#define ANALYSIS(name, choice)                                                                               \
    [[nodiscard]] std::unique_ptr<Analysis> make_##name(const scene::Scene&, const scene::AnalysisSpec&);
#include "scene/analyses.def"

} // namespace sandlane::analysis
