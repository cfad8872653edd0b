// Power spectra of series, and straight lines through clouds of points.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace sandlane::automata {

// Discrete Fourier transform, sum over j of values[j] exp(-2 pi i j k/n), of any length n in n log n steps.
[[nodiscard]] std::vector<std::complex<double>> fourier(const std::vector<std::complex<double>>& values);

struct Spectrum {
    std::vector<double> frequency, power; // in cycles per sample, above 0; power per frequency
};
// Welch's periodogram: Hann windows of `length` that overlap by half, means removed.
[[nodiscard]] Spectrum welch(std::span<const double> series, std::size_t length);

struct Line {
    double slope = 0, offset = 0, error = 0; // error: standard error of the slope
};
// Least squares.
[[nodiscard]] Line fit_line(std::span<const double> x, std::span<const double> y);

// Exponent of power ~ f^-alpha between two frequencies, fitted to means over bins of equal ratio, so that
// each octave has the same weight.
[[nodiscard]] Line power_law(const Spectrum& spectrum, double from, double to);

} // namespace sandlane::automata
