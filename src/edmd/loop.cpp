// The loop over events.
#include "core/parallel.hpp"
#include "edmd/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sandlane::edmd {

using simd::HardEvents;
using simd::HardState;
using simd::image_of;
using simd::never_meets;
using simd::no_partner;

namespace {

std::uint32_t kind_of(const HardState& s) {
    return static_cast<std::uint32_t>(s.word >> 48);
}
laws::Flight<double> flight_of(const HardState& s) {
    return {{s.place[0], s.place[1], s.place[2]}, {s.velocity[0], s.velocity[1], s.velocity[2]}, s.time};
}
double key_of(const HardEvents& e) {
    return e.first_time < e.crossing_time ? e.first_time : e.crossing_time;
}

} // namespace

// ---- prediction

template <int dimension> Vector<double> Simulation::shift_of(std::uint32_t i, std::uint32_t j) const {
    const HardEvents &a = events_[i], &b = events_[j];
    double shift[3] = {0, 0, 0};
    for (int d = 0; d < dimension; ++d) {
        const int apart = a.cell[d] - b.cell[d];
        const int faces = apart > 1 ? 1 : apart < -1 ? -1 : 0;
        const std::int64_t images = image_of(states_[i], d) - image_of(states_[j], d) + faces;
        shift[d] = static_cast<double>(images) * view_.length[d];
    }
    return {shift[0], shift[1], shift[2]};
}

template <int dimension> Image Simulation::image_between(std::uint32_t i, std::uint32_t j, double now) const {
    if (setup_.shear == 0) return {shift_of<dimension>(i, j), 0};
    std::array<std::int64_t, 3> boxes{};
    (void)boxes_between<dimension>(i, j, boxes);
    return sandlane::edmd::image_of(setup_, boxes, now);
}

// Whether the stored contact is what the present states lead to.
template <int dimension, bool special>
bool Simulation::still_meets(std::uint32_t i, std::uint32_t j, double time) const {
    const HardEvents &a = events_[i], &b = events_[j];
    const double reach =
        radius_[special ? kind_of(states_[i]) : 0] + radius_[special ? kind_of(states_[j]) : 0];
    if (special && setup_.shear != 0) {
        std::array<std::int64_t, 3> boxes{};
        if (!boxes_between<dimension>(i, j, boxes)) return false;
        const Vector<double> shift{static_cast<double>(boxes[0]) * view_.length[0],
                                   static_cast<double>(boxes[1]) * view_.length[1],
                                   static_cast<double>(boxes[2]) * view_.length[2]};
        return laws::sheared_pair_time<dimension, double>(flight_of(states_[i]), flight_of(states_[j]), shift,
                                                          static_cast<double>(boxes[1]), reach, setup_.offset,
                                                          setup_.image_speed(), never_meets) == time;
    }
    for (int d = 0; d < dimension; ++d) {
        const int apart = std::abs(a.cell[d] - b.cell[d]);
        if (apart > 1 && !(view_.periodic[d] && apart == view_.count[d] - 1)) return false;
    }
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    if (special && setup_.growth > 0)
        return laws::growing_pair_time<dimension, double>(flight_of(states_[i]), flight_of(states_[j]),
                                                          shift_of<dimension>(i, j), reach, setup_.scale,
                                                          setup_.growth, never_meets) == time;
    return laws::pair_time<dimension, special, double>(flight_of(states_[i]), flight_of(states_[j]),
                                                       shift_of<dimension>(i, j), reach, gravity,
                                                       never_meets) == time;
}

// Of two whose last event was their collision, at the same time: whether it was with this image.
template <int dimension> bool Simulation::just_met(std::uint32_t i, std::uint32_t j) const {
    const laws::Flight<double> a = flight_of(states_[i]), b = flight_of(states_[j]);
    const double reach = radius_[kind_of(states_[i])] + radius_[kind_of(states_[j])];
    return laws::touches(a.place - b.place - image_between<dimension>(i, j, a.time).shift, reach);
}

template <int dimension, bool special> void Simulation::search(std::uint32_t i, int layer) {
    HardEvents& e = events_[i];
    simd::HardFound start{never_meets, never_meets, no_partner, no_partner, false};
    if (layer >= 0)
        start = {e.first_time, e.second_time, e.first, e.second, e.missed != 0};
    else if constexpr (special) {
        const laws::Flight<double> flight = flight_of(states_[i]);
        for (int wall = 0; wall < setup_.walls(); ++wall) {
            const double t = wall_time(setup_, flight, kind_of(states_[i]), wall, clock_.epoch);
            if (t < never_meets)
                simd::add_contact(start, t, simd::first_wall + static_cast<std::uint32_t>(wall),
                                  events_.data());
        }
    }
    simd::HardFound found = start;
    search_near_(view_, i, layer, no_partner, found);
    // Two that just met do not meet again before something else happens to one of them; another image may.
    if (!simd::is_wall(e.last) && (found.first == e.last || found.second == e.last) &&
        events_[e.last].last == i && setup_.growth == 0 && just_met<dimension>(i, e.last)) {
        found = start;
        search_near_(view_, i, layer, e.last, found);
    }
    e.first_time = found.first_time;
    e.second_time = found.second_time;
    e.first = found.first;
    e.second = found.second;
    e.missed = found.missed ? 1 : 0;
}

