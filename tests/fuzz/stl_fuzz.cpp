// STL files.
#include "core/error.hpp"
#include "scene/stl.hpp"

#include <cstdlib>

using namespace sandlane;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const std::string_view content(reinterpret_cast<const char*>(data), size);
        const scene::TriangleMesh mesh = scene::parse_stl(content, "fuzz.stl");
        if (mesh.triangles.empty()) std::abort();
        for (const auto& corners : mesh.triangles)
            for (const std::uint32_t corner : corners)
                if (corner >= mesh.points.size()) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
