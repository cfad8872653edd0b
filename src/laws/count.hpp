// How many laws there are.
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

} // namespace sandlane::laws