// When i leaves its cell, and through which face.
template <int dimension, bool special> void Simulation::look_for_crossing(std::uint32_t i) {
    HardEvents& e = events_[i];
    const HardState& s = states_[i];
    double first = never_meets;
    int through = 0;
    double time[3] = {never_meets, never_meets, never_meets};
    int face_number[3] = {0, 2, 4};
    for (int d = 0; d < dimension; ++d) {
        const double base = setup_.lower[d] + static_cast<double>(image_of(s, d)) * view_.length[d];
        if constexpr (!special) {
            const double v = s.velocity[d];
            const int up = v > 0 ? 1 : 0;
            const double face = base + (e.cell[d] + up) * edge_[d];
            time[d] = v != 0 ? s.time + (face - s.place[d]) / v : never_meets;
            face_number[d] = 2 * d + up;
        } else {
            // From the present, since the face may have been met before the last crossing.
            const double dt = now_ - s.time, g = setup_.gravity[d];
            double v = s.velocity[d] + g * dt;
            double x = s.place[d] + s.velocity[d] * dt + g * (0.5 * (dt * dt));
            if (d == 0 && setup_.shear != 0) { // as seen from the box where it is
                const auto up = static_cast<double>(image_of(s, 1));
                x -= up * setup_.offset_at(now_);
                v -= up * setup_.image_speed();
            }
            for (int up = 0; up < 2; ++up) {
                if (!view_.periodic[d] && e.cell[d] == (up == 0 ? 0 : view_.count[d] - 1)) continue;
                const double face = base + (e.cell[d] + up) * edge_[d], sign = up == 0 ? 1 : -1;
                const double t = now_ + laws::flat_wall_time(sign * (x - face), sign * v, sign * g);
                if (t < first) first = t, through = 2 * d + up;
            }
        }
    }
    if constexpr (!special) { // without branches: none of them could be foreseen
        const int d = time[1] < time[0] ? 1 : 0, last = dimension == 3 && time[2] < time[d] ? 2 : d;
        first = time[last];
        through = face_number[last];
    }
    e.crossing_time = first;
    e.crossing = static_cast<std::uint8_t>(through);
}

// ---- events

template <int dimension, bool special> void Simulation::cross(std::uint32_t i) {
    HardEvents& e = events_[i];
    const int layer = e.crossing, d = layer / 2, up = layer % 2;
    take_from_cell(cell_number(e.cell), i);
    const int to = e.cell[d] + (up == 1 ? 1 : -1), count = view_.count[d];
    const std::uint64_t one = std::uint64_t{1} << 16 * d;
    if (to < 0) states_[i].word -= one;
    if (to == count) states_[i].word += one;
    e.cell[d] = static_cast<std::uint16_t>(to < 0 ? count - 1 : to == count ? 0 : to);
    const bool slides = special && setup_.shear != 0 && d == 1 && (to < 0 || to == count);
    if (slides) find_column<dimension>(i);
    add_to_cell(cell_number(e.cell), i);
    look_for_crossing<dimension, special>(i);
    search<dimension, special>(i, slides ? -1 : layer);
    queue_.put(i, e);
    ++work_.crossings;
}

template <int dimension, bool special> void Simulation::fold(std::uint32_t i) {
    HardState& s = states_[i];
    const bool slides = special && setup_.shear != 0;
    if (slides) {
        const std::int64_t boxes = fold_height(setup_, now_, s.place[0], s.place[1], s.velocity[0]);
        s.word -= static_cast<std::uint64_t>(boxes) << 16;
        turns_[3 * i + 1] += static_cast<std::int32_t>(boxes);
    }
    for (int d = 0; d < dimension; ++d) {
        if (!view_.periodic[d] || (slides && d == 1)) continue;
        const double from = s.place[d] - setup_.lower[d];
        if (from >= 0 && from < view_.length[d]) continue;
        const double boxes = std::floor(from / view_.length[d]);
        if (boxes == 0) continue;
        s.place[d] -= boxes * view_.length[d];
        s.word -= static_cast<std::uint64_t>(static_cast<std::int64_t>(boxes)) << 16 * d;
        turns_[3 * i + static_cast<std::size_t>(d)] += static_cast<std::int32_t>(boxes);
    }
}

