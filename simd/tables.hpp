// The single door between src/ and simd/: plain views of columns, and one table of kernel functions per
// instruction set. The table named `scalar` is the reference: simple loops written separately in
// src/md/reference.
#pragma once

#include "laws/count.hpp"
#include "simd/records.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace sandlane::simd {

enum class Isa { scalar, sse4_2, avx2, avx512 };

// What a pair kernel reads and writes. Open sides: period 0, half period infinite.
struct PairView {
    const double *records, *spins; // spins: 3D with rotation, else null
    const std::int32_t* material;
    double* force;
    double period[3], half[3];
    const double* coefficients; // laws::PairCoefficients [materials][materials]
    std::int32_t materials;
    double dt, inverse_dt; // s: between two evaluations of a contact that remembers
    double step;           // s: of laws that resolve begin and end of a contact
    // Lees-Edwards: the image beyond the upper y side stands this far along x, [-1/2, 1/2) of the period, and
    // moves by so much more per step.
    bool sheared;
    double seam, seam_shift; // m
};

// Which images of a pair are looked at.
enum class Images { none, periodic, sheared };

// Which partners of a pair get the force.
enum class Target { both, first, second };

// Evaluates `count` pairs (i, j) and adds their forces in list order; returns the largest overlap [m] (or
// `largest`).
using PairKernel = double (*)(const PairView&, const std::int32_t* i, const std::int32_t* j,
                              std::int32_t count, Target target, double largest);

// L-vectors (docs/physics.md 10): one entry per site, row-major with a halo of `reach` sites on every
// side. Positions are single precision and relative to the centre of their site: the distance
// stage finds a superset of the contacts, the pair kernels decide in double from the records, so the results
// are those of double. Periodic images need no shift. Empty sites hold x = 1e15 and owner -1; sites
// of the domain start at `origin`.
struct LatticeView {
    const float *x, *y, *radius; // radius carries the margin
    const std::int32_t* owner;
    std::ptrdiff_t row_stride, origin;
    std::int32_t columns, rows, reach;
    const std::int32_t* offsets;      // full mask, ascending; the half mask is its second half
    const float *offset_x, *offset_y; // the same in m
    float uniform_square;             // (2 R)^2 with margin, when all radii are equal
};
inline constexpr float empty_site = 1e15F;
// Widening of the single-precision contact distance, 2^-19 of the distance (2^-18 of its square).
inline constexpr double lattice_margin = 1.0 + 0x1p-19;
// Sites that are looked at together; fixes the order of additions of the half mask.
inline constexpr int site_group = 16;
// Widening of the squared contact distance in double precision: candidates are a superset, pair kernels
// decide.
inline constexpr double candidate_margin = 1.0 + 0x1p-40;

struct SweepResult {
    double largest_overlap = 0; // m
    std::int64_t occupied = 0;  // sites with a particle: equals N unless two shared a site
};
using LatticeKernel = SweepResult (*)(const LatticeView&, const PairView&, PairKernel, std::int32_t row_begin,
                                      std::int32_t row_end);

// Verlet lists: pairs of grains whose gap is small, cut into tiles of consecutive grains so that nothing is
// written by two tiles. A pair inside the tile is listed once, i < j; a pair with a grain j of another tile
// is listed for i only, and once more in the other tile. Ascending in i, then j: the order of additions is a
// function of the storage order alone, not of when or how the list was made.
inline constexpr std::int32_t tile_grains = 1024; // fixed, so that results do not depend on threads
struct TileList {
    const std::int32_t *i, *j; // storage indices, begin <= i < end
    std::int32_t count, begin, end;
    Images images; // none: no pair is nearest across a periodic side
    // Of laws that remember: the numbers of pair n stand at memory[n * memory_row], and bit n of `touched`
    // says that they are those of a contact that lasts.
    double* memory;
    std::uint8_t* touched;
};
// Adds the forces of the listed pairs that touch to the grains of the tile, in list order; `force` is the
// accumulator of grain `begin`, with a row behind the last of a whole tile that takes what is not wanted.
// Returns the largest overlap [m] (or `largest`).
using TileKernel = double (*)(const PairView&, const TileList&, double* force, double largest);

// Copies the pairs whose gap is below `skin`, in order, and their positions in the list; all lists have room
// for eight pairs more than `count`.
using NearKernel = std::int32_t (*)(const PairView&, const std::int32_t* i, const std::int32_t* j,
                                    std::int32_t count, double skin, std::int32_t* near_i,
                                    std::int32_t* near_j, std::int32_t* position);

