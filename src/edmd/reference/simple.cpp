#include "edmd/reference/simple.hpp"

#include "core/bytes.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sandlane::edmd {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Vector<double> vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void fly(const Setup& setup, laws::Flight<double>& f, double dt) {
    if (setup.dimension == 2)
        laws::fly<2, true>(f, dt, vector_of(setup.gravity));
    else
        laws::fly<3, true>(f, dt, vector_of(setup.gravity));
}

Vector<double> at_rest(const Setup& setup, const std::array<std::int64_t, 3>& boxes) {
    double shift[3] = {0, 0, 0};
    for (int d = 0; d < setup.dimension; ++d)
        if (setup.periodic[d])
            shift[d] = static_cast<double>(boxes[static_cast<std::size_t>(d)]) * setup.length(d);
    return vector_of(shift);
}

// Of i with the image of j so many boxes away.
double pair_time(const Setup& setup, const laws::Flight<double>& i, const laws::Flight<double>& j,
                 const std::array<std::int64_t, 3>& boxes, double reach) {
    const Vector<double> shift = at_rest(setup, boxes);
    if (setup.shear != 0) {
        const auto up = static_cast<double>(boxes[1]);
        const double speed = setup.image_speed();
        return setup.dimension == 2
                   ? laws::sheared_pair_time<2, double>(i, j, shift, up, reach, setup.offset, speed, never)
                   : laws::sheared_pair_time<3, double>(i, j, shift, up, reach, setup.offset, speed, never);
    }
    if (setup.growth > 0)
        return setup.dimension == 2
                   ? laws::growing_pair_time<2, double>(i, j, shift, reach, setup.scale, setup.growth, never)
                   : laws::growing_pair_time<3, double>(i, j, shift, reach, setup.scale, setup.growth, never);
    const Vector<double> gravity = vector_of(setup.gravity);
    return setup.dimension == 2 ? laws::pair_time<2, true, double>(i, j, shift, reach, gravity, never)
                                : laws::pair_time<3, true, double>(i, j, shift, reach, gravity, never);
}

} // namespace

SimpleAlgorithm::SimpleAlgorithm(Setup setup, const std::vector<Particle>& particles)
    : Algorithm(std::move(setup)), states_(particles.size()) {
    for (const Particle& p : particles) {
        State& s = states_[p.id];
        s = {{{p.place[0], p.place[1], p.place[2]}, {p.velocity[0], p.velocity[1], p.velocity[2]}, 0},
             {p.spin[0], p.spin[1], p.spin[2]},
             p.kind,
             p.image,
             -1,
             -never,
             0};
        if (setup_.dimension == 2) s.flight.place.z = s.flight.velocity.z = 0;
    }
    pairs_.resize(states_.size() * states_.size() / 2 + 1);
    const auto walls = static_cast<std::size_t>(setup_.walls());
    walls_.resize(walls * states_.size());
    predict_all();
}

// All images around the nearest one.
SimpleAlgorithm::Next SimpleAlgorithm::next_of_pair(std::size_t i, std::size_t j) const {
    if (i > j) std::swap(i, j);
    const State &a = states_[i], &b = states_[j];
    Next next;
    next.first = i;
    next.second = j;
    // Two that just met do not meet again before something else happens to one of them; another image may.
    const bool met = setup_.growth == 0 && a.last == static_cast<std::int64_t>(j) &&
                     b.last == static_cast<std::int64_t>(i);
    laws::Flight<double> p = a.flight, q = b.flight;
    fly(setup_, p, clock_.now - p.time);
    fly(setup_, q, clock_.now - q.time);
    const double reach = setup_.classes[a.kind].radius + setup_.classes[b.kind].radius;
    const double apart[3] = {p.place.x - q.place.x, p.place.y - q.place.y, p.place.z - q.place.z};
    std::int64_t nearest[3] = {0, 0, 0}, width[3] = {0, 0, 0};
    double horizon = never;
    const Vector<double> v = p.velocity - q.velocity;
    double fastest = std::sqrt(dot(v, v));
    for (int d = 0; d < setup_.dimension; ++d) {
        if (!setup_.periodic[d]) continue;
        nearest[d] = std::llrint(apart[d] / setup_.length(d));
        width[d] = 1;
    }
    std::array<std::int64_t, 3> k{};
    for (k[2] = nearest[2] - width[2]; k[2] <= nearest[2] + width[2]; ++k[2])
        for (k[1] = nearest[1] - width[1]; k[1] <= nearest[1] + width[1]; ++k[1]) {
            if (setup_.shear != 0) { // boxes above are elsewhere along x, and move
                const Image above = image_of(setup_, {0, k[1], 0}, clock_.now);
                const Vector<double> u = v - Vector<double>{above.speed, 0, 0};
                nearest[0] = std::llrint((apart[0] - above.shift.x) / setup_.length(0));
                fastest = std::max(fastest, std::sqrt(dot(u, u)));
            }
            for (k[0] = nearest[0] - width[0]; k[0] <= nearest[0] + width[0]; ++k[0]) {
                const Vector<double> shift = image_of(setup_, k, a.flight.time).shift;
                if (met && laws::touches(a.flight.place - b.flight.place - shift, reach)) continue;
                const double t = pair_time(setup_, a.flight, b.flight, k, reach);
                if (t < next.time) next = {t, Next::Kind::pair, i, j, k};
            }
        }
    for (int d = 0; d < setup_.dimension; ++d)
        if (setup_.periodic[d] && fastest > 0)
            horizon = std::min(horizon, (setup_.length(d) / 2 - 1e-9 * reach) / fastest);
    // An image outside of these is more than L away, and must come closer by more than the horizon's L/2.
    if (clock_.now + horizon < next.time) next = {clock_.now + horizon, Next::Kind::check, i, j, {}};
    return next;
}

