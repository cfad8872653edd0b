// STL files for tests: text with all digits of a double, and binary.
#pragma once

#include "core/file.hpp"
#include "core/vec.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <unistd.h>

namespace sandlane::test {

using Triangles = std::vector<std::array<Vec, 3>>;

inline std::string stl_text(const Triangles& triangles) {
    std::string text = "solid test\n";
    for (const auto& t : triangles) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const Vec& p : t) text += fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid test\n";
}

inline std::string stl_binary(const Triangles& triangles, const std::string& header = "test") {
    std::string content(84 + 50 * triangles.size(), '\0');
    std::memcpy(content.data(), header.data(), header.size());
    const auto count = static_cast<std::uint32_t>(triangles.size());
    std::memcpy(content.data() + 80, &count, sizeof(count));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        std::array<float, 12> number{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec p = triangles[t][k];
            number[3 + 3 * k] = static_cast<float>(p.x);
            number[4 + 3 * k] = static_cast<float>(p.y);
            number[5 + 3 * k] = static_cast<float>(p.z);
        }
        std::memcpy(content.data() + 84 + 50 * t, number.data(), sizeof(number));
    }
    return content;
}

// Removes what stl_file has written when the program ends.
struct WrittenFiles {
    std::vector<std::string> paths;

    WrittenFiles() = default;
    WrittenFiles(const WrittenFiles&) = delete;
    WrittenFiles& operator=(const WrittenFiles&) = delete;
    ~WrittenFiles() {
        for (const std::string& path : paths) std::remove(path.c_str());
    }
};

// A file of that content; tests run at the same time, each as a program of its own.
inline std::string stl_file(const std::string& name, const std::string& content) {
    static WrittenFiles written;
    std::string path = fmt::format("{}sandlane_{}_{}.stl", testing::TempDir(), getpid(), name);
    write_file_atomically(path, content);
    written.paths.push_back(path);
    return path;
}

// The faces of a box, two triangles each, seen from outside.
inline Triangles box_triangles(Vec low, Vec high) {
    const auto p = [&](int n) {
        return Vec{(n & 1) != 0 ? high.x : low.x, (n & 2) != 0 ? high.y : low.y,
                   (n & 4) != 0 ? high.z : low.z};
    };
    Triangles t;
    for (const auto& f : std::array<std::array<int, 4>, 6>{
             {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}}) {
        t.push_back({p(f[0]), p(f[1]), p(f[2])});
        t.push_back({p(f[0]), p(f[2]), p(f[3])});
    }
    return t;
}

// A square [-1, 1]^2 at z = 0 of n x n cells, two triangles each whose diagonals alternate, with inner points
// displaced by up to a fifth of a cell.
inline Triangles uneven_square(int n) {
    const auto point = [n](int i, int j) {
        const double step = 2.0 / n;
        const bool inner = i > 0 && j > 0 && i < n && j < n;
        const double dx = inner ? 0.2 * std::sin(12.9898 * i + 78.233 * j) : 0;
        const double dy = inner ? 0.2 * std::cos(39.425 * i + 11.135 * j) : 0;
        return Vec{-1 + step * (i + dx), -1 + step * (j + dy), 0};
    };
    Triangles t;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
            if ((i + j) % 2 == 0) {
                t.push_back({a, b, c});
                t.push_back({a, c, d});
            } else {
                t.push_back({a, b, d});
                t.push_back({d, b, c});
            }
        }
    return t;
}

} // namespace sandlane::test
