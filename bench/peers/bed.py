"""Spheres of a bed at rest on a floor, of the bed flowing down a chute, and of a column that collapses: one start and
one time step for every program. Units: diameter 1, mass 1, g = 1. Masses are equal; with `sizes` radii are not."""
import dataclasses
import math

import numpy

import dump

gravity = {"bed": (0.0, 0.0, -1.0), "column": (0.0, 0.0, -1.0),
           "chute": (math.sin(math.radians(20)), 0.0, -math.cos(math.radians(20)))}
time_step = 1e-4  # t_c/50 of both laws, of Hertz for impacts with a speed of 1
skin = 0.1  # of the lists of every program that asks for one
settling = 8.0  # time in which the start comes to rest
columns = ("x", "y", "z", "vx", "vy", "vz", "omega_x", "omega_y", "omega_z", "radius", "mass")


@dataclasses.dataclass
class Law:
    """Coefficients as sandlane takes them."""
    stiffness: float  # linear: k; Hertz: F = stiffness sqrt(R_eff) xi^(3/2)
    damping: float  # linear: gamma; Hertz: A
    spring: float  # k_t of Cundall and Strack; 0: the dashpot of Haff and Werner
    dashpot: float  # gamma_t
    friction: float = 0.5


laws = {"linear": Law(2e5, 25.0, 0.0, 25.0), "hertz": Law(1e7, 1e-4, 1e5, 0.0)}
effective_mass = 0.5


def layers(grains):
    """Grains along x, y and z: 28 x 28 x 40 and beds of that shape."""
    side = max(4, round((0.7 * grains) ** (1 / 3)))
    return side, side, max(4, round(grains / side**2))


def spacing_of(sizes):
    return 1.22 if sizes else 1.06


def box_of(case, grains, sizes):
    """Lengths of the sides; the floor is z = 0. The box of the column is mostly empty."""
    nx, ny, nz = layers(grains)
    apart = spacing_of(sizes)
    return [(6 if case == "column" else 1) * apart * nx, apart * ny, 1.4 * nz]


def scene(case, law_name, box, grains_text, dt=time_step):
    law = laws[law_name]
    hertz = law_name == "hertz"
    coefficients = (f"young = {1.5 * law.stiffness}\npoisson = 0\ndissipation = {law.damping}" if hertz else
                    f"stiffness = {law.stiffness}\ndamping = {law.damping}")
    spring = f"\ntangential_stiffness = {law.spring}" if law.spring > 0 else ""
    return f"""title = "Spheres that several programs simulate"

[domain]
dimension = 3
lower = [0, 0, -1]
upper = [{box[0]!r}, {box[1]!r}, {box[2]!r}]
periodic = ["x", "y"]
gravity = {list(gravity[case])!r}

[[materials]]
name = "sphere"
density = {6 / math.pi!r}
{coefficients}
friction = {law.friction}
tangential_damping = {law.dashpot}{spring}

[[walls]]
name = "floor"
kind = "plane"
points = [[0, 0, 0]]
normal = [0, 0, 1]

[[grains]]
{grains_text}

[md]
normal = "{'viscoelastic' if hertz else 'linear-dashpot'}"
tangential = "{'cundall-strack' if law.spring > 0 else 'haff-werner'}"
integrator = "velocity-verlet"
dt = {dt!r}
duration = {settling}

[output]
picture_every = -1
trajectory_every = 1e9
report = false
movie = false
"""


def start(grains, sizes):
    """A loose lattice that falls; sizes: radii within 20 % instead of equal ones."""
    shape, apart = layers(grains), spacing_of(sizes)
    random = numpy.random.default_rng(1)
    place = apart * (numpy.indices(shape).reshape(3, -1) + 0.5) + numpy.array([[0], [0], [0.1]])
    n = place.shape[1]
    radius = random.uniform(0.4, 0.6, n) if sizes else numpy.full(n, 0.5)
    place += random.uniform(-0.01, 0.01, place.shape)
    zero = numpy.zeros(n)
    return dict(zip(columns, (*place, *random.normal(0, 0.3, (3, n)), zero, zero, zero, radius, numpy.ones(n))))


def write_csv(path, grains):
    path.parent.mkdir(parents=True, exist_ok=True)
    numpy.savetxt(path, numpy.column_stack([grains[name] for name in columns]), delimiter=",",
                  header=",".join(columns), comments="", fmt="%.17g")


def read_dump(path):
    """Last frame of a dump in the order of ids: {column: values}."""
    found = {name.replace("omega", "omega_"): values for name, values in dump.read_dump(path).items()}
    return {name: found[name] for name in columns if name in found}


def contacts(grains, box):
    """Touching neighbours per grain; periodic along x and y."""
    from scipy.spatial import cKDTree

    place = numpy.column_stack([grains[c] for c in "xyz"])
    place[:, :2] %= box[:2]
    tree = cKDTree(place, boxsize=[box[0], box[1], 1e9])
    near = tree.query_pairs(2 * grains["radius"].max(), output_type="ndarray")
    apart = place[near[:, 0]] - place[near[:, 1]]
    for axis in (0, 1):
        apart[:, axis] -= box[axis] * numpy.round(apart[:, axis] / box[axis])
    touching = numpy.linalg.norm(apart, axis=1) < grains["radius"][near].sum(axis=1)
    return 2 * touching.sum() / len(place)