template <int dimension, bool special> void Simulation::collide_pair(std::uint32_t i, std::uint32_t j) {
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    if (events_[j].id < events_[i].id) std::swap(i, j);
    const std::uint32_t pair[2] = {i, j};
    Body body[2];
    for (int k = 0; k < 2; ++k) {
        laws::Flight<double> f = flight_of(states_[pair[k]]);
        laws::fly<dimension, special>(f, now_ - f.time, gravity);
        body[k].place = f.place;
        body[k].velocity = f.velocity;
        if constexpr (special) {
            body[k].kind = kind_of(states_[pair[k]]);
            if (setup_.rough) body[k].spin = spin_[pair[k]];
        }
    }
    Impact impact;
    if constexpr (special) {
        const double last = max(events_[i].last_time, events_[j].last_time);
        impact = collide(setup_, body[0], body[1], image_between<dimension>(i, j, now_),
                         now_ - last < setup_.contact_time, now_);
        if (setup_.rough)
            for (int k = 0; k < 2; ++k) spin_[pair[k]] = body[k].spin;
    } else {
        impact =
            collide_plain<dimension>(setup_.restitution.eps, radius_[0] + radius_[0], setup_.classes[0].mass,
                                     body[0], body[1], shift_of<dimension>(i, j));
    }
    for (int k = 0; k < 2; ++k) settle<dimension, special>(pair[k], body[k], pair[1 - k]);
    tally_.add(impact, setup_.classes[kind_of(states_[i])], setup_.classes[kind_of(states_[j])]);
    log_.add({now_, Event::Kind::pair, events_[i].id, events_[j].id});
}

template <int dimension, bool special>
void Simulation::settle(std::uint32_t i, const Body& body, std::uint32_t partner) {
    HardState& s = states_[i];
    s.place[0] = body.place.x, s.place[1] = body.place.y, s.place[2] = body.place.z;
    s.velocity[0] = body.velocity.x, s.velocity[1] = body.velocity.y, s.velocity[2] = body.velocity.z;
    s.time = now_;
    fold<dimension, special>(i);
    events_[i].last = partner;
    events_[i].last_time = now_;
}

template <int dimension> void Simulation::meet_side(std::uint32_t i, std::uint32_t wall) {
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    HardEvents& e = events_[i];
    const int number = static_cast<int>(wall - simd::first_wall);
    laws::Flight<double> f = flight_of(states_[i]);
    laws::fly<dimension, true>(f, now_ - f.time, gravity);
    Body body{f.place, f.velocity, {0, 0, 0}, kind_of(states_[i])};
    if (setup_.rough) body.spin = spin_[i];
    const WallHit hit{number, clock_.epoch + now_, e.id, e.hits, now_ - e.last_time < setup_.contact_time};
    const WallEffect effect = meet_wall(setup_, body, hit);
    if (effect.heated) ++e.hits;
    if (setup_.rough) spin_[i] = body.spin;
    settle<dimension, true>(i, body, wall);
    tally_.add(effect);
    log_.add({now_, Event::Kind::wall, e.id, static_cast<std::uint32_t>(number)});
}

template <int dimension, bool special> void Simulation::renew(std::uint32_t i) {
    look_for_crossing<dimension, special>(i);
    search<dimension, special>(i, -1);
    queue_.put(i, events_[i]);
}

// Of what its cell faces now.
template <int dimension> void Simulation::search_again(std::uint32_t i) {
    search<dimension, true>(i, -1);
    queue_.put(i, events_[i]);
}
template void Simulation::search_again<2>(std::uint32_t);
template void Simulation::search_again<3>(std::uint32_t);

template <int dimension, bool special> void Simulation::predict_all() {
    const std::size_t n = states_.size(), tile = 256, tiles = (n + tile - 1) / tile;
    for_tiles(tiles, threads_, [&](std::size_t t) {
        for (std::size_t i = t * tile; i < std::min(n, (t + 1) * tile); ++i) {
            look_for_crossing<dimension, special>(static_cast<std::uint32_t>(i));
            search<dimension, special>(static_cast<std::uint32_t>(i), -1);
        }
    });
    double next = never_meets, sum = 0;
    std::size_t finite = 0;
    for (const HardEvents& e : events_) {
        const double key = key_of(e);
        if (!(key < never_meets)) continue;
        next = std::min(next, key);
        sum += key - now_;
        ++finite;
    }
    const auto count = static_cast<double>(finite);
    queue_.restart(now_, sum > 0 ? count * count / sum : 0, n);
    for (std::size_t i = 0; i < n; ++i) {
        events_[i].bucket = Queue::nowhere;
        queue_.put(static_cast<std::uint32_t>(i), events_[i]);
    }
}
template void Simulation::predict_all<2, false>();
template void Simulation::predict_all<2, true>();
template void Simulation::predict_all<3, false>();
template void Simulation::predict_all<3, true>();

