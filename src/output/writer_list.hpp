// The trajectory formats. A new one: a file with its factory, and one line in each of the two lists here.
#pragma once

#include "output/writers.hpp"

#include <array>

namespace sandlane::output {

using WriterFactory = std::unique_ptr<TrajectoryWriter> (*)(const std::filesystem::path& folder,
                                                            const scene::Scene& scene,
                                                            const std::string& bookmark);

std::unique_ptr<TrajectoryWriter> make_dump(const std::filesystem::path&, const scene::Scene&,
                                            const std::string&);
std::unique_ptr<TrajectoryWriter> make_xyz(const std::filesystem::path&, const scene::Scene&,
                                           const std::string&);
std::unique_ptr<TrajectoryWriter> make_vtp(const std::filesystem::path&, const scene::Scene&,
                                           const std::string&);
std::unique_ptr<TrajectoryWriter> make_book(const std::filesystem::path&, const scene::Scene&,
                                            const std::string&);

struct WriterEntry {
    scene::Trajectory kind;
    WriterFactory make;
};

inline constexpr std::array writer_list{
    WriterEntry{scene::Trajectory::dump, make_dump},
    WriterEntry{scene::Trajectory::xyz, make_xyz},
    WriterEntry{scene::Trajectory::vtp, make_vtp},
    WriterEntry{scene::Trajectory::book, make_book},
};

} // namespace sandlane::output
