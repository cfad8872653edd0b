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

void ContactMemory::write(ByteWriter& bytes) const {
    std::vector<std::int64_t> ids;
    for (const Key& key : keys_) ids.insert(ids.end(), {key.first, key.second});
    bytes.put_array(ids.data(), ids.size());
    bytes.put_array(values_.data(), values_.size());
}

ContactMemory ContactMemory::read(ByteReader& bytes, const ContactMemory& kind, std::int64_t grains) {
    ContactMemory memory = kind.empty_copy();
    std::vector<std::int64_t> ids;
    bytes.get_array(ids);
    bytes.get_array(memory.values_);
    if (ids.size() % 2 != 0 || memory.values_.size() != ids.size() / 2 * memory.fields_)
        fail(Exit::io, "memory of contacts of unequal length");
    for (std::size_t n = 0; n < ids.size(); n += 2) {
        if (ids[n] < 0 || ids[n] >= grains) fail(Exit::io, "a contact of grain {} that cannot be", ids[n]);
        memory.keys_.push_back({ids[n], ids[n + 1]});
    }
    memory.index();
    return memory;
}

} // namespace sandlane::md
