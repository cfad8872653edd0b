// Little-endian byte strings for checkpoints: plain values, strings and arrays, with bounds checks on the way
// back.
#pragma once

#include "core/error.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sandlane {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

// Takes pieces of a longer content, one after the other.
using ByteSink = std::function<void(std::string_view)>;

class ByteWriter {
public:
    ByteWriter() = default;
    // What was put goes on to `sink` from time to time, and what is left with flush(): never whole in memory.
    explicit ByteWriter(ByteSink sink) : sink_(std::move(sink)) {}

    template <class T>
    requires std::is_arithmetic_v<T>
    void put(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        put_bytes({raw, sizeof(T)});
    }
    template <class T> void put_array(const T* data, std::size_t count) {
        put(static_cast<std::uint64_t>(count));
        if (count > 0) put_bytes({reinterpret_cast<const char*>(data), count * sizeof(T)});
    }
    void put_text(std::string_view text) { put_array(text.data(), text.size()); }
    void put_bytes(std::string_view bytes) {
        if (sink_ && bytes.size() >= piece) {
            flush();
            return sink_(bytes);
        }
        bytes_.append(bytes);
        if (sink_ && bytes_.size() >= piece) flush();
    }
    void flush() {
        sink_(bytes_);
        bytes_.clear();
    }
    [[nodiscard]] const std::string& bytes() const& { return bytes_; }
    [[nodiscard]] std::string bytes() && { return std::move(bytes_); }

private:
    static constexpr std::size_t piece = std::size_t{1} << 18;

    std::string bytes_;
    ByteSink sink_;
};

// Reads past the end, or counts that cannot be, are an Error(io).
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    requires std::is_arithmetic_v<T>
    [[nodiscard]] T get() {
        T value;
        std::memcpy(&value, take(sizeof(T)), sizeof(T));
        return value;
    }
    // Resizes the container (anything with resize and data).
    template <class Container> void get_array(Container& container) {
        using T = std::remove_pointer_t<decltype(container.data())>;
        const auto count = get<std::uint64_t>();
        if (count > bytes_.size() / sizeof(T)) damaged();
        container.resize(static_cast<std::size_t>(count));
        if (count > 0)
            std::memcpy(static_cast<void*>(container.data()),
                        take(static_cast<std::size_t>(count) * sizeof(T)),
                        static_cast<std::size_t>(count) * sizeof(T));
    }
    [[nodiscard]] std::string get_text() {
        std::string text;
        get_array(text);
        return text;
    }
    [[nodiscard]] std::string rest() {
        const std::size_t left = bytes_.size() - position_;
        return {take(left), left};
    }
    [[nodiscard]] bool at_end() const { return position_ == bytes_.size(); }

private:
    [[noreturn]] static void damaged() { fail(Exit::io, "damaged or truncated content"); }
    const char* take(std::size_t count) {
        if (count > bytes_.size() - position_) damaged();
        const char* at = bytes_.data() + position_;
        position_ += count;
        return at;
    }

    std::string_view bytes_;
    std::size_t position_ = 0;
};

} // namespace sandlane
