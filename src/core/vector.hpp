// Vectors of space for formulas on R = double or a block of lanes.
#pragma once

#include "core/real.hpp"

namespace sandlane {

template <class R> struct Vector {
    R x, y, z;

    friend SANDLANE_INLINE Vector operator+(const Vector& a, const Vector& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend SANDLANE_INLINE Vector operator-(const Vector& a, const Vector& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend SANDLANE_INLINE Vector operator*(const R& s, const Vector& a) {
        return {s * a.x, s * a.y, s * a.z};
    }
};

template <class R> SANDLANE_INLINE R dot(const Vector<R>& a, const Vector<R>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R> SANDLANE_INLINE Vector<R> cross(const Vector<R>& a, const Vector<R>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class M, class R>
SANDLANE_INLINE Vector<R> select(const M& mask, const Vector<R>& yes, const Vector<R>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}

} // namespace sandlane