// The grid of one class of radii, where there are several: cells as wide as the largest grains of the class
// at least.
struct CellGrid {
    const std::int32_t* start;        // cells + 1 entries
    std::int32_t count[3], first_row; // columns, rows, layers; its first row of those of all classes
    double lower[3], inverse_edge[3]; // m, 1/m
    double radius;                    // of its largest grain, m
};
// Link cells: particles counting-sorted by class and cell, columns innermost. One cell in a direction means
// "all particles" in that direction; a plane has one layer.
struct CellView {
    const double *position[3], *radius;
    const std::int32_t* owner;
    const std::int32_t* start; // of the only class: cells + 1 entries
    std::int32_t count[3];     // columns, rows, layers
    bool periodic[3];
    bool sheared; // beyond the y sides all columns are neighbours
    std::int32_t classes;
    const CellGrid* grids; // of more than one class, from the smallest radii up
};
// Widening of the distance within which cells are looked at: rounding of positions never exceeds it.
inline constexpr double cell_margin = 1.0 + 0x1p-30;
// Grains whose gap to the grain at sorted position `self`, which stands in `cell`, is below `skin`: storage
// indices in the order of classes and cells. `out` has room for all grains of the cells that are looked at
// and eight more.
using CandidateKernel = std::int32_t (*)(const CellView&, const PairView&, std::int32_t cell,
                                         std::int32_t self, double skin, std::int32_t* out);
// Rows of all layers and classes are numbered through: row + rows * layer + first_row.
using CellKernel = SweepResult (*)(const CellView&, const PairView&, PairKernel, std::int32_t row_begin,
                                   std::int32_t row_end);

// State of the integrator: values k = 0 and 1 of the Nordsieck vector are the records', the others lie in
// blocks of eight particles, gear[block][dof * (order - 2) + k - 2][lane], dof = x, y, (z,) rotation. The new
// state may go to other records than the old one comes from.
struct MotionView {
    double* gear;
    const double *records, *spins;
    double *new_records, *new_spins;
    double* force; // of the first particle of the range
    const double* inverse_mass;
    double inverse_inertia; // 1/c of J = c m R^2
    std::int32_t* image[3];
    double half_dt2;
    double gravity[3], gravity_spin; // 2D: G_phi
    double lower[3], upper[3];
    double period[3]; // 0: open
    bool sheared;     // Lees-Edwards, as in PairView, at t + dt
    double seam, seam_shift;
};
struct MotionResult {
    double largest_shift2 = 0; // m^2, of the predicted displacements per step
    std::int64_t outside = 0;  // particles outside the domain after wrapping, or NaN
    double seam_gain = 0;      // kg m^2: kinetic energy times dt^2 that crossing the seam gave
};
// correct: forces -> state at t. predict: state at t -> state at t + dt. advance: both, in one pass.
using MotionKernel = MotionResult (*)(const MotionView&, std::int64_t begin, std::int64_t end);

// Site (or cell) of each particle, computed from its record; conflict free because a site holds one centre.
struct BinView {
    const double* records;
    std::int32_t* site;
    double lower[3], edge[3];
    std::int32_t count[3];
    std::ptrdiff_t stride[3], origin; // of columns, rows, layers
    // For the lattice, else null: position relative to the centre of the site [m], and whether the site has
    // an image in the halo (closer than `reach` to an edge).
    float *relative_x, *relative_y;
    std::uint8_t* edge_site;
    std::int32_t reach;
};
using BinKernel = void (*)(const BinView&, std::int64_t begin, std::int64_t end);

// Kernels of the plane or of space.
struct DimensionKernels {
    // [laws::Couples][many materials]; null for laws that remember, which need lists, and for laws that the
    // dimension does not have
    struct Law {
        PairKernel pair[laws::couple_kinds][2];
        TileKernel tile[laws::couple_kinds][2];
        TileKernel resolved[2]; // [many materials], begin and end of contacts resolved; without couples
    };
    Law law[laws::normal_laws][laws::tangential_laws];
    CellKernel cells;
    CandidateKernel candidates;
    NearKernel near_pairs;
    MotionKernel predict[5][rotations], correct[5][rotations], advance[5][rotations]; // [scheme - 3]
    BinKernel bin;
};

struct MdKernels {
    DimensionKernels plane, space;
    LatticeKernel lattice_full[2]; // [many radii]; plane only
    LatticeKernel lattice_half[2];

    [[nodiscard]] const DimensionKernels& in(int dimension) const { return dimension == 3 ? space : plane; }
};

[[nodiscard]] const MdKernels& md_kernels(Isa isa);

// ---- dispatch

[[nodiscard]] std::string_view isa_name(Isa isa);
[[nodiscard]] std::optional<Isa> isa_from_name(std::string_view name);
[[nodiscard]] bool isa_built(Isa isa);     // this binary holds its kernels
[[nodiscard]] bool isa_supported(Isa isa); // and this machine can run them
[[nodiscard]] std::vector<Isa> available_isas();

// name: "auto" or an instruction set. Throws Error(invalid_input) for an unknown name, Error(unavailable) for
// one that this machine lacks. "auto" honours SANDLANE_ISA.
[[nodiscard]] Isa choose_isa(std::string_view name);

} // namespace sandlane::simd
