#include "scene/fields.hpp"

#include "scene/space.hpp"

#include <algorithm>
#include <numeric>

namespace sandlane::scene {

std::string Range::text() const {
    if (std::isfinite(low) && std::isfinite(high)) return fmt::format("{} to {}", low, high);
    if (std::isfinite(low))
        return fmt::format("{}{}", open ? "above " : "",
                           open ? fmt::format("{}", low) : fmt::format("{} or more", low));
    return "";
}

void fail_at(const Value& value, const std::string& path, const std::string& message) {
    fail(Exit::invalid_input, "{}: {}: {}", value.origin, path, message);
}

namespace {

// Edit distance of two short words.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
    std::string best;
    std::size_t least = word.size() / 2 + 1;
    for (const std::string& candidate : known)
        if (const std::size_t d = distance(word, candidate); d < least) {
            least = d;
            best = candidate;
        }
    return best;
}

std::string shown(const Value& v) {
    switch (v.kind) {
    case Value::Kind::flag:
        return v.flag ? "true" : "false";
    case Value::Kind::integer:
        return fmt::format("{}", v.integer);
    case Value::Kind::number:
        return fmt::format("{}", v.number);
    case Value::Kind::text:
        return fmt::format("\"{}\"", v.text);
    case Value::Kind::array:
        return "a list";
    case Value::Kind::table:
        return "a table";
    }
    return "";
}

} // namespace

void fail_unknown(const Value& value, const std::string& path, const std::vector<std::string>& known) {
    const std::string word = path.substr(path.find_last_of('.') + 1);
    const std::string guess = nearest(word, known);
    std::string all;
    for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
    fail_at(value, path,
            guess.empty() ? fmt::format("unknown key; known here: {}", all)
                          : fmt::format("unknown key; did you mean \"{}\"?", guess));
}

void fail_wrong_dimension(const Value& value, const std::string& path, std::int64_t dimension,
                          const std::string& instead) {
    fail_at(value, path,
            fmt::format("is no key of a {}-dimensional scene{}{}", dimension == 3 ? "three" : "two",
                        instead.empty() ? "" : "; use ", instead));
}

double read_number(const Value& value, const std::string& path, Unit unit, const Range& range) {
    double x = 0;
    if (value.kind == Value::Kind::text) {
        if (const std::string problem = parse_quantity(value.text, unit, x); !problem.empty())
            fail_at(value, path, problem);
    } else if (value.is_number()) {
        x = value.as_number();
    } else {
        fail_at(value, path, fmt::format("{} is not a number", shown(value)));
    }
    if (!std::isfinite(x)) fail_at(value, path, fmt::format("{} is not a finite number", shown(value)));
    if (!range.contains(x))
        fail_at(value, path,
                fmt::format("{} is out of range; allowed: {}{}{}", shown(value), range.text(),
                            unit == Unit::none ? "" : " ", unit_symbol(unit)));
    return x;
}

std::int64_t read_integer(const Value& value, const std::string& path, const Range& range) {
    std::int64_t n = value.integer;
    if (value.kind == Value::Kind::number && value.number == std::floor(value.number) &&
        std::abs(value.number) < 9e15)
        n = static_cast<std::int64_t>(value.number);
    else if (value.kind != Value::Kind::integer)
        fail_at(value, path, fmt::format("{} is not a whole number", shown(value)));
    if (!range.contains(static_cast<double>(n)))
        fail_at(value, path, fmt::format("{} is out of range; allowed: {}", n, range.text()));
    return n;
}

std::string read_text(const Value& value, const std::string& path) {
    if (value.kind != Value::Kind::text)
        fail_at(value, path, fmt::format("{} is not a text in quotes", shown(value)));
    return value.text;
}

Vec read_vector(const Value& value, const std::string& path, Unit unit, std::int64_t dimension) {
    if (value.kind != Value::Kind::array)
        fail_at(value, path,
                fmt::format("{} is not a vector; write {}", shown(value), vector_form(dimension)));
    const std::size_t given = value.items.size();
    if (given != static_cast<std::size_t>(dimension))
        fail_at(value, path,
                fmt::format("has {} components; a {}-dimensional scene needs {}{}", given,
                            dimension == 3 ? "three" : "two", vector_form(dimension),
                            dimension == 2 && given == 3 ? ". Write domain.dimension = 3 for space." : ""));
    Vec v;
    for (const auto& [name, component, n] : axes(dimension))
        v.*component = read_number(value.items[n], fmt::format("{}[{}]", path, n), unit, any);
    return v;
}

int read_choice(const Value& value, const std::string& path, const Choices& choices) {
    const std::string text = read_text(value, path);
    std::vector<std::string> known(choices.begin(), choices.end());
    for (std::size_t n = 0; n < known.size(); ++n)
        if (known[n] == text) return static_cast<int>(n);
    const std::string guess = nearest(text, known);
    std::string all;
    for (const std::string& k : known) all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", k);
    fail_at(value, path,
            fmt::format("\"{}\" is not one of {}{}", text, all,
                        guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)));
}

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else if (code < 0x20 || code == 0x7f)
            result += fmt::format("\\u{:04x}", code);
        else
            result += c;
    }
    return result + "\"";
}

std::string written(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string written(Vec value, std::int64_t dimension) {
    std::vector<std::string> items;
    for (const AxisOfSpace& axis : axes(dimension)) items.push_back(written(value.*axis.component));
    return joined(items);
}

std::string joined(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
    return "[" + text + "]";
}

} // namespace sandlane::scene
