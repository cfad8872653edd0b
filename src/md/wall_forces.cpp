// Forces of walls on grains: candidate list, its upkeep, and the kernels, one per law of laws.def.
#include "md/law_choice.hpp"
#include "md/passing_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::md {

namespace {

// A disc is a grain; everything else is flat and moves as its point at the contact does.
laws::PairState<double> state_of(const RecordedGrain& g, const WallContact& c) {
    laws::PairState<double> s{};
    s.dx = c.distance * c.direction.x;
    s.dy = c.distance * c.direction.y;
    s.dvx = c.velocity.x - g.velocity.x;
    s.dvy = c.velocity.y - g.velocity.y;
    s.spin = g.surface_speed + c.spin;
    s.radius_sum = g.radius + c.radius;
    s.inverse_radii = g.inverse_radius + c.inverse_radius;
    const double omega = g.surface_speed * g.inverse_radius;
    s.turn = omega + c.angular_velocity.z;
    s.differ = omega - c.angular_velocity.z;
    s.radius = g.radius;
    s.other = c.radius;
    s.square_difference = flat_or_round(c, g.radius);
    return s;
}

bool is_touched(const WallContact& c, const RecordedGrain& g) {
    return c.valid && c.distance < g.radius + c.radius;
}

// Adds the force of a contact. remembered: its first number, null of laws without memory.
template <class Normal, class Tangential, laws::Couples couples>
void add_contact(const Walls& walls, const WallInput& input, const NearWall& near, const RecordedGrain& g,
                 const WallContact& c, double* remembered, WallResult& result) {
    constexpr int memory = laws::memory_of<Normal, Tangential, couples, 2>;
    const std::size_t i = near.grain;
    const WallElement& element = walls.elements()[near.element];
    const double* k = input.coefficients +
                      (input.material[i] * input.materials + element.material) * laws::pair_coefficients;
    double held[memory + 1];
    for (int m = 0; m < memory; ++m) held[m] = remembered[m * input.stride];
    const auto f = laws::pair_force<Normal, Tangential, couples>(
        state_of(g, c), laws::coefficients_from<double>(k), held, input.dt, input.dt);
    for (int m = 0; m < memory; ++m) remembered[m * input.stride] = held[m];
    double* force = input.force + (i - input.first) * 4;
    force[0] += f.x;
    force[1] += f.y;
    force[2] += f.tangential;
    force[3] += f.couple;
    result.power += f.x * c.velocity.x + f.y * c.velocity.y - f.tangential * c.spin;
    if constexpr (couples != laws::Couples::none) result.power += f.couple * c.angular_velocity.z;
    result.see(f.overlap / g.radius, i, element.wall);
}

RecordedGrain grain_of(const WallInput& input, std::size_t grain) {
    return recorded_grain<2>(input.records + grain * simd::record_fields, nullptr, input.inverse_dt);
}

template <class Normal, class Tangential, laws::Couples couples>
WallResult forces_without_memory(const Walls& walls, const WallInput& input, const NearWall* begin,
                                 const NearWall* end) {
    WallResult result;
    for (const NearWall* n = begin; n != end; ++n) {
        const RecordedGrain g = grain_of(input, n->grain);
        const WallContact c = walls.contact(n->element, g.position);
        if (is_touched(c, g))
            add_contact<Normal, Tangential, couples>(walls, input, *n, g, c, nullptr, result);
    }
    return result;
}

// Grain by grain: a contact that begins may be one that another piece of the wall has lost.
template <class Normal, class Tangential, laws::Couples couples>
WallResult forces_with_memory(const Walls& walls, const WallInput& input, const NearWall* begin,
                              const NearWall* end) {
    WallResult result;
    for (const NearWall *first = begin, *last = begin; first != end; first = last) {
        while (last != end && last->grain == first->grain) ++last;
        const RecordedGrain g = grain_of(input, first->grain);
        const WallCandidates candidates{first, last, input.memory + (first - input.near), input.stride};
        const auto touches = [&](std::uint32_t element) {
            return is_touched(walls.contact(element, g.position), g);
        };
        bool ended = false;
        for (const NearWall* n = first; n != last; ++n) {
            const WallContact c = walls.contact(n->element, g.position);
            double* const remembered = input.memory + (n - input.near);
            if (!is_touched(c, g)) {
                ended = ended || remembers(remembered);
                continue;
            }
            if (!remembers(remembered))
                take_over(walls, g, candidates, n->element, g.position + c.distance * c.direction, touches);
            add_contact<Normal, Tangential, couples>(walls, input, *n, g, c, remembered, result);
        }
        if (ended) forget_ended(walls, candidates, touches);
    }
    return result;
}

template <class Normal, class Tangential, laws::Couples couples> WallKernel kernel_of() {
    if constexpr ((laws::memory_of<Normal, Tangential, couples, 2>) != 0)
        return forces_with_memory<Normal, Tangential, couples>;
    else
        return forces_without_memory<Normal, Tangential, couples>;
}

} // namespace

