// log.csv: one row per time, the header "time[s],kinetic_energy[J],contacts,...", numbers that read back to
// the same bits.
#pragma once

#include "analysis/snapshot.hpp"
#include "core/file.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::output {

// The same as one text. Every row has one number per column.
[[nodiscard]] std::string log_text(const analysis::Log& table);

class LogWriter {
public:
    // bookmark: empty for a new file, else what bookmark() returned before; the rows after it are cut off.
    LogWriter(const std::filesystem::path& path, const std::vector<analysis::LogColumn>& columns,
              const std::string& bookmark = {});

    // Appends the rows and flushes. Every row has one number per column.
    void write(std::span<const std::vector<double>> rows);
    [[nodiscard]] std::string bookmark();

private:
    OutputFile file_;
    std::size_t columns_;
};

// Throws Error(invalid_input) with "path:line: ..." for anything but a complete table.
[[nodiscard]] analysis::Log read_log(const std::filesystem::path& path);
[[nodiscard]] analysis::Log parse_log(std::string_view text, const std::filesystem::path& path);

} // namespace sandlane::output
