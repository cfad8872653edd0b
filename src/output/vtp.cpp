// ParaView: one VTK XML PolyData file per frame with raw appended float32 data, and trajectory.pvd with the
// times.
#include "core/error.hpp"
#include "core/file.hpp"
#include "output/text.hpp"
#include "output/writer_list.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>

namespace sandlane::output {

namespace fs = std::filesystem;

namespace {

using analysis::Snapshot;
using analysis::WallShape;

static_assert(std::endian::native == std::endian::little,
              "the appended data is written as it lies in memory");

// The data behind the XML: every block is its length in bytes (UInt64) and its values.
class Blocks {
public:
    template <class T>
    std::string declare(std::string_view type, std::string_view name, int components,
                        const std::vector<T>& values) {
        std::string tag = fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                                      "format=\"appended\" offset=\"{}\"/>\n",
                                      type, name, components, bytes_.size());
        const std::uint64_t length = values.size() * sizeof(T);
        bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
        bytes_.append(reinterpret_cast<const char*>(values.data()), length);
        return tag;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

std::vector<float> single(const std::vector<double>& values) {
    std::vector<float> out;
    out.reserve(values.size());
    for (const double value : values) out.push_back(static_cast<float>(value));
    return out;
}

// of(i): the vector of grain i.
template <class Of> std::vector<float> triples(std::size_t count, const Of& of) {
    std::vector<float> out;
    out.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec v = of(i);
        out.insert(out.end(), {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    }
    return out;
}

// w x y z, the order of VTK.
std::vector<float> quadruples(const std::vector<Quaternion>& quaternions) {
    std::vector<float> out;
    out.reserve(4 * quaternions.size());
    for (const Quaternion& q : quaternions)
        out.insert(out.end(), {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                               static_cast<float>(q.z)});
    return out;
}

std::string document(const Snapshot& s, std::string_view piece, const Blocks& blocks) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n"
        "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";
    append(text, s.time);
    text += "</DataArray>\n</FieldData>\n";
    text += piece;
    text += "</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    text += blocks.bytes();
    text += "\n</AppendedData>\n</VTKFile>\n";
    return text;
}

std::string grains_document(const Snapshot& s) {
    Blocks blocks;
    std::vector<std::int64_t> connectivity, offsets;
    for (std::size_t i = 0; i < s.size(); ++i) {
        connectivity.push_back(static_cast<std::int64_t>(i));
        offsets.push_back(static_cast<std::int64_t>(i) + 1);
    }
    std::string piece =
        fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"radius\">\n",
                    s.size());
    piece += blocks.declare("Float32", "radius", 1, single(s.radius));
    const auto vectors = [&](const char* name, Vec (Snapshot::*of)(std::size_t) const) {
        piece +=
            blocks.declare("Float32", name, 3, triples(s.size(), [&](std::size_t i) { return (s.*of)(i); }));
    };
    vectors("velocity", &Snapshot::velocity);
    if (s.dimension == 3) {
        vectors("omega", &Snapshot::angular_velocity);
    } else {
        piece += blocks.declare("Float32", "omega", 1, single(s.omega));
        piece += blocks.declare("Float32", "angle", 1, single(s.angle));
    }
    if (!s.orientation.empty())
        piece += blocks.declare("Float32", "orientation", 4, quadruples(s.orientation));
    piece += blocks.declare("Float32", "mass", 1, single(s.mass));
    piece += blocks.declare("Float32", "pressure", 1, single(s.pressure));
    piece += blocks.declare("Int64", "id", 1, s.id);
    piece += blocks.declare("Int32", "material", 1, s.material);
    piece += "</PointData>\n<Points>\n";
    vectors("Points", &Snapshot::position);
    piece += "</Points>\n<Verts>\n" + blocks.declare("Int64", "connectivity", 1, connectivity);
    piece += blocks.declare("Int64", "offsets", 1, offsets) + "</Verts>\n</Piece>\n";
    return document(s, piece, blocks);
}

// Walls as cells. 2D: poly-lines; a segment has two points, arcs and discs one point every four degrees.
// 3D: triangles.
struct Cells {
    std::vector<float> points;
    std::vector<std::int64_t> connectivity, offsets;
    std::vector<std::int32_t> wall, material;

