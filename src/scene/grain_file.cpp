// Grains read from a file: CSV with a header line, or the book's format.
#include "core/error.hpp"
#include "scene/book_format.hpp"
#include "scene/population.hpp"

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
    bool positive;
    double& (*at)(GrainState&);
};

constexpr NumberColumn number_columns[] = {
    {"x", false, [](GrainState& g) -> double& { return g.position.x; }},
    {"y", false, [](GrainState& g) -> double& { return g.position.y; }},
    {"vx", false, [](GrainState& g) -> double& { return g.velocity.x; }},
    {"vy", false, [](GrainState& g) -> double& { return g.velocity.y; }},
    {"angle", false, [](GrainState& g) -> double& { return g.angle; }},
    {"omega", false, [](GrainState& g) -> double& { return g.omega; }},
    {"radius", true, [](GrainState& g) -> double& { return g.radius; }},
    {"mass", true, [](GrainState& g) -> double& { return g.mass; }},
};

const NumberColumn* find_column(std::string_view name) {
    for (const NumberColumn& c : number_columns)
        if (c.name == name) return &c;
    return nullptr;
}

class CsvReader {
public:
    CsvReader(const Scene& scene, const Grains& grains, const GrainState& prototype, const std::string& file)
        : scene_(scene), grains_(grains), prototype_(prototype), file_(file) {}

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
        if (header_.empty()) reject("is empty; a header line x,y,vx,vy,omega,radius is needed");
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
            if (name != "material" && find_column(name) == nullptr)
                reject("\"{}\" is not a column; known: x, y, vx, vy, angle, omega, radius, mass, material",
                       name);
            if (std::count(header_.begin(), header_.end(), name) > 1)
                reject("column \"{}\" is there twice", name);
        }
        if (!has("x") || !has("y")) reject("column \"{}\" is missing", has("x") ? "y" : "x");
        if (!has("radius") && !(grains_.sizes.min > 0))
            reject("column \"radius\" is missing; add it, or give the population a radius");
    }

    GrainState read_grain(std::string_view line) const {
        const std::vector<std::string_view> cells = split(line);
        if (cells.size() != header_.size())
            reject("{} values; the header has {} columns", cells.size(), header_.size());
        GrainState g = prototype_;
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (const NumberColumn* column = find_column(header_[c]); column != nullptr)
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
    return free_grains(parse_book(text, file), prototype, file);
}

} // namespace sandlane::scene