WallKernel wall_kernel(const Plan& plan) {
    return with_laws(plan.normal, plan.tangential, plan.couples,
                     [&]<class Normal, class Tangential, laws::Couples couples>(
                         Type<Normal>, Type<Tangential>, Kind<couples>) -> WallKernel {
                         if constexpr (laws::can_resolve<Normal> && couples == laws::Couples::none)
                             if (plan.resolved)
                                 return kernel_of<laws::Resolved<Normal>, Tangential, couples>();
                         return kernel_of<Normal, Tangential, couples>();
                     });
}

namespace {

// Coarse grid over the domain: which elements come within `reach` of a cell.
class ElementGrid {
public:
    ElementGrid(const Walls& walls, Vec lower, Vec upper, double reach, std::size_t grains)
        : lower_(lower), width_(upper.x - lower.x), height_(upper.y - lower.y) {
        const double edge = std::max({4 * reach, width_ / 256, height_ / 256,
                                      std::sqrt(width_ * height_ / static_cast<double>(grains + 1))});
        columns_ = std::max(1, static_cast<int>(width_ / edge));
        rows_ = std::max(1, static_cast<int>(height_ / edge));
        cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        const double dx = width_ / columns_, dy = height_ / rows_, radius = 0.5 * std::hypot(dx, dy);
        for (std::size_t e = 0; e < walls.elements().size(); ++e)
            for (int row = 0; row < rows_; ++row)
                for (int column = 0; column < columns_; ++column)
                    if (near(walls.elements()[e], lower + Vec{(column + 0.5) * dx, (row + 0.5) * dy, 0},
                             radius + reach))
                        cells_[static_cast<std::size_t>(row * columns_ + column)].push_back(
                            static_cast<std::uint32_t>(e));
    }

    [[nodiscard]] const std::vector<std::uint32_t>& at(double x, double y) const {
        const int column = std::clamp(static_cast<int>((x - lower_.x) / width_ * columns_), 0, columns_ - 1);
        const int row = std::clamp(static_cast<int>((y - lower_.y) / height_ * rows_), 0, rows_ - 1);
        return cells_[static_cast<std::size_t>(row * columns_ + column)];
    }

private:
    // Whether the element's surface may come within `distance` of p (a superset: whole circles and lines'
    // ends).
    static bool near(const WallElement& e, Vec p, double distance) {
        switch (e.kind) {
        case WallElement::Kind::plane:
            return dot(p - e.a, e.b) < distance;
        case WallElement::Kind::segment:
            return norm(p - closest_on_segment(e, p)) < distance;
        case WallElement::Kind::vertex:
            return norm(p - e.a) < distance;
        case WallElement::Kind::arc:
            return std::abs(norm(p - e.a) - e.radius) < distance;
        case WallElement::Kind::disc:
            return norm(p - e.a) < distance + e.radius;
        case WallElement::Kind::surface:
            break;
        }
        return true;
    }

    Vec lower_;
    double width_, height_;
    int columns_ = 1, rows_ = 1;
    std::vector<std::vector<std::uint32_t>> cells_;
};

// Distance to the surface, without the rules that say whose contact it is: those may change while the list is
// valid.
double surface_distance(const WallElement& e, Vec p) {
    switch (e.kind) {
    case WallElement::Kind::plane:
        return dot(p - e.a, e.b);
    case WallElement::Kind::segment:
        return norm(p - closest_on_segment(e, p));
    case WallElement::Kind::vertex:
        return norm(p - e.a);
    case WallElement::Kind::arc:
        return std::abs(norm(p - e.a) - e.radius);
    case WallElement::Kind::disc:
        return norm(p - e.a) - e.radius;
    case WallElement::Kind::surface:
        break;
    }
    return 0;
}

// Whether the box around the element's surface comes within R of p: spares the reference most of its work.
bool box_reaches(const WallElement& e, Vec p, double radius) {
    if (e.kind == WallElement::Kind::plane) return true;
    const double reach = radius + e.radius;
    return p.x >= std::min(e.a.x, e.b.x) - reach && p.x <= std::max(e.a.x, e.b.x) + reach &&
           p.y >= std::min(e.a.y, e.b.y) - reach && p.y <= std::max(e.a.y, e.b.y) + reach;
}

} // namespace

void Walls::invalidate(const State& state) {
    if (!stale_ && fields_ > 0) remembered_ = memory(state);
    stale_ = true;
}

void Walls::adopt(ContactMemory memory) {
    remembered_ = std::move(memory);
    stale_ = true;
}

