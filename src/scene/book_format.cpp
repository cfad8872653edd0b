#include "scene/book_format.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace sandlane::scene {

namespace {

constexpr std::array<std::string_view, 25> columns = {
    "x",  "y",  "phi",    "vx", "vy", "omega", "R",  "m",  "ptype", "Y",  "A",  "mu",  "gamma",
    "Fx", "Fy", "torque", "x2", "y2", "phi2",  "x3", "y3", "phi3",  "x4", "y4", "phi4"};

// Words of a text with their lines.
class Words {
public:
    Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    // The next word stays; empty at the end.
    [[nodiscard]] std::string_view peek() {
        while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
        std::size_t end = at_;
        while (end < text_.size() && !is_space(text_[end])) ++end;
        return text_.substr(at_, end - at_);
    }
    std::string_view take() {
        const std::string_view word = peek();
        at_ += word.size();
        return word;
    }
    template <class... Args>
    [[noreturn]] void reject(fmt::format_string<Args...> format, Args&&... args) const {
        fail(Exit::invalid_input, "{}:{}: {}", file_, line_,
             fmt::format(format, std::forward<Args>(args)...));
    }
    template <class T> T number(const std::string& what) {
        const std::string_view word = take();
        T value{};
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty()) reject("{}: the file ends here; a number is missing", what);
        if (error != std::errc{} || stop != word.data() + word.size())
            reject("{}: \"{}\" is not a {}", what, word, std::is_integral_v<T> ? "whole number" : "number");
        if constexpr (!std::is_integral_v<T>)
            if (!std::isfinite(value)) reject("{}: \"{}\" is not a finite number", what, word);
        return value;
    }

private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 1;
};

// One header line that init files and frames share; false if the keyword is unknown.
bool read_header_entry(Words& words, std::string_view keyword, BookHeader& h) {
    const std::string what(keyword);
    const auto positive = [&] {
        const double value = words.number<double>(what);
        if (!(value > 0)) words.reject("{}: {} is out of range; allowed: above 0", what, value);
        return value;
    };
    const auto count = [&] {
        const auto value = words.number<std::int64_t>(what);
        if (value < 0) words.reject("{}: {} is out of range; allowed: 0 or more", what, value);
        return value;
    };
    if (keyword == "#gravity:") {
        h.gravity.x = words.number<double>(what);
        h.gravity.y = words.number<double>(what);
        h.gravity.z = words.number<double>(what);
    } else if (keyword == "#Time:")
        h.time = words.number<double>(what);
    else if (keyword == "#timestep:")
        h.time_step = positive();
    else if (keyword == "#nstep:")
        h.steps = count();
    else if (keyword == "#nprint:")
        h.print_every = count();
    else if (keyword == "#nenergy:")
        h.energy_every = count();
    else if (keyword == "#lx:")
        h.lx = positive();
    else if (keyword == "#ly:")
        h.ly = positive();
    else if (keyword == "#x_0:")
        h.x_0 = words.number<double>(what);
    else if (keyword == "#y_0:")
        h.y_0 = words.number<double>(what);
    else
        return false;
    return true;
}

BookRecord read_record(Words& words, std::size_t index) {
    const auto what = [&](std::size_t c) {
        return fmt::format("record {}, column {} ({})", index + 1, c + 1, columns[c]);
    };
    std::array<double, 25> v{};
    BookRecord r;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (words.peek().empty())
            words.reject("{}: the file ends inside the record; a record has {} numbers", what(c),
                         columns.size());
        if (c == 8)
            r.type = words.number<int>(what(c));
        else
            v[c] = words.number<double>(what(c));
        if ((c == 6 || c == 7) && !(v[c] > 0))
            words.reject("{}: {} is out of range; allowed: above 0", what(c), v[c]);
        if (c >= 9 && c <= 12 && v[c] < 0)
            words.reject("{}: {} is out of range; allowed: 0 or more", what(c), v[c]);
    }
    r.x = v[0], r.y = v[1], r.phi = v[2], r.vx = v[3], r.vy = v[4], r.omega = v[5];
    r.radius = v[6], r.mass = v[7];
    r.modulus = v[9], r.dissipation = v[10], r.friction = v[11], r.damping = v[12];
    std::copy(v.begin() + 13, v.begin() + 16, r.force.begin());
    std::copy(v.begin() + 16, v.end(), r.derivatives.begin());
    return r;
}

