"""Force-based dynamics beside accuracy.py: springs between surfaces, grains that start to roll, a small system; and LAMMPS
in the cases with walls and many contacts."""
import functools
import math
import pathlib
import shutil
import subprocess
import tempfile

import numpy

import accuracy
import accuracy_cases as cases
import accuracy_runs as runs
import accuracy_springs as springs
import accuracy_tables as common
import measure
import tables

ratios = accuracy.ratios
box_length, box_gravity = 10.5, 1.0
small_ends = (0.6, 1.2, 2.4)


# Springs

def spring_scene(case):
    normal = case.normal
    text = runs.materials(normal, normal.damping).replace(
        "friction = 0.0", f"friction = {case.friction}\ntangential_stiffness = {case.tangential_stiffness!r}")
    text = text.replace('"none"', '"walton-braun"' if case.walton_braun else '"cundall-strack"')
    if case.walton_braun:
        text = text.replace("damping = " + repr(normal.damping), f"unloading_stiffness = {case.unloading!r}")
        text = text.replace('"linear-dashpot"', '"walton-braun"')
    return text


def collide(folder, program, case, ratio):
    """Root mean square error of the velocities after an oblique impact, over the normal speed."""
    dt = case.contact_time / ratio
    steps = math.ceil(1.3 * ratio) + 8
    oblique = cases.Law(False, case.restitution, friction=case.friction, tangential_speed=case.tangential_speed)
    grains, _ = runs.pairs(oblique, dt)
    runs.clear(folder)
    if program == "lammps":
        gamma = case.normal.damping / cases.effective_mass
        end = runs.lammps_run(folder, grains, runs.box(), (
            f"gran/hooke/history {cases.stiffness} {case.tangential_stiffness!r} {gamma!r} 0 {case.friction} 1 "
            "limit_damping", "* *"), steps, dt)
    else:
        box = runs.box()
        scene = f"[domain]\nupper = [{box[0]}, {box[1]}]\n" + spring_scene(case) + runs.quiet
        end = runs.sandlane(folder, scene, grains, program, steps, dt)
    first, second = slice(0, runs.phases), slice(runs.phases, None)
    found = [end[c][first] - end[c][second] for c in ("vx", "vy")]
    found.append(cases.radius * (end["omegaz"][first] + end["omegaz"][second]))
    right = answer(case) * [1, 1, cases.radius]
    return {"velocity": runs.rms(numpy.sqrt(sum((a - b) ** 2 for a, b in zip(found, right))) / cases.speed)}


@functools.cache
def answer(case):
    return springs.after(case)


# Rolling

def roll(folder, program, case, ratio, until, velocity=None, space=False):
    """Grains that slide or roll on a plane: velocities, spins that count as the velocity of a surface against them, what is
    right for both, velocities at the start."""
    time = cases.laws["linear e=0.88"].answer[1] * math.sqrt(cases.mass / cases.effective_mass)
    dt = time / ratio
    steps = round(until / dt)
    phase = (numpy.arange(runs.phases) + 0.5) / runs.phases
    # Sliding ends at another moment of a step for each.
    start = (case.velocity + case.friction * (1 + 1 / case.inertia) * dt * phase if velocity is None else
             velocity * (1 + 0.1 * phase))
    end = rolling_run(folder, program, case, steps, dt, start, space)
    rolled = end["omegay"] if space else -end["omegaz"]
    return end["vx"], rolled, numpy.array([case.after(v, steps * dt) for v in start]), start


def rolling_run(folder, program, case, steps, dt, start, space):
    law = cases.Law(False, 0.88, friction=case.friction, tangential_damping=case.tangential_damping)
    text = runs.materials(law, law.damping * math.sqrt(cases.mass / cases.effective_mass))
    if space:
        text = text.replace('inertia = "disc"\n', "")
    if case.rolling_friction:
        text = text.replace("[[grains]]", f"rolling_friction = {case.rolling_friction}\n"
                                          f"rolling_damping = {case.rolling_damping}\n\n[[grains]]")
    zero, one = numpy.zeros(runs.phases), numpy.ones(runs.phases)
    sunk = one - 1 / cases.stiffness  # at rest under the weight
    spin = case.omega * start  # the surface at the plane moves with v + omega R
    way = 4 + 2 * steps * dt * float(start.max())
    number = numpy.arange(runs.phases)
    table = {"x": zero if space else way * number, "vx": start, "radius": one, "mass": one}
    if space:
        table.update(y=4 * number + 2, z=sunk, omega_y=-spin)
        box = f"dimension = 3\nlower = [-10, 0, -1]\nupper = [{way}, {4 * runs.phases}, 4]\ngravity = [0, 0, -1]\n"
        plane = "points = [[0, 0, 0]]\nnormal = [0, 0, 1]"
    else:
        table.update(y=sunk, omega=spin)
        box = f"lower = [-10, -1]\nupper = [{runs.phases * way}, 4]\ngravity = [0, -1]\n"
        plane = "points = [[0, 0]]\nnormal = [0, 1]"
    scene = f'[domain]\n{box}{text}[[walls]]\nkind = "plane"\n{plane}\n\n{runs.quiet}'
    return run(runs.clear(folder), scene, table, program, steps, dt)


