// Extended XYZ: one comment line of key=value pairs per frame, read by OVITO and ASE.
#include "output/single_file.hpp"
#include "output/text.hpp"
#include "output/writer_list.hpp"

#include <array>

namespace sandlane::output {

namespace {

using analysis::Snapshot;
using analysis::WallShape;

// ASE accepts chemical symbols only, so a material is written as the element with its number; the comment
// line gives the names in this order. X (no element) marks the discs of walls.
constexpr std::array<const char*, 36> elements{
    "H", "He", "Li", "Be", "B", "C",  "N",  "O",  "F",  "Ne", "Na", "Mg", "Al", "Si", "P",  "S",  "Cl", "Ar",
    "K", "Ca", "Sc", "Ti", "V", "Cr", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Ga", "Ge", "As", "Se", "Br", "Kr"};

class XyzWriter final : public SingleFileWriter {
public:
    XyzWriter(const std::filesystem::path& folder, const scene::Scene& scene, const std::string& bookmark)
        : SingleFileWriter(folder / "trajectory.xyz", bookmark) {
        for (const scene::Material& material : scene.materials) {
            if (!materials_.empty()) materials_ += ',';
            for (const char c : material.name) materials_ += c == '"' || c == '\\' || c < ' ' ? '_' : c;
        }
    }

protected:
    void format(const Snapshot& snapshot, std::string& text) override;

private:
    void append_comment(const Snapshot& s, std::string& text) const;

    std::string materials_; // names, separated by commas
};

void XyzWriter::append_comment(const Snapshot& s, std::string& text) const {
    const double none = 0;
    const auto [bottom, top] = depth_range(s);
    text += "Lattice=\"";
    append_line(text, s.upper.x - s.lower.x, none, none, none, s.upper.y - s.lower.y, none, none, none,
                top - bottom);
    text.back() = '"';
    text += " Origin=\"";
    append_line(text, s.lower.x, s.lower.y, bottom);
    text.back() = '"';
    text += " Properties=species:S:1:pos:R:3:velo:R:3:id:I:1:material:I:1:radius:R:1:mass:R:1:";
    text += s.dimension == 2 ? "omega:R:1:angle:R:1:" : "omega:R:3:";
    if (!s.orientation.empty()) text += "orientation:R:4:"; // x y z w, as OVITO reads it
    text += "pressure:R:1 Time=";
    append(text, s.time);
    text += " Step=";
    append(text, s.step);
    text += " pbc=\"";
    text += s.periodic_x ? "T " : "F ";
    text += s.periodic_y ? "T " : "F ";
    text += s.periodic_z ? "T\"" : "F\"";
    text += " materials=\"" + materials_ + "\"\n";
}

void append_grain(const Snapshot& s, std::size_t i, std::string& text) {
    const Vec at = s.position(i), v = s.velocity(i);
    text += elements[static_cast<std::size_t>(s.material[i]) % elements.size()];
    text += ' ';
    append_numbers(text, at.x, at.y, at.z, v.x, v.y, v.z, s.id[i], std::int64_t{s.material[i]}, s.radius[i],
                   s.mass[i]);
    append_spin(s, i, text);
    if (!s.orientation.empty()) {
        const Quaternion& q = s.orientation[i];
        append_numbers(text, q.x, q.y, q.z, q.w);
    }
    append_line(text, s.pressure[i]);
}

void XyzWriter::format(const Snapshot& s, std::string& text) {
    const double none = 0;
    std::int64_t discs = 0;
    for (const WallShape& wall : s.walls) discs += wall.kind == WallShape::Kind::disc ? 1 : 0;
    append_line(text, static_cast<std::int64_t>(s.size()) + discs);
    append_comment(s, text);
    for (std::size_t i = 0; i < s.size(); ++i) {
        append_grain(s, i, text);
        pass_on(text);
    }
    std::int64_t id = first_wall_id;
    for (const WallShape& wall : s.walls) {
        if (wall.kind != WallShape::Kind::disc) continue;
        text += "X ";
        append_line(text, wall.centre.x, wall.centre.y, none, wall.velocity.x, wall.velocity.y, none, id++,
                    std::int64_t{wall.material}, wall.radius, none, wall.omega, wall.angle, none);
    }
}

} // namespace

std::unique_ptr<TrajectoryWriter> make_xyz(const std::filesystem::path& folder, const scene::Scene& scene,
                                           const std::string& bookmark) {
    return std::make_unique<XyzWriter>(folder, scene, bookmark);
}

} // namespace sandlane::output