SimpleAlgorithm::Next SimpleAlgorithm::next_at_wall(std::size_t i, int wall) const {
    const State& s = states_[i];
    const double t = wall_time(setup_, s.flight, s.kind, wall, clock_.epoch);
    return {t, Next::Kind::wall, i, static_cast<std::size_t>(wall), {}};
}

bool SimpleAlgorithm::before(const Next& a, const Next& b) {
    return std::tie(a.time, a.kind, a.first, a.second) < std::tie(b.time, b.kind, b.first, b.second);
}

SimpleAlgorithm::Next SimpleAlgorithm::earliest() const {
    Next first;
    for (const Next& n : pairs_)
        if (before(n, first)) first = n;
    for (const Next& n : walls_)
        if (before(n, first)) first = n;
    return first;
}

void SimpleAlgorithm::predict(std::size_t i) {
    for (std::size_t j = 0; j < states_.size(); ++j)
        if (j != i) pairs_[std::max(i, j) * (std::max(i, j) - 1) / 2 + std::min(i, j)] = next_of_pair(i, j);
    const auto walls = static_cast<std::size_t>(setup_.walls());
    for (std::size_t wall = 0; wall < walls; ++wall)
        walls_[walls * i + wall] = next_at_wall(i, static_cast<int>(wall));
}

Body SimpleAlgorithm::body_of(std::size_t i) const {
    const State& s = states_[i];
    laws::Flight<double> f = s.flight;
    fly(setup_, f, clock_.now - f.time);
    return {f.place, f.velocity, s.spin, s.kind};
}

void SimpleAlgorithm::fold(State& s) const {
    double* const place[3] = {&s.flight.place.x, &s.flight.place.y, &s.flight.place.z};
    if (setup_.shear != 0)
        s.turns[1] += fold_height(setup_, clock_.now, *place[0], *place[1], s.flight.velocity.x);
    for (int d = 0; d < setup_.dimension; ++d) {
        if (!setup_.periodic[d] || (setup_.shear != 0 && d == 1)) continue;
        const double boxes = std::floor((*place[d] - setup_.lower[d]) / setup_.length(d));
        *place[d] -= boxes * setup_.length(d);
        s.turns[static_cast<std::size_t>(d)] += static_cast<std::int64_t>(boxes);
    }
}

void SimpleAlgorithm::settle(std::size_t i, const Body& body, std::int64_t partner) {
    State& s = states_[i];
    s.flight = {body.place, body.velocity, clock_.now};
    s.spin = body.spin;
    s.last = partner;
    s.last_time = clock_.now;
    fold(s);
}

void SimpleAlgorithm::execute(const Next& next) {
    const auto id = static_cast<std::uint32_t>(next.first), other = static_cast<std::uint32_t>(next.second);
    if (next.kind == Next::Kind::pair) {
        const State &a = states_[next.first], &b = states_[next.second];
        Body i = body_of(next.first), j = body_of(next.second);
        const Image image = image_of(setup_, next.boxes, clock_.now);
        const bool soon = clock_.now - std::max(a.last_time, b.last_time) < setup_.contact_time;
        const Impact impact = collide(setup_, i, j, image, soon, clock_.now);
        tally_.add(impact, setup_.classes[i.kind], setup_.classes[j.kind]);
        settle(next.first, i, static_cast<std::int64_t>(next.second));
        settle(next.second, j, static_cast<std::int64_t>(next.first));
        log_.add({clock_.now, Event::Kind::pair, id, other});
        predict(next.first);
        predict(next.second);
        return;
    }
    State& s = states_[next.first];
    Body body = body_of(next.first);
    const bool soon = clock_.now - s.last_time < setup_.contact_time;
    const WallEffect effect =
        meet_wall(setup_, body, {static_cast<int>(other), clock_.epoch + clock_.now, id, s.hits, soon});
    tally_.add(effect);
    if (effect.heated) ++s.hits;
    settle(next.first, body, -1);
    log_.add({clock_.now, Event::Kind::wall, id, other});
    predict(next.first);
}

