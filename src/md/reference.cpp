// The scalar reference of every molecular dynamics kernel: the book's loops, one particle or pair at a time,
// sharing only the formulas (laws/, motion/) with the vector kernels. Compiled without the vectoriser. The
// order of additions is the documented one of simd/md/*.ipp, so results are equal bit for bit.
#include "laws/contact.hpp"
#include "motion/gear.hpp"
#include "simd/tables.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::simd {

namespace {

struct Particle {
    double x, y, vx, vy, spin, radius, inverse_radius;
};

Particle particle(const PairView& view, std::int32_t i) {
    const double* r = view.records + std::ptrdiff_t{i} * record_fields;
    return {r[0], r[1], r[2], r[3], r[4], r[5], r[6]};
}

double nearest_image(double d, double half, double period) {
    if (d < -half) d += period;
    if (d > half) d -= period;
    return d;
}

template <class Normal, class Tangential, bool many_materials>
double pair_forces(const PairView& view, const std::int32_t* first, const std::int32_t* second,
                   std::int32_t count, Target target, double largest) {
    for (std::int32_t n = 0; n < count; ++n) {
        const Particle a = particle(view, first[n]), b = particle(view, second[n]);
        std::ptrdiff_t pair = 0;
        if (many_materials)
            pair = std::ptrdiff_t{view.material[first[n]]} * view.materials + view.material[second[n]];
        const double* c = view.coefficients + pair * laws::pair_coefficients;
        const laws::PairState<double> state{nearest_image(b.x - a.x, view.half_x, view.period_x),
                                            nearest_image(b.y - a.y, view.half_y, view.period_y),
                                            b.vx - a.vx,
                                            b.vy - a.vy,
                                            b.spin + a.spin,
                                            b.radius + a.radius,
                                            b.inverse_radius + a.inverse_radius};
        const auto f =
            laws::pair_force<Normal, Tangential, double>(state, laws::coefficients_from<double>(c));
        if (f.overlap > largest) largest = f.overlap;
        double* on_first = view.force + std::ptrdiff_t{first[n]} * force_fields;
        double* on_second = view.force + std::ptrdiff_t{second[n]} * force_fields;
        if (target != Target::second) {
            on_first[0] += f.x;
            on_first[1] += f.y;
            on_first[2] += f.tangential;
        }
        if (target != Target::first) {
            on_second[0] -= f.x;
            on_second[1] -= f.y;
            on_second[2] += f.tangential;
        }
    }
    return largest;
}

// Evaluates one pair as soon as it is found.
struct Visit {
    const PairView& view;
    PairKernel kernel;
    Target target;
    double largest = 0;

