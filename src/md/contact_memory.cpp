#include "md/contact_memory.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace sandlane::md {

void ContactMemory::add(std::int64_t first, std::int64_t second, const double* values) {
    add_wall(std::min(first, second), std::max(first, second), values, 1);
    if (first < second) return;
    double* const stored = values_.data() + values_.size() - fields_;
    for (std::size_t f = 0; f < odd_; ++f) stored[f] = -stored[f];
}

bool ContactMemory::find(std::int64_t first, std::int64_t second, double* values) const {
    const double* stored = find_wall(std::min(first, second), std::max(first, second));
    if (stored == nullptr) return false;
    for (std::size_t f = 0; f < fields_; ++f) values[f] = f < odd_ && first > second ? -stored[f] : stored[f];
    return true;
}

void ContactMemory::add_wall(std::int64_t grain, std::int64_t element, const double* values,
                             std::ptrdiff_t stride) {
    keys_.push_back({grain, element});
    for (std::size_t f = 0; f < fields_; ++f)
        values_.push_back(values[static_cast<std::ptrdiff_t>(f) * stride]);
}

void ContactMemory::index() {
    std::int64_t largest = -1;
    for (const Key& key : keys_) largest = std::max(largest, key.first);
    start_.assign(static_cast<std::size_t>(largest) + 3, 0);
    for (const Key& key : keys_) ++start_[static_cast<std::size_t>(key.first) + 2];
    for (std::size_t n = 2; n < start_.size(); ++n) start_[n] += start_[n - 1];
    order_.resize(keys_.size());
    for (std::size_t n = 0; n < keys_.size(); ++n)
        order_[start_[static_cast<std::size_t>(keys_[n].first) + 1]++] = static_cast<std::uint32_t>(n);
}

const double* ContactMemory::find_wall(std::int64_t grain, std::int64_t element) const {
    if (static_cast<std::size_t>(grain) + 1 >= start_.size()) return nullptr;
    for (std::uint32_t n = start_[static_cast<std::size_t>(grain)];
         n < start_[static_cast<std::size_t>(grain) + 1]; ++n)
        if (keys_[order_[n]].second == element) return values_.data() + order_[n] * fields_;
    return nullptr;
}

void ContactMemory::reserve(std::size_t contacts) {
    keys_.reserve(contacts);
    values_.reserve(contacts * fields_);
}

void ContactMemory::write(ByteWriter& bytes) const {
    write_size(bytes, keys_.size());
    write_contacts(bytes);
}

void ContactMemory::write_contacts(ByteWriter& bytes) const {
    const double* values = values_.data();
    for (const Key& key : keys_) {
        bytes.put(key.first);
        bytes.put(key.second);
        for (std::size_t f = 0; f < fields_; ++f) bytes.put(*values++);
    }
}

ContactMemory ContactMemory::read(ByteReader& bytes, const ContactMemory& kind, std::int64_t grains) {
    ContactMemory memory = kind.empty_copy();
    std::vector<double> values(kind.fields_);
    for (auto left = bytes.get<std::uint64_t>(); left > 0; --left) {
        const auto first = bytes.get<std::int64_t>(), second = bytes.get<std::int64_t>();
        if (first < 0 || first >= grains) fail(Exit::io, "a contact of grain {} that cannot be", first);
        for (double& value : values) value = bytes.get<double>();
        memory.add_wall(first, second, values.data(), 1);
    }
    memory.index();
    return memory;
}

} // namespace sandlane::md
