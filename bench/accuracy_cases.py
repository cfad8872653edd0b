"""Collisions with known answers: two equal discs of radius 1 and mass 1 that meet with normal speed 1, and a grain that
bounces. Answers are closed forms, or the equations of motion integrated to a relative 1e-12 with the ends of the
contact located as events (docs/accuracy.md)."""
import dataclasses
import functools
import math

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

radius, mass, speed = 1.0, 1.0, 1.0
effective_mass = 0.5 * mass
inertia = 0.5 * mass * radius**2  # disc
stiffness = 1e4  # linear: k; Hertz: F = stiffness sqrt(R_eff) xi^(3/2)
precise = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15}


@dataclasses.dataclass(frozen=True)
class Law:
    """A normal law by the restitution coefficient wanted at impact speed 1; friction makes the impact oblique."""
    hertz: bool
    restitution: float
    cut: bool = True  # the force ends at zero, never pulls
    friction: float = 0.0
    tangential_damping: float = 0.0  # [kg/s], Haff and Werner
    tangential_speed: float = 0.0

    @property
    def prefactor(self):
        """F = prefactor xi^power without damping."""
        return stiffness * math.sqrt(0.5 * radius) if self.hertz else stiffness

    @functools.cached_property
    def damping(self):
        """gamma [kg/s] of the dashpot, or A [s] of viscoelastic spheres."""
        if self.restitution == 1:
            return 0.0
        if self.hertz:
            scale = (self.prefactor / effective_mass) ** -0.4 * speed**-0.2
            return brentq(lambda a: impact(self, a)[0] - self.restitution, 1e-3 * scale, 3 * scale, xtol=1e-14 * scale)
        z = brentq(lambda z: dashpot(z, self.cut)[0] - self.restitution, 1e-9, 0.99, xtol=1e-15)
        return 2 * z * math.sqrt(stiffness * effective_mass)

    @functools.cached_property
    def answer(self):
        """Restitution coefficient, contact time, and the apparent contact time: from the touch to the moment where the
        straight line of the outgoing motion, prolonged backwards, reaches the overlap 0."""
        return impact(self, self.damping)


laws = {
    "linear e=0.88": Law(False, 0.88),
    "linear e=0.5": Law(False, 0.5),
    "linear elastic": Law(False, 1.0),
    "linear e=0.88, pulls": Law(False, 0.88, cut=False),
    "Hertz e=0.9": Law(True, 0.9),
    "Hertz e=0.42": Law(True, 0.42),
    "Hertz elastic": Law(True, 1.0),
    "Hertz e=0.42, pulls": Law(True, 0.42, cut=False),
    "oblique, linear e=0.88": Law(False, 0.88, friction=0.3, tangential_damping=11.0, tangential_speed=1.0),
}


def dashpot(z, cut, rate=1.0):
    """Restitution and contact time of the linear dashpot below critical damping."""
    w = rate * math.sqrt(1 - z * z)
    time = (2 * math.acos(z) if cut else math.pi) / w
    return math.exp(-z * rate * time), time


def impact(law, damping):
    if not law.hertz:
        rate = math.sqrt(stiffness / effective_mass)
        z = damping / (2 * math.sqrt(stiffness * effective_mass))
        eps, time = dashpot(z, law.cut, rate)
        # At the release with the force cut k xi = gamma eps g
        return eps, time, time + (damping / stiffness if law.cut else 0.0)
    scaled = law.prefactor / effective_mass
    if damping == 0:
        time = 2 * math.sqrt(math.pi) * math.gamma(1.4) / math.gamma(0.9) * 1.25**0.4 * scaled**-0.4 * speed**-0.2
        return 1.0, time, time

    def motion(_, y):
        root = math.sqrt(max(y[0], 0.0))
        return [y[1], -scaled * root * (y[0] + damping * y[1])]

    def release(_, y):
        return y[0] + (damping * y[1] if law.cut else 0.0)

    release.terminal, release.direction = True, -1
    found = solve_ivp(motion, (0, 1e3 * scaled**-0.4), [0.0, speed], events=release, **precise)
    time, (overlap, rate) = found.t_events[0][0], found.y_events[0][0]
    return -rate / speed, time, time - overlap / rate


def oblique(law):
    """Relative velocity u of first minus second, (x, y), and the sum of the spins after an oblique impact along x."""
    def force(y):
        apart, u, spin = y[:2], y[2:4], y[4]
        distance = math.hypot(*apart)
        n = apart / distance
        t = numpy.array([-n[1], n[0]])
        overlap = 2 * radius - distance
        normal = max(0.0, stiffness * overlap + law.damping * u @ n) if overlap > 0 else 0.0
        slip = u @ t + radius * spin
        tangential = -math.copysign(min(law.tangential_damping * abs(slip), law.friction * normal), slip)
        return normal, tangential, n, t

    def motion(_, y):
        normal, tangential, n, t = force(y)
        return numpy.concatenate([-y[2:4], (tangential * t - normal * n) / effective_mass,
                                  [2 * radius * tangential / inertia]])

    def release(_, y):
        distance = math.hypot(y[0], y[1])
        return stiffness * (2 * radius - distance) + law.damping * (y[2:4] @ y[:2]) / distance

    release.terminal, release.direction = True, -1
    # A hair of overlap puts the start behind the jump of the force; its effect is of that size.
    start = numpy.array([2 * radius - 1e-14, 0.0, speed, law.tangential_speed, 0.0])
    found = solve_ivp(motion, (0, 10 * law.answer[1]), start, events=release,
                      max_step=law.answer[1] / 200, **precise)
    return found.y_events[0][0][2:]


def bounce_time():
    """A time between the third and the fourth bounce; the flight after the first impact takes about 20 contacts."""
    law = laws["linear e=0.88"]
    flights = 1.0 + sum(2 * law.restitution**k for k in (1, 2)) + law.restitution**3
    return flights * speed / bounce_gravity() + 3 * math.pi * math.sqrt(mass / stiffness)


def bounce_gravity():
    return 2 * speed / (20 * math.pi * math.sqrt(mass / stiffness))


def bounced_energy(height, until):
    """Mechanical energy over m of a grain that falls from `height` onto a plane, at time `until` of a flight."""
    gravity = bounce_gravity()
    damping = laws["linear e=0.88"].damping * math.sqrt(mass / effective_mass)

    def motion(_, y):
        return [y[1], -gravity - (stiffness * y[0] + damping * y[1]) / mass]

    def release(_, y):
        return -stiffness * y[0] - damping * y[1]

    release.terminal, release.direction = True, -1
    time, energy = 0.0, gravity * height
    place, rate = height, 0.0
    while True:
        time += (rate + math.sqrt(rate**2 + 2 * gravity * place)) / gravity
        if time > until:
            return energy
        found = solve_ivp(motion, (0, 1), [0.0, -math.sqrt(2 * energy)], events=release, **precise)
        time += found.t_events[0][0]
        place, rate = found.y_events[0][0]
        energy = 0.5 * rate**2 + gravity * place
