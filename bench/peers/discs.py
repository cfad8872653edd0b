"""The discs that both programs simulate: a start, files that each of them reads, energies of what they write.

All masses are equal, so that m_eff is one number: LAMMPS multiplies its damping constants by m_eff, sandlane does not.
Units are reduced: mass 1, mean radius 1. README.md beside this file derives the mapping of the coefficients.
"""
import dataclasses

import numpy
from scipy.spatial import cKDTree

import dump

columns = ("x", "y", "vx", "vy", "omega", "radius", "mass")


@dataclasses.dataclass
class Law:
    stiffness: float  # linear: k [N/m]; hertz: elastic coefficient, F = stiffness sqrt(R_eff) xi^(3/2)
    damping: float  # linear: gamma [kg/s]; hertz: A [s]
    tangential_damping: float  # [kg/s]
    friction: float


laws = {"linear": Law(1e4, 0.25, 0.1, 0.3), "hertz": Law(5e4, 1e-4, 0.0, 0.0)}
effective_mass = 0.5


def start(grains, packing_fraction):
    """Thermal discs, radii +-5 %, on a triangular lattice in a periodic box: {column: values}, box."""
    side = 2 * round(0.5 * grains**0.5)
    spacing = (2 * numpy.pi / (3**0.5 * packing_fraction)) ** 0.5
    box = numpy.array([side * spacing, side * spacing * 3**0.5 / 2])
    number = numpy.arange(side * side)
    column, row = number % side, number // side
    random = numpy.random.default_rng(1)
    velocity = random.normal(0, 0.5, (2, number.size))
    return {"x": (column + 0.25 + 0.5 * (row % 2)) * spacing, "y": (row + 0.5) * spacing * 3**0.5 / 2,
            "vx": velocity[0], "vy": velocity[1], "omega": numpy.zeros(number.size),
            "radius": random.uniform(0.95, 1.05, number.size), "mass": numpy.ones(number.size)}, box


def write_sandlane(folder, discs, box, law_name, dt):
    """scene.toml and grains.csv. dt 0: sandlane's choice."""
    law = laws[law_name]
    linear = law_name == "linear"
    coefficients = (f"stiffness = {law.stiffness}\ndamping = {law.damping}" if linear else
                    f"young = {1.5 * law.stiffness}\npoisson = 0\ndissipation = {law.damping}")
    folder.joinpath("scene.toml").write_text(f"""title = "Discs that two programs simulate"

[domain]
upper = [{box[0]!r}, {box[1]!r}]
periodic = ["x", "y"]

[[materials]]
name = "disc"
{coefficients}
tangential_damping = {law.tangential_damping}
friction = {law.friction}

[[grains]]
kind = "file"
file = "grains.csv"

[md]
normal = "{'linear-dashpot' if linear else 'viscoelastic'}"
tangential = "{'haff-werner' if linear else 'none'}"
inertia = "disc"
dt = {dt!r}
max_speed = 2

[output]
picture_every = -1
trajectory_every = 1e9
report = false
movie = false
""")
    values = numpy.column_stack([discs[name] for name in columns])
    numpy.savetxt(folder / "grains.csv", values, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")


def write_lammps(folder, discs, box, law_name, dt, skin):
    """data.lmp and in.lmp; variables of the script: `steps`, and `write`: 1 for a dump at the end."""
    law = laws[law_name]
    n = discs["x"].size
    density = discs["mass"] / (4 / 3 * numpy.pi * discs["radius"] ** 3)  # atom_style sphere makes the mass of it
    with open(folder / "data.lmp", "w") as file:
        file.write(f"discs\n\n{n} atoms\n1 atom types\n\n0 {box[0]!r} xlo xhi\n0 {box[1]!r} ylo yhi\n-1 1 zlo zhi\n")
        file.write("\nAtoms # sphere\n\n")
        for i in range(n):
            file.write(f"{i + 1} 1 {float(2 * discs['radius'][i])!r} {float(density[i])!r} {float(discs['x'][i])!r} "
                       f"{float(discs['y'][i])!r} 0\n")
        file.write("\nVelocities\n\n")
        for i in range(n):
            file.write(f"{i + 1} {float(discs['vx'][i])!r} {float(discs['vy'][i])!r} 0 0 0 "
                       f"{float(discs['omega'][i])!r}\n")
    if law_name == "linear":
        gamma = law.damping / effective_mass
        gamma_t = law.tangential_damping / effective_mass
        pair = f"gran/hooke {law.stiffness} NULL {gamma} {gamma_t} {law.friction} 1 limit_damping"
        coefficients = "* *"
    else:
        gamma = law.damping * law.stiffness / effective_mass
        pair = "granular"
        coefficients = (f"* * hertz {law.stiffness} {gamma} tangential linear_nohistory 0 0 "
                        "damping viscoelastic limit_damping")
    folder.joinpath("in.lmp").write_text(f"""units si
dimension 2
atom_style sphere
boundary p p p
newton on
comm_modify vel yes
read_data data.lmp
pair_style {pair}
pair_coeff {coefficients}
neighbor {skin} bin
neigh_modify every 1 delay 0 check yes
fix move all nve/sphere disc
timestep {dt!r}
run ${{steps}}
if "${{write}} == 1" then "write_dump all custom lammps.dump id x y vx vy omegaz radius mass &
    modify sort id format float %.17g"
""")


def read_dump(path):
    """Last frame of a dump, as both programs write it, in the order of ids: {column: values}."""
    found = dump.read_dump(path)
    return {name: found["omegaz" if name == "omega" else name] for name in columns}


def observables(discs, box, law_name):
    """Total energy [J] and number of contacts, by formulas that belong to neither program."""
    law = laws[law_name]
    kinetic = 0.5 * (discs["mass"] * (discs["vx"] ** 2 + discs["vy"] ** 2)).sum()
    rotational = 0.25 * (discs["mass"] * discs["radius"] ** 2 * discs["omega"] ** 2).sum()
    place = numpy.column_stack([discs["x"], discs["y"]]) % box
    near = cKDTree(place, boxsize=box).query_pairs(2.2, output_type="ndarray")
    apart = place[near[:, 0]] - place[near[:, 1]]
    apart -= box * numpy.round(apart / box)
    radius = discs["radius"][near]
    overlap = radius.sum(axis=1) - numpy.hypot(*apart.T)
    touching = overlap > 0
    overlap, radius = overlap[touching], radius[touching]
    if law_name == "linear":
        elastic = (0.5 * law.stiffness * overlap**2).sum()
    else:
        reduced = radius.prod(axis=1) / radius.sum(axis=1)
        elastic = (0.4 * law.stiffness * numpy.sqrt(reduced) * overlap**2.5).sum()
    return kinetic + rotational + elastic, int(touching.sum())
