#include "output/log.hpp"

#include "core/error.hpp"
#include "output/single_file.hpp"
#include "output/text.hpp"

#include <string_view>

namespace sandlane::output {

using analysis::Log;
using analysis::LogColumn;

namespace {

std::string header(const std::vector<LogColumn>& columns) {
    std::string text;
    for (const LogColumn& column : columns) {
        if (!text.empty()) text += ',';
        text += column.name;
        if (!column.unit.empty()) text += '[' + column.unit + ']';
    }
    return text + '\n';
}

void append_row(std::string& text, const std::vector<double>& row) {
    for (const double value : row) {
        append(text, value);
        text += ',';
    }
    text.back() = '\n';
}

template <class Cell> void for_cells(std::string_view line, const Cell& cell) {
    while (true) {
        const std::size_t comma = line.find(',');
        cell(line.substr(0, comma));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
    }
}

LogColumn parse_column(std::string_view cell) {
    const std::size_t bracket = cell.find('[');
    if (bracket == std::string_view::npos || cell.back() != ']') return {std::string(cell), ""};
    return {std::string(cell.substr(0, bracket)),
            std::string(cell.substr(bracket + 1, cell.size() - bracket - 2))};
}

std::vector<double> parse_row(std::string_view line, const std::filesystem::path& path, std::size_t number) {
    std::vector<double> row;
    for_cells(line, [&](std::string_view cell) {
        double value = 0;
        if (!read_number(cell, value))
            fail(Exit::invalid_input, "{}:{}: \"{}\" is not a number", path.string(), number, cell);
        row.push_back(value);
    });
    return row;
}

} // namespace

std::string log_text(const Log& table) {
    std::string text = header(table.columns);
    for (const std::vector<double>& row : table.rows) append_row(text, row);
    return text;
}

LogWriter::LogWriter(const std::filesystem::path& path, const std::vector<LogColumn>& columns,
                     const std::string& bookmark)
    : file_(path, length_in(bookmark, path)), columns_(columns.size()) {
    if (!bookmark.empty()) return;
    file_.write(header(columns));
    file_.flush();
}

void LogWriter::write(std::span<const std::vector<double>> rows) {
    std::string text;
    for (const std::vector<double>& row : rows) {
        if (row.size() != columns_)
            fail(Exit::internal, "{}: a row of {} numbers for {} columns", file_.path().string(), row.size(),
                 columns_);
        append_row(text, row);
    }
    file_.write(text);
    file_.flush();
}

std::string LogWriter::bookmark() {
    file_.flush();
    return std::to_string(file_.position());
}

Log read_log(const std::filesystem::path& path) {
    return parse_log(read_file(path), path);
}

Log parse_log(std::string_view text, const std::filesystem::path& path) {
    std::string_view rest = text;
    Log log;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos)
            fail(Exit::invalid_input, "{}:{}: the last line is incomplete", path.string(), number);
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (number == 1) {
            for_cells(line, [&](std::string_view cell) { log.columns.push_back(parse_column(cell)); });
            continue;
        }
        log.rows.push_back(parse_row(line, path, number));
        if (log.rows.back().size() != log.columns.size())
            fail(Exit::invalid_input, "{}:{}: {} numbers for {} columns", path.string(), number,
                 log.rows.back().size(), log.columns.size());
    }
    if (log.columns.empty()) fail(Exit::invalid_input, "{}: is empty, it has no header", path.string());
    return log;
}

} // namespace sandlane::output
