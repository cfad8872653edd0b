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

// Calls body(Type<Normal>, Type<Tangential>, bool_constant<couples>); couples need a law with spins.
template <class Body> auto with_laws(int normal, int tangential, bool couples, const Body& body) {
    return with_normal_law(normal, [&]<class Normal>(Type<Normal> n) {
        return with_tangential_law(tangential, [&]<class Tangential>(Type<Tangential> t) {
            if constexpr (Tangential::needs_spin)
                if (couples) return body(n, t, std::true_type{});
            return body(n, t, std::false_type{});
        });
    });
}

} // namespace sandlane::md
