// How many laws there are, and what couples come with them.
#pragma once

namespace sandlane::laws {

inline constexpr int normal_laws = 0
#define NORMAL(type, choice, name, key) +1
#include "laws/laws.def"
    ;
inline constexpr int tangential_laws = 0
#define TANGENTIAL(type, choice, name) +1
#include "laws/laws.def"
    ;

// Couples at a contact, from rolling friction and lever arms other than the radius: none; functions of the
// present motion alone; with a spring against rolling, which the contact remembers.
enum class Couples { none, damped, sprung };
inline constexpr int couple_kinds = 3;

} // namespace sandlane::laws