    void add_point(Vec p) {
        connectivity.push_back(static_cast<std::int64_t>(points.size() / 3));
        points.insert(points.end(),
                      {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    void add_arc(Vec centre, double radius, double from, double to) {
        const int steps =
            std::max(2, static_cast<int>(std::ceil(std::abs(to - from) * 45 / std::numbers::pi)));
        for (int k = 0; k <= steps; ++k) {
            const double angle = from + (to - from) * k / steps;
            add_point({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle), 0});
        }
    }
    void add(const WallShape& shape) {
        switch (shape.kind) {
        case WallShape::Kind::segment:
            for (const Vec p : {shape.a, shape.b}) add_point(p);
            break;
        case WallShape::Kind::arc:
            add_arc(shape.centre, shape.radius, shape.angle_from, shape.angle_to);
            break;
        case WallShape::Kind::disc:
            add_arc(shape.centre, shape.radius, shape.angle, shape.angle + 2 * std::numbers::pi);
            break;
        case WallShape::Kind::triangle:
            for (const Vec p : {shape.a, shape.b, shape.c}) add_point(p);
            break;
        }
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        wall.push_back(shape.wall);
        material.push_back(shape.material);
    }
};

std::string walls_document(const Snapshot& s) {
    Cells cells;
    for (const WallShape& shape : s.walls) cells.add(shape);
    Blocks blocks;
    const char* kind = s.dimension == 3 ? "Polys" : "Lines";
    const std::size_t count = cells.wall.size();
    std::string piece =
        fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<CellData Scalars=\"wall\">\n",
                    cells.points.size() / 3, s.dimension == 3 ? 0 : count, s.dimension == 3 ? count : 0);
    piece += blocks.declare("Int32", "wall", 1, cells.wall);
    piece += blocks.declare("Int32", "material", 1, cells.material);
    piece += "</CellData>\n<Points>\n" + blocks.declare("Float32", "Points", 3, cells.points);
    piece += fmt::format("</Points>\n<{}>\n{}", kind,
                         blocks.declare("Int64", "connectivity", 1, cells.connectivity));
    piece += fmt::format("{}</{}>\n</Piece>\n", blocks.declare("Int64", "offsets", 1, cells.offsets), kind);
    return document(s, piece, blocks);
}

// Frames are numbered from 0. Walls at rest are written with frame 0 only, and every later time points there.
// The index is a small XML document that grows with the run: written with every frame it would cost the
// square of their number. It is written when it has grown by an eighth, with every checkpoint, and at the
// end.
class VtpWriter final : public TrajectoryWriter {
public:
    VtpWriter(fs::path folder, const scene::Scene& scene, const std::string& bookmark);
    VtpWriter(const VtpWriter&) = delete;
    VtpWriter& operator=(const VtpWriter&) = delete;
    ~VtpWriter() override;
    void write(const Snapshot& snapshot) override;
    std::string bookmark() override; // "walls" (1 or 0) and the time of every frame, separated by blanks

private:
    [[nodiscard]] fs::path file(std::string_view prefix, std::size_t frame) const {
        return folder_ / "frames" / fmt::format("{}{:06}.vtp", prefix, frame);
    }
    void restore(const std::string& bookmark);
    void remove_frames_from(std::size_t frame) const;
    void write_index();

    fs::path folder_;
    bool walls_move_ = false, has_walls_ = false;
    std::vector<double> times_;
    std::size_t indexed_ = 0; // frames in the index on the disk
};

VtpWriter::VtpWriter(fs::path folder, const scene::Scene& scene, const std::string& bookmark)
    : folder_(std::move(folder)) {
    for (const scene::Wall& wall : scene.walls)
        walls_move_ = walls_move_ || !wall.motion.empty() || wall.omega != 0;
    std::error_code status;
    fs::create_directories(folder_ / "frames", status);
    if (status)
        fail(Exit::io, "{}: cannot create the folder: {}", (folder_ / "frames").string(), status.message());
    if (!bookmark.empty()) restore(bookmark);
    remove_frames_from(times_.size());
    write_index();
}

void VtpWriter::restore(const std::string& bookmark) {
    std::string_view rest = bookmark;
    bool first = true;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        double value = 0;
        if (!read_number(rest.substr(0, end), value) || (first && value != 0 && value != 1))
            fail(Exit::io, "{}: the checkpoint's list of frames is damaged",
                 (folder_ / "trajectory.pvd").string());
        if (first)
            has_walls_ = value != 0;
        else
            times_.push_back(value);
        first = false;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    std::error_code status;
    for (std::size_t frame = 0; frame < times_.size(); ++frame)
        if (!fs::exists(file("", frame), status))
            fail(Exit::io, "{}: is missing; the trajectory cannot be continued", file("", frame).string());
}

// Frames written after the checkpoint that a resumed run starts from.
void VtpWriter::remove_frames_from(std::size_t frame) const {
    std::error_code ignored;
    for (; fs::exists(file("", frame), ignored); ++frame) {
        fs::remove(file("", frame), ignored);
        fs::remove(file("walls_", frame), ignored);
    }
}

void VtpWriter::write_index() {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                       "byte_order=\"LittleEndian\">\n<Collection>\n";
    const auto add = [&](double time, int part, const fs::path& path) {
        text += "<DataSet timestep=\"";
        append(text, time);
        text +=
            fmt::format("\" part=\"{}\" file=\"{}\"/>\n", part, path.lexically_relative(folder_).string());
    };
    for (std::size_t frame = 0; frame < times_.size(); ++frame) {
        add(times_[frame], 0, file("", frame));
        if (has_walls_) add(times_[frame], 1, file("walls_", walls_move_ ? frame : 0));
    }
    write_file_atomically(folder_ / "trajectory.pvd", text + "</Collection>\n</VTKFile>\n");
    indexed_ = times_.size();
}

// Also of a run that ends with an error: its frames are there to be looked at.
VtpWriter::~VtpWriter() {
    if (indexed_ == times_.size()) return;
    try {
        write_index();
    } catch (...) { // NOLINT(bugprone-empty-catch): a full disk; the index on it lacks the last frames
    }
}

void VtpWriter::write(const Snapshot& snapshot) {
    const std::size_t frame = times_.size();
    if (frame == 0) has_walls_ = !snapshot.walls.empty();
    write_file_atomically(file("", frame), grains_document(snapshot));
    if (has_walls_ && (walls_move_ || frame == 0))
        write_file_atomically(file("walls_", frame), walls_document(snapshot));
    times_.push_back(snapshot.time);
    if (times_.size() > indexed_ + indexed_ / 8) write_index();
}

std::string VtpWriter::bookmark() {
    if (indexed_ != times_.size()) write_index();
    std::string text = has_walls_ ? "1" : "0";
    for (const double time : times_) {
        text += ' ';
        append(text, time);
    }
    return text;
}

} // namespace

std::unique_ptr<TrajectoryWriter> make_vtp(const fs::path& folder, const scene::Scene& scene,
                                           const std::string& bookmark) {
    return std::make_unique<VtpWriter>(folder, scene, bookmark);
}

} // namespace sandlane::output
