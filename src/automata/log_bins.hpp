// Counts of positive whole numbers in bins of equal ratio: four to an octave.
#pragma once

#include "core/bytes.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

namespace sandlane::automata {

class LogBins {
public:
    static constexpr int per_octave = 4;

    void add(std::int64_t value) {
        ++events_;
        sum_ += static_cast<double>(value);
        if (value < 1) return;
        const std::size_t bin = bin_of(value);
        if (counts_.size() <= bin) counts_.resize(bin + 1, 0);
        ++counts_[bin];
    }

    // Rows of (geometric mean of the bin, counts, counts per event and whole number in the bin); empty bins
    // are left out.
    [[nodiscard]] std::vector<std::vector<double>> rows() const {
        std::vector<std::vector<double>> rows;
        for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
            if (counts_[bin] == 0) continue;
            const double low = lower(bin), high = lower(bin + 1), count = static_cast<double>(counts_[bin]);
            rows.push_back(
                {std::sqrt(low * (high - 1)), count, count / ((high - low) * static_cast<double>(events_))});
        }
        return rows;
    }
    [[nodiscard]] std::int64_t events() const { return events_; }
    [[nodiscard]] double mean() const { return events_ > 0 ? sum_ / static_cast<double>(events_) : 0; }

    void save(ByteWriter& bytes) const {
        bytes.put(events_);
        bytes.put(sum_);
        bytes.put_array(counts_.data(), counts_.size());
    }
    void load(ByteReader& bytes) {
        events_ = bytes.get<std::int64_t>();
        sum_ = bytes.get<double>();
        bytes.get_array(counts_);
    }

private:
    // The smallest whole number of a bin.
    static double lower(std::size_t bin) {
        return std::ceil(std::exp2(static_cast<double>(bin) / per_octave) - 1e-9);
    }
    static std::size_t bin_of(std::int64_t value) {
        auto bin = static_cast<std::size_t>(per_octave * std::log2(static_cast<double>(value)));
        while (bin > 0 && lower(bin) > static_cast<double>(value)) --bin;
        while (lower(bin + 1) <= static_cast<double>(value)) ++bin;
        return bin;
    }

    std::vector<std::uint64_t> counts_;
    std::int64_t events_ = 0;
    double sum_ = 0;
};

} // namespace sandlane::automata
