// Grains read from a file: CSV with a header line, or the book's format.
#include "core/error.hpp"
#include "scene/book_format.hpp"
#include "scene/population.hpp"
#include "scene/space.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace sandlane::scene {

namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

struct NumberColumn {
    std::string_view name;
    std::int64_t only; // 2 or 3: a column of files for scenes of this dimension
    bool positive;
    double& (*at)(GrainState&);
};

constexpr NumberColumn number_columns[] = {
    {"x", 0, false, [](GrainState& g) -> double& { return g.position.x; }},
    {"y", 0, false, [](GrainState& g) -> double& { return g.position.y; }},
    {"z", 3, false, [](GrainState& g) -> double& { return g.position.z; }},
    {"vx", 0, false, [](GrainState& g) -> double& { return g.velocity.x; }},
    {"vy", 0, false, [](GrainState& g) -> double& { return g.velocity.y; }},
    {"vz", 3, false, [](GrainState& g) -> double& { return g.velocity.z; }},
    {"angle", 2, false, [](GrainState& g) -> double& { return g.angle; }},
    {"omega", 2, false, [](GrainState& g) -> double& { return g.omega; }},
    {"omega_x", 3, false, [](GrainState& g) -> double& { return g.angular_velocity.x; }},
    {"omega_y", 3, false, [](GrainState& g) -> double& { return g.angular_velocity.y; }},
    {"omega_z", 3, false, [](GrainState& g) -> double& { return g.angular_velocity.z; }},
    {"radius", 0, true, [](GrainState& g) -> double& { return g.radius; }},
    {"mass", 0, true, [](GrainState& g) -> double& { return g.mass; }},
};

bool exists(const NumberColumn& column, std::int64_t dimension) {
    return column.only == 0 || column.only == dimension;
}

const NumberColumn* find_column(std::string_view name, std::int64_t dimension) {
    for (const NumberColumn& c : number_columns)
        if (c.name == name && exists(c, dimension)) return &c;
    return nullptr;
}

// For messages.
std::string known_columns(std::int64_t dimension) {
    std::string names;
    for (const NumberColumn& c : number_columns)
        if (exists(c, dimension)) names += fmt::format("{}, ", c.name);
    return names + "material";
}

class CsvReader {
public:
    CsvReader(const Scene& scene, const Grains& grains, const GrainState& prototype, const std::string& file)
        : scene_(scene), grains_(grains), prototype_(prototype), file_(file),
          dimension_(scene.domain.dimension) {}

    std::vector<GrainState> read(std::string_view text) {
        std::vector<GrainState> result;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            const std::string_view line = trimmed(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
            ++line_;
            if (line.empty()) continue;
            if (header_.empty())
                read_header(line);
            else
                result.push_back(read_grain(line));
        }
        if (header_.empty())
            reject("is empty; a header line {} is needed",
                   dimension_ == 3 ? "x,y,z,vx,vy,vz,radius" : "x,y,vx,vy,omega,radius");
        return result;
    }

private:
    template <class... Args>
    [[noreturn]] void reject(fmt::format_string<Args...> format, Args&&... args) const {
        fail(Exit::invalid_input, "{}:{}: {}", file_, line_,
             fmt::format(format, std::forward<Args>(args)...));
    }

    void read_header(std::string_view line) {
        header_ = split(line);
        const auto has = [&](std::string_view name) {
            return std::count(header_.begin(), header_.end(), name) > 0;
        };
        for (const std::string_view name : header_) {
            if (name != "material" && find_column(name, dimension_) == nullptr)
                reject("\"{}\" is not a column{}; known: {}", name,
                       dimension_ == 3 ? " of a three-dimensional scene" : "", known_columns(dimension_));
            if (std::count(header_.begin(), header_.end(), name) > 1)
                reject("column \"{}\" is there twice", name);
        }
        for (const AxisOfSpace& axis : axes(dimension_))
            if (!has(axis.name)) reject("column \"{}\" is missing", axis.name);
        if (!has("radius") && !(grains_.sizes.min > 0))
            reject("column \"radius\" is missing; add it, or give the population a radius");
    }

    GrainState read_grain(std::string_view line) const {
        const std::vector<std::string_view> cells = split(line);
        if (cells.size() != header_.size())
            reject("{} values; the header has {} columns", cells.size(), header_.size());
        GrainState g = prototype_;
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (const NumberColumn* column = find_column(header_[c], dimension_); column != nullptr)
                column->at(g) = number(cells[c], *column);
            else
                g.material = material(cells[c]);
        return g;
    }

    [[nodiscard]] double number(std::string_view cell, const NumberColumn& column) const {
        double value = 0;
        const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc{} || stop != cell.data() + cell.size() || !std::isfinite(value))
            reject("column {}: \"{}\" is not a finite number", column.name, cell);
        if (column.positive && !(value > 0))
            reject("column {}: {} is out of range; allowed: above 0", column.name, value);
        return value;
    }

    [[nodiscard]] int material(std::string_view name) const {
        for (std::size_t m = 0; m < scene_.materials.size(); ++m)
            if (scene_.materials[m].name == name) return static_cast<int>(m);
        reject("column material: \"{}\" is not a material of the scene", name);
    }

    const Scene& scene_;
    const Grains& grains_;
    const GrainState& prototype_;
    const std::string& file_;
    std::int64_t dimension_;
    std::vector<std::string_view> header_;
    int line_ = 0;
};

std::vector<GrainState> free_grains(const Book& book, const GrainState& prototype, const std::string& file) {
    std::vector<GrainState> grains;
    for (const BookRecord& r : book.records) {
        if (r.type != 0)
            fail(Exit::invalid_input,
                 "{}: record {}, column 9 (ptype): {} is a wall grain; a population holds free grains "
                 "(type 0) only. Describe it under [[walls]].",
                 file, grains.size() + 1, r.type);
        GrainState g = prototype;
        g.position = {r.x, r.y, 0};
        g.velocity = {r.vx, r.vy, 0};
        g.angle = r.phi;
        g.omega = r.omega;
        g.radius = r.radius;
        g.mass = r.mass;
        grains.push_back(g);
    }
    return grains;
}

} // namespace

std::vector<GrainState> parse_grains(const std::string& text, const std::string& file, const Scene& scene,
                                     const Grains& grains, const GrainState& prototype) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool csv = first == std::string::npos || std::isalpha(static_cast<unsigned char>(text[first])) != 0;
    if (csv) return CsvReader(scene, grains, prototype, file).read(text);
    if (scene.domain.dimension == 3)
        fail(Exit::invalid_input,
             "{}: has no header line of column names; a three-dimensional scene needs one. Known columns: {}",
             file, known_columns(3));
    return free_grains(parse_book(text, file), prototype, file);
}

} // namespace sandlane::scene
