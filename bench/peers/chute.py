"""Speed at equal error on a chute of discs: `tools/bench equal-error`.

Discs of radius 1 +- 20 % and mass 1 in a bed of packing fraction 0.82, periodic along x, on a floor; gravity tilted by
20 degrees. Linear dashpot of restitution 0.88 and the friction of Haff and Werner, as README.md maps them for LAMMPS.
What one program takes for a particle to live through one contact time at a given error of the restitution coefficient
is its time for a step times the steps per contact time at which pairs of the same law have that error.
"""
import csv
import json
import math
import shutil
import statistics

import accuracy
import accuracy_cases as cases
import accuracy_runs as runs
import discs
import measure
import programs
from dump import loop_rate

stiffness, friction, tangential_damping = 1e4, 0.5, 5.0
gravity = 0.2  # m/s^2, overlaps at the floor below 1 % of a radius
tilt = math.radians(20)
skin = 0.3
settle_time = 30.0  # s
error = 2e-3
lammps_ratio = 50.37
columns = discs.columns


def law(cut):
    return cases.laws["linear e=0.88" if cut else "linear e=0.88, pulls"]


def contact_time(cut):
    return law(cut).answer[1]


def start(grains):
    """{column: values} of a loose triangular lattice, and the sides of the box."""
    import numpy
    height = max(8, round(0.25 * grains**0.5))
    number = numpy.arange(height * (grains // height))
    width, apart = grains // height, 2.42
    random = numpy.random.default_rng(1)
    column, row = number % width, number // width
    zero = numpy.zeros(number.size)
    state = (apart * (column + 0.25 + 0.5 * (row % 2)), 1.3 + apart * 0.98 * row, random.normal(0, 0.1, number.size),
             random.normal(0, 0.1, number.size), zero, random.uniform(0.8, 1.2, number.size), zero + 1)
    return dict(zip(columns, state)), (apart * width, apart * height + 4)


def write_sandlane(folder, state, box, cut):
    import numpy
    folder.mkdir(parents=True, exist_ok=True)
    folder.joinpath("scene.toml").write_text(f"""title = "Discs on a chute"

[domain]
lower = [0, -2]
upper = [{box[0]!r}, {box[1]!r}]
periodic = ["x"]
gravity = [{gravity * math.sin(tilt)!r}, {-gravity * math.cos(tilt)!r}]

[[materials]]
name = "disc"
stiffness = {stiffness}
damping = {law(cut).damping!r}
tangential_damping = {tangential_damping}
friction = {friction}

[[walls]]
kind = "plane"
points = [[0, 0]]
normal = [0, 1]

[[grains]]
kind = "file"
file = "grains.csv"

[md]
normal = "linear-dashpot"
tangential = "haff-werner"
integrator = "velocity-verlet"
inertia = "disc"
cut = {"true" if cut else "false"}
max_speed = 2

[output]
picture_every = -1
trajectory_every = 1e9
report = false
movie = false
""")
    numpy.savetxt(folder / "grains.csv", numpy.column_stack([state[name] for name in columns]), fmt="%.17g",
                  delimiter=",", header=",".join(columns), comments="")


def sandlane(folder, steps, dt, resolved, extra=()):
    keys = [f"md.dt={dt!r}", f"md.contact_onset={'resolved' if resolved else 'step'}", *extra]
    shutil.rmtree(folder / "out", ignore_errors=True)
    command = [measure.build / "sandlane", "run", "scene.toml", "--out", "out", "--steps", steps, "-j", "1", "--quiet",
               "--json", *(word for key in keys for word in ("--set", key))]
    return json.loads(programs.run(command, folder, cores=1)[0])


def write_lammps(folder, state, box, cut, dt, dump=""):
    n = state["x"].size
    density = state["mass"] / (4 / 3 * math.pi * state["radius"] ** 3)
    lines = [f"discs\n\n{n} atoms\n1 atom types\n\n0 {box[0]!r} xlo xhi\n-2 {box[1]!r} ylo yhi\n-1 1 zlo zhi\n",
             "Atoms # sphere\n"]
    lines += [f"{i + 1} 1 {float(2 * state['radius'][i])!r} {float(density[i])!r} {float(state['x'][i])!r} "
              f"{float(state['y'][i])!r} 0" for i in range(n)]
    lines += ["\nVelocities\n"]
    lines += [f"{i + 1} {float(state['vx'][i])!r} {float(state['vy'][i])!r} 0 0 0 {float(state['omega'][i])!r}"
              for i in range(n)]
    folder.joinpath("data.lmp").write_text("\n".join(lines) + "\n")
    limit = " limit_damping" if cut else ""

    def style(mass):
        return (f"hooke {stiffness} NULL {law(cut).damping / mass!r} {tangential_damping / mass!r} {friction} 1"
                f"{limit}")
    folder.joinpath("in.lmp").write_text(f"""units si
dimension 2
atom_style sphere
boundary p f p
newton on
comm_modify vel yes
read_data data.lmp
pair_style gran/{style(0.5)}
pair_coeff * *
neighbor {skin} bin
neigh_modify every 1 delay 0 check yes
fix weight all gravity {gravity} vector {math.sin(tilt)!r} {-math.cos(tilt)!r} 0
fix floor all wall/gran {style(1.0)} yplane 0 NULL
fix move all nve/sphere disc
fix flat all enforce2d
timestep {dt!r}
thermo 1000000
{dump}run ${{steps}}
""")


def lammps(folder, steps):
    return loop_rate(programs.run(["lmp", "-in", "in.lmp", "-log", "none", "-var", "steps", steps], folder, cores=1)[0])


def flowing(grains, cut):
    """Folder, state and box of the bed that flows; made once."""
    import numpy
    folder = measure.results / f"chute/{'cut' if cut else 'pulls'}-{grains}"
    state, box = start(grains)
    if not (folder / "flowing.npz").exists():
        print(f"settling {state['x'].size} discs", flush=True)
        write_sandlane(folder, state, box, cut)
        dt = contact_time(cut) / 20.37
        steps = round(settle_time / dt)
        sandlane(folder, steps, dt, True, [f"output.trajectory_every={steps * dt!r}"])
        numpy.savez(folder / "flowing.npz", **discs.read_dump(folder / "out/trajectory.dump"))
    state = dict(numpy.load(folder / "flowing.npz"))
    write_sandlane(folder, state, box, cut)
    return folder, state, box


def steps_for(program, cut, ratios):
    """Steps per contact time at which pairs have the error: {ratio: error} by interpolation, as in accuracy.py."""
    import tempfile
    import pathlib
    with tempfile.TemporaryDirectory() as folder:
        errors = {r: runs.collide(pathlib.Path(folder) / "run", program, law(cut), r)["restitution"] for r in ratios}
    return accuracy.cost_at(error, errors, {(program, r): r for r in ratios}, program), errors


def one_case(grains, cut, options):
    folder, state, box = flowing(grains, cut)
    n = state["x"].size
    coarse = (6.37, 7.37, 8.37, 9.37, 10.37, 14.37, 20.37)
    fine = (20.37, 30.37, 40.37, 50.37, 70.37, 100.37)
    programs_of = {"LAMMPS": ("lammps", fine, None), "velocity Verlet": ("velocity-verlet", fine, False),
                   "velocity Verlet, onset resolved": (accuracy.resolved, coarse, True)}
    found, times = {}, {}
    for name, (program, ratios, _) in programs_of.items():
        found[name] = steps_for(program, cut, ratios)[0]
    for _ in range(options.rounds):
        for name, (_, _, resolved) in programs_of.items():
            dt = contact_time(cut) / found[name]
            steps = max(20, round(options.seconds * (1e7 if resolved is None else 5e7) / n))
            if resolved is None:
                write_lammps(folder, state, box, cut, dt)
                rate = lammps(folder, steps)
            else:
                rate = sandlane(folder, steps, dt, resolved)["particle_steps_per_second"]
            times.setdefault(name, []).append(1e9 / rate)
    print(f"{n} discs, restitution 0.88 {'with the cut' if cut else 'without the cut'}, error {error:g}")
    for name, of in times.items():
        step = statistics.median(of)
        faster = statistics.median(a * found["LAMMPS"] / (b * found[name]) for a, b in zip(times["LAMMPS"], of))
        print(f"    {name:<32} t_c/{found[name]:<6.2f}{step:8.2f} ns a particle-step{step * found[name]:9.1f} ns for t_c, "
              f"{faster:5.1f} times LAMMPS", flush=True)


def energy(state, box):
    """Kinetic, elastic and potential energy, J, by formulas that belong to neither program."""
    import numpy
    from scipy.spatial import cKDTree
    kinetic = 0.5 * (state["mass"] * (state["vx"] ** 2 + state["vy"] ** 2)).sum()
    rotational = 0.25 * (state["mass"] * state["radius"] ** 2 * state["omega"] ** 2).sum()
    place = numpy.column_stack([state["x"] % box[0], state["y"] + 10])
    near = cKDTree(place, boxsize=[box[0], 1e6]).query_pairs(2.4, output_type="ndarray")
    apart = place[near[:, 0]] - place[near[:, 1]]
    apart[:, 0] -= box[0] * numpy.round(apart[:, 0] / box[0])
    overlap = numpy.concatenate([state["radius"][near].sum(axis=1) - numpy.hypot(*apart.T),
                                 state["radius"] - state["y"]])
    elastic = 0.5 * stiffness * (numpy.maximum(overlap, 0) ** 2).sum()
    return kinetic + rotational + elastic + gravity * math.cos(tilt) * (state["mass"] * state["y"]).sum()


def unwrapped(after, before, box):
    """How far the discs went down the slope, m."""
    import numpy
    moved = after["x"] - before["x"]
    return moved - box[0] * numpy.round(moved / box[0])


def balance(grains, cut, ours, theirs, windows=6, times=2):
    """Energy that each program loses within two contact times of the flow, against steps of t_c/800 from the same
    states, over what is lost: {name: [relative residual of each window]}."""
    folder, state, box = flowing(grains, cut)
    span, found = times * contact_time(cut), {}
    for _ in range(windows):
        write_sandlane(folder, state, box, cut)

        def ran(ratio, resolved):
            steps = round(times * ratio)
            dt = span / steps
            sandlane(folder, steps, dt, resolved, [f"output.trajectory_every={steps * dt!r}"])
            return discs.read_dump(folder / "out/trajectory.dump")

        def lammps_ran(ratio):
            steps = round(times * ratio)
            write_lammps(folder, state, box, cut, span / steps)
            with open(folder / "in.lmp", "a") as script:
                script.write("write_dump all custom lammps.dump id x y vx vy omegaz radius mass "
                             "modify sort id format float %.17g\n")
            lammps(folder, steps)
            return discs.read_dump(folder / "lammps.dump")

        right = ran(800, True)

        def gained(after):
            work = gravity * math.sin(tilt) * (state["mass"] * unwrapped(after, state, box)).sum()
            return energy(after, box) - energy(state, box) - work

        lost = -gained(right)
        for name, after in ((f"LAMMPS, t_c/{theirs}", lammps_ran(theirs)),
                            (f"velocity Verlet, t_c/{theirs}", ran(theirs, False)),
                            (f"velocity Verlet, onset resolved, t_c/{ours}", ran(ours, True)),
                            (f"velocity Verlet, onset resolved, t_c/{theirs}", ran(theirs, True))):
            found.setdefault(name, []).append((-gained(after) - lost) / lost)
        state = right
    print(f"{state['x'].size} discs, restitution 0.88 {'with the cut' if cut else 'without the cut'}: energy lost within "
          f"{times} contact times, {windows} windows, against t_c/800")
    for name, of in found.items():
        print(f"    {name:<44} mean {statistics.mean(of):+9.1e}, rms {math.sqrt(statistics.mean(r * r for r in of)):8.1e}",
              flush=True)


def main(options, skipped):
    if shutil.which("lmp") is None:
        print("skipped: no lmp here; on Debian: apt-get install lammps")
        return skipped
    for cut in (False, True):
        if not options.balance_only:
            one_case(options.grains, cut, options)
        balance(options.balance_grains, cut, 10.5, 50.5)
    return 0