    void operator()(std::int32_t i, std::int32_t j) { largest = kernel(view, &i, &j, 1, target, largest); }
};

// Whether two particles are close enough to be worth the law, in double precision from their records.
bool near(const PairView& view, std::int32_t i, std::int32_t j) {
    const Particle a = particle(view, i), b = particle(view, j);
    const double dx = nearest_image(b.x - a.x, view.half_x, view.period_x);
    const double dy = nearest_image(b.y - a.y, view.half_y, view.period_y);
    const double sum = b.radius + a.radius;
    return dx * dx + dy * dy < sum * sum * candidate_margin;
}

// Sites of one row with mask offsets [k_begin, k_end): full mask, site by site.
std::int64_t visit_row(const LatticeView& lattice, std::int32_t row, int k_begin, int k_end, Visit& visit) {
    std::int64_t occupied = 0;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    for (std::ptrdiff_t site = row_start; site < row_start + lattice.columns; ++site) {
        const std::int32_t i = lattice.owner[site];
        if (i < 0) continue;
        ++occupied;
        for (int k = k_begin; k < k_end; ++k) {
            const std::int32_t j = lattice.owner[site + lattice.offsets[k]];
            if (j >= 0 && near(visit.view, i, j)) visit(i, j);
        }
    }
    return occupied;
}

// The half mask adds to both partners, so its order matters: groups of sites, then offsets, then sites.
std::int64_t visit_row_grouped(const LatticeView& lattice, std::int32_t row, int k_begin, int k_end,
                               Visit& visit) {
    std::int64_t occupied = 0;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    const std::ptrdiff_t row_end = row_start + lattice.columns;
    for (std::ptrdiff_t first = row_start; first < row_end; first += site_group) {
        const std::ptrdiff_t last = first + site_group < row_end ? first + site_group : row_end;
        for (std::ptrdiff_t site = first; site < last; ++site) occupied += lattice.owner[site] >= 0 ? 1 : 0;
        for (int k = k_begin; k < k_end; ++k)
            for (std::ptrdiff_t site = first; site < last; ++site) {
                const std::int32_t i = lattice.owner[site], j = lattice.owner[site + lattice.offsets[k]];
                if (i >= 0 && j >= 0 && near(visit.view, i, j)) visit(i, j);
            }
    }
    return occupied;
}

SweepResult lattice_full(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int offsets = (2 * lattice.reach + 1) * (2 * lattice.reach + 1) - 1;
    Visit visit{view, kernel, Target::first};
    SweepResult result;
    for (std::int32_t row = row_begin; row < row_end; ++row)
        result.occupied += visit_row(lattice, row, 0, offsets, visit);
    result.largest_overlap = visit.largest;
    return result;
}

SweepResult lattice_half(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int side = 2 * lattice.reach + 1;
    const int begin = (side * side - 1) / 2;
    SweepResult result;
    // Offsets [first, last) of row distances a, by target, in the order rows above, tile, rows below.
    const auto pass = [&](std::int32_t row_first, std::int32_t row_last, Target target) {
        Visit visit{view, kernel, target, result.largest_overlap};
        for (std::int32_t row = row_first; row < row_last; ++row) {
            const int all = begin + lattice.reach + lattice.reach * side;
            const int to_tile = begin + lattice.reach + (row_begin - 1 - row) * side;
            const int to_end = begin + lattice.reach + (row_end - 1 - row) * side;
            const int cut = to_end < all ? to_end : all;
            if (target == Target::second) visit_row_grouped(lattice, row, to_tile, all, visit);
            if (target == Target::both) result.occupied += visit_row_grouped(lattice, row, begin, cut, visit);
            if (target == Target::first) visit_row_grouped(lattice, row, cut, all, visit);
        }
        result.largest_overlap = visit.largest;
    };
    pass(row_begin - lattice.reach, row_begin, Target::second);
    pass(row_begin, row_end, Target::both);
    pass(row_begin, row_end, Target::first);
    return result;
}

// All particles of the cells next to (column, row), each cell once, rows outermost.
template <class Body>
void for_neighbour_cells(std::int32_t c, std::int32_t cells, bool periodic, const Body& body) {
    if (cells == 1) return body(0);
    std::int32_t neighbours[3] = {c - 1, c, c + 1};
    if (periodic && c == 0) neighbours[0] = c, neighbours[1] = c + 1, neighbours[2] = cells - 1;
    if (periodic && c == cells - 1) neighbours[0] = 0, neighbours[1] = c - 1, neighbours[2] = c;
    for (const std::int32_t n : neighbours)
        if (n >= 0 && n < cells) body(n);
}

SweepResult cells_full(const CellView& cells, const PairView& view, PairKernel kernel, std::int32_t row_begin,
                       std::int32_t row_end) {
    Visit visit{view, kernel, Target::first};
    SweepResult result;
    const auto visit_cell = [&](std::int32_t self, std::ptrdiff_t other) {
        for (std::int32_t n = cells.start[other]; n < cells.start[other + 1]; ++n) {
            if (n == self) continue;
            const double dx = nearest_image(cells.x[n] - cells.x[self], view.half_x, view.period_x);
            const double dy = nearest_image(cells.y[n] - cells.y[self], view.half_y, view.period_y);
            const double sum = cells.radius[n] + cells.radius[self];
            if (dx * dx + dy * dy < sum * sum * candidate_margin) visit(cells.owner[self], cells.owner[n]);
        }
    };
    for (std::int32_t row = row_begin; row < row_end; ++row)
        for (std::int32_t column = 0; column < cells.columns; ++column) {
            const std::ptrdiff_t cell = std::ptrdiff_t{row} * cells.columns + column;
            result.occupied += cells.start[cell + 1] - cells.start[cell];
            for (std::int32_t self = cells.start[cell]; self < cells.start[cell + 1]; ++self)
                for_neighbour_cells(row, cells.rows, cells.periodic_y, [&](std::int32_t r) {
                    for_neighbour_cells(column, cells.columns, cells.periodic_x, [&](std::int32_t c) {
                        visit_cell(self, std::ptrdiff_t{r} * cells.columns + c);
                    });
                });
        }
    result.largest_overlap = visit.largest;
    return result;
}

// All grains around the cell, looked at one by one.
std::int32_t cell_candidates(const CellView& cells, const PairView& view, std::int32_t cell,
                             std::int32_t self, double skin, std::int32_t* out) {
    std::int32_t count = 0;
    for_neighbour_cells(cell / cells.columns, cells.rows, cells.periodic_y, [&](std::int32_t r) {
        for_neighbour_cells(cell % cells.columns, cells.columns, cells.periodic_x, [&](std::int32_t c) {
            const std::ptrdiff_t other = std::ptrdiff_t{r} * cells.columns + c;
            for (std::int32_t n = cells.start[other]; n < cells.start[other + 1]; ++n) {
                const double dx = nearest_image(cells.x[n] - cells.x[self], view.half_x, view.period_x);
                const double dy = nearest_image(cells.y[n] - cells.y[self], view.half_y, view.period_y);
                const double reach = cells.radius[n] + (cells.radius[self] + skin);
                if (n != self && dx * dx + dy * dy < reach * reach) out[count++] = cells.owner[n];
            }
        });
    });
    return count;
}

std::int32_t near_pairs(const PairView& view, const std::int32_t* i, const std::int32_t* j,
                        std::int32_t count, double skin, std::int32_t* near_i, std::int32_t* near_j,
                        std::int32_t* position) {
    std::int32_t found = 0;
    for (std::int32_t n = 0; n < count; ++n) {
        const Particle a = particle(view, i[n]), b = particle(view, j[n]);
        const double dx = nearest_image(b.x - a.x, view.half_x, view.period_x);
        const double dy = nearest_image(b.y - a.y, view.half_y, view.period_y);
        const double reach = b.radius + a.radius + skin;
        if (!(dx * dx + dy * dy < reach * reach)) continue;
        position[found] = n;
        near_i[found] = i[n];
        near_j[found++] = j[n];
    }
    return found;
}

template <class Normal, class Tangential, bool many_materials>
double tile_forces(const PairView& view, const TileList& list, double* force, double largest) {
    for (std::int32_t n = 0; n < list.count; ++n) {
        const std::int32_t i = list.i[n], j = list.j[n];
        const Particle a = particle(view, i), b = particle(view, j);
        const double dx = nearest_image(b.x - a.x, view.half_x, view.period_x);
        const double dy = nearest_image(b.y - a.y, view.half_y, view.period_y);
        const double sum = b.radius + a.radius;
        constexpr int memory = laws::memory_of<Tangential>;
        double held[memory + 1];
        for (int m = 0; m < memory; ++m) held[m] = list.memory[m * list.stride + n];
        if (!(dx * dx + dy * dy < sum * sum)) {
            for (int m = 0; m < memory; ++m) list.memory[m * list.stride + n] = laws::no_contact;
            continue;
        }
        std::ptrdiff_t pair = 0;
        if (many_materials) pair = std::ptrdiff_t{view.material[i]} * view.materials + view.material[j];
        const double* c = view.coefficients + pair * laws::pair_coefficients;
        const laws::PairState<double> state{
            dx, dy, b.vx - a.vx, b.vy - a.vy, b.spin + a.spin, sum, b.inverse_radius + a.inverse_radius};
        const auto f = laws::pair_force<Normal, Tangential, double>(state, laws::coefficients_from<double>(c),
                                                                    held, view.dt);
        for (int m = 0; m < memory; ++m) list.memory[m * list.stride + n] = held[m];
        if (f.overlap > largest) largest = f.overlap;
        double* on_i = force + std::ptrdiff_t{i - list.begin} * force_fields;
        on_i[0] += f.x;
        on_i[1] += f.y;
        on_i[2] += f.tangential;
        if (j < list.begin || j >= list.end) continue;
        double* on_j = force + std::ptrdiff_t{j - list.begin} * force_fields;
        on_j[0] -= f.x;
        on_j[1] -= f.y;
        on_j[2] += f.tangential;
    }
    return largest;
}

double wrap(double x, double lower, double upper, double period, std::int32_t& image) {
    if (x < lower) {
        --image;
        x += period;
        return x >= upper ? lower : x;
    }
    if (x >= upper) {
        ++image;
        x -= period;
    }
    return x;
}

template <int order, bool spin, bool do_correct, bool do_predict>
MotionResult gear_step(const MotionView& view, std::int64_t begin, std::int64_t end) {
    constexpr int dofs = spin ? 3 : 2;
    MotionResult result;
    for (std::int64_t i = begin; i < end; ++i) {
        double* block = view.gear + (i - i % 8) * dofs * order + i % 8;
        double* force = view.force + (i - begin) * force_fields;
        double* record = view.records + i * record_fields;
        const double acceleration[3] = {force[0] * view.inverse_mass[i] + view.gravity_x,
                                        force[1] * view.inverse_mass[i] + view.gravity_y,
                                        spin ? force[2] * view.spin_factor[i] + view.gravity_phi : 0.0};
        double values[dofs][order];
        for (int dof = 0; dof < dofs; ++dof) {
            for (int k = 0; k < order; ++k) values[dof][k] = block[(dof * order + k) * 8];
            if (do_correct) motion::gear_correct(values[dof], acceleration[dof], view.half_dt2);
            if (do_predict) motion::gear_predict(values[dof]);
        }
        if (do_correct) force[0] = force[1] = force[2] = 0.0;
        if (do_predict) {
            double &x = values[0][0], &y = values[1][0];
            if (view.period_x > 0) x = wrap(x, view.lower_x, view.upper_x, view.period_x, view.image_x[i]);
            if (view.period_y > 0) y = wrap(y, view.lower_y, view.upper_y, view.period_y, view.image_y[i]);
            if (!(x >= view.lower_x && x < view.upper_x && y >= view.lower_y && y < view.upper_y))
                ++result.outside;
            record[0] = x;
            record[1] = y;
            record[2] = values[0][1] * view.inverse_dt;
            record[3] = values[1][1] * view.inverse_dt;
            if constexpr (spin) record[4] = view.radius[i] * (values[2][1] * view.inverse_dt);
            const double speed2 = record[2] * record[2] + record[3] * record[3];
            if (speed2 > result.largest_speed2) result.largest_speed2 = speed2;
        }
        for (int dof = 0; dof < dofs; ++dof)
            for (int k = 0; k < order; ++k) block[(dof * order + k) * 8] = values[dof][k];
    }
    return result;
}

void bin_sites(const BinView& view, std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
        const double* r = view.records + i * record_fields;
        const double x = r[0] - view.lower_x, y = r[1] - view.lower_y;
        auto column = static_cast<std::int32_t>(std::floor(x * (1.0 / view.dx)));
        auto row = static_cast<std::int32_t>(std::floor(y * (1.0 / view.dy)));
        column = std::clamp(column, 0, view.columns - 1);
        row = std::clamp(row, 0, view.rows - 1);
        view.site[i] = static_cast<std::int32_t>(view.origin + row * view.row_stride + column);
        if (view.relative_x == nullptr) continue;
        view.relative_x[i] = static_cast<float>(x - (column + 0.5) * view.dx);
        view.relative_y[i] = static_cast<float>(y - (row + 0.5) * view.dy);
        const bool interior = column >= view.reach && column < view.columns - view.reach &&
                              row >= view.reach && row < view.rows - view.reach;
        view.edge[i] = interior ? 0 : 1;
    }
}

