// The keys of [watch].
#include "scene/fields.hpp"

namespace sandlane::scene {

namespace {

void read_limit(WatchLimit& limit, const Value& v, const std::string& path) {
    const Range range = not_negative();
    if (v.kind != Value::Kind::array || v.items.size() != 2)
        fail_at(v, path, "must be [warning, stop], two numbers; 0: no such limit");
    limit.asked = true;
    limit.warn = read_number(v.items[0], path, Unit::none, range);
    limit.stop = read_number(v.items[1], path, Unit::none, range);
    if (limit.stop > 0 && limit.warn > limit.stop)
        fail_at(v, path,
                fmt::format("[{}, {}]: the warning must not lie above the stop", limit.warn, limit.stop));
}

Field<Watch> limit(const char* name, WatchLimit Watch::*member, std::string doc) {
    return {name,
            "[warning, stop]",
            "",
            "0 or more",
            std::move(doc),
            false,
            [member](Watch& w, const Value& v, const std::string& path, std::int64_t) {
                read_limit(w.*member, v, path);
            },
            [member](const Watch& w, std::int64_t) {
                const WatchLimit& l = w.*member;
                return l.asked ? fmt::format("[{}, {}]", written(l.warn), written(l.stop)) : std::string();
            }};
}

} // namespace

const Table<Watch>& watch_table() {
    static const Table<Watch> table =
        Table<Watch>("Errors that a run watches of itself (docs/physics.md, section 14): what is given is "
                     "measured with every row of log.csv and written there and into summary.json. Above the "
                     "first number there is a warning, above the second the run ends with exit code 6; 0: no "
                     "such limit.")
            .custom(
                limit("largest_overlap", &Watch::overlap,
                      "overlap of a contact over the smaller radius; also looked at between rows. Not dsmc"))
            .custom(limit(
                "energy_residual", &Watch::energy,
                "kinetic and potential energy against the work of forces; without loss all energy. Gases: only "
                "without loss"))
            .custom(
                limit("momentum_error", &Watch::momentum,
                      "net momentum against the impulses of gravity and walls; not with shear_rate. Gases: "
                      "only where nothing changes it"))
            .custom(limit("step_error", &Watch::step,
                          "energy of a collision with this time step and with half of it, root mean square "
                          "over a random sample of the contacts. md"))
            .integer("sample", &Watch::sample, between(1, 100000),
                     "md: contacts in the sample of step_error");
    return table;
}

} // namespace sandlane::scene