ContactMemory Walls::memory(const State& state) const {
    if (stale_) return remembered_;
    ContactMemory result(fields_);
    for (std::size_t n = 0; n < near_.size() && fields_ > 0; ++n)
        if (near_memory_[n] < 0.5 * laws::no_contact)
            result.add_wall(state.id[near_[n].grain], near_[n].element, near_memory_.data() + n,
                            static_cast<std::ptrdiff_t>(near_.size()));
    result.index();
    return result;
}

void Walls::update(const State& state, const double* records) {
    if (!stale_ && budget_ >= 0) return;
    invalidate(state);
    rebuild(state, records);
}

// Where a grain at p may stand while the list lasts, but for the skin: there, or where a periodic side takes
// it.
Walls::Places Walls::places(Vec p) const {
    Places all;
    all.at[0] = p;
    constexpr double Vec::*axes[] = {&Vec::x, &Vec::y, &Vec::z};
    for (std::size_t d = 0; d < 3; ++d) {
        double Vec::*const x = axes[d];
        if (!periodic_[d]) continue;
        const double period = upper_.*x - lower_.*x;
        const bool low = p.*x < lower_.*x + skin_, high = p.*x >= upper_.*x - skin_;
        if (!low && !high) continue;
        const std::size_t known = all.count;
        for (std::size_t n = 0; n < known; ++n) {
            Vec& image = all.at[all.count++];
            image = all.at[n];
            image.*x += low ? period : -period;
        }
    }
    return all;
}

void Walls::list_near_elements(const State& state, const double* records) {
    const ElementGrid grid(*this, lower_, upper_, radius_max_ + 2 * skin_, state.size()); // and outside, too
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double* r = records + i * simd::record_fields;
        found.clear();
        for (const Vec p : places({r[0], r[1], 0}))
            for (const std::uint32_t e : grid.at(p.x, p.y))
                if (surface_distance(elements_[e], p) < r[5] + skin_) found.push_back(e);
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        for (const std::uint32_t e : found) near_.push_back({static_cast<std::uint32_t>(i), e});
        if ((i + 1) % tile_size == 0) tile_begin_.push_back(near_.size());
    }
}

std::vector<double> Walls::memory_of_tile(std::size_t tile) const {
    std::vector<double> values;
    if (tile_begin_.empty()) return values;
    for (std::size_t f = 0; f < static_cast<std::size_t>(fields_); ++f) {
        const double* of_field = near_memory_.data() + f * near_.size();
        values.insert(values.end(), of_field + tile_begin_[tile], of_field + tile_begin_[tile + 1]);
    }
    return values;
}

bool Walls::moves_near(std::size_t tile) const {
    if (tile_begin_.empty()) return false;
    const auto first = near_.begin();
    return std::any_of(first + static_cast<std::ptrdiff_t>(tile_begin_[tile]),
                       first + static_cast<std::ptrdiff_t>(tile_begin_[tile + 1]),
                       [&](const NearWall& n) { return element(n.element).motion >= 0; });
}

void Walls::rebuild(const State& state, const double* records) {
    ++builds_;
    near_.clear();
    tile_begin_.assign(1, 0);
    if (surfaces_)
        list_near_surfaces(state, records);
    else
        list_near_elements(state, records);
    while (tile_begin_.size() <= state.tiles()) tile_begin_.push_back(near_.size());
    budget_ = 0.8 * skin_; // the rest covers what the speed bound of a step misses
    stale_ = false;
    const auto fields = static_cast<std::size_t>(fields_);
    near_memory_.assign(near_.size() * fields, laws::no_contact);
    for (std::size_t n = 0; n < near_.size() && !remembered_.empty(); ++n)
        if (const double* values = remembered_.find_wall(state.id[near_[n].grain], near_[n].element))
            for (std::size_t f = 0; f < fields; ++f) near_memory_[f * near_.size() + n] = values[f];
}

WallResult Walls::add_forces(WallInput input, std::size_t tile, std::size_t grains, bool list) {
    if (list || fields_ > 0) { // memory lies beside the list
        input.near = near_.data();
        input.memory = near_memory_.data();
        input.stride = static_cast<std::ptrdiff_t>(near_.size());
        const NearWall* all = near_.data();
        return kernel_(*this, input, all + tile_begin_[tile], all + tile_begin_[tile + 1]);
    }
    if (surfaces_)
        return add_surface_forces(input, tile * tile_size, std::min(grains, (tile + 1) * tile_size));
    WallResult worst;
    for (std::size_t i = tile * tile_size; i < std::min(grains, (tile + 1) * tile_size); ++i)
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const double* r = input.records + i * simd::record_fields;
            if (!box_reaches(elements_[e], {r[0], r[1], 0}, r[5])) continue;
            const NearWall pair{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(e)};
            worst.add(kernel_(*this, input, &pair, &pair + 1));
        }
    return worst;
}

} // namespace sandlane::md
