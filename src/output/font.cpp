#include "output/font.hpp"

#include <array>
#include <string>

namespace sandlane::output {

namespace {

struct Drawing {
    char character;
    const char* rows; // '#' is a dot, '/' ends a row
};

constexpr Drawing drawings[] = {
    {'0', ".##./#..#/#..#/#..#/#..#/#..#/.##."},
    {'1', ".#/##/.#/.#/.#/.#/.#"},
    {'2', ".##./#..#/...#/..#./.#../#.../####"},
    {'3', ".##./#..#/...#/.##./...#/#..#/.##."},
    {'4', "...#./..##./.#.#./#..#./#####/...#./...#."},
    {'5', "####/#.../###./...#/...#/#..#/.##."},
    {'6', ".##./#.../#.../###./#..#/#..#/.##."},
    {'7', "####/...#/...#/..#./..#./.#../.#.."},
    {'8', ".##./#..#/#..#/.##./#..#/#..#/.##."},
    {'9', ".##./#..#/#..#/.###/...#/...#/.##."},
    {'.', "././././././#"},
    {',', "../../../../../.#/.#/#."},
    {':', "./././#/././#"},
    {'-', "..../..../..../####"},
    {'+', "...../...../..#../..#../#####/..#../..#.."},
    {'>', "#..../.#.../..#../...#./..#../.#.../#...."},
    {'=', "..../..../..../####/..../####"},
    {'/', "....#/...#./...#./..#../.#.../.#.../#...."},
    {'(', ".#/#./#./#./#./#./.#"},
    {')', "#./.#/.#/.#/.#/.#/#."},
    {'|', "#/#/#/#/#/#/#"},
    {'_', "..../..../..../..../..../..../..../####"},
    {'a', "..../..../.##./...#/.###/#..#/.###"},
    {'b', "#.../#.../###./#..#/#..#/#..#/###."},
    {'c', "..../..../.##./#..#/#.../#..#/.##."},
    {'d', "...#/...#/.###/#..#/#..#/#..#/.###"},
    {'e', "..../..../.##./#..#/####/#.../.###"},
    {'f', ".##/#../###/#../#../#../#.."},
    {'g', "..../..../.###/#..#/#..#/#..#/.###/...#/.##."},
    {'h', "#.../#.../###./#..#/#..#/#..#/#..#"},
    {'i', "#/./#/#/#/#/#"},
    {'j', ".#/../.#/.#/.#/.#/.#/.#/#."},
    {'k', "#.../#.../#..#/#.#./##../#.#./#..#"},
    {'l', "#./#./#./#./#./#./.#"},
    {'m', "...../...../####./#.#.#/#.#.#/#.#.#/#.#.#"},
    {'n', "..../..../###./#..#/#..#/#..#/#..#"},
    {'o', "..../..../.##./#..#/#..#/#..#/.##."},
    {'p', "..../..../###./#..#/#..#/#..#/###./#.../#..."},
    {'q', "..../..../.###/#..#/#..#/#..#/.###/...#/...#"},
    {'r', ".../.../#.#/##./#../#../#.."},
    {'s', "..../..../.###/#.../.##./...#/###."},
    {'t', "#../#../###/#../#../#../.##"},
    {'u', "..../..../#..#/#..#/#..#/#..#/.###"},
    {'v', "...../...../#...#/#...#/.#.#./.#.#./..#.."},
    {'w', "...../...../#.#.#/#.#.#/#.#.#/#.#.#/.#.#."},
    {'x', "..../..../#..#/#..#/.##./#..#/#..#"},
    {'y', "..../..../#..#/#..#/#..#/#..#/.###/...#/.##."},
    {'z', "..../..../####/...#/..#./.#../####"},
    {'G', ".###./#...#/#..../#.###/#...#/#...#/.###."},
    {'J', "...#/...#/...#/...#/#..#/#..#/.##."},
    {'M', "#...#/##.##/#.#.#/#.#.#/#...#/#...#/#...#"},
    {'N', "#...#/##..#/##..#/#.#.#/#..##/#..##/#...#"},
    {'P', "###./#..#/#..#/###./#.../#.../#..."},
};

constexpr int columns = 5, rows = 9;
using Dots = std::array<std::array<bool, columns + 2>, rows + 2>; // with an empty frame around

Dots read_dots(std::string_view drawing, double& width) {
    Dots dots{};
    std::size_t row = 1, column = 1, widest = 1;
    for (const char c : drawing) {
        if (c == '/') {
            ++row;
            column = 1;
            continue;
        }
        dots[row][column] = c == '#';
        widest = column > widest ? column : widest;
        ++column;
    }
    width = static_cast<double>(widest - 1);
    return dots;
}

// Diagonal neighbours are joined only where no dot beside them already makes the corner.
Glyph join(const Dots& d, double width) {
    Glyph glyph;
    glyph.width = width;
    for (std::size_t y = 1; y <= rows; ++y) {
        for (std::size_t x = 1; x <= columns; ++x) {
            if (!d[y][x]) continue;
            const double px = static_cast<double>(x) - 1, py = static_cast<double>(y) - 1;
            bool alone = !(d[y - 1][x] || d[y][x - 1] || d[y - 1][x - 1] || d[y - 1][x + 1]);
            const auto add = [&](double dx, double dy) {
                glyph.lines.push_back({px, py, px + dx, py + dy});
                alone = false;
            };
            if (d[y][x + 1]) add(1, 0);
            if (d[y + 1][x]) add(0, 1);
            if (d[y + 1][x + 1] && !d[y][x + 1] && !d[y + 1][x]) add(1, 1);
            if (d[y + 1][x - 1] && !d[y][x - 1] && !d[y + 1][x]) add(-1, 1);
            if (alone) add(0, 0);
        }
    }
    return glyph;
}

std::array<Glyph, 128> build_font() {
    std::array<Glyph, 128> font;
    double width = 0;
    const Dots box = read_dots("####/#..#/#..#/#..#/#..#/#..#/####", width);
    for (Glyph& entry : font) entry = join(box, width);
    for (const Drawing& drawing : drawings) {
        const Dots dots = read_dots(drawing.rows, width);
        font[static_cast<unsigned char>(drawing.character)] = join(dots, width);
    }
    font[' '] = Glyph{{}, 1.5};
    return font;
}

} // namespace

const Glyph& glyph(char c) {
    static const std::array<Glyph, 128> font = build_font();
    const auto code = static_cast<unsigned char>(c);
    return font[code < font.size() ? code : 0];
}

double text_width(std::string_view words) {
    double width = 0;
    for (const char c : words) width += glyph(c).width + glyph_gap;
    return words.empty() ? 0 : width - glyph_gap;
}

} // namespace sandlane::output
