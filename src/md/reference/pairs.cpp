// Forces of single pairs and of listed pairs.
#include "laws/contact.hpp"
#include "md/reference/reference.hpp"

namespace sandlane::simd::reference {

namespace {

template <int dimension, class Tangential, laws::Couples couples>
laws::ContactState<dimension, double> contact_state(const PairView& view, std::int32_t i, std::int32_t j) {
    const Pair<dimension> p(view, i, j);
    const double* a = view.records + std::ptrdiff_t{i} * record_fields;
    const double* b = view.records + std::ptrdiff_t{j} * record_fields;
    const auto sum = [&](int c) {
        return (turn_of<dimension>(b, view.spins, j, c) + turn_of<dimension>(a, view.spins, i, c)) *
               view.inverse_dt;
    };
    const auto difference = [&](int c) {
        return (turn_of<dimension>(a, view.spins, i, c) - turn_of<dimension>(b, view.spins, j, c)) *
               view.inverse_dt;
    };
    const double ri = a[Record<dimension>::radius], rj = b[Record<dimension>::radius];
    laws::ContactState<dimension, double> s{};
    s.radius_sum = p.sum;
    s.inverse_radii = p.inverse_sum;
    s.radius = ri;
    s.other = rj;
    s.square_difference = ri * ri - rj * rj;
    if constexpr (dimension == 2) {
        s.dx = p.d[0];
        s.dy = p.d[1];
        s.dvx = p.dv[0];
        s.dvy = p.dv[1];
        s.spin = (b[Record<2>::spin] + a[Record<2>::spin]) * view.inverse_dt;
        if (couples != laws::Couples::none) s.turn = sum(0), s.differ = difference(0);
    } else {
        s.d = {p.d[0], p.d[1], p.d[2]};
        s.dv = {p.dv[0], p.dv[1], p.dv[2]};
        if constexpr (Tangential::needs_spin) {
            const auto spin = [&](int c) {
                const double of_i = ri * view.spins[std::ptrdiff_t{i} * spin_fields + c];
                const double of_j = rj * view.spins[std::ptrdiff_t{j} * spin_fields + c];
                return (of_j + of_i) * view.inverse_dt;
            };
            s.spin = {spin(0), spin(1), spin(2)};
            s.turn = {sum(0), sum(1), sum(2)};
            s.differ = {difference(0), difference(1), difference(2)};
        }
    }
    return s;
}

// What a contact adds to the accumulator of its first grain.
void make_row(const laws::PairForce<double>& f, double (&row)[4]) {
    row[0] = f.x;
    row[1] = f.y;
    row[2] = f.tangential;
    row[3] = f.couple;
}
template <int fields> void make_row(const laws::SpatialForce<double>& f, double (&row)[fields]) {
    const Vector<double> parts[] = {f.force, f.turning, f.couple};
    for (int p = 0; p < fields / 4; ++p) {
        row[4 * p] = parts[p].x;
        row[4 * p + 1] = parts[p].y;
        row[4 * p + 2] = parts[p].z;
        row[4 * p + 3] = 0;
    }
}
// Null: that partner is not wanted.
template <int dimension, int fields, class Force> void add(const Force& f, double* first, double* second) {
    double row[fields];
    make_row(f, row);
    for (int n = 0; n < fields && first != nullptr; ++n) first[n] += row[n];
    for (int n = 0; n < fields && second != nullptr; ++n)
        second[n] = is_mirrored(dimension, n) ? second[n] - row[n] : second[n] + row[n];
}

template <class Tangential, laws::Couples couples> constexpr Rotation rotation_of() {
    if (couples != laws::Couples::none) return Rotation::couples;
    return Tangential::needs_spin ? Rotation::friction : Rotation::none;
}

template <bool many_materials>
laws::PairCoefficients<double> coefficients(const PairView& view, std::int32_t i, std::int32_t j) {
    std::ptrdiff_t pair = 0;
    if (many_materials) pair = std::ptrdiff_t{view.material[i]} * view.materials + view.material[j];
    return laws::coefficients_from<double>(view.coefficients + pair * laws::pair_coefficients);
}

template <int dimension, class Normal, class Tangential, laws::Couples couples, bool many_materials>
double pair_forces(const PairView& view, const std::int32_t* first, const std::int32_t* second,
                   std::int32_t count, Target target, double largest) {
    constexpr int fields = force_stride(dimension, rotation_of<Tangential, couples>());
    for (std::int32_t n = 0; n < count; ++n) {
        const std::int32_t i = first[n], j = second[n];
        const auto f = laws::pair_force<Normal, Tangential, couples>(
            contact_state<dimension, Tangential, couples>(view, i, j),
            coefficients<many_materials>(view, i, j));
        if (f.overlap > largest) largest = f.overlap;
        const auto of = [&](std::int32_t grain) { return view.force + std::ptrdiff_t{grain} * fields; };
        add<dimension, fields>(f, target != Target::second ? of(i) : nullptr,
                               target != Target::first ? of(j) : nullptr);
    }
    return largest;
}

// Whether the pair touched when the list was looked at last; from now on, whether it does.
bool exchange_touched(const TileList& list, std::int32_t n, bool touches) {
    std::uint8_t& byte = list.touched[n / 8];
    const auto bit = static_cast<std::uint8_t>(1u << (n % 8));
    const bool before = (byte & bit) != 0;
    byte = static_cast<std::uint8_t>(touches ? byte | bit : byte & ~bit);
    return before;
}

template <int dimension, class Normal, class Tangential, laws::Couples couples, bool many_materials>
double tile_forces(const PairView& view, const TileList& list, double* force, double largest) {
    constexpr int fields = force_stride(dimension, rotation_of<Tangential, couples>());
    constexpr int memory = laws::memory_of<Normal, Tangential, couples, dimension>;
    const auto of = [&](std::int32_t grain) { return force + std::ptrdiff_t{grain - list.begin} * fields; };
    for (std::int32_t n = 0; n < list.count; ++n) {
        const std::int32_t i = list.i[n], j = list.j[n];
        const Pair<dimension> pair(view, i, j);
        const bool touches = pair.square < pair.sum * pair.sum;
        double* held = list.memory;
        if constexpr (memory > 0) {
            held += std::ptrdiff_t{n} * memory_row(memory);
            if (!exchange_touched(list, n, touches)) held[0] = laws::no_contact;
        }
        if (!touches) continue;
        const auto f = laws::pair_force<Normal, Tangential, couples>(
            contact_state<dimension, Tangential, couples>(view, i, j),
            coefficients<many_materials>(view, i, j), held, view.dt, view.step);
        if (f.overlap > largest) largest = f.overlap;
        add<dimension, fields>(f, of(i), j >= list.begin && j < list.end ? of(j) : nullptr);
    }
    return largest;
}

template <int dimension, class Normal, class Tangential, laws::Couples couples>
void fill(DimensionKernels::Law& law) {
    constexpr int kind = static_cast<int>(couples);
    if constexpr (laws::exists_with<Tangential, couples>) {
        if constexpr (laws::memory_of<Normal, Tangential, couples, dimension> == 0) {
            law.pair[kind][0] = pair_forces<dimension, Normal, Tangential, couples, false>;
            law.pair[kind][1] = pair_forces<dimension, Normal, Tangential, couples, true>;
        }
        law.tile[kind][0] = tile_forces<dimension, Normal, Tangential, couples, false>;
        law.tile[kind][1] = tile_forces<dimension, Normal, Tangential, couples, true>;
    }
    if constexpr (laws::can_resolve<Normal> && couples == laws::Couples::none) {
        law.resolved[0] = tile_forces<dimension, laws::Resolved<Normal>, Tangential, couples, false>;
        law.resolved[1] = tile_forces<dimension, laws::Resolved<Normal>, Tangential, couples, true>;
    }
}
template <int dimension, class Normal, class Tangential> void fill_couples(DimensionKernels::Law& law) {
    using enum laws::Couples;
    if constexpr (laws::exists_in<Tangential, dimension>) {
        fill<dimension, Normal, Tangential, none>(law);
        fill<dimension, Normal, Tangential, damped>(law);
        fill<dimension, Normal, Tangential, sprung>(law);
    }
}

template <class Normal> void fill_normal(MdKernels& kernels, int normal) {
    int tangential = 0;
#define TANGENTIAL(type, choice, name)                                                                       \
    fill_couples<2, Normal, laws::type>(kernels.plane.law[normal][tangential]);                              \
    fill_couples<3, Normal, laws::type>(kernels.space.law[normal][tangential]);                              \
    ++tangential;
#include "laws/laws.def"
}

} // namespace

void fill_laws(MdKernels& kernels) {
    int normal = 0;
#define NORMAL(type, choice, name, key) fill_normal<laws::type>(kernels, normal++);
#include "laws/laws.def"
}

} // namespace sandlane::simd::reference

namespace sandlane::simd {

const MdKernels& md_kernels_scalar();
const MdKernels& md_kernels_scalar() {
    static const MdKernels table = [] {
        MdKernels t{};
        reference::fill_laws(t);
        reference::fill_search(t);
        reference::fill_motion(t);
        return t;
    }();
    return table;
}

} // namespace sandlane::simd
