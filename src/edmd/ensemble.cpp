#include "edmd/ensemble.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>

namespace sandlane::edmd {

namespace {

constexpr std::int64_t all_events = std::numeric_limits<std::int64_t>::max();
// Of the first, between two looks of the others at its clock.
constexpr std::int64_t block = 20000;

// What a run throws waits until all threads have come back.
template <class Body> void guarded(std::exception_ptr& caught, const Body& body) {
    try {
        body();
    } catch (...) {
        caught = std::current_exception();
    }
}

void rethrow(const std::vector<std::exception_ptr>& caught) {
    for (const std::exception_ptr& e : caught)
        if (e) std::rethrow_exception(e);
}

} // namespace

// While the first goes on, as many others as there are threads follow it as far as it has come; then all come
// to its time. Where a run stops leaves no trace in it, so nothing depends on who was how fast.
std::int64_t Ensemble::run(std::int64_t events, double until) {
    if (runs_.size() == 1) return runs_.front()->run(events, until);
    std::vector<std::exception_ptr> caught(runs_.size());
    std::atomic<double> reached{first().time()};
    std::atomic<bool> there{false};
    std::int64_t done = 0;
    const auto lead = [&] {
        while (done < events) {
            const std::int64_t asked = std::min(block, events - done), taken = runs_[0]->run(asked, until);
            done += taken;
            reached = first().time();
            if (taken < asked) break;
        }
    };
    const std::size_t together = std::min(runs_.size(), static_cast<std::size_t>(std::max(threads_, 1)));
    for_tiles_dynamic(together, threads_, [&](std::size_t n) { // the first of them begins first
        guarded(caught[n], [&] {
            if (n == 0) return lead();
            while (!there) {
                if (runs_[n]->time() < reached)
                    (void)runs_[n]->run(all_events, reached);
                else
                    std::this_thread::yield();
            }
        });
        if (n == 0) there = true;
    });
    rethrow(caught);
    for_tiles_dynamic(runs_.size() - 1, threads_, [&](std::size_t n) {
        guarded(caught[n + 1], [&] { (void)runs_[n + 1]->run(all_events, first().time()); });
    });
    rethrow(caught);
    return done;
}

Hash128 Ensemble::state_hash() const {
    if (runs_.size() == 1) return first().state_hash();
    ByteWriter out;
    for (const auto& run : runs_) {
        const Hash128 hash = run->state_hash();
        out.put_array(&hash, 1);
    }
    return hash_bytes(out.bytes().data(), out.bytes().size());
}

std::uint64_t Ensemble::log_hash() const {
    std::uint64_t hash = first().log().hash();
    for (std::size_t n = 1; n < runs_.size(); ++n)
        hash = (hash ^ runs_[n]->log().hash()) * 0x9E3779B97F4A7C15u + n;
    return hash;
}

std::string Ensemble::serialise() const {
    ByteWriter out;
    out.put(static_cast<std::uint64_t>(runs_.size()));
    for (const auto& run : runs_) out.put_text(run->serialise());
    return std::move(out).bytes();
}

void Ensemble::restore(const std::string& bytes) {
    ByteReader in(bytes);
    if (const auto count = in.get<std::uint64_t>(); count != runs_.size())
        fail(Exit::io, "the state is of {} replicas instead of {}", count, runs_.size());
    for (const auto& run : runs_) run->restore(in.get_text());
}

MeanError mean_of(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double v : values) sum += v / n;
    for (const double v : values) squares += (v - sum) * (v - sum);
    return {sum, std::sqrt(squares / (n * (n - 1)))};
}

} // namespace sandlane::edmd
