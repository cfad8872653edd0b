"""Right answers of contacts that remember, of grains that start to roll and of those that roll out: the equations of motion,
integrated piece by piece to a relative 1e-12; pieces end where a contact begins to slide, holds again, turns or parts.
Signs are those of docs/physics.md, 2."""
import dataclasses
import math

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from accuracy_cases import effective_mass, inertia, laws, precise, radius, speed, stiffness


@dataclasses.dataclass(frozen=True)
class Spring:
    """Oblique impact with a tangential spring; the normal law is the linear dashpot, or Walton and Braun's with theirs."""
    friction: float
    tangential_speed: float
    walton_braun: bool = False
    restitution: float = 0.88
    tangential_stiffness: float = 0.3 * stiffness

    @property
    def normal(self):
        return laws["linear e=0.88"]

    @property
    def unloading(self):
        return stiffness / self.restitution**2

    @property
    def contact_time(self):
        if not self.walton_braun:
            return self.normal.answer[1]
        return 0.5 * math.pi * sum(math.sqrt(effective_mass / k) for k in (stiffness, self.unloading))


springs = {"oblique, Cundall-Strack, slides": Spring(0.3, 1.0), "oblique, Cundall-Strack, holds": Spring(1.0, 0.3),
           "oblique, Walton-Braun": Spring(0.3, 0.3, True)}


class Geometry:
    """Of two discs: y = (place of the second minus the first since the touch, velocity of the first minus the second, sum
    of spins, ...)."""

    def __init__(self, y):
        x, z = y[:2]
        self.u = y[2:4]
        apart = numpy.array([2 * radius + x, z])
        self.distance = math.hypot(*apart)
        self.n = apart / self.distance
        self.t = numpy.array([-self.n[1], self.n[0]])
        self.overlap = -(4 * radius * x + x * x + z * z) / (self.distance + 2 * radius)  # keeps its digits
        self.rate = self.u @ self.n
        self.across = self.u @ self.t
        self.slip = self.across + radius * y[4]

    def motion(self, normal, tangential):
        """Derivatives of the first five."""
        return [*-self.u, *(tangential * self.t - normal * self.n) / effective_mass, 2 * radius * tangential / inertia]


def pieces(start, motion_of, events_of, mode, time_scale):
    """Goes from piece to piece: events_of(mode) lists (function of (time, y), direction, next(y, mode) -> (y, mode)); the
    mode None ends it."""
    time, y = 0.0, numpy.array(start, dtype=float)
    for _ in range(100):
        events = []
        for function, direction, _ in events_of(mode):
            def event(t, y, function=function):
                return function(t, y)
            event.terminal, event.direction = True, direction
            events.append(event)
        done = solve_ivp(motion_of(mode), (time, time + 20 * time_scale), y, events=events,
                         max_step=time_scale / 100, **precise)
        hit = next((k for k, times in enumerate(done.t_events) if times.size), None)
        if hit is None:
            raise SystemExit("an answer of bench/accuracy_springs.py does not come to its end")
        time, y = done.t_events[hit][0], done.y_events[hit][0]
        y, mode = events_of(mode)[hit][2](y.copy(), mode)
        if mode is None:
            return time, y
    raise SystemExit("an answer of bench/accuracy_springs.py changes its course too often")


def after(case):
    """Relative velocity (x, y) and the sum of the spins after the impact."""
    return (walton_braun if case.walton_braun else cundall_strack)(case)


def cundall_strack(case):
    """Modes: "holds", or the sign with which it slides. The last number of y is zeta."""
    damping, k_t, mu = case.normal.damping, case.tangential_stiffness, case.friction

    def load(g):
        return max(0.0, stiffness * g.overlap + damping * g.rate)

    def force(y, mode):
        g = Geometry(y)
        return g, (-k_t * y[5] if mode == "holds" else -mode * mu * load(g))

    def motion_of(mode):
        def motion(_, y):
            g, tangential = force(y, mode)
            return [*g.motion(load(g), tangential), g.slip if mode == "holds" else 0.0]
        return motion

    def release(_, y):
        g = Geometry(y)
        return stiffness * g.overlap + damping * g.rate

    def gives_way(sign):
        def slides(_, y):
            return sign * k_t * y[5] - mu * load(Geometry(y))
        return slides, 1, lambda y, mode: (y, sign)

    def events_of(mode):
        ends = (release, -1, lambda y, mode: (y, None))
        if mode == "holds":
            return [ends, gives_way(1.0), gives_way(-1.0)]

        def keeps_sliding(_, y):
            g = Geometry(y)
            # The motion of the surfaces must stretch the spring faster than its bound grows.
            along = -load(g) / effective_mass - g.across**2 / g.distance
            return mode * g.slip - mu / k_t * (stiffness * g.rate + damping * along)

        def hold(y, mode):
            y[5] = mode * mu * load(Geometry(y)) / k_t
            return y, "holds"
        return [ends, (keeps_sliding, -1, hold)]

    # A hair of overlap puts the start behind the jump of the force; its effect is of that size.
    start = [-1e-14, 0, speed, case.tangential_speed, 0, 0]
    return pieces(start, motion_of, events_of, "holds", case.contact_time)[1][2:5]