template <int order, bool spin> void fill_motion(MdKernels& t) {
    t.predict[order - 3][spin] = gear_step<order, spin, false, true>;
    t.correct[order - 3][spin] = gear_step<order, spin, true, false>;
    t.advance[order - 3][spin] = gear_step<order, spin, true, true>;
}

template <class Normal, class Tangential> void fill_law(PairKernel (&pair)[2], TileKernel (&tile)[2]) {
    if constexpr (Tangential::memory == 0) {
        pair[0] = pair_forces<Normal, Tangential, false>;
        pair[1] = pair_forces<Normal, Tangential, true>;
    }
    tile[0] = tile_forces<Normal, Tangential, false>;
    tile[1] = tile_forces<Normal, Tangential, true>;
}

template <class Normal>
void fill_laws(PairKernel (&pair)[laws::tangential_laws][2], TileKernel (&tile)[laws::tangential_laws][2]) {
    int law = 0;
#define TANGENTIAL(type, choice, name)                                                                       \
    fill_law<Normal, laws::type>(pair[law], tile[law]);                                                      \
    ++law;
#include "laws/laws.def"
}

MdKernels make_table() {
    MdKernels t{};
    int law = 0;
#define NORMAL(type, choice, name, key)                                                                      \
    fill_laws<laws::type>(t.pair[law], t.tile[law]);                                                         \
    ++law;
#include "laws/laws.def"
    t.lattice_full[0] = t.lattice_full[1] = lattice_full;
    t.lattice_half[0] = t.lattice_half[1] = lattice_half;
    t.cells = cells_full;
    t.candidates = cell_candidates;
    t.near_pairs = near_pairs;
    fill_motion<3, false>(t);
    fill_motion<3, true>(t);
    fill_motion<4, false>(t);
    fill_motion<4, true>(t);
    fill_motion<5, false>(t);
    fill_motion<5, true>(t);
    fill_motion<6, false>(t);
    fill_motion<6, true>(t);
    t.bin = bin_sites;
    return t;
}

} // namespace

const MdKernels& md_kernels_scalar();
const MdKernels& md_kernels_scalar() {
    static const MdKernels table = make_table();
    return table;
}

} // namespace sandlane::simd