// All particles to the present, which becomes zero.
template <int dimension> void Simulation::synchronise() {
    const Vector<double> gravity{setup_.gravity[0], setup_.gravity[1], setup_.gravity[2]};
    for (std::size_t k = 0; k < states_.size(); ++k) {
        HardState& s = states_[k];
        laws::Flight<double> f = flight_of(s);
        laws::fly<dimension, true>(f, now_ - f.time, gravity);
        s.place[0] = f.place.x, s.place[1] = f.place.y, s.place[2] = f.place.z;
        s.velocity[0] = f.velocity.x, s.velocity[1] = f.velocity.y, s.velocity[2] = f.velocity.z;
        fold<dimension, true>(static_cast<std::uint32_t>(k));
        s.time = 0;
        events_[k].last_time -= now_;
    }
}
template void Simulation::synchronise<2>();
template void Simulation::synchronise<3>();

// The entry that is next among those of the same time.
void Simulation::settle_tie() {
    std::vector<Queue::Entry>& sorted = queue_.sorted();
    const auto order = [&](const Queue::Entry& q) {
        const HardEvents& e = events_[q.particle];
        if (e.crossing_time <= e.first_time) return std::array<std::uint32_t, 3>{1, e.id, e.crossing};
        if (simd::is_wall(e.first)) return std::array<std::uint32_t, 3>{2, e.id, e.first};
        const std::uint32_t other = events_[e.first].id;
        return std::array<std::uint32_t, 3>{3, std::min(e.id, other), std::max(e.id, other)};
    };
    const auto holds = [&](const Queue::Entry& q) {
        const HardEvents& e = events_[q.particle];
        return e.bucket == Queue::present && key_of(e) == q.time;
    };
    const double time = sorted.back().time;
    std::size_t best = sorted.size();
    for (std::size_t k = sorted.size(); k-- > 0 && sorted[k].time == time;)
        if (holds(sorted[k]) && (best == sorted.size() || order(sorted[k]) < order(sorted[best]))) best = k;
    if (best != sorted.size()) std::swap(sorted[best], sorted.back());
}

template <int dimension, bool special> std::int64_t Simulation::loop(std::int64_t events, double until) {
    std::int64_t done = 0;
    while (done < events) {
        if (queue_.sorted().empty()) {
            if (!queue_.advance(events_.data())) return done;
            if (far_) look_ahead<dimension>();
            continue;
        }
        const Queue::Entry* top = &queue_.sorted().back();
        HardEvents* e = &events_[top->particle];
        if (e->bucket != Queue::present || key_of(*e) != top->time) { // it no longer holds
            queue_.pop();
            continue;
        }
        if (queue_.sorted().size() > 1 && queue_.sorted()[queue_.sorted().size() - 2].time == top->time) {
            settle_tie();
            top = &queue_.sorted().back();
            e = &events_[top->particle];
        }
        if (top->time > until) return done;
        const std::uint32_t i = top->particle;
        now_ = max(now_, top->time);
        queue_.pop();
        e->bucket = Queue::nowhere;
        if (e->crossing_time <= e->first_time) {
            cross<dimension, special>(i);
            continue;
        }
        const std::uint32_t j = e->first;
        if (special && simd::is_wall(j)) {
            meet_side<dimension>(i, j);
            renew<dimension, special>(i);
            ++done;
        } else if (still_meets<dimension, special>(i, j, e->first_time)) {
            collide_pair<dimension, special>(i, j);
            renew<dimension, special>(i);
            renew<dimension, special>(j);
            ++done;
        } else {
            ++work_.stale;
            if (e->second != no_partner) {
                e->first = e->second;
                e->first_time = e->second_time;
                e->second = no_partner;
                e->second_time = never_meets;
            } else if (e->missed == 0) {
                e->first = no_partner;
                e->first_time = never_meets;
            } else {
                search<dimension, special>(i, -1);
                ++work_.searches;
            }
            queue_.put(i, *e);
        }
    }
    return done;
}

template std::int64_t Simulation::loop<2, false>(std::int64_t, double);
template std::int64_t Simulation::loop<2, true>(std::int64_t, double);
template std::int64_t Simulation::loop<3, false>(std::int64_t, double);
template std::int64_t Simulation::loop<3, true>(std::int64_t, double);

} // namespace sandlane::edmd