def walton_braun(case):
    """Mode: (overlap at which unloading ends, None while the contact loads; sign of the slip; where F is). F is free, or
    held by the bound at its side 1 or -1 of zero. The last numbers of y are F and F* over the bound."""
    k_0, mu, steep = case.tangential_stiffness, case.friction, case.unloading

    def load(g, mode):
        return stiffness * g.overlap if mode[0] is None else steep * (g.overlap - mode[0])

    def growth(g, y, mode, f, bound):
        _, sign, _ = mode
        room, whole = bound - sign * f, bound * (1 - sign * y[6])
        return k_0 * max(room / whole, 0.0) ** (1 / 3) * g.slip if bound > 0 else 0.0

    def held(y, mode):
        g = Geometry(y)
        bound = mu * max(load(g, mode), 0.0)
        return g, bound, mode[2] * bound if mode[2] else y[5]

    def motion_of(mode):
        def motion(_, y):
            g, bound, f = held(y, mode)
            return [*g.motion(load(g, mode), -f), 0.0 if mode[2] else growth(g, y, mode, f, bound), 0.0]
        return motion

    def turn(y, mode):
        _, bound, f = held(y, mode)
        y[5], y[6] = f, f / bound
        # Where F stands at the bound that it now grows towards, it stays there.
        return y, (mode[0], -mode[1], mode[2] if mode[2] == -mode[1] else 0)

    def events_of(mode):
        unloading, sign, side = mode
        events = [(lambda _, y: sign * Geometry(y).slip, -1, turn)]
        if unloading is None:
            events.append((lambda _, y: Geometry(y).rate, -1,
                           lambda y, mode: (y, (Geometry(y).overlap * (1 - stiffness / steep), sign, side))))
        else:
            events.append((lambda _, y: load(Geometry(y), mode), -1, lambda y, mode: (y, None)))
        if side == 0:
            for bounded in (1, -1):
                events.append((lambda _, y, bounded=bounded: bounded * y[5] - held(y, mode)[1], 1,
                               lambda y, mode, bounded=bounded: (y, (unloading, sign, bounded))))
        elif side == -sign:  # pressed back by a bound that shrinks faster than F
            def outruns(_, y):
                g, bound, f = held(y, mode)
                return sign * growth(g, y, mode, f, bound) + mu * steep * g.rate

            def leave(y, mode):
                y[5] = held(y, mode)[2]
                return y, (unloading, sign, 0)
            events.append((outruns, 1, leave))
        return events

    # At first F is a fixed part of a bound that grows evenly.
    rise = mu * stiffness * speed
    part = brentq(lambda p: p * rise - k_0 * (1 - p) ** (1 / 3) * case.tangential_speed, 0, 1, xtol=1e-16)
    hair = 1e-9 * case.contact_time
    start = [-hair * speed, 0, speed, case.tangential_speed, 0, part * rise * hair, 0]
    return pieces(start, motion_of, events_of, (None, 1, 0), case.contact_time)[1][2:5]


@dataclasses.dataclass(frozen=True)
class Rolling:
    """A grain of mass 1 and radius 1 that slides or rolls on a plane, under gravity 1. inertia: of m R^2."""
    inertia: float
    friction: float = 0.3
    tangential_damping: float = 10.0
    rolling_friction: float = 0.0
    rolling_damping: float = 0.0
    velocity: float = 1.0
    omega: float = 0.0

    def after(self, velocity, until):
        """Velocity and spin at a time, with v + omega the slip and f against it."""
        mu, gamma = self.friction, self.tangential_damping

        def motion(_, y):
            slip = y[0] + y[1]
            f = -max(-mu, min(mu, gamma * slip))
            couple = -max(-self.rolling_friction, min(self.rolling_friction, self.rolling_damping * y[1]))
            return [f, (f + couple) / self.inertia]

        def slides(_, y):
            return gamma * abs(y[0] + y[1]) - mu

        def rolls(_, y):
            return self.rolling_damping * abs(y[1]) - self.rolling_friction

        slides.terminal = rolls.terminal = True
        slides.direction = rolls.direction = -1
        time, y, changes = 0.0, numpy.array([velocity, self.omega * velocity]), [slides, rolls]
        while time < until:
            done = solve_ivp(motion, (time, until), y, events=changes, **precise)
            time, y = done.t[-1], done.y[:, -1]
            changes = [c for c, times in zip(changes, done.t_events) if not times.size]  # each comes once
        return y

    def transition(self, velocity):
        """When sliding gives way to creeping, from v without spin."""
        return (velocity - self.friction / self.tangential_damping) / (self.friction * (1 + 1 / self.inertia))

    @property
    def relaxation(self):
        """Of the slip afterwards."""
        return 1 / (self.tangential_damping * (1 + 1 / self.inertia))