Book read_frame(Words& words) {
    Book frame;
    std::int64_t count = -1;
    for (std::string_view keyword = words.take(); keyword != "#EndOfHeader"; keyword = words.take()) {
        if (keyword.empty()) words.reject("the file ends inside a frame header; #EndOfHeader is missing");
        if (keyword == "#no_of_particles:") {
            count = words.number<std::int64_t>(std::string(keyword));
        } else if (keyword == "#compressed:") {
            if (const auto word = words.take(); word != "no")
                words.reject("#compressed: \"{}\" is not supported; allowed: no", word);
        } else if (keyword == "#type:") {
            if (const auto word = words.take(); word != "SphereXYPhiVxVyOmegaRMFixed25")
                words.reject("#type: \"{}\" is not supported; allowed: SphereXYPhiVxVyOmegaRMFixed25", word);
        } else if (!read_header_entry(words, keyword, frame.header)) {
            words.reject("\"{}\" is not a keyword of a frame header", keyword);
        }
    }
    if (count < 0) words.reject("#no_of_particles: is missing in the frame header or below 0");
    for (std::int64_t n = 0; n < count; ++n)
        frame.records.push_back(read_record(words, static_cast<std::size_t>(n)));
    return frame;
}

void write_record(std::string& text, const BookRecord& r) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{} {} {} {} {} {} {} {} {} {} {} {} {}", r.x, r.y, r.phi, r.vx, r.vy, r.omega,
                   r.radius, r.mass, r.type, r.modulus, r.dissipation, r.friction, r.damping);
    for (const double f : r.force) fmt::format_to(out, " {}", f);
    for (const double d : r.derivatives) fmt::format_to(out, " {}", d);
    text += '\n';
}

} // namespace

Book parse_book(std::string_view text, const std::string& file) {
    Words words(text, file);
    Book book;
    while (words.peek().starts_with('#')) {
        const std::string_view keyword = words.take();
        if (!read_header_entry(words, keyword, book.header))
            words.reject("\"{}\" is not a keyword; known: #gravity:, #Time:, #nstep:, #timestep:, #nprint:, "
                         "#nenergy:, #lx:, #ly:, #x_0:, #y_0:",
                         keyword);
    }
    while (!words.peek().empty()) book.records.push_back(read_record(words, book.records.size()));
    return book;
}

std::vector<Book> parse_book_frames(std::string_view text, const std::string& file) {
    Words words(text, file);
    std::vector<Book> frames;
    for (std::string_view word = words.take(); !word.empty(); word = words.take()) {
        if (word != "#NewFrame") words.reject("\"{}\" stands where #NewFrame should begin a frame", word);
        frames.push_back(read_frame(words));
    }
    return frames;
}

std::string write_book(const Book& book) {
    const BookHeader& h = book.header;
    std::string text = fmt::format("#gravity: {} {} {}\n#Time: {}\n#nstep: {}\n", h.gravity.x, h.gravity.y,
                                   h.gravity.z, h.time, h.steps);
    if (h.time_step > 0) text += fmt::format("#timestep: {}\n", h.time_step);
    text += fmt::format("#nprint: {}\n#nenergy: {}\n#lx: {}\n#ly: {}\n#x_0: {}\n#y_0: {}\n", h.print_every,
                        h.energy_every, h.lx, h.ly, h.x_0, h.y_0);
    for (const BookRecord& r : book.records) write_record(text, r);
    return text;
}

std::string write_book_frame(const Book& book) {
    const BookHeader& h = book.header;
    std::string text = fmt::format("#NewFrame\n#no_of_particles: {}\n#compressed: no\n#type: "
                                   "SphereXYPhiVxVyOmegaRMFixed25\n#gravity: {} {} {}\n#Time: {}\n",
                                   book.records.size(), h.gravity.x, h.gravity.y, h.gravity.z, h.time);
    if (h.time_step > 0) text += fmt::format("#timestep: {}\n", h.time_step);
    text += "#EndOfHeader\n";
    for (const BookRecord& r : book.records) write_record(text, r);
    return text;
}

} // namespace sandlane::scene
