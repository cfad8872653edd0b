// Forces of single pairs and of listed pairs.
#include "laws/contact.hpp"
#include "md/reference/reference.hpp"

namespace sandlane::simd::reference {

namespace {

template <int dimension>
laws::ContactState<dimension, double> contact_state(const PairView& view, std::int32_t i, std::int32_t j) {
    const Pair<dimension> p(view, i, j);
    if constexpr (dimension == 2) {
        const double* a = view.records + std::ptrdiff_t{i} * record_fields;
        const double* b = view.records + std::ptrdiff_t{j} * record_fields;
        const double spin = (b[Record<2>::spin] + a[Record<2>::spin]) * view.inverse_dt;
        return {p.d[0], p.d[1], p.dv[0], p.dv[1], spin, p.sum, p.inverse_sum};
    } else {
        laws::SpatialState<double> s{
            {p.d[0], p.d[1], p.d[2]}, {p.dv[0], p.dv[1], p.dv[2]}, {}, {}, p.sum, p.inverse_sum};
        if (view.spins == nullptr) return s;
        const double* a = view.spins + std::ptrdiff_t{i} * spin_fields;
        const double* b = view.spins + std::ptrdiff_t{j} * spin_fields;
        const auto spin = [&](int k) { return (b[3] * b[k] + a[3] * a[k]) * view.inverse_dt; };
        const auto turn = [&](int k) { return (b[k] + a[k]) * view.inverse_dt; };
        s.spin = {spin(0), spin(1), spin(2)};
        s.turn = {turn(0), turn(1), turn(2)};
        return s;
    }
}

void add_first(const laws::PairForce<double>& f, double* row) {
    row[0] += f.x;
    row[1] += f.y;
    row[2] += f.tangential;
}
void add_second(const laws::PairForce<double>& f, double* row) {
    row[0] -= f.x;
    row[1] -= f.y;
    row[2] += f.tangential;
}
void add_turning(const laws::SpatialForce<double>& f, double* row) {
    row[4] += f.turning.x;
    row[5] += f.turning.y;
    row[6] += f.turning.z;
}
void add_first(const laws::SpatialForce<double>& f, double* row) {
    row[0] += f.force.x;
    row[1] += f.force.y;
    row[2] += f.force.z;
}
void add_second(const laws::SpatialForce<double>& f, double* row) {
    row[0] -= f.force.x;
    row[1] -= f.force.y;
    row[2] -= f.force.z;
}
template <int fields, class Force> void add(const Force& f, double* first, double* second) {
    if (first != nullptr) add_first(f, first);
    if (second != nullptr) add_second(f, second);
    if constexpr (fields == 8) {
        if (first != nullptr) add_turning(f, first);
        if (second != nullptr) add_turning(f, second);
    }
}

template <bool many_materials>
laws::PairCoefficients<double> coefficients(const PairView& view, std::int32_t i, std::int32_t j) {
    std::ptrdiff_t pair = 0;
    if (many_materials) pair = std::ptrdiff_t{view.material[i]} * view.materials + view.material[j];
    return laws::coefficients_from<double>(view.coefficients + pair * laws::pair_coefficients);
}

template <int dimension, class Normal, class Tangential, bool many_materials>
double pair_forces(const PairView& view, const std::int32_t* first, const std::int32_t* second,
                   std::int32_t count, Target target, double largest) {
    constexpr int fields = force_stride(dimension, Tangential::needs_spin);
    for (std::int32_t n = 0; n < count; ++n) {
        const std::int32_t i = first[n], j = second[n];
        const auto f = laws::pair_force<Normal, Tangential, double>(contact_state<dimension>(view, i, j),
                                                                    coefficients<many_materials>(view, i, j));
        if (f.overlap > largest) largest = f.overlap;
        const auto of = [&](std::int32_t grain) { return view.force + std::ptrdiff_t{grain} * fields; };
        add<fields>(f, target != Target::second ? of(i) : nullptr, target != Target::first ? of(j) : nullptr);
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

template <int dimension, class Normal, class Tangential, bool many_materials>
double tile_forces(const PairView& view, const TileList& list, double* force, double largest) {
    constexpr int fields = force_stride(dimension, Tangential::needs_spin);
    constexpr int memory = laws::memory_of<Normal, Tangential, dimension>;
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
        const auto f = laws::pair_force<Normal, Tangential, double>(
            contact_state<dimension>(view, i, j), coefficients<many_materials>(view, i, j), held, view.dt);
        if (f.overlap > largest) largest = f.overlap;
        add<fields>(f, of(i), j >= list.begin && j < list.end ? of(j) : nullptr);
    }
    return largest;
}

template <int dimension, class Normal, class Tangential>
void fill(DimensionKernels& kernels, int normal, int tangential) {
    if constexpr (laws::memory_of<Normal, Tangential, dimension> == 0) {
        kernels.pair[normal][tangential][0] = pair_forces<dimension, Normal, Tangential, false>;
        kernels.pair[normal][tangential][1] = pair_forces<dimension, Normal, Tangential, true>;
    }
    kernels.tile[normal][tangential][0] = tile_forces<dimension, Normal, Tangential, false>;
    kernels.tile[normal][tangential][1] = tile_forces<dimension, Normal, Tangential, true>;
}

template <class Normal> void fill_normal(MdKernels& kernels, int normal) {
    int tangential = 0;
#define TANGENTIAL(type, choice, name)                                                                       \
    fill<2, Normal, laws::type>(kernels.plane, normal, tangential);                                          \
    fill<3, Normal, laws::type>(kernels.space, normal, tangential);                                          \
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
