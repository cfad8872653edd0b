// PNG encoding by libpng, in memory, so that the file can be written atomically.
#include "core/error.hpp"
#include "output/canvas.hpp"

#include <png.h>

namespace sandlane::output {

std::string Canvas::png() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_);
    image.height = static_cast<png_uint_32>(height_);
    image.format = PNG_FORMAT_RGB;
    image.flags = PNG_IMAGE_FLAG_FAST;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels_.data(), 0, nullptr) == 0)
        fail(Exit::io, "a picture of {} x {} pixels cannot be encoded: {}", width_, height_, image.message);
    bytes.resize(size);
    return bytes;
}

} // namespace sandlane::output
