#include "output/report.hpp"

#include "core/file.hpp"
#include "output/camera.hpp"
#include "output/colours.hpp"
#include "output/escape.hpp"
#include "output/page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string_view>

namespace sandlane::output {

namespace {

constexpr std::size_t replay_budget = 3'300'000; // bytes; base64 makes four of three
constexpr std::size_t most_rows = 2000;          // of the log: more than a plot has pixels

std::string colour_map_digits() {
    std::string digits;
    const auto byte = [](float value) { return std::lround(value * 255); };
    for (const Rgb& c : colour_map())
        digits += fmt::format("{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
    return digits;
}

std::string json_vector(Vec v, std::int64_t dimension) {
    const std::string plane = json_number(v.x) + ", " + json_number(v.y);
    return fmt::format("[{}]", dimension == 3 ? plane + ", " + json_number(v.z) : plane);
}

// Axes of the picture, to the right, up, towards the viewer, and up in the world.
std::string json_camera(const Camera& camera) {
    return fmt::format("[{}, {}, {}, {}]", json_vector(camera.right, 3), json_vector(camera.up, 3),
                       json_vector(camera.towards, 3), json_vector(camera.vertical, 3));
}

// Column by column, so that a plot takes what it needs.
std::string log_data(const analysis::Log& log, std::size_t stride) {
    std::string text = "[";
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
        text += fmt::format("{}{{\"name\": {}, \"unit\": {}, \"values\": [", c > 0 ? ",\n" : "",
                            json_text(log.columns[c].name), json_text(log.columns[c].unit));
        for (std::size_t r = 0; r < log.rows.size(); r += stride) {
            if (r > 0) text += ',';
            text += json_number(log.rows[r][c]);
        }
        text += "]}";
    }
    return text + "]";
}

std::string quantities(std::int64_t dimension) {
    std::string text = "[";
    for (int k = 0; k < 4; ++k) {
        const Quantity q = quantity(static_cast<scene::Colour>(k), dimension);
        text += fmt::format("{}{{\"name\": {}, \"unit\": {}}}", k > 0 ? ", " : "", json_text(q.name),
                            json_text(q.unit));
    }
    return text + "]";
}

std::string page_data(const ReportInput& input, std::size_t log_stride, const PackedReplay& replay) {
    const scene::Domain& d = input.scene.domain;
    return fmt::format("{{\"dimension\": {}, \"lower\": {}, \"upper\": {}, \"periodic\": [{}, {}, {}], "
                       "\"camera\": {},\n\"quantities\": {}, \"colour\": {}, \"map\": \"{}\",\n"
                       "\"frames\": {}, \"replayStride\": {}, \"logStride\": {}, \"log\": {}}}",
                       d.dimension, json_vector(d.lower, d.dimension), json_vector(d.upper, d.dimension),
                       d.periodic[0], d.periodic[1], d.periodic[2], json_camera(camera_of(input.scene)),
                       quantities(d.dimension), static_cast<int>(input.scene.output.colour),
                       colour_map_digits(), replay.frames, replay.stride, log_stride,
                       log_data(input.log, log_stride));
}

std::string summary_rows(const ReportInput& input) {
    std::string rows;
    for (const auto& [label, value] : input.summary)
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", html_text(label),
                            html_text(value));
    return rows;
}

std::string figures(const ReportInput& input) {
    std::string text;
    for (const Figure& f : input.figures)
        if (!f.svg.empty())
            text += fmt::format("<figure class=\"card\">{}<figcaption>{}</figcaption></figure>", f.svg,
                                html_text(f.caption));
        else
            text += fmt::format("<figure class=\"card\"><img alt=\"{0}\" src=\"data:image/png;base64,{1}\">"
                                "<figcaption>{0}</figcaption></figure>",
                                html_text(f.caption), base64(f.png));
    return text;
}

// Replaces every {{name}} of the template once: what is filled in is not looked at again.
std::string fill(std::string_view page, const std::map<std::string, std::string, std::less<>>& parts) {
    std::string out;
    while (true) {
        const std::size_t open = page.find("{{"), close = page.find("}}", open);
        if (close == std::string_view::npos) return out.append(page);
        out.append(page.substr(0, open));
        out.append(parts.at(std::string(page.substr(open + 2, close - open - 2))));
        page.remove_prefix(close + 2);
    }
}

} // namespace

void write_report(const std::filesystem::path& path, const ReportInput& input) {
    const PackedReplay replay = pack_replay(input.replay, replay_budget);
    const std::size_t log_stride = input.log.rows.size() / most_rows + 1;
    const std::string& title = input.scene.title;
    write_file_atomically(path, fill(page_html, {{"title", html_text(title.empty() ? "Untitled run" : title)},
                                                 {"description", html_text(input.scene.description)},
                                                 {"css", std::string(page_css)},
                                                 {"script", std::string(page_script)},
                                                 {"summary", summary_rows(input)},
                                                 {"figures", figures(input)},
                                                 {"plan", html_text(input.plan)},
                                                 {"scene", html_text(input.scene_text)},
                                                 {"data", page_data(input, log_stride, replay)},
                                                 {"replay", base64(replay.bytes)}}));
}

} // namespace sandlane::output
