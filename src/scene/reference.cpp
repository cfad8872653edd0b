// The scene reference: an introduction, and the tables of the schema.
#include "scene/fields.hpp"
#include "scene/reader.hpp"

namespace sandlane::scene {

namespace {

constexpr std::string_view introduction = R"(# Scene reference

Written by `sandlane --help-scene`. A scene is a TOML file. This one is complete: 500 grains fall into an open box.

```toml
domain = { upper = [0.2, 0.3], gravity = [0, -9.81] }
md = { duration = "1 s", max_speed = "2 m/s" }

[[materials]]
name = "glass"
young = "300 MPa"
dissipation = "20 us"
friction = 0.5
tangential_damping = "0.2 kg/s"

[[grains]]
kind = "random"
radius = { law = "uniform", min = "3 mm", max = "4 mm" }
lower = [0.02, 0.02]
upper = [0.18, 0.28]
count = 500

[[walls]]
kind = "polyline"
points = [[0.01, 0.29], [0.01, 0.01], [0.19, 0.01], [0.19, 0.29]]
```

`[name]` is one table, `[[name]]` one entry of a list: there can be several materials, populations of grains, walls and
motions. `sandlane check FILE` says what a scene will do; for a mistake it names file, line, key, value and allowed range.
A run writes the scene with every default filled in to `scene.toml` in its folder.

**Units.** A plain number is in SI units, the column "unit" of the tables below. A text brings its own unit:
`"5 mm"`, `"2.5 g/cm^3"`, `"100 MPa"`, `"0.3 kg/s"`, `"30 deg"`. Known are m, km, cm, mm, um; kg, g, mg, t;
s, ms, us, ns, min, h; N, mN, kN, MN; Pa, kPa, MPa, GPa; J, Hz, rpm, rad, deg, %, and their products, quotients and
powers. As an angular velocity `"8 Hz"` is 8 turns per second, 50.3 rad/s. The wrong dimension is an error.

**Two or three dimensions.** With `domain.dimension = 3` vectors have three components, `[x, y, z]`, wherever the
tables say `[x, y]`, and `counts` has columns, rows and layers. A key whose meaning starts with "2D:" or "3D:" exists in
scenes of that dimension only, and so do kinds of walls, the bodies and inertia of discs, the neighbour methods `lattice`
and `lattice-half`, and the trajectory format `book` (all 2D).

**Changes from the command line.** `--set path=value` replaces a key after the file was read, as often as needed:

    sandlane run FILE --set md.duration=0.5 --set materials.0.friction=0.1 --set 'grains.0.radius="4 mm"'

Entries of a list are counted from 0. The value is TOML; a text without quotes is understood where it is not TOML.

**Methods.** `method` chooses what runs the scene; without it, molecular dynamics. Tables that the method does not read are an
error. Those of one method only say so below: "With `method` = ...". Cellular automata have no domain and no units: lengths are
in sites, times, those of `[output]` too, in steps.

**Names.** Grains and walls refer to a material by its name, walls to a motion; with one material the name may be left out.
File names are relative to the folder of the scene file.

)";

// Nothing of what all engines read.
std::string read_by(EngineSet engines) {
    const Choices& names = engine_choices();
    std::vector<std::string> readers;
    for (std::size_t n = 0; n < names.size(); ++n)
        if (engines.contains(static_cast<Engine>(n))) readers.push_back(fmt::format("`\"{}\"`", names[n]));
    return readers.size() == names.size() ? "" : fmt::format("With `method` = {}.", fmt::join(readers, ", "));
}

} // namespace

std::string scene_reference() {
    using enum Engine;
    std::string text = std::string(introduction) + scene_table().reference("(top level)");
#define TABLE(member, name, table, engines) text += table().reference("[" name "]", read_by(engines));
#define LIST(member, name, table, engines) text += table().reference("[[" name "]]", read_by(engines));
#define PART(heading, table, engines) text += table().reference(heading, read_by(engines));
#include "scene/engines.def"
    return text;
}

} // namespace sandlane::scene