void SimpleAlgorithm::synchronise() {
    for (State& s : states_) {
        fly(setup_, s.flight, clock_.now - s.flight.time);
        fold(s);
        s.flight.time = 0;
        s.last_time -= clock_.now;
    }
    restart_clock();
}

void SimpleAlgorithm::predict_all() {
    double square = 0;
    for (const State& s : states_) square = std::max(square, dot(s.flight.velocity, s.flight.velocity));
    epoch_end_ = longest_epoch(setup_, square);
    for (std::size_t i = 0; i < states_.size(); ++i) predict(i);
}

void SimpleAlgorithm::begin_epoch() {
    synchronise();
    Drift drift;
    for (const State& s : states_) drift.add(setup_.classes[s.kind].mass, s.flight.velocity);
    check_course(drift);
    epoch_events_ = 0;
    predict_all();
}

void SimpleAlgorithm::kick() {
    synchronise();
    std::vector<std::uint32_t> kinds;
    kinds.reserve(states_.size());
    for (const State& s : states_) kinds.push_back(s.kind);
    const std::vector<Vector<double>> given = kicks(setup_, kinds, kicks_++);
    for (std::size_t i = 0; i < states_.size(); ++i) {
        Vector<double>& v = states_[i].flight.velocity;
        tally_.add_kick(setup_.classes[kinds[i]].mass, v, given[i]);
        v = v + given[i];
        states_[i].last = -1;
    }
    predict_all();
}

std::int64_t SimpleAlgorithm::run(std::int64_t events, double until) {
    std::int64_t done = 0;
    while (done < events) {
        const double stop = std::min(epoch_end_, next_kick()), end = std::min(stop, clock_.until(until));
        const Next next = earliest();
        if (!(next.time <= end) || next.time == never) {
            if (end < never) clock_.now = std::max(clock_.now, end);
            if (end != stop || end == never) break;
            stop == epoch_end_ ? begin_epoch() : kick();
            continue;
        }
        clock_.now = std::max(clock_.now, next.time);
        if (next.kind == Next::Kind::check) {
            pairs_[next.second * (next.second - 1) / 2 + next.first] = next_of_pair(next.first, next.second);
            continue;
        }
        execute(next);
        ++done;
        if (++epoch_events_ == events_of_epoch(states_.size())) begin_epoch();
    }
    return done;
}

std::size_t SimpleAlgorithm::bytes() const {
    return states_.size() * sizeof(State) + (pairs_.size() + walls_.size()) * sizeof(Next);
}

std::vector<RawState> SimpleAlgorithm::raw_states() const {
    std::vector<RawState> all;
    for (const State& s : states_) {
        const Vector<double>&x = s.flight.place, &v = s.flight.velocity;
        all.push_back({{x.x, x.y, x.z},
                       {v.x, v.y, v.z},
                       {s.spin.x, s.spin.y, s.spin.z},
                       s.flight.time,
                       s.last_time,
                       s.turns,
                       static_cast<std::uint32_t>(s.last), // -1: none
                       s.hits,
                       s.kind});
    }
    return all;
}

std::string SimpleAlgorithm::frame() const {
    ByteWriter out;
    out.put_text("simple");
    put_frame(out);
    return std::move(out).bytes();
}

std::string SimpleAlgorithm::serialise() const {
    ByteWriter out;
    out.put_text(frame());
    const std::vector<RawState> states = raw_states();
    out.put_array(states.data(), states.size());
    put_course(out);
    return std::move(out).bytes();
}

void SimpleAlgorithm::restore(const std::string& bytes) {
    ByteReader in(bytes);
    std::vector<RawState> states;
    if (in.get_text() != frame())
        fail(Exit::io, "the state is of the other algorithm, other particles, another box or other heating");
    in.get_array(states);
    if (states.size() != states_.size()) fail(Exit::io, "damaged state");
    for (std::size_t n = 0; n < states.size(); ++n) {
        const RawState& s = states[n];
        if (s.kind >= setup_.classes.size()) fail(Exit::io, "damaged state");
        const std::int64_t last = s.last < states.size() ? static_cast<std::int64_t>(s.last) : -1;
        states_[n] = {
            {{s.place[0], s.place[1], s.place[2]}, {s.velocity[0], s.velocity[1], s.velocity[2]}, s.time},
            {s.spin[0], s.spin[1], s.spin[2]},
            s.kind,
            s.boxes,
            last,
            s.last_time,
            s.hits};
    }
    get_course(in);
    for (const RawState& s : states)
        if (!suits(s)) fail(Exit::io, "damaged state");
    for (std::size_t i = 0; i < states_.size(); ++i) predict(i);
}

} // namespace sandlane::edmd