def run(folder, scene, table, program, steps, dt, *more):
    """State after some steps; table: columns of the grains."""
    folder.joinpath("scene.toml").write_text(scene)
    numpy.savetxt(folder / "grains.csv", numpy.column_stack(list(table.values())), fmt="%.17g", delimiter=",",
                  header=",".join(table), comments="")
    runs.execute([measure.build / "sandlane", "run", "scene.toml", "--out", "out", "--steps", steps, "-j", 1, "--quiet",
                  *(word for key in runs.overrides(program) for word in ("--set", key)), "--set", f"md.dt={dt!r}",
                  "--set", f"output.trajectory_every={steps * dt!r}", *more], folder)
    return runs.read_dump(folder / "out/trajectory.dump")


def start_to_roll(folder, program, inertia, ratio):
    """Errors of the moment when sliding ends, in units of when it does, and of the velocity in the end."""
    case = springs.Rolling(inertia)
    moment = case.transition(case.velocity)
    v, rolled, right, _ = roll(folder, program, case, ratio, moment + case.relaxation, space=inertia == 0.4)
    # What slips now goes down by itself; the error of the slip tells how late it began to.
    slip, expected = v - rolled, right[:, 0] + right[:, 1]
    late = case.relaxation * (slip - expected) / expected
    v, _, _, start = roll(folder, program, case, ratio, moment + 60 * case.relaxation, space=inertia == 0.4)
    return {"end of sliding": runs.rms(late / moment), "final velocity": runs.rms(v * (1 + inertia) / start - 1)}


def roll_out(folder, program, ratio):
    """Error of the velocity of a rolling disc that rolling friction has slowed to less than a quarter."""
    case = springs.Rolling(0.5, friction=0.5, rolling_friction=0.02, rolling_damping=0.2, omega=-1.0)
    v, _, right, start = roll(folder, program, case, ratio, 20.0, velocity=0.3)
    return {"velocity": runs.rms((v - right[:, 0]) / start)}


# A small system

def small_start():
    random = numpy.random.default_rng(3)
    grid = numpy.array([(x, y) for y in (1.3, 3.7, 6.1) for x in (1.4, 3.9, 6.4)] + [(4.0, 8.6)])
    grid = grid + random.uniform(-0.15, 0.15, grid.shape)
    return numpy.column_stack([grid, random.normal(0, 1.0, (10, 2)), random.normal(0, 0.5, 10)])


small_law = cases.laws["oblique, linear e=0.88"]


@functools.cache
def small_answer(until, step):
    """State in long double, and how many contacts have begun."""
    law = small_law
    numbers = (box_length, box_gravity, cases.stiffness, law.damping, law.friction, law.tangential_damping, until, step)
    lines = "".join(" ".join(repr(float(v)) for v in row) + "\n" for row in small_start())
    done = subprocess.run([measure.build / "bench/soft_reference", *(repr(float(v)) for v in numbers)], input=lines,
                          capture_output=True, text=True, check=True)
    return numpy.array([[float(v) for v in line.split()] for line in done.stdout.splitlines()]), int(done.stderr)


def small(folder, program, until, ratio):
    """Largest distance of a disc from where it should be, in radii."""
    time = small_law.answer[1]
    steps = round(until / (time / ratio))
    dt = until / steps
    start = small_start()
    table = dict(zip(("x", "y", "vx", "vy", "omega"), start.T))
    table.update(radius=numpy.ones(10), mass=numpy.ones(10))
    scene = (f"[domain]\nlower = [-1, -1]\nupper = [{box_length + 1}, {box_length + 1}]\ngravity = [0, {-box_gravity}]\n"
             + runs.materials(small_law, small_law.damping).replace("max_speed = 1.0", "max_speed = 5.0"))
    for point, normal in (((0, 0), (1, 0)), ((0, 0), (0, 1)), ((box_length,) * 2, (-1, 0)), ((box_length,) * 2, (0, -1))):
        scene += f'[[walls]]\nkind = "plane"\npoints = [{list(point)}]\nnormal = {list(normal)}\n\n'
    end = run(runs.clear(folder), scene + runs.quiet, table, program, steps, dt)
    right, _ = small_answer(until, time / 2000)
    return {"place": float(numpy.hypot(end["x"] - right[:, 0], end["y"] - right[:, 1]).max() / cases.radius)}


