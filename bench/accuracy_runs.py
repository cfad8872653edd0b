"""The cases of accuracy_cases.py in sandlane and LAMMPS: one run holds many collisions that begin at different moments
within a step."""
import csv
import math
import shutil
import subprocess

import numpy

import accuracy_cases as cases
import measure
from dump import read_dump

phases = 16
columns = ("x", "y", "vx", "vy", "omega", "radius", "mass")
quiet = """[output]
picture_every = -1
trajectory_every = 1e9
report = false
movie = false
"""


class Refused(Exception):
    """The program finds the time step too long, or does not resolve contacts of this law."""


def execute(command, folder):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True)
    if done.returncode == 2 and ("dt" in done.stderr or "contact_onset" in done.stderr):
        raise Refused(done.stderr)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr}")
    return done.stdout


def clear(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def overrides(integrator):
    """Keys of the scene; "NAME, resolved": the integrator with begin and end of contacts resolved."""
    name, *onset = integrator.split(", ")
    return [f"md.integrator={name}", *(f"md.contact_onset={o}" for o in onset)]


def sandlane(folder, scene, grains, integrator, steps, dt):
    """State after `steps` steps: {column: values}."""
    save(folder, scene, grains)
    execute([measure.build / "sandlane", "run", "scene.toml", "--out", "out", "--steps", steps, "-j", 1, "--quiet",
             *(word for key in overrides(integrator) for word in ("--set", key)), "--set", f"md.dt={dt!r}",
             "--set", f"output.trajectory_every={steps * dt!r}"], folder)
    return read_dump(folder / "out/trajectory.dump")


def save(folder, scene, grains):
    folder.joinpath("scene.toml").write_text(scene)
    values = numpy.column_stack([grains[name] for name in columns])
    numpy.savetxt(folder / "grains.csv", values, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")


def materials(law, damping):
    text = (f"young = {1.5 * cases.stiffness}\npoisson = 0\ndissipation = {damping!r}" if law.hertz else
            f"stiffness = {cases.stiffness}\ndamping = {damping!r}")
    return f"""[[materials]]
name = "disc"
{text}
friction = {law.friction}
tangential_damping = {law.tangential_damping}

[[grains]]
kind = "file"
file = "grains.csv"

[md]
normal = "{'viscoelastic' if law.hertz else 'linear-dashpot'}"
tangential = "{'haff-werner' if law.friction else 'none'}"
inertia = "disc"
cut = {"true" if law.cut else "false"}
max_speed = {cases.speed}

"""


def pairs(law, dt):
    """Pairs one above the other, far apart; the gap of pair k closes k/phases of a step later, and the gaps."""
    turn = (numpy.arange(phases) + 0.5) / phases
    gap = (2 + turn) * dt * cases.speed
    # Oblique: the line of centres is to lie along x at the touch.
    shift = law.tangential_speed * gap / cases.speed
    row = 4.0 * cases.radius * (numpy.arange(phases) + 1)
    zero, one = numpy.zeros(2 * phases), numpy.ones(2 * phases)
    apart = numpy.concatenate([-(cases.radius + 0.5 * gap), cases.radius + 0.5 * gap])
    side = numpy.repeat([1.0, -1.0], phases)
    values = (5 + apart, numpy.tile(row, 2) - 0.5 * side * numpy.tile(shift, 2), 0.5 * side * cases.speed + zero,
              0.5 * side * law.tangential_speed + zero, zero, cases.radius * one, cases.mass * one)
    return dict(zip(columns, values)), gap


def box():
    return 10.0, 4.0 * cases.radius * (phases + 1)


def collide(folder, program, law, ratio):
    """Errors, root mean square over the phases, of one program or integrator at contact time / dt = ratio."""
    eps, time, apparent = law.answer
    dt = time / ratio
    steps = math.ceil(1.3 * ratio) + 8
    grains, gap = pairs(law, dt)
    clear(folder)
    if program == "lammps":
        end = lammps(folder, law, grains, steps, dt)
    else:
        scene = f"[domain]\nupper = [{box()[0]}, {box()[1]}]\n" + materials(law, law.damping) + quiet
        end = sandlane(folder, scene, grains, program, steps, dt)
    first, second = slice(0, phases), slice(phases, None)
    u = [end[c][first] - end[c][second] for c in ("vx", "vy")]
    if law.tangential_speed:
        spin = cases.radius * (end["omegaz"][first] + end["omegaz"][second])
        right = cases.oblique(law) * [1, 1, cases.radius]
        return {"velocity": rms(numpy.sqrt(sum((a - b) ** 2 for a, b in zip((*u, spin), right))) / cases.speed)}
    outside = end["x"][second] - end["x"][first] - 2 * cases.radius
    touch_to_end = steps * dt - gap / cases.speed
    return {"restitution": rms(-u[0] / cases.speed - eps),
            "contact time": rms((touch_to_end + outside / u[0] - apparent) / time)}


def rms(values):
    return float(numpy.sqrt(numpy.mean(numpy.square(values))))


def measured(found, case, program, ratio, run, quantities):
    """Appends rows (case, quantity, program, ratio, error) of what run() returns; nan where the step is refused."""
    try:
        errors = run()
    except Refused:
        errors = dict.fromkeys(quantities, math.nan)
    found.extend((case, quantity, program, ratio, error) for quantity, error in errors.items())


def bounce_start(ratio):
    """Law, damping, time step, steps, gravity and heights of bounce()."""
    law = cases.laws["linear e=0.88"]
    damping = law.damping * math.sqrt(cases.mass / cases.effective_mass)
    dt = law.answer[1] * math.sqrt(cases.mass / cases.effective_mass) / ratio
    gravity = cases.bounce_gravity()
    height = 0.5 / gravity + (numpy.arange(phases) + 0.5) / phases * dt * cases.speed
    return law, damping, dt, round(cases.bounce_time() / dt), gravity, height


def bounce(folder, integrator, ratio):
    """Relative error of the energy after three bounces on a plane under gravity."""
    law, damping, dt, steps, gravity, height = bounce_start(ratio)
    zero, one = numpy.zeros(phases), numpy.ones(phases)
    grains = dict(zip(columns, (4 * numpy.arange(phases) + 2, cases.radius + height, zero, zero, zero,
                                cases.radius * one, cases.mass * one)))
    scene = f"[domain]\nupper = [{4 * phases}, 4]\nlower = [0, -1]\ngravity = [0, {-gravity!r}]\n"
    # materials() is written for a pair; against a wall the law takes the material's constants as they are.
    scene += materials(law, damping)
    scene += '[[walls]]\nkind = "plane"\npoints = [[0, 0]]\nnormal = [0, 1]\n\n' + quiet
    end = sandlane(clear(folder), scene, grains, integrator, steps, dt)
    energy = 0.5 * end["vy"] ** 2 + gravity * (end["y"] - cases.radius)
    right = numpy.array([cases.bounced_energy(h, steps * dt) for h in height])
    return {"energy": rms((energy - right) / (gravity * height))}


def gas_start():
    """36 discs at packing fraction 0.77 that move and do not touch, and the side of their box."""
    side, spacing = 6, 2.02 * cases.radius
    random = numpy.random.default_rng(1)
    grid = (numpy.indices((side, side)).reshape(2, -1) + 0.5) * spacing
    velocity = random.normal(0, 0.5 * cases.speed, (2, side**2))
    velocity -= velocity.mean(axis=1)[:, None]
    zero, one = numpy.zeros(side**2), numpy.ones(side**2)
    return dict(zip(columns, (*grid, *velocity, zero, cases.radius * one, cases.mass * one))), side * spacing


def gas(folder, integrator, hertz, ratio):
    """Largest relative error of the energy of the undamped discs until time 4."""
    law = cases.Law(hertz, 1.0)
    grains, size = gas_start()
    scene = f'[domain]\nupper = [{size}, {size}]\nperiodic = ["x", "y"]\n'
    scene += materials(law, 0.0) + quiet + "log_every = 0.02\n"
    dt = law.answer[1] / ratio
    sandlane(clear(folder), scene, grains, integrator, round(4.0 / dt), dt)
    with open(folder / "out/log.csv") as file:
        rows = list(csv.DictReader(file))
    total = numpy.array([float(row["total_energy[J]"]) for row in rows])
    return {"energy": float(abs(total / total[0] - 1).max())}


def lammps(folder, law, grains, steps, dt):
    """The same pairs by LAMMPS; its damping constants are multiplied by m_eff, ours are not."""
    gamma = law.damping * (cases.stiffness if law.hertz else 1) / cases.effective_mass
    tangential = law.tangential_damping / cases.effective_mass
    limit = "limit_damping" if law.cut else ""
    pair, coefficients = ((
        "granular", f"* * hertz {cases.stiffness} {gamma!r} tangential linear_nohistory 0 0 damping viscoelastic "
        f"{limit}") if law.hertz else (
        f"gran/hooke {cases.stiffness} NULL {gamma!r} {tangential!r} {law.friction} 1 {limit}", "* *"))
    return lammps_run(folder, grains, box(), (pair, coefficients), steps, dt)


def lammps_run(folder, grains, size, pair, steps, dt, boundary="p p p", more=""):
    """State after `steps` steps of discs between 0 and `size`; pair: style and coefficients; more: lines of the script."""
    n = len(grains["x"])
    density = cases.mass / (4 / 3 * math.pi * cases.radius**3)
    lines = [f"discs\n\n{n} atoms\n1 atom types\n\n0 {size[0]} xlo xhi\n0 {size[1]} ylo yhi\n-1 1 zlo zhi\n",
             "Atoms # sphere\n"]
    lines += [f"{i + 1} 1 {2 * cases.radius} {density!r} {float(grains['x'][i])!r} {float(grains['y'][i])!r} 0"
              for i in range(n)]
    lines += ["\nVelocities\n"]
    lines += [f"{i + 1} {float(grains['vx'][i])!r} {float(grains['vy'][i])!r} 0 0 0 0" for i in range(n)]
    folder.joinpath("data.lmp").write_text("\n".join(lines) + "\n")
    folder.joinpath("in.lmp").write_text(f"""units si
dimension 2
atom_style sphere
boundary {boundary}
newton on
comm_modify vel yes
read_data data.lmp
pair_style {pair[0]}
pair_coeff {pair[1]}
neighbor 0.5 bin
fix move all nve/sphere disc
{more}
timestep {dt!r}
run {steps}
write_dump all custom lammps.dump id x y vx vy omegaz radius mass modify sort id format float %.17g
""")
    execute(["lmp", "-in", "in.lmp", "-log", "none"], folder)
    return read_dump(folder / "lammps.dump")


def costs(folder, integrators, with_lammps, rounds, seconds):
    """{(program, hertz): seconds per particle-step} on 10 000 agitated discs, packing fraction 0.82; medians of turns."""
    import lammps as race
    found = {}
    for name in ("linear", "hertz"):
        state, size, dt = race.prepare(folder / name, name, 0.82, 10000)
        race.discs.write_lammps(folder / name, state, size, name, dt, 0.2)
        times = {}
        steps = max(20, int(seconds * 2e7 / 10000))
        for _ in range(rounds):
            for integrator in integrators:
                summary = race.sandlane(folder / name, steps, overrides(integrator))
                times.setdefault(integrator, []).append(1 / summary["particle_steps_per_second"])
            if with_lammps:
                times.setdefault("lammps", []).append(1 / race.lammps(folder / name, max(20, steps // 5)))
        found.update({(program, name == "hertz"): float(numpy.median(t)) for program, t in times.items()})
    return found
