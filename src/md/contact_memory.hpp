// What contacts remember, keyed by who touches whom: the form in which it survives new lists, new storage
// orders and checkpoints.
#pragma once

#include "core/bytes.hpp"
#include "laws/contact.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandlane::md {

class ContactMemory {
public:
    ContactMemory() = default;
    // `odd`: how many of the numbers, the first ones, change their sign when the partners are exchanged.
    explicit ContactMemory(int fields, int odd = 0)
        : fields_(static_cast<std::size_t>(fields)), odd_(static_cast<std::size_t>(odd)) {}
    // Of the same kind of contacts.
    [[nodiscard]] ContactMemory empty_copy() const {
        return ContactMemory(static_cast<int>(fields_), static_cast<int>(odd_));
    }

    void reserve(std::size_t contacts);
    // first, second: ids of two grains, whose numbers are those seen from the first; or the id of a grain and
    // a wall element by `add_wall`. values: `fields` numbers, for walls `stride` apart.
    void add(std::int64_t first, std::int64_t second, const double* values);
    void add_wall(std::int64_t grain, std::int64_t element, const double* values, std::ptrdiff_t stride);

    // After the last add. Writes the numbers of a contact, seen from the first; false if it is new.
    void index();
    bool find(std::int64_t first, std::int64_t second, double* values) const;
    // Null if it is new.
    [[nodiscard]] const double* find_wall(std::int64_t grain, std::int64_t element) const;
    [[nodiscard]] bool empty() const { return keys_.empty(); }

    void write(ByteWriter& bytes) const;
    // Content that is written in parts: how many contacts they have together, then each of them.
    static void write_size(ByteWriter& bytes, std::size_t contacts) {
        bytes.put(static_cast<std::uint64_t>(contacts));
    }
    void write_contacts(ByteWriter& bytes) const;
    // Throws Error(io) for lengths that do not fit and for a grain that is not one of 0 .. grains - 1.
    static ContactMemory read(ByteReader& bytes, const ContactMemory& kind, std::int64_t grains);

private:
    struct Key {
        std::int64_t first, second;
    };
    std::size_t fields_ = 0, odd_ = 0;
    std::vector<Key> keys_;
    std::vector<double> values_;       // [contact][fields]
    std::vector<std::uint32_t> start_; // by first, where its contacts begin in order_
    std::vector<std::uint32_t> order_; // contacts by first
};

} // namespace sandlane::md
