// LAMMPS text dump: read by OVITO, VMD, MDAnalysis and ASE. Column names follow LAMMPS where it has one.
#include "output/single_file.hpp"
#include "output/text.hpp"
#include "output/writer_list.hpp"

namespace sandlane::output {

namespace {

using analysis::Snapshot;
using analysis::WallShape;

constexpr std::int64_t first_wall_type = 100;

class DumpWriter final : public SingleFileWriter {
public:
    DumpWriter(const std::filesystem::path& folder, const std::string& bookmark)
        : SingleFileWriter(folder / "trajectory.dump", bookmark) {}

protected:
    void format(const Snapshot& snapshot, std::string& text) override;
};

void append_header(const Snapshot& s, std::size_t atoms, bool images, std::string& text) {
    text += "ITEM: TIME\n";
    append_line(text, s.time);
    text += "ITEM: TIMESTEP\n";
    append_line(text, s.step);
    text += "ITEM: NUMBER OF ATOMS\n";
    append_line(text, static_cast<std::int64_t>(atoms));
    text += "ITEM: BOX BOUNDS ";
    text += s.periodic_x ? "pp " : "ff ";
    text += s.periodic_y ? "pp " : "ff ";
    text += s.periodic_z ? "pp\n" : "ff\n";
    append_line(text, s.lower.x, s.upper.x);
    append_line(text, s.lower.y, s.upper.y);
    const auto [bottom, top] = depth_range(s);
    append_line(text, bottom, top);
    text += "ITEM: ATOMS id type x y z vx vy vz radius mass ";
    text += s.dimension == 2 ? "omegaz angle" : "omegax omegay omegaz";
    if (!s.orientation.empty()) text += " quatw quati quatj quatk";
    text += images ? " pressure ix iy iz\n" : " pressure\n";
}

void append_grain(const Snapshot& s, std::size_t i, std::string& text) {
    const Vec at = s.position(i), v = s.velocity(i);
    append_numbers(text, s.id[i], std::int64_t{s.material[i]} + 1, at.x, at.y, at.z, v.x, v.y, v.z,
                   s.radius[i], s.mass[i]);
    append_spin(s, i, text);
    if (!s.orientation.empty()) {
        const Quaternion& q = s.orientation[i];
        append_numbers(text, q.w, q.x, q.y, q.z);
    }
    append_line(text, s.pressure[i]);
}

// 2D. A wall disc has no mass of its own: it moves as prescribed.
void append_wall_disc(const WallShape& disc, std::int64_t id, std::string& text) {
    const double none = 0;
    append_line(text, id, first_wall_type + disc.wall, disc.centre.x, disc.centre.y, none, disc.velocity.x,
                disc.velocity.y, none, disc.radius, none, disc.omega, disc.angle, none);
}

void append_images(std::int64_t x, std::int64_t y, std::int64_t z, std::string& text) {
    text.back() = ' ';
    append_line(text, x, y, z);
}

void DumpWriter::format(const Snapshot& s, std::string& text) {
    const bool images = s.periodic_x || s.periodic_y || s.periodic_z;
    std::size_t discs = 0;
    for (const WallShape& wall : s.walls) discs += wall.kind == WallShape::Kind::disc ? 1 : 0;
    append_header(s, s.size() + discs, images, text);
    for (std::size_t i = 0; i < s.size(); ++i) {
        append_grain(s, i, text);
        if (images) append_images(s.image_x[i], s.image_y[i], s.dimension == 3 ? s.image_z[i] : 0, text);
        pass_on(text);
    }
    std::int64_t id = first_wall_id;
    for (const WallShape& wall : s.walls) {
        if (wall.kind != WallShape::Kind::disc) continue;
        append_wall_disc(wall, id++, text);
        if (images) append_images(0, 0, 0, text);
    }
}

} // namespace

std::unique_ptr<TrajectoryWriter> make_dump(const std::filesystem::path& folder, const scene::Scene&,
                                            const std::string& bookmark) {
    return std::make_unique<DumpWriter>(folder, bookmark);
}

} // namespace sandlane::output
