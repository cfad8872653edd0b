// The queue of events: a ring of buckets of equal width in time, of which the present one is sorted. Entries
// are numbers of particles; those that no longer hold are left where they are and dropped when their bucket
// comes up. The width decides about speed only, never about the order.
#pragma once

#include "core/column.hpp"
#include "simd/edmd/tables.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace sandlane::edmd {

// Entries of a bucket, and the number of the block that goes on; 0: none.
struct QueueBlock {
    std::uint32_t particle[7];
    std::uint32_t meta; // as HardCell::meta
};

class Queue {
public:
    struct Entry {
        double time;
        std::uint32_t particle;
    };
    // Buckets that no entry can have.
    static constexpr std::uint32_t nowhere = 0xffffffff, present = 0xfffffffe, later = 0xfffffffd;

    // Empties the queue: about `events` of them per second are expected, of so many particles.
    void restart(double now, double events, std::size_t particles);

    // events.bucket must be `nowhere` for particles that never were in the queue.
    void put(std::uint32_t particle, simd::HardEvents& events) {
        const double time =
            events.first_time < events.crossing_time ? events.first_time : events.crossing_time;
        const double at = (time - origin_) * inverse_width_;
        if (at < end_) {
            const auto bucket = static_cast<std::uint32_t>(at < 0 ? 0 : at);
            if (bucket <= current_) {
                events.bucket = present;
                insert({time, particle});
                return;
            }
            if (events.bucket == bucket) return; // stands there already
            events.bucket = bucket;
            defer(bucket, particle);
            return;
        }
        if (!(time < simd::never_meets)) {
            events.bucket = nowhere;
            return;
        }
        if (events.bucket == later) return;
        events.bucket = later;
        later_.push_back(particle);
    }

    // Makes the next bucket the present one; false: no entries are left. sorted() may still be empty.
    [[nodiscard]] bool advance(simd::HardEvents* events);
    // Entries of a bucket that comes up, some of which may no longer hold.
    template <class Body> void for_entries(std::uint32_t ahead, const Body& body) const {
        if (current_ + ahead + fetched_ahead < buckets_)
            __builtin_prefetch(&blocks_[current_ + ahead + fetched_ahead]);
        if (current_ + ahead >= buckets_) return;
        const QueueBlock& b = blocks_[current_ + ahead];
        for (std::uint32_t k = 0; k < (b.meta & 7); ++k) body(b.particle[k], current_ + ahead);
    }

    void pop() { sorted_.pop_back(); }
    // Entries of the present bucket, the latest first.
    [[nodiscard]] std::vector<Entry>& sorted() { return sorted_; }

    [[nodiscard]] std::size_t bytes() const {
        return blocks_.bytes() + later_.capacity() * sizeof(std::uint32_t) +
               sorted_.capacity() * sizeof(Entry);
    }

private:
    void insert(Entry entry) {
        std::size_t at = sorted_.size();
        sorted_.push_back(entry);
        while (at > 0 && sorted_[at - 1].time < entry.time) {
            sorted_[at] = sorted_[at - 1];
            --at;
        }
        sorted_[at] = entry;
    }
    // Buckets are far from each other in memory: the line of one is fetched, and written a few entries later.
    void defer(std::uint32_t bucket, std::uint32_t particle) {
        __builtin_prefetch(&blocks_[bucket], 1);
        Deferred& oldest = deferred_[turn_of_deferred_++ % deferred_most];
        if (oldest.bucket != nowhere) append(oldest.bucket, oldest.particle);
        oldest = {bucket, particle};
    }
    // Those of buckets up to `last`.
    void write_deferred(std::uint32_t last) {
        for (Deferred& d : deferred_) {
            if (d.bucket > last) continue;
            append(d.bucket, d.particle);
            d.bucket = nowhere;
        }
    }
    void append(std::uint32_t bucket, std::uint32_t particle) {
        QueueBlock& b = blocks_[bucket];
        const std::uint32_t size = b.meta & 7;
        if (size == 7) {
            append_block(bucket, particle);
            return;
        }
        b.particle[size] = particle;
        ++b.meta;
    }
    void append_block(std::uint32_t bucket, std::uint32_t particle);
    static constexpr std::uint32_t fetched_ahead = 4, looked_ahead = 4; // buckets
    void take(std::uint32_t particle, simd::HardEvents* events);
    [[nodiscard]] bool turn(simd::HardEvents* events);

    static constexpr std::uint32_t deferred_most = 8;
    struct Deferred {
        std::uint32_t bucket = nowhere, particle = 0;
    };
    std::array<Deferred, deferred_most> deferred_{};
    std::uint32_t turn_of_deferred_ = 0;
    Column<QueueBlock> blocks_; // the buckets, then what goes on from them
    std::uint32_t buckets_ = 0, current_ = 0, free_ = 0;
    double origin_ = 0, inverse_width_ = 1, end_ = 0; // end_: buckets_ as a number
    std::size_t popped_ = 0;                          // entries that held, in this turn
    std::size_t particles_ = 0;
    std::vector<Entry> sorted_;
    std::vector<std::uint32_t> later_;
};

} // namespace sandlane::edmd
