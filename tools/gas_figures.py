#!/usr/bin/env python3
"""gas_figures.py [haff|sonine|mixture|state|clusters ...]: runs the scenes behind figures of docs/gases.md that one run does not
give, and draws them into docs/pictures. Runs and tables go to build/gas-figures. Standard library only.

haff       the cooling of hard spheres, constant and viscoelastic: Monte Carlo, event-driven dynamics and theory (half a minute)
sonine     the second Sonine coefficient against restitution (two minutes)
mixture    the temperatures of a mixture over each other (half a minute)
state      pressure and collision rate of hard discs and spheres against packing fraction (a minute)
clusters   clusters.toml with a spectrum every 25 units of time (two minutes)
"""
import argparse
import csv
import math
import pathlib
import shutil
import statistics
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
work = root / "build/gas-figures"
scenes = root / "data/scenes"
pictures = root / "docs/pictures"
prefix = "gas-"
nan = float("nan")


def run(program, scene, name, *settings):
    """The columns of log.csv of a run, by name."""
    out = work / name
    shutil.rmtree(out, ignore_errors=True)
    command = [program, "run", scene, "--out", out, "--quiet"]
    for setting in ("output.report=false", *settings):
        command += ["--set", setting]
    subprocess.run(command, check=True)
    return columns(out / "log.csv")


def columns(path):
    rows = list(csv.reader(open(path)))
    return {cell.split("[")[0]: [float(row[n]) for row in rows[1:]] for n, cell in enumerate(rows[0])}


def plot(name, x, units, series, *options):
    """series: name -> list of (x, y); those that end in "run" are dots."""
    table = work / f"{name}.csv"
    with open(table, "w") as out:
        print(",".join([f"{x}[{units[0]}]"] + [f"{key}[{units[1]}]" for key in series]), file=out)
        for n, points in enumerate(series.values()):
            for at, value in points:
                row = [nan] * len(series)
                row[n] = value
                print(",".join(str(v) for v in (at, *row)), file=out)
    dots = ",".join(key for key in series if key.endswith("run"))
    subprocess.run([sys.executable, root / "tools/plot.py", pictures / f"{prefix}{name}.svg", table, x, ",".join(series),
                    "--points", dots, *options], check=True)
    print(f"docs/pictures/{prefix}{name}.svg")


def thinned(points, parts):
    """About so many of them, evenly over the logarithm of x."""
    chosen, last = [], -math.inf
    logs = [math.log(p[0]) for p in points if p[0] > 0]
    if not logs:
        return points
    step = (logs[-1] - max(logs[0], logs[-1] - 12)) / parts
    for p in points:
        if p[0] > 0 and math.log(p[0]) - last >= step:
            chosen.append(p)
            last = math.log(p[0])
    return chosen


gas = """title = "A gas that cools"
method = "{method}"
[domain]
dimension = 3
upper = [40, 40, 40]
periodic = ["x", "y", "z"]
[gas] # packing fraction 0.05
temperature = 1
{gas}
[{method}]
duration = 2000
sample_every = -1
{run}
[output]
log_every = 2
"""


