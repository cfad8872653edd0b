#include "scene/stl.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

namespace sandlane::scene {

namespace {

using Corners = std::vector<Vec>; // three for each triangle

// ---- binary: header of 80 bytes, number of triangles, 50 bytes for each

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

std::uint64_t announced_triangles(std::string_view content) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + header_bytes - sizeof(count), sizeof(count));
    return count;
}

bool is_binary(std::string_view content) {
    return content.size() >= header_bytes &&
           content.size() == header_bytes + triangle_bytes * announced_triangles(content);
}

Corners binary_corners(std::string_view content, const std::string& file) {
    static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
    const std::size_t count = announced_triangles(content);
    Corners corners;
    corners.reserve(3 * count);
    for (std::size_t t = 0; t < count; ++t) {
        float number[12]; // normal, three corners
        std::memcpy(number, content.data() + header_bytes + t * triangle_bytes, sizeof(number));
        for (int k = 3; k < 12; k += 3) {
            const Vec corner{number[k], number[k + 1], number[k + 2]};
            if (!std::isfinite(corner.x) || !std::isfinite(corner.y) || !std::isfinite(corner.z))
                fail(Exit::invalid_input,
                     "{}: triangle {} of {} has a corner ({}, {}, {}); allowed: finite numbers. Export the "
                     "mesh again.",
                     file, t + 1, count, corner.x, corner.y, corner.z);
            corners.push_back(corner);
        }
    }
    return corners;
}

// ---- text

// Words with the line they stand in.
class TextReader {
public:
    TextReader(std::string_view content, const std::string& file) : content_(content), file_(file) {}

    Corners read() {
        Corners corners;
        expect("solid");
        skip_line();
        for (std::string_view word = next(); !word.empty(); word = next()) {
            if (same(word, "facet"))
                facet(corners);
            else if (same(word, "endsolid") || same(word, "solid"))
                skip_line();
            else
                refuse("\"facet\" or \"endsolid\"", word);
        }
        return corners;
    }

private:
    void facet(Corners& corners) {
        expect("normal");
        for (int k = 0; k < 3; ++k) (void)next(); // follows from the corners, and exporters often write zeros
        expect("outer");
        expect("loop");
        for (int k = 0; k < 3; ++k) {
            expect("vertex");
            const double x = number(), y = number(), z = number();
            corners.push_back({x, y, z});
        }
        expect("endloop");
        expect("endfacet");
    }

    static bool same(std::string_view word, std::string_view keyword) {
        return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                          [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
    }
    static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

    std::string_view next() {
        for (; at_ < content_.size() && is_space(content_[at_]); ++at_)
            if (content_[at_] == '\n') ++line_;
        const std::size_t begin = at_;
        while (at_ < content_.size() && !is_space(content_[at_])) ++at_;
        return content_.substr(begin, at_ - begin);
    }
    void skip_line() { at_ = std::min(content_.find('\n', at_), content_.size()); }

    void expect(std::string_view keyword) {
        const std::string_view word = next();
        if (!same(word, keyword)) refuse(fmt::format("\"{}\"", keyword), word);
    }
    double number() {
        const std::string_view word = next();
        double value = 0;
        const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
        const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
            refuse("a finite number", word);
        return value;
    }
    [[noreturn]] void refuse(const std::string& expected, std::string_view found) const {
        const std::string what =
            found.empty() ? "the file ends" : fmt::format("it reads \"{}\"", found.substr(0, 40));
        fail(Exit::invalid_input,
             "{}:{}: {} where an STL file has {}. Export the mesh again, as STL of triangles.", file_, line_,
             what, expected);
    }

    std::string_view content_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 1;
};

bool is_text(std::string_view content) {
    constexpr std::string_view keyword = "solid";
    const std::size_t begin = content.find_first_not_of(" \t\r\n");
    return begin != std::string_view::npos && content.substr(begin, keyword.size()) == keyword;
}

// ---- from corners to points

// Height of a triangle over its longest side that counts as an area: coordinates of binary files have 24
// bits.
constexpr double thinnest = 1e-7;

bool has_area(Vec a, Vec b, Vec c) {
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return norm(cross(b - a, c - a)) > thinnest * longest * longest;
}

TriangleMesh joined(const Corners& corners) {
    std::vector<std::uint32_t> order(corners.size()), point(corners.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto place = [&](std::uint32_t n) {
        return std::tuple(corners[n].x, corners[n].y, corners[n].z, n);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    TriangleMesh mesh;
    for (const std::uint32_t n : order) {
        if (mesh.points.empty() || mesh.points.back() != corners[n]) mesh.points.push_back(corners[n]);
        point[n] = static_cast<std::uint32_t>(mesh.points.size() - 1);
    }
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
        if (has_area(corners[t], corners[t + 1], corners[t + 2]))
            mesh.triangles.push_back({point[t], point[t + 1], point[t + 2]});
    return mesh;
}

} // namespace

TriangleMesh parse_stl(std::string_view content, const std::string& file) {
    const bool binary = is_binary(content);
    if (!binary && !is_text(content)) {
        if (content.size() < header_bytes)
            fail(Exit::invalid_input, "{}: is no STL file: it has {} bytes and does not begin with \"solid\"",
                 file, content.size());
        const std::uint64_t count = announced_triangles(content);
        fail(Exit::invalid_input,
             "{}: is no STL file, or a damaged one: it does not begin with \"solid\", and as a binary file "
             "of {} triangles it would have {} bytes, not {}. Export the mesh again.",
             file, count, header_bytes + triangle_bytes * count, content.size());
    }
    TriangleMesh mesh = joined(binary ? binary_corners(content, file) : TextReader(content, file).read());
    if (mesh.triangles.empty())
        fail(Exit::invalid_input, "{}: has no triangle with an area; a mesh needs one or more", file);
    return mesh;
}

} // namespace sandlane::scene
