#include "output/npy.hpp"

#include "core/file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

namespace sandlane::output {

static_assert(std::endian::native == std::endian::little, "'<f4'");

std::string npy_bytes(const analysis::Field& field) {
    std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}",
                                     field.rows, field.columns);
    constexpr std::size_t before = 10, alignment = 64; // magic, version and length of the header
    header.append((alignment - (before + header.size() + 1) % alignment) % alignment, ' ');
    header += '\n';
    const auto length = static_cast<std::uint16_t>(header.size());
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(length & 0xff);
    bytes += static_cast<char>(length >> 8);
    bytes += header;
    bytes.reserve(bytes.size() + sizeof(float) * field.values.size());
    for (const double value : field.values) {
        const auto single = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        bytes.append(reinterpret_cast<const char*>(&single), sizeof single);
    }
    return bytes;
}

void write_npy(const std::filesystem::path& path, const analysis::Field& field) {
    write_file_atomically(path, npy_bytes(field));
}

} // namespace sandlane::output
