#include "automata/spectrum.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::automata {

namespace {

using Numbers = std::vector<std::complex<double>>;

constexpr std::size_t largest_factor = 32; // that the library need not square

std::size_t largest_prime_factor(std::size_t n) {
    std::size_t largest = 1;
    for (std::size_t p = 2; p * p <= n; ++p)
        for (; n % p == 0; n /= p) largest = p;
    return std::max(largest, n);
}

// By the convolution with a chirp exp(i pi k^2/n), on a power of two (Bluestein 1970).
Numbers chirped(const Numbers& values) {
    const std::size_t n = values.size(), m = std::bit_ceil(2 * n - 1);
    Numbers chirp(n), a(m, 0), b(m, 0), transformed, product(m);
    for (std::size_t k = 0; k < n; ++k) {
        const auto turns = static_cast<double>(k * k % (2 * n)) / static_cast<double>(n); // of half a circle
        chirp[k] = std::polar(1.0, std::numbers::pi * turns);
        a[k] = values[k] * std::conj(chirp[k]);
        b[k] = b[(m - k) % m] = chirp[k];
    }
    Eigen::FFT<double> transform;
    transform.fwd(transformed, a);
    transform.fwd(product, b);
    for (std::size_t k = 0; k < m; ++k) product[k] *= transformed[k];
    transform.inv(a, product);
    a.resize(n);
    for (std::size_t k = 0; k < n; ++k) a[k] *= std::conj(chirp[k]);
    return a;
}

} // namespace

std::vector<std::complex<double>> fourier(const std::vector<std::complex<double>>& values) {
    if (values.size() < 2) return values; // the library wants more
    if (largest_prime_factor(values.size()) > largest_factor) return chirped(values);
    Numbers transformed;
    Eigen::FFT<double> transform;
    transform.fwd(transformed, values);
    return transformed;
}

Spectrum welch(std::span<const double> series, std::size_t length) {
    Spectrum result;
    if (length < 4 || series.size() < length) return result;
    std::vector<double> sums(length / 2, 0), window(length);
    double weight = 0;
    for (std::size_t i = 0; i < length; ++i) {
        window[i] =
            0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length));
        weight += window[i] * window[i];
    }
    std::size_t pieces = 0;
    for (std::size_t start = 0; start + length <= series.size(); start += length / 2, ++pieces) {
        double mean = 0;
        for (std::size_t i = 0; i < length; ++i) mean += series[start + i];
        mean /= static_cast<double>(length);
        std::vector<std::complex<double>> values(length);
        for (std::size_t i = 0; i < length; ++i) values[i] = window[i] * (series[start + i] - mean);
        const std::vector<std::complex<double>> transformed = fourier(values);
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += std::norm(transformed[k + 1]);
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        result.frequency.push_back(static_cast<double>(k + 1) / static_cast<double>(length));
        result.power.push_back(2 * sums[k] / (weight * static_cast<double>(pieces)));
    }
    return result;
}

Line fit_line(std::span<const double> x, std::span<const double> y) {
    const double n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    Line line;
    line.slope = xy / xx;
    line.offset = mean_y - line.slope * mean_x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off = y[i] - line.offset - line.slope * x[i];
        rest += off * off;
    }
    line.error = n > 2 ? std::sqrt(rest / (n - 2) / xx) : std::numeric_limits<double>::infinity();
    return line;
}

Line power_law(const Spectrum& spectrum, double from, double to) {
    constexpr double bins_per_octave = 3;
    std::vector<double> x, y;
    std::size_t k = 0;
    while (k < spectrum.frequency.size() && spectrum.frequency[k] < from) ++k;
    while (k < spectrum.frequency.size() && spectrum.frequency[k] <= to) {
        const double end = spectrum.frequency[k] * std::exp2(1 / bins_per_octave);
        double power = 0, logs = 0, count = 0;
        for (; k < spectrum.frequency.size() && spectrum.frequency[k] < end; ++k, ++count) {
            power += spectrum.power[k];
            logs += std::log(spectrum.frequency[k]);
        }
        if (!(power > 0)) continue;
        x.push_back(logs / count);
        y.push_back(std::log(power / count));
    }
    if (x.size() < 3) return {0, 0, std::numeric_limits<double>::infinity()};
    Line line = fit_line(x, y);
    line.slope = -line.slope;
    return line;
}

} // namespace sandlane::automata
