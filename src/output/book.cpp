// The book program's snapshot frames: 25 columns per grain. A snapshot holds no forces and
// no higher derivatives, so columns 14 to 25 are 0. Straight walls and arcs have no place in this format.
#include "output/single_file.hpp"
#include "output/writer_list.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numbers>

namespace sandlane::output {

namespace {

using analysis::Snapshot;
using analysis::WallShape;

struct Record {
    double x, y, angle, vx, vy, omega, radius, mass;
    int type; // 0: free grain, 1: wall grain
    scene::Material material;
};

void append_record(const Record& r, std::string& text) {
    const scene::Material& m = r.material;
    const double reduced_modulus = 4 * m.young / (3 * (1 - m.poisson * m.poisson));
    fmt::format_to(
        std::back_inserter(text),
        "{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {} {:.17g} {:.17g} {:.17g} {:.17g}"
        " 0 0 0 0 0 0 0 0 0 0 0 0\n",
        r.x, r.y, r.angle, r.vx, r.vy, r.omega, r.radius, r.mass, r.type, reduced_modulus, m.dissipation,
        m.friction, m.tangential_damping);
}

class BookWriter final : public SingleFileWriter {
public:
    BookWriter(const std::filesystem::path& folder, const scene::Scene& scene, const std::string& bookmark)
        : SingleFileWriter(folder / "trajectory.book", bookmark), materials_(scene.materials),
          gravity_(scene.domain.gravity), dt_(scene.md.dt), body_(scene.md.body) {}

protected:
    void format(const Snapshot& snapshot, std::string& text) override;

private:
    [[nodiscard]] scene::Material material(int index) const;
    [[nodiscard]] Record wall_record(const WallShape& disc) const;

    std::vector<scene::Material> materials_;
    Vec gravity_;
    double dt_;
    scene::Body body_;
};

scene::Material BookWriter::material(int index) const {
    const auto at = static_cast<std::size_t>(index);
    return at < materials_.size() ? materials_[at] : scene::Material{};
}

// Readers of the format want a positive mass also for wall grains, whose motion does not depend on it.
Record BookWriter::wall_record(const WallShape& disc) const {
    const double r = disc.radius;
    const double volume =
        body_ == scene::Body::sphere ? 4.0 / 3 * std::numbers::pi * r * r * r : std::numbers::pi * r * r;
    const scene::Material m = material(disc.material);
    return {disc.centre.x,
            disc.centre.y,
            disc.angle,
            disc.velocity.x,
            disc.velocity.y,
            disc.omega,
            r,
            volume * m.density,
            1,
            m};
}

void BookWriter::format(const Snapshot& s, std::string& text) {
    std::size_t records = s.size();
    for (const WallShape& wall : s.walls) records += wall.kind == WallShape::Kind::disc ? 1 : 0;
    fmt::format_to(std::back_inserter(text),
                   "#NewFrame\n#no_of_particles: {}\n#compressed: no\n#type: SphereXYPhiVxVyOmegaRMFixed25\n"
                   "#gravity: {:.17g} {:.17g} 0\n#Time: {:.17g}\n#timestep: {:.17g}\n#EndOfHeader\n",
                   records, gravity_.x, gravity_.y, s.time, dt_);
    for (std::size_t i = 0; i < s.size(); ++i) {
        append_record({s.x[i], s.y[i], s.angle[i], s.vx[i], s.vy[i], s.omega[i], s.radius[i], s.mass[i], 0,
                       material(s.material[i])},
                      text);
        pass_on(text);
    }
    for (const WallShape& wall : s.walls)
        if (wall.kind == WallShape::Kind::disc) append_record(wall_record(wall), text);
}

} // namespace

std::unique_ptr<TrajectoryWriter> make_book(const std::filesystem::path& folder, const scene::Scene& scene,
                                            const std::string& bookmark) {
    return std::make_unique<BookWriter>(folder, scene, bookmark);
}

} // namespace sandlane::output
