#include "output/picture_series.hpp"

#include "core/error.hpp"
#include "output/colours.hpp"
#include "output/text.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

namespace sandlane::output {

namespace fs = std::filesystem;

PictureSeries::PictureSeries(fs::path folder, const scene::Scene& scene, const std::string& bookmark)
    : folder_(std::move(folder)), style_(picture_style(scene)) {
    if (!bookmark.empty()) restore(bookmark);
}

fs::path PictureSeries::file(std::int64_t number) const {
    return folder_ / fmt::format("{:06}.png", number);
}

void PictureSeries::restore(const std::string& bookmark) {
    const std::string_view words = bookmark;
    const std::size_t blank = words.find(' ');
    if (blank == std::string_view::npos || !read_number(words.substr(0, blank), count_) || count_ < 0 ||
        !read_number(words.substr(blank + 1), style_.scale_max))
        fail(Exit::io, "{}: the checkpoint holds \"{}\" where the number of pictures is expected",
             folder_.string(), bookmark);
    // Left by the run that went on after the checkpoint: they would end up in the movie.
    std::error_code ignored;
    for (std::int64_t number = count_; fs::remove(file(number), ignored); ++number) {
    }
}

void PictureSeries::write(const analysis::Snapshot& snapshot) {
    const std::vector<double> values = colour_values(snapshot, style_.colour);
    const double high = style_.colour == scene::Colour::radius ? largest_finite(values) : usual_high(values);
    if (high > 0) style_.scale_max = std::max(style_.scale_max, round_up(high));
    std::error_code status;
    fs::create_directories(folder_, status);
    if (status) fail(Exit::io, "{}: cannot create the folder: {}", folder_.string(), status.message());
    write_picture(file(count_), snapshot, style_);
    ++count_;
}

std::string PictureSeries::bookmark() const {
    std::string text = std::to_string(count_) + ' ';
    append(text, style_.scale_max);
    return text;
}

} // namespace sandlane::output
