#include "output/field_picture.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "output/picture_frame.hpp"
#include "output/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

namespace sandlane::output {

namespace fs = std::filesystem;

double scale_of(const analysis::Field& field) {
    if (field.high > 0) return field.high;
    std::vector<double> sizes(field.values.size());
    std::transform(field.values.begin(), field.values.end(), sizes.begin(),
                   [](double v) { return std::abs(v); });
    const double usual = usual_high(sizes);
    return usual > 0 ? round_up(usual) : 1;
}

namespace {

// Mean over the sites of a pixel, or the site that the pixel lies in.
class Sampler {
public:
    Sampler(const analysis::Field& field, double pixels_wide, double pixels_high)
        : field_(field), wide_(static_cast<double>(field.columns) / pixels_wide),
          high_(static_cast<double>(field.rows) / pixels_high) {}

    [[nodiscard]] double operator()(int x, int y) const {
        const std::size_t x0 = site(x * wide_, field_.columns), y0 = site(y * high_, field_.rows);
        const std::size_t x1 = std::max(x0 + 1, edge((x + 1) * wide_, field_.columns)),
                          y1 = std::max(y0 + 1, edge((y + 1) * high_, field_.rows));
        double sum = 0;
        for (std::size_t row = y0; row < y1; ++row)
            for (std::size_t column = x0; column < x1; ++column)
                sum += field_.values[row * field_.columns + column];
        return sum / static_cast<double>((x1 - x0) * (y1 - y0));
    }

private:
    static std::size_t site(double at, std::size_t count) {
        return std::min(static_cast<std::size_t>(at), count - 1);
    }
    static std::size_t edge(double at, std::size_t count) {
        return std::min(static_cast<std::size_t>(at), count);
    }

    const analysis::Field& field_;
    double wide_, high_; // sites of a pixel
};

} // namespace

std::string draw_field(const analysis::Field& field, const std::string& caption, double high, int width) {
    const View v =
        make_view({0, 0, 0}, {static_cast<double>(field.columns), static_cast<double>(field.rows), 0}, width);
    Canvas canvas(v.width, v.height, paper);
    draw_ground(canvas, v);
    const int left = static_cast<int>(std::lround(v.left)), right = static_cast<int>(std::lround(v.right));
    const int top = static_cast<int>(std::lround(v.top)), bottom = static_cast<int>(std::lround(v.bottom));
    const Sampler sample(field, right - left, bottom - top);
    const double low = field.is_signed ? -high : 0;
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            canvas.blend(x, y, map_colour((sample(x - left, bottom - 1 - y) - low) / (high - low)), 1);
    canvas.text(v.left, v.baseline() - 10 * v.unit, 13 * v.unit, caption, ink);
    draw_colour_bar(canvas, v, fmt::format("{:.3g}", low), fmt::format("{:.3g}", high),
                    field.unit.empty() ? field.label : fmt::format("{} ({})", field.label, field.unit));
    return canvas.png();
}

FieldSeries::FieldSeries(fs::path folder, int width, const std::string& bookmark)
    : folder_(std::move(folder)), width_(width) {
    if (bookmark.empty()) return;
    const std::string_view words = bookmark;
    const std::size_t blank = words.find(' ');
    if (blank == std::string_view::npos || !read_number(words.substr(0, blank), count_) || count_ < 0 ||
        !read_number(words.substr(blank + 1), high_))
        fail(Exit::io, "{}: the checkpoint holds \"{}\" where the number of pictures is expected",
             folder_.string(), bookmark);
    std::error_code ignored;
    for (std::int64_t number = count_; fs::remove(file(number), ignored); ++number) {
    }
}

fs::path FieldSeries::file(std::int64_t number) const {
    return folder_ / fmt::format("{:06}.png", number);
}

void FieldSeries::write(const analysis::Field& field, const std::string& caption) {
    high_ = std::max(high_, scale_of(field));
    std::error_code status;
    fs::create_directories(folder_, status);
    if (status) fail(Exit::io, "{}: cannot create the folder: {}", folder_.string(), status.message());
    write_file_atomically(file(count_), draw_field(field, caption, high_, width_));
    ++count_;
}

std::string FieldSeries::bookmark() const {
    std::string text = std::to_string(count_) + ' ';
    append(text, high_);
    return text;
}

} // namespace sandlane::output
