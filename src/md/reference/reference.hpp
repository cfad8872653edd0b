// The scalar reference of every molecular dynamics kernel: the book's loops, one particle or pair at a time,
// sharing only the formulas (laws/, motion/) with the vector kernels. Compiled without the vectoriser. The
// order of additions is the documented one of simd/md/*.ipp, so results are equal bit for bit.
#pragma once

#include "simd/tables.hpp"

namespace sandlane::simd::reference {

void fill_laws(MdKernels& kernels);   // pairs.cpp
void fill_search(MdKernels& kernels); // search.cpp
void fill_motion(MdKernels& kernels); // motion.cpp

inline double nearest_image(double d, double half, double period) {
    if (d < -half) d += period;
    if (d > half) d -= period;
    return d;
}

// The image across a Lees-Edwards seam stands and moves along x.
inline void cross_seam(const PairView& view, double dy, double& dx, double& shift) {
    if (dy > view.half[1]) dx -= view.seam, shift -= view.seam_shift;
    if (dy < -view.half[1]) dx += view.seam, shift += view.seam_shift;
}

// What one pair is to its law: field f of both records, subtracted or added.
template <int dimension> struct Pair {
    double d[dimension], dv[dimension];
    double square; // of the distance of the centres, nearest image
    double sum;    // R_i + R_j
    double inverse_sum;

    Pair(const PairView& view, std::int32_t i, std::int32_t j) {
        using Fields = Record<dimension>;
        const double* a = view.records + std::ptrdiff_t{i} * record_fields;
        const double* b = view.records + std::ptrdiff_t{j} * record_fields;
        double apart[dimension], shift[dimension];
        for (int k = 0; k < dimension; ++k) {
            apart[k] = b[k] - a[k];
            shift[k] = b[dimension + k] - a[dimension + k];
        }
        if (view.sheared) cross_seam(view, apart[1], apart[0], shift[0]);
        square = 0;
        for (int k = 0; k < dimension; ++k) {
            d[k] = nearest_image(apart[k], view.half[k], view.period[k]);
            dv[k] = shift[k] * view.inverse_dt;
            square = k == 0 ? d[k] * d[k] : square + d[k] * d[k];
        }
        sum = b[Fields::radius] + a[Fields::radius];
        inverse_sum = b[Fields::inverse_radius] + a[Fields::inverse_radius];
    }
};

} // namespace sandlane::simd::reference