# LAMMPS: a wall, and many contacts

def lammps_bounce(folder, ratio):
    """As runs.bounce, with LAMMPS's wall; its damping constants are multiplied by the mass."""
    _, damping, dt, steps, gravity, height = runs.bounce_start(ratio)
    zero = numpy.zeros(runs.phases)
    grains = {"x": 4 * numpy.arange(runs.phases) + 2, "y": cases.radius + height, "vx": zero, "vy": zero}
    pair = f"gran/hooke {cases.stiffness} NULL {damping!r} 0 0 1 limit_damping"
    more = (f"fix wall all wall/gran hooke {cases.stiffness} NULL {damping!r} 0 0 1 limit_damping yplane 0 NULL\n"
            f"fix fall all gravity {gravity!r} vector 0 -1 0")
    end = runs.lammps_run(runs.clear(folder), grains, (4 * runs.phases, height.max() + 3), (pair, "* *"), steps, dt,
                          "p f p", more)
    energy = 0.5 * end["vy"] ** 2 + gravity * (end["y"] - cases.radius)
    right = numpy.array([cases.bounced_energy(h, steps * dt) for h in height])
    return {"energy": runs.rms((energy - right) / (gravity * height))}


def lammps_gas(folder, hertz, ratio):
    """As runs.gas, with the energy of the contacts from the places in frames every 0.02."""
    law = cases.Law(hertz, 1.0)
    grains, size = runs.gas_start()
    dt = law.answer[1] / ratio
    every = max(1, round(0.02 / dt))
    pair = (("granular", f"* * hertz {cases.stiffness} 0 tangential linear_nohistory 0 0 damping viscoelastic")
            if hertz else (f"gran/hooke {cases.stiffness} NULL 0 0 0 1", "* *"))
    more = (f"dump frames all custom {every} frames.dump id x y vx vy\n"
            "dump_modify frames sort id format float %.17g\nneigh_modify every 1 delay 0 check yes")
    runs.lammps_run(runs.clear(folder), grains, (size, size), pair, round(4.0 / dt), dt, more=more)
    energies = []
    for frame in (folder / "frames.dump").read_text().split("ITEM: ATOMS ")[1:]:
        rows = frame.split("ITEM:")[0].splitlines()[1:]
        x, y, vx, vy = numpy.array([row.split() for row in rows], dtype=float).T[1:]
        dx, dy = (a[:, None] - a[None, :] for a in (x, y))
        apart = numpy.hypot(dx - size * numpy.round(dx / size), dy - size * numpy.round(dy / size))
        overlap = numpy.clip(2 * cases.radius - apart[numpy.triu_indices(x.size, 1)], 0, None)
        power = 2.5 if hertz else 2.0
        energies.append(0.5 * cases.mass * (vx**2 + vy**2).sum() + (law.prefactor * overlap**power / power).sum())
    total = numpy.array(energies)
    return {"energy": float(abs(total / total[0] - 1).max())}


# The laboratory

def evaluate(folder, programs, steps=ratios, short=False):
    """Rows (case, quantity, program, ratio, error)."""
    found = []
    add = functools.partial(runs.measured, found)
    for program in programs:
        for ratio in steps:
            for name, case in springs.springs.items():
                if program != "lammps" or not case.walton_braun:
                    add(name, program, ratio, lambda: collide(folder, program, case, ratio), ("velocity",))
            if program == "lammps":
                add("bouncing grain", program, ratio, lambda: lammps_bounce(folder, ratio), ("energy",))
                for hertz, kind in ((False, "linear"), (True, "Hertz")):
                    add(f"dense elastic gas, {kind}", program, ratio, lambda: lammps_gas(folder, hertz, ratio), ("energy",))
                continue
            for inertia, body in ((0.5, "disc"), (0.4, "sphere"))[:1 if short else 2]:
                add(f"sliding {body}", program, ratio, lambda: start_to_roll(folder, program, inertia, ratio),
                    ("end of sliding", "final velocity"))
            if short:
                continue
            add("rolling disc", program, ratio, lambda: roll_out(folder, program, ratio), ("velocity",))
            for until in small_ends:
                contacts = small_answer(until, small_law.answer[1] / 2000)[1]
                add(f"ten discs, {contacts} contacts", program, ratio, lambda: small(folder, program, until, ratio),
                    ("place",))
    return found


