// Ten or so soft discs in a box, in long double, for tools/bench accuracy:
//   soft_reference LENGTH GRAVITY STIFFNESS DAMPING FRICTION TANGENTIAL UNTIL STEP < x y vx vy omega, a line
//   each
// Discs of radius and mass 1, inertia 1/2; linear dashpot, cut, and Haff and Werner's friction; the same
// constants against the walls x, y = 0 and LENGTH. Runge and Kutta's fourth order in steps of at most STEP,
// which end where a contact begins, is cut, starts or ends to slide or parts. Prints x y vx vy omega at
// UNTIL, a line each, and the number of contacts that began on the standard error.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace {

using Long = long double;

struct Disc {
    Long x, y, vx, vy, omega;
};
using State = std::vector<Disc>;

struct Law {
    Long length, gravity, stiffness, damping, friction, tangential;
};

// What a contact does; the equations are smooth as long as it stays the same.
enum class Mode : unsigned char { apart, cut, creeps, slides, slides_back };

struct Contact {
    Long nx, ny, overlap, rate, slip;
};

// Of disc i with disc j, or with wall j - n: x = 0, x = length, y = 0, y = length.
Contact contact(const Law& law, const State& s, std::size_t i, std::size_t j) {
    const Disc& a = s[i];
    if (j < s.size()) {
        const Disc& b = s[j];
        const Long dx = b.x - a.x, dy = b.y - a.y, d = std::sqrt(dx * dx + dy * dy);
        const Long nx = dx / d, ny = dy / d, ux = a.vx - b.vx, uy = a.vy - b.vy;
        return {nx, ny, 2 - d, ux * nx + uy * ny, uy * nx - ux * ny + a.omega + b.omega};
    }
    const std::size_t wall = j - s.size();
    const Long sign = wall % 2 == 0 ? -1 : 1, nx = wall < 2 ? sign : 0, ny = wall < 2 ? 0 : sign;
    const Long at = wall < 2 ? a.x : a.y, gap = wall % 2 == 0 ? at : law.length - at;
    return {nx, ny, 1 - gap, a.vx * nx + a.vy * ny, a.vy * nx - a.vx * ny + a.omega};
}

Mode mode(const Law& law, const Contact& c) {
    if (!(c.overlap > 0)) return Mode::apart;
    const Long load = law.stiffness * c.overlap + law.damping * c.rate;
    if (!(load > 0)) return Mode::cut;
    if (std::abs(law.tangential * c.slip) < law.friction * load) return Mode::creeps;
    return c.slip > 0 ? Mode::slides : Mode::slides_back;
}

std::vector<Mode> modes(const Law& law, const State& s) {
    std::vector<Mode> all;
    for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = i + 1; j < s.size() + 4; ++j) all.push_back(mode(law, contact(law, s, i, j)));
    return all;
}

// Rates of change, with what the contacts do given.
State rates(const Law& law, const State& s, const std::vector<Mode>& what) {
    State out;
    for (const Disc& d : s) out.push_back({d.vx, d.vy, 0, -law.gravity, 0});
    std::size_t k = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = i + 1; j < s.size() + 4; ++j, ++k) {
            if (what[k] == Mode::apart || what[k] == Mode::cut) continue;
            const Contact c = contact(law, s, i, j);
            const Long load = law.stiffness * c.overlap + law.damping * c.rate;
            const Long f = what[k] == Mode::creeps   ? -law.tangential * c.slip
                           : what[k] == Mode::slides ? -law.friction * load
                                                     : law.friction * load;
            const Long fx = -load * c.nx - f * c.ny, fy = -load * c.ny + f * c.nx;
            out[i].vx += fx, out[i].vy += fy, out[i].omega += 2 * f;
            if (j < s.size()) out[j].vx -= fx, out[j].vy -= fy, out[j].omega += 2 * f;
        }
    return out;
}

State plus(const State& s, Long h, const State& rate) {
    State out = s;
    for (std::size_t i = 0; i < s.size(); ++i) {
        out[i].x += h * rate[i].x, out[i].y += h * rate[i].y;
        out[i].vx += h * rate[i].vx, out[i].vy += h * rate[i].vy, out[i].omega += h * rate[i].omega;
    }
    return out;
}

State step(const Law& law, const State& s, Long h, const std::vector<Mode>& what) {
    const State a = rates(law, s, what), b = rates(law, plus(s, h / 2, a), what);
    const State c = rates(law, plus(s, h / 2, b), what), d = rates(law, plus(s, h, c), what);
    return plus(plus(plus(plus(s, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 9) return 2;
    std::array<Long, 8> number{};
    for (std::size_t n = 0; n < 8; ++n) number[n] = std::strtold(argv[n + 1], nullptr);
    const Law law{number[0], number[1], number[2], number[3], number[4], number[5]};
    const Long until = number[6], longest = number[7];
    State s;
    for (Disc d{}; std::cin >> d.x >> d.y >> d.vx >> d.vy >> d.omega;) s.push_back(d);

    Long time = 0;
    int begun = 0;
    std::vector<Mode> what = modes(law, s);
    while (time < until) {
        Long h = std::min(longest, until - time);
        State next = step(law, s, h, what);
        std::vector<Mode> then = modes(law, next);
        if (then != what) {
            // The shortest step after which something has changed.
            Long low = 0;
            for (int n = 0; n < 80 && h - low > 1e-22L; ++n) {
                const Long middle = (low + h) / 2;
                (modes(law, step(law, s, middle, what)) == what ? low : h) = middle;
            }
            next = step(law, s, h, what);
            then = modes(law, next);
            for (std::size_t k = 0; k < then.size(); ++k)
                begun += what[k] == Mode::apart && then[k] != Mode::apart;
        }
        s = next;
        time += h;
        what = then;
    }
    for (const Disc& d : s)
        std::printf("%.20Lg %.20Lg %.20Lg %.20Lg %.20Lg\n", d.x, d.y, d.vx, d.vy, d.omega);
    std::fprintf(stderr, "%d\n", begun);
    return 0;
}