def haff(program):
    series, compared = {}, []
    for law, text in (("constant", "restitution = 0.9"), ("viscoelastic", 'model = "viscoelastic"\ndissipation = 0.05')):
        for method, particles, more in (("dsmc", "particles = 100000\nweight = 0.06112", "adaptive = true\nenskog = true"),
                                        ("edmd", "particles = 6112", "")):
            scene = work / f"{law}-{method}.toml"
            scene.write_text(gas.format(method=method, gas=f"{particles}\n{text}", run=more))
            log = run(program, scene, f"{law}-{method}")
            found = list(zip(log["time"], log["temperature"]))
            theory = list(zip(log["time"], log["theory_temperature"]))
            compared += [f"{law} {method}: T/theory {found[n][1] / theory[n][1]:.4f} at t = {found[n][0]:.4g}"
                         for n in (len(found) // 20, len(found) - 1)]
            series[f"{law}_{method}_run"] = thinned(found, 24 if method == "dsmc" else 17)
        series[f"{law}_theory"] = theory[1:]
    plot("cooling", "time", "sJ", series, "--log", "xy")
    print("\n".join(compared))


def a2_of_theory(eps):
    """Montanero and Santos, in space."""
    return 16 * (1 - eps) * (1 - 2 * eps**2) / (97 - 33 * eps - 2 * eps**2 * (1 - eps))


def sonine(program):
    found = []
    for eps in (0.5, 0.6, 0.7, 0.8, 0.9, 0.95):
        log = run(program, scenes / "haff.toml", f"sonine-{eps}", f"gas.restitution={eps}", "dsmc.cells=[8, 8, 8]",
                  "dsmc.duration=2000", "dsmc.sample_every=-1")
        late = [a for a, n in zip(log["a2"], log["collisions_per_particle"]) if n > 12]
        error = statistics.stdev(late) / math.sqrt(len(late)) if len(late) > 1 else nan
        found.append((eps, statistics.mean(late)))
        print(f"eps {eps}: a2 = {found[-1][1]:.4f} +- {error:.4f}, theory {a2_of_theory(eps):.4f}")
    curve = [(0.45 + 0.005 * n, a2_of_theory(0.45 + 0.005 * n)) for n in range(110)]
    plot("a2", "restitution", "11", {"a2_run": found, "a2_theory": curve})


def mixture(program):
    series = {}
    for method, name in (("dsmc", "mixture"), ("edmd", "mixture-edmd")):
        log = run(program, scenes / f"{name}.toml", name)
        ratio = [(t, b / a) for t, a, b in zip(log["time"], log["temperature_0"], log["temperature_1"])]
        theory = [(t, b / a) for t, a, b in
                  zip(log["time"], log["theory_temperature_0"], log["theory_temperature_1"])]
        late = [r for t, r in ratio if t > 200]
        print(f"{method}: {statistics.mean(late):.4f} after t = 200, theory {theory[-1][1]:.4f}")
        series[f"{method}_run"] = ratio if method == "edmd" else thinned(ratio, 40)
        series["theory"] = theory
    series["theory"] = series.pop("theory")
    plot("mixture", "time", "s1", series)


def contact(dimension, phi):
    """Carnahan and Starling, Henderson."""
    return (1 - phi / 2) / (1 - phi) ** 3 if dimension == 3 else (1 - 7 * phi / 16) / (1 - phi) ** 2


def state(program):
    pressure, rates = {}, {}
    for dimension, name, fractions in ((2, "discs", (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65)),
                                       (3, "spheres", (0.05, 0.1, 0.2, 0.3, 0.35, 0.4, 0.45))):
        z, omega = [], []
        for phi in fractions:
            volume = math.pi / (6 if dimension == 3 else 4)
            edge = (2048 * volume / phi) ** (1 / dimension)
            # Of a particle, at T = m = s = 1, after theory: 300 of them are seen, the first 60 are left out.
            rate = contact(dimension, phi) * phi / volume * math.sqrt(math.pi) * (4 if dimension == 3 else 2)
            scene = work / f"{name}-{phi}.toml"
            scene.write_text(f'method = "edmd"\n[domain]\ndimension = {dimension}\nupper = {[edge] * dimension}\n'
                             f'periodic = {["x", "y", "z"][:dimension]}\n[gas]\nparticles = 2048\ntemperature = 1\n[edmd]\n'
                             f'duration = {300 / rate}\nsample_every = -1\n[output]\nlog_every = {10 / rate}\n')
            log = run(program, scene, f"{name}-{phi}")
            late = [n for n, t in enumerate(log["time"]) if t * rate > 60]
            z.append((phi, statistics.mean(log["compressibility"][n] for n in late)))
            omega.append((phi, statistics.mean(log["collision_rate"][n] for n in late)))
            of_theory = 1 + 2 ** (dimension - 1) * phi * contact(dimension, phi)
            print(f"{name} phi {phi}: p/nT = {z[-1][1]:.4f}, theory {of_theory:.4f} ({z[-1][1] / of_theory - 1:+.2%}); "
                  f"rate {omega[-1][1]:.4f}, theory {rate:.4f} ({omega[-1][1] / rate - 1:+.2%})")
        curve = [0.01 * n for n in range(1, 69 if dimension == 2 else 52)]
        pressure[f"{name}_run"], rates[f"{name}_run"] = z, omega
        pressure[f"{name}_theory"] = [(phi, 1 + 2 ** (dimension - 1) * phi * contact(dimension, phi)) for phi in curve]
        rates[f"{name}_theory"] = [(phi, contact(dimension, phi) * phi / volume * math.sqrt(math.pi)
                                    * (4 if dimension == 3 else 2)) for phi in curve]
    plot("state", "packing_fraction", "11", pressure, "--log", "y")
    plot("rate", "packing_fraction", ["1", "1/s"], rates, "--log", "y")


def clusters(program):
    log = run(program, scenes / "clusters.toml", "clusters", "edmd.structure_every=25", "output.picture_every=-1")
    table = columns(work / "clusters/clusters.csv")
    shape = columns(work / "clusters/structure.csv")
    late = -1
    print(f"t = {table['time'][late]:.4g}: {table['largest_cluster'][late]:.1%} of the particles in the largest cluster, "
          f"T/Haff = {log['temperature'][late] / log['theory_temperature'][late]:.3g}")
    plot("cluster-growth", "time", "s1", {key: list(zip(table["time"], table[key])) for key in
                                          ("density_spectrum", "shear_spectrum", "number_fluctuation")}, "--log", "y")
    plot("structure", "k", ["1/m", "1"], {key: list(zip(shape["k"], shape[key])) for key in
                                          ("structure_factor", "shear_spectrum")}, "--log", "xy")


def draw(figures, text, folder):
    """Command line of figures, functions of the program's path that work in `folder`."""
    figures = {f.__name__: f for f in figures}
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figure", nargs="*", choices=[*figures, []], help="all if none is given")
    parser.add_argument("--program", default=str(root / "build/release/sandlane"))
    options = parser.parse_args()
    folder.mkdir(parents=True, exist_ok=True)
    for name in options.figure or figures:
        print(f"-- {name}", flush=True)
        figures[name](options.program)


if __name__ == "__main__":
    draw((haff, sonine, mixture, state, clusters), __doc__, work)