def costs(folder, programs, rounds, seconds):
    """{program: seconds per particle-step} with springs, on the agitated discs of accuracy_runs.costs; medians of turns."""
    import lammps as race
    state, size, dt = race.prepare(folder / "springs", "linear", 0.82, 10000)
    race.discs.write_lammps(folder / "springs", state, size, "linear", dt, 0.2)
    script = folder / "springs/in.lmp"
    script.write_text(script.read_text().replace("gran/hooke ", "gran/hooke/history "))
    stiffness = race.discs.laws["linear"].stiffness
    with_springs = ["md.tangential=cundall-strack", f"materials.0.tangential_stiffness={0.3 * stiffness!r}",
                    "materials.0.tangential_damping=0"]
    steps, times = max(20, int(seconds * 1e7 / 10000)), {}
    for _ in range(rounds):
        for program in programs:
            times.setdefault(program, []).append(
                1 / race.lammps(folder / "springs", max(20, steps // 5)) if program == "lammps" else
                1 / race.sandlane(folder / "springs", steps, [*runs.overrides(program), *with_springs])[
                    "particle_steps_per_second"])
    return {program: float(numpy.median(t)) for program, t in times.items()}


# Springs add up their steps, so that Cundall and Strack's are of first order, as is a force that jumps at the touch.
# Sliding ends with a kink of the force: second order, which at so few steps from the kink scatters. The sum of momentum
# and spin that decides about the final velocity is kept to rounding.
expected = {("oblique, Cundall-Strack, slides", "velocity"): (0.85, 1.25),
            ("oblique, Cundall-Strack, holds", "velocity"): (0.85, 1.25),
            ("oblique, Walton-Braun", "velocity"): (0.85, 1.5),
            ("sliding disc", "end of sliding"): (1.7, 2.4)}


def check():
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        rows = evaluate(pathlib.Path(folder) / "run", ("velocity-verlet",), ratios[2:], short=True)
    for (case, quantity), series in accuracy.group(rows).items():
        for program, errors in series.items():
            if quantity == "final velocity":
                wrong = common.verdict(wrong, f"{case}, {program}: error of the final velocity", max(errors.values()), 0, 1e-11)
            elif (case, quantity) in expected:
                wrong = common.verdict(wrong, f"{case}, {program}: order", accuracy.order(errors), *expected[case, quantity])
    return wrong


def main(options):
    if options.check:
        return check()
    programs = (*accuracy.integrators, *(("lammps",) if shutil.which("lmp") else ()))

    def measured():
        with tempfile.TemporaryDirectory() as folder:
            return evaluate(pathlib.Path(folder) / "run", programs)

    groups = accuracy.group(common.remembered("contacts-errors", options, measured))
    costs_of = costs(accuracy.results / "cost", programs, options.rounds, options.seconds)
    text, lammps_text, rows = "", "", []
    for key, series in groups.items():
        points = {(p, r): (costs_of[p] * r, e) for p, errors in series.items() for r, e in errors.items()
                  if math.isfinite(e)}
        front = accuracy.front_of(points)
        rows += [(*key, p, r, e, cost * 1e9, int((p, r) in front)) for (p, r), (cost, e) in points.items()]
        part = f"\n### {key[0]}: {key[1]}\n\n" + common.table(
            series, ratios, () if key[1] == "final velocity" or set(series) == {"lammps"} else front)
        if set(series) == {"lammps"}:
            lammps_text += part
        else:
            text += part
            accuracy.picture(key, series, {a: cost for a, (cost, _) in points.items()})
    common.save("contacts", accuracy.fields, rows)
    cost_text = tables.head("ns per particle-step", "linear dashpot, springs")
    cost_text += "".join(tables.row(accuracy.names[p], f"{costs_of[p] * 1e9:.1f}") for p in programs)
    common.publish(options, {"contacts-cost": f"{measure.machine()}.\n\n{cost_text}", "contacts": text,
                             "lammps": lammps_text})
    if options.write:
        source = accuracy.results / "oblique-Cundall-Strack-slides-velocity.svg"
        shutil.copy(source, measure.root / "docs/pictures/accuracy-springs.svg")
    return 0
