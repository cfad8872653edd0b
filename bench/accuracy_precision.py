"""What the precision of the numbers allows: round-off against ever shorter steps, far from the origin, by every method of
finding pairs, and in the orientations of spheres in space."""
import math
import pathlib
import tempfile

import numpy

import accuracy_cases as cases
import accuracy_contacts as contacts
import accuracy_runs as runs
import accuracy_tables as common
import measure
import tables

floor_ratios = (100.37, 1000.37, 10000.37, 100000.37)
distances = (0.0, 1e3, 1e6, 1e9)


def floor(folder):
    """Errors of the restitution of elastic spheres with very short steps: {(integrator, ratio): error}."""
    law = cases.laws["Hertz elastic"]
    return {(program, ratio): runs.collide(folder, program, law, ratio)["restitution"]
            for program in ("velocity-verlet", "gear5") for ratio in floor_ratios}


def far_away(folder, distance, ratio=10000.37):
    """The same far from the origin, where places have fewer digits."""
    law = cases.laws["Hertz elastic"]
    dt = law.answer[1] / ratio
    grains, _ = runs.pairs(law, dt)
    grains = dict(grains, x=grains["x"] + distance, y=grains["y"] + distance)
    upper = [size + distance for size in runs.box()]
    scene = f"[domain]\nlower = [{distance}, {distance}]\nupper = {upper}\n" + runs.materials(law, 0.0) + runs.quiet
    steps = math.ceil(1.3 * ratio) + 8
    end = runs.sandlane(runs.clear(folder), scene, grains, "velocity-verlet", steps, dt)
    first, second = slice(0, runs.phases), slice(runs.phases, None)
    return runs.rms((end["vx"][second] - end["vx"][first]) / cases.speed - 1)


def methods(folder, ratio=50.37):
    """The same impact with every method of finding pairs, whose distances are not all double: {method: velocities}."""
    law = cases.laws["linear e=0.88"]
    dt = law.answer[1] / ratio
    grains, _ = runs.pairs(law, dt)
    table = {name: grains[name] for name in runs.columns}
    scene = f"[domain]\nupper = [{runs.box()[0]}, {runs.box()[1]}]\n" + runs.materials(law, law.damping) + runs.quiet
    found = {}
    for method in ("verlet", "link-cells", "lattice", "lattice-half", "brute-force"):
        end = contacts.run(runs.clear(folder), scene, table, "velocity-verlet", math.ceil(1.3 * ratio) + 8, dt,
                  "--set", f"md.neighbours={method}")
        found[method] = end["vx"]
    return found


turns = 100
turn_steps = (10, 100, 1000, 10000)


def turning(folder, program, steps_per_turn):
    """A free sphere after a hundred turns: errors of the angle and of the length of its quaternion."""
    omega = numpy.array([2.0, -1.0, 3.0])
    rate = float(numpy.sqrt((omega.astype(numpy.longdouble) ** 2).sum()))
    dt = 2 * math.pi / rate / steps_per_turn
    steps = turns * steps_per_turn + steps_per_turn // 3
    scene = f"""[domain]
dimension = 3
lower = [-1, -1, -1]
upper = [1, 1, 1]
[[materials]]
name = "soft"
stiffness = 1e-6
density = 1
friction = 0.1
tangential_damping = 1e-9
[[grains]]
kind = "list"
items = [{{ position = [0, 0, 0], radius = 0.5, angular_velocity = {omega.tolist()} }}]
[md]
normal = "linear-dashpot"
orientation = true
max_speed = 0.01
"""
    runs.clear(folder).joinpath("scene.toml").write_text(scene + runs.quiet)
    runs.execute([measure.build / "sandlane", "run", "scene.toml", "--out", "out", "--steps", steps, "-j", 1, "--quiet",
                  "--set", f"md.integrator={program}", "--set", f"md.dt={dt!r}",
                  "--set", f"output.trajectory_every={steps * dt!r}"], folder)
    end = runs.read_dump(folder / "out/trajectory.dump")
    q = numpy.array([end[c][0] for c in ("quatw", "quati", "quatj", "quatk")], dtype=numpy.longdouble)
    length = numpy.sqrt((q**2).sum())
    full = numpy.sqrt((omega.astype(numpy.longdouble) ** 2).sum())
    half = full * numpy.longdouble(steps) * numpy.longdouble(dt) / 2
    right = numpy.concatenate([[numpy.cos(half)], numpy.sin(half) * omega / full])
    if q @ right < 0:
        right = -right
    return {"angle": float(2 * numpy.sqrt(((q / length - right) ** 2).sum())), "length": float(abs(length - 1))}



def evaluate(folder):
    found = {"floor": [[*at, error] for at, error in floor(folder).items()],
             "far": [[distance, far_away(folder, distance)] for distance in distances]}
    bits = methods(folder)
    found["methods"] = {name: bool((v == bits["verlet"]).all()) for name, v in bits.items()}
    found["turning"] = [[program, n, *turning(folder, program, n).values()] for program in ("velocity-verlet", "gear6")
                        for n in turn_steps]
    return found


def floor_table(rows):
    series = {}
    for program, ratio, error in rows:
        series.setdefault(program, {})[ratio] = error
    return common.table(series, floor_ratios, orders=False)


def check():
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder) / "run"
        error = runs.collide(place, "velocity-verlet", cases.laws["Hertz elastic"], 10000.37)["restitution"]
        wrong = common.verdict(0, "restitution, Hertz elastic, t_c/10000", error, 0, 1e-10)
        bits = methods(place)
        same = all((v == bits["verlet"]).all() for v in bits.values())
        wrong = common.verdict(wrong, "methods of finding pairs that give other velocities", 0 if same else 1, 0, 0)
        turned = turning(place, "velocity-verlet", 100)
    wrong = common.verdict(wrong, "angle of a sphere after 100 turns", turned["angle"], 0, 1e-11)
    return common.verdict(wrong, "length of its quaternion", turned["length"], 0, 1e-15)


def main(options):
    if options.check:
        return check()

    def measured():
        with tempfile.TemporaryDirectory() as folder:
            return evaluate(pathlib.Path(folder) / "run")

    found = common.remembered("precision", options, measured)
    far = tables.head("distance from the origin, radii", *(f"{d:.0e}" if d else "0" for d, _ in found["far"]))
    far += tables.row("error of the restitution coefficient", *(f"{e:.1e}" for _, e in found["far"]))
    same = tables.head("method of finding pairs", *found["methods"])
    same += tables.row("velocities", *("the same bits" if s else "different" for s in found["methods"].values()))
    turned = tables.head("steps per turn", *(f"{n}" for n in turn_steps))
    for program in dict.fromkeys(row[0] for row in found["turning"]):
        for k, quantity in ((2, "angle, rad"), (3, "length")):
            turned += tables.row(f"{program}: {quantity}", *(f"{row[k]:.1e}" for row in found["turning"] if row[0] == program))
    common.save("precision", ("integrator", "steps_per_contact", "error"), found["floor"])
    common.publish(options, {"floor": f"{floor_table(found['floor'])}\n{far}\n{same}", "turning": turned})
    return 0
