// Forces of walls in 3D on grains, one kernel per law of laws.def.
#include "md/law_choice.hpp"
#include "md/passing_contacts.hpp"

#include <algorithm>

namespace sandlane::md {

namespace {

using Entry = SurfaceContacts::Entry;

// Contacts that passed to another triangle take their memory along.
void pass_on(const Walls& walls, const RecordedGrain& g, const std::vector<Entry>& touching,
             const WallCandidates& candidates) {
    const auto touches = [&](std::uint32_t element) {
        return std::any_of(touching.begin(), touching.end(),
                           [&](const Entry& t) { return t.element == element; });
    };
    for (const Entry& t : touching)
        if (!remembers(candidates.of(t.element)))
            take_over(walls, g, candidates, t.element, g.position + t.contact.distance * t.contact.direction,
                      touches);
    forget_ended(walls, candidates, touches);
}

Vector<double> vector(Vec v) {
    return {v.x, v.y, v.z};
}

// n from the grain to the wall, which is flat and moves as its point at the contact does.
laws::SpatialState<double> state_of(const RecordedGrain& g, const WallContact& c) {
    return {vector(c.distance * c.direction),
            vector(c.velocity - g.velocity),
            vector(g.radius * g.angular_velocity),
            vector(g.angular_velocity + c.angular_velocity),
            g.radius,
            g.inverse_radius,
            vector(g.angular_velocity - c.angular_velocity),
            g.radius,
            c.radius,
            flat_or_round(c, g.radius)};
}

// As many of the vectors as the accumulator has room for.
void add_to(double* accumulator, const laws::SpatialForce<double>& f, int fields) {
    const Vector<double> parts[] = {f.force, f.turning, f.couple};
    for (int p = 0; p < fields / 4; ++p) {
        accumulator[4 * p] += parts[p].x;
        accumulator[4 * p + 1] += parts[p].y;
        accumulator[4 * p + 2] += parts[p].z;
    }
}

template <class Normal, class Tangential, laws::Couples couples>
laws::SpatialForce<double> force_of(const RecordedGrain& g, const WallContact& c, const double* coefficients,
                                    double* remembered, std::ptrdiff_t stride, double dt) {
    constexpr int memory = laws::memory_of<Normal, Tangential, couples, 3>;
    double held[memory + 1];
    for (int m = 0; m < memory; ++m) held[m] = remembered[m * stride];
    const auto f = laws::pair_force<Normal, Tangential, couples>(
        state_of(g, c), laws::coefficients_from<double>(coefficients), held, dt, dt);
    for (int m = 0; m < memory; ++m) remembered[m * stride] = held[m];
    return f;
}

template <class Normal, class Tangential, laws::Couples couples>
WallResult surface_forces(const Walls& walls, const WallInput& input, const NearWall* begin,
                          const NearWall* end) {
    constexpr bool has_memory = (laws::memory_of<Normal, Tangential, couples, 3>) != 0;
    WallResult result;
    SurfaceContacts contacts;
    for (const NearWall *first = begin, *last = begin; first != end; first = last) {
        const std::size_t i = first->grain;
        while (last != end && last->grain == i) ++last;
        const double* spin = input.spins != nullptr ? input.spins + i * simd::spin_fields : nullptr;
        const RecordedGrain g =
            recorded_grain<3>(input.records + i * simd::record_fields, spin, input.inverse_dt);
        walls.find_contacts(g.position, g.radius, first, last, contacts);
        WallCandidates candidates{first, last, nullptr, input.stride};
        if constexpr (has_memory) {
            candidates.memory = input.memory + (first - input.near);
            pass_on(walls, g, contacts.entries, candidates);
        }
        for (const auto& [e, c] : contacts.entries) {
            const WallElement& element = walls.element(e);
            const double* k = input.coefficients + (input.material[i] * input.materials + element.material) *
                                                       laws::pair_coefficients;
            const auto f = force_of<Normal, Tangential, couples>(
                g, c, k, has_memory ? candidates.of(e) : nullptr, input.stride, input.dt);
            add_to(input.force + (i - input.first) * static_cast<std::size_t>(input.force_stride), f,
                   input.force_stride);
            result.power += f.force.x * c.velocity.x + f.force.y * c.velocity.y + f.force.z * c.velocity.z;
            if constexpr (couples != laws::Couples::none)
                result.power += f.couple.x * c.angular_velocity.x + f.couple.y * c.angular_velocity.y +
                                f.couple.z * c.angular_velocity.z;
            result.see(f.overlap / g.radius, i, element.wall);
        }
    }
    return result;
}

} // namespace

WallKernel surface_kernel(const Plan& plan) {
    return with_laws(plan.normal, plan.tangential, plan.couples,
                     [&]<class Normal, class Tangential, laws::Couples couples>(
                         Type<Normal>, Type<Tangential>, Kind<couples>) -> WallKernel {
                         if constexpr (!laws::exists_in<Tangential, 3>)
                             return nullptr;
                         else {
                             if constexpr (laws::can_resolve<Normal> && couples == laws::Couples::none)
                                 if (plan.resolved)
                                     return surface_forces<laws::Resolved<Normal>, Tangential, couples>;
                             return surface_forces<Normal, Tangential, couples>;
                         }
                     });
}

} // namespace sandlane::md
