// Pictures decoded by libpng. The domain is found by its ground colour, grains are then where they must be.
#pragma once

#include "output/colours.hpp"
#include "output/picture.hpp"
#include "output/sample.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

namespace sandlane::output {

using Pixel = std::array<int, 3>;
inline constexpr Pixel ground{246, 247, 249};

class Image {
public:
    explicit Image(const std::filesystem::path& path) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
        image.format = PNG_FORMAT_RGB;
        bytes_.resize(PNG_IMAGE_SIZE(image));
        EXPECT_NE(png_image_finish_read(&image, nullptr, bytes_.data(), 0, nullptr), 0) << image.message;
        width = static_cast<int>(image.width);
        height = static_cast<int>(image.height);
        find_domain();
    }
    [[nodiscard]] Pixel at(int x, int y) const {
        const unsigned char* p = &bytes_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                              static_cast<std::size_t>(x))];
        return {p[0], p[1], p[2]};
    }
    // Pixel at a place of a domain of which the ground shows at all edges, in units of its extent, y up.
    [[nodiscard]] Pixel in_domain(double x, double y) const {
        return at(static_cast<int>(left + x * (right - left)), static_cast<int>(bottom - y * (bottom - top)));
    }

    int width = 0, height = 0;
    int left = 1 << 30, right = 0, top = 1 << 30, bottom = 0; // of the domain; right and bottom exclusive

private:
    void find_domain() {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (at(x, y) == ground) {
                    left = std::min(left, x);
                    right = std::max(right, x + 1);
                    top = std::min(top, y);
                    bottom = std::max(bottom, y + 1);
                }
    }
    std::vector<unsigned char> bytes_;
};

inline Image draw(const analysis::Snapshot& s, const PictureStyle& style) {
    const sample::Folder folder("picture");
    write_picture(folder / "p.png", s, style);
    return Image(folder / "p.png");
}

} // namespace sandlane::output
