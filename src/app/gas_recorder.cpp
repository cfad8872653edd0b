#include "app/gas_recorder.hpp"

#include "core/file.hpp"
#include "output/curves.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::app {

namespace {

// Pictures and trajectories are for those who ask: a gas has many particles.
Timer asked(double every, const GasEngine& engine, Spacing spacing = Spacing::paced) {
    return every > 0 ? Timer(every, 0, engine, spacing) : Timer();
}

} // namespace

GasRecorder::GasRecorder(const std::filesystem::path& folder, const GasEngine& engine,
                         const output::Checkpoint* resume)
    : engine_(engine), folder_(folder),
      // Averages over time need frames at equal distances.
      sample_timer_(engine.sampling().every, 200, engine, Spacing::even),
      structure_timer_(asked(engine.sampling().structure_every, engine, Spacing::even)),
      picture_timer_(asked(engine.scene().output.picture_every, engine)),
      trajectory_timer_(asked(engine.scene().output.trajectory_every, engine)),
      samples_(engine.make_samples()), structure_(engine.make_structure()),
      pictures_(folder / "pictures", engine.scene(), output::bookmark_in(resume, "pictures")) {
    if (trajectory_timer_.is_on())
        for (const scene::Trajectory kind : engine.scene().output.trajectory) {
            const std::string name(scene::trajectory_choices()[static_cast<std::size_t>(kind)]);
            trajectories_[name] = output::make_trajectory_writer(kind, folder, engine.scene(),
                                                                 output::bookmark_in(resume, name));
        }
    if (const std::string bookmark = output::bookmark_in(resume, "samples"); !bookmark.empty())
        samples_.restore(bookmark);
    if (const std::string bookmark = output::bookmark_in(resume, "structure"); !bookmark.empty())
        structure_.restore(bookmark);
}

std::int64_t GasRecorder::next_due(std::int64_t step) const {
    return std::min({sample_timer_.next_step(step), structure_timer_.next_step(step),
                     picture_timer_.next_step(step), trajectory_timer_.next_step(step)});
}

double GasRecorder::next_time() const {
    return std::min({sample_timer_.next_time(), structure_timer_.next_time(), picture_timer_.next_time(),
                     trajectory_timer_.next_time()});
}

void GasRecorder::write_due(bool all) {
    if (sample_timer_.is_due(engine_, false) && engine_.time() > 0 &&
        engine_.time() >= engine_.sampling().start)
        engine_.sample(samples_);
    if (structure_timer_.is_due(engine_, all))
        structure_.add(engine_.time(), engine_.structure_particles(), engine_.vessel(),
                       engine_.time() > 0 && engine_.time() >= engine_.sampling().start);
    const bool picture = picture_timer_.is_due(engine_, all),
               trajectory = trajectory_timer_.is_due(engine_, all);
    if (!(picture || trajectory)) return;
    const analysis::Snapshot snapshot = engine_.snapshot();
    if (picture) pictures_.write(snapshot);
    if (trajectory)
        for (auto& [name, writer] : trajectories_) writer->write(snapshot);
}

void GasRecorder::add_bookmarks(std::map<std::string, std::string>& bookmarks) {
    bookmarks["pictures"] = pictures_.bookmark();
    for (auto& [name, writer] : trajectories_) bookmarks[name] = writer->bookmark();
    bookmarks["samples"] = samples_.serialise();
    bookmarks["structure"] = structure_.serialise();
    write_tables();
}

void GasRecorder::write_tables() const {
    if (!structure_.rows().empty()) {
        write_file_atomically(folder_ / "clusters.csv", structure_.clusters_csv());
        write_file_atomically(folder_ / "structure.csv", structure_.structure_csv());
        write_file_atomically(folder_ / "cluster_sizes.csv", structure_.sizes_csv());
    }
    if (samples_.frames() == 0) return;
    write_file_atomically(folder_ / "profile.csv", samples_.profile());
    write_file_atomically(folder_ / "distribution.csv", samples_.distribution());
}

namespace {

void add_figure(output::ReportInput& report, const std::string& caption, const output::CurvePlot& plot) {
    if (const std::string svg = output::svg_of(plot); !svg.empty())
        report.figures.push_back({caption, {}, svg});
}

void add_structure(output::ReportInput& report, const analysis::GasStructure& structure) {
    output::Curve density{"density", {}, {}}, shear{"transverse momentum", {}, {}};
    for (const auto& shell : structure.shells()) {
        for (output::Curve* c : {&density, &shear}) c->x.push_back(shell.k);
        density.y.push_back(shell.density);
        shear.y.push_back(shell.shear);
    }
    add_figure(report,
               "Structure factor S(k) of the last frame, and the spectrum of transverse momentum over that "
               "of equilibrium",
               {"k [1/m]", "spectrum", true, true, {density, shear}});
    output::Curve sizes{"clusters", {}, {}, true};
    for (std::size_t n = 0; n < structure.sizes().size(); ++n) {
        sizes.x.push_back(1.5 * std::exp2(n));
        sizes.y.push_back(structure.sizes()[n]);
    }
    add_figure(report, "Number of clusters of the last frame, by powers of two of their sizes",
               {"particles", "clusters", true, true, {sizes}});
    output::Curve largest{"particles in the largest cluster", {}, {}};
    output::Curve longest{"S(k) of the longest waves", {}, {}}, fluctuation{"variance of numbers", {}, {}};
    for (const analysis::StructureRow& row : structure.rows()) {
        for (output::Curve* c : {&largest, &longest, &fluctuation}) c->x.push_back(row.time);
        largest.y.push_back(row.largest);
        longest.y.push_back(row.density);
        fluctuation.y.push_back(row.fluctuation);
    }
    add_figure(report, "Fraction of the particles in the largest cluster",
               {"time [s]", "fraction", false, false, {largest}});
    add_figure(report,
               "Structure factor of the longest waves, and the variance of the number of particles in a "
               "cell over that of chance",
               {"time [s]", "over a uniform gas", false, true, {longest, fluctuation}});
}

} // namespace

void GasRecorder::add_to_report(output::ReportInput& report) const {
    if (!structure_.rows().empty()) add_structure(report, structure_);
    if (samples_.frames() == 0) return;
    const auto profile = samples_.profile_rows();
    output::Curve density{"density", {}, {}}, temperature{"temperature", {}, {}};
    for (const auto& row : profile) {
        density.x.push_back(row.place);
        temperature.x.push_back(row.place);
        density.y.push_back(row.density);
        temperature.y.push_back(row.temperature);
    }
    const std::string axis(1, samples_.axis_name());
    add_figure(report, "Mean density along " + axis, {axis + " [m]", "density", false, false, {density}});
    add_figure(report, "Mean temperature along " + axis,
               {axis + " [m]", "temperature [J]", false, false, {temperature}});
    output::Curve found{"measured", {}, {}, true}, maxwell{"Maxwell", {}, {}};
    for (const auto& row : samples_.speed_rows()) {
        found.x.push_back(row.c);
        found.y.push_back(row.density);
        maxwell.x.push_back(row.c);
        maxwell.y.push_back(row.maxwell > 1e-10 ? row.maxwell : 0);
    }
    add_figure(report, "Distribution of speeds, in units of the square root of 2T/m",
               {"c", "probability density", false, true, {found, maxwell}});
}

} // namespace sandlane::app
