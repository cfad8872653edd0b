// From the positions of two laws in laws.def to their types: the one place where a choice at run time becomes
// a kernel.
#pragma once

#include "laws/contact.hpp"

#include <cstdlib>
#include <type_traits>

namespace sandlane::md {

template <class Law> using Type = std::type_identity<Law>;

// Calls body(Type<Law>) with the law at this position.
template <class Body> auto with_normal_law(int normal, const Body& body) {
    int position = 0;
#define NORMAL(type, choice, name, key)                                                                      \
    if (position++ == normal) return body(Type<laws::type>{});
#include "laws/laws.def"
    std::abort();
}
template <class Body> auto with_tangential_law(int tangential, const Body& body) {
    int position = 0;
#define TANGENTIAL(type, choice, name)                                                                       \
    if (position++ == tangential) return body(Type<laws::type>{});
#include "laws/laws.def"
    std::abort();
}

template <laws::Couples couples> using Kind = std::integral_constant<laws::Couples, couples>;

// Calls body(Type<Normal>, Type<Tangential>, Kind<couples>); couples that the law does not have: without.
template <class Body> auto with_laws(int normal, int tangential, laws::Couples couples, const Body& body) {
    using enum laws::Couples;
    return with_normal_law(normal, [&]<class Normal>(Type<Normal> n) {
        return with_tangential_law(tangential, [&]<class Tangential>(Type<Tangential> t) {
            if constexpr (laws::exists_with<Tangential, sprung>)
                if (couples == sprung) return body(n, t, Kind<sprung>{});
            if constexpr (laws::exists_with<Tangential, damped>)
                if (couples == damped) return body(n, t, Kind<damped>{});
            return body(n, t, Kind<none>{});
        });
    });
}

} // namespace sandlane::md
