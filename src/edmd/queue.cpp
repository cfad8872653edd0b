#include "edmd/queue.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::edmd {

namespace {

constexpr double per_bucket = 3; // entries, about

// Without the doubling of Column::resize.
void grow(Column<QueueBlock>& column, std::size_t size) {
    Column<QueueBlock> larger(size);
    for (std::size_t k = 0; k < column.size(); ++k) larger[k] = column[k];
    column.swap(larger);
}
double key_of(const simd::HardEvents& e) {
    return e.first_time < e.crossing_time ? e.first_time : e.crossing_time;
}

} // namespace

void Queue::restart(double now, double events, std::size_t particles) {
    particles_ = particles;
    // So that a turn of the ring takes one and a half mean waiting times.
    buckets_ = static_cast<std::uint32_t>(std::max<std::size_t>(
        16, static_cast<std::size_t>(static_cast<double>(particles) * 1.5 / per_bucket)));
    if (blocks_.size() < buckets_) blocks_ = Column<QueueBlock>(buckets_ + buckets_ / 4 + 64);
    blocks_.fill({});
    free_ = 0;
    for (std::size_t k = buckets_; k < blocks_.size(); ++k) {
        blocks_[k].meta = free_ << 3;
        free_ = static_cast<std::uint32_t>(k);
    }
    current_ = 0;
    origin_ = now;
    inverse_width_ = events > 0 ? events / per_bucket : 1;
    end_ = buckets_;
    popped_ = 0;
    deferred_.fill({});
    sorted_.clear();
    later_.clear();
}

void Queue::append_block(std::uint32_t bucket, std::uint32_t particle) {
    const std::uint32_t next = blocks_[bucket].meta >> 3;
    if (next != 0 && (blocks_[next].meta & 7) < 7) {
        QueueBlock& b = blocks_[next];
        b.particle[b.meta & 7] = particle;
        ++b.meta;
        return;
    }
    if (free_ == 0) {
        const std::size_t size = blocks_.size();
        grow(blocks_, size + size / 8);
        for (std::size_t k = size; k < blocks_.size(); ++k) {
            blocks_[k].meta = free_ << 3;
            free_ = static_cast<std::uint32_t>(k);
        }
    }
    const std::uint32_t fresh = free_;
    QueueBlock& b = blocks_[fresh];
    free_ = b.meta >> 3;
    b.particle[0] = particle;
    b.meta = next << 3 | 1;
    blocks_[bucket].meta = fresh << 3 | 7;
}

void Queue::take(std::uint32_t particle, simd::HardEvents* events) {
    simd::HardEvents& e = events[particle];
    if (e.bucket != current_) return; // it went elsewhere, or came twice
    e.bucket = present;
    sorted_.push_back({key_of(e), particle});
}

bool Queue::advance(simd::HardEvents* events) {
    do {
        if (++current_ == buckets_) {
            if (!turn(events)) return false;
        } else {
            write_deferred(current_ + looked_ahead);
        }
    } while (blocks_[current_].meta == 0);
    std::uint32_t block = current_;
    bool first = true;
    do {
        QueueBlock& b = blocks_[block];
        const std::uint32_t size = b.meta & 7, next = b.meta >> 3;
        for (std::uint32_t k = 0; k < size; ++k) take(b.particle[k], events);
        b.meta = 0;
        if (!first) {
            b.meta = free_ << 3;
            free_ = block;
        }
        first = false;
        block = next;
    } while (block != 0);
    popped_ += sorted_.size();
    if (sorted_.size() > 1)
        std::sort(sorted_.begin(), sorted_.end(),
                  [](const Entry& a, const Entry& b) { return a.time > b.time; });
    return true;
}

// All buckets are done: those that were too late for them start the next turn.
bool Queue::turn(simd::HardEvents* events) {
    write_deferred(nowhere - 1);
    std::vector<std::uint32_t> waiting;
    waiting.swap(later_);
    double first = simd::never_meets;
    for (const std::uint32_t p : waiting)
        if (events[p].bucket == later) first = std::min(first, key_of(events[p]));
    if (first == simd::never_meets) {
        current_ = buckets_ - 1;
        return false;
    }
    // The width follows what came up in the last turn.
    const double width = 1 / inverse_width_, mean = static_cast<double>(popped_) / buckets_;
    const double start = std::max(origin_ + end_ * width, first);
    const double factor = std::clamp(per_bucket / std::max(mean, 1e-3), 0.25, 4.0);
    if (factor < 0.7 || factor > 1.5) inverse_width_ = 1 / (width * factor);
    origin_ = start;
    current_ = 0;
    popped_ = 0;
    // Nothing may land in the bucket that is passed over next.
    origin_ -= 1.5 / inverse_width_;
    for (const std::uint32_t p : waiting) {
        if (events[p].bucket != later) continue;
        events[p].bucket = nowhere;
        put(p, events[p]);
    }
    return true;
}

} // namespace sandlane::edmd
