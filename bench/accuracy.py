"""Error of known answers against the time it costs, for integrators, time steps and laws of force-based dynamics.

Results lie in build/bench/accuracy: accuracy.csv, and for each case a CSV and a picture; docs/accuracy.md explains
them.
"""
import csv
import functools
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

import accuracy_cases as cases
import accuracy_runs as runs
import measure
import tables

# Non-integer: at integer ratios the errors of the begin and the end of a contact that pulls cancel.
ratios = (10.37, 20.37, 50.37, 100.37, 200.37)
resolved = "velocity-verlet, resolved"
integrators = ("gear4", "gear5", "gear6", "velocity-verlet", resolved)
names = {"gear4": "Gear, 4 values", "gear5": "Gear, 5 values", "gear6": "Gear, 6 values",
         "velocity-verlet": "velocity Verlet", resolved: "velocity Verlet, onset resolved",
         "lammps": "LAMMPS"}
results = measure.results / "accuracy"
alike = 1.02  # errors that differ by less are no gain
compared = (5e-3, 2e-3, 1e-3, 5e-4)  # errors whose costs stand side by side
fields = ("case", "quantity", "program", "steps_per_contact", "error", "cost[ns]", "front")


def evaluate(programs, chosen=None, steps=ratios):
    """Rows (case, quantity, program, ratio, error or nan where the program refuses the step)."""
    with tempfile.TemporaryDirectory() as folder:
        return evaluate_in(pathlib.Path(folder) / "run", programs, chosen, steps)


def evaluate_in(folder, programs, chosen, steps):
    found = []
    add = functools.partial(runs.measured, found)
    for name, law in cases.laws.items():
        if chosen and name not in chosen:
            continue
        quantities = ("velocity",) if law.tangential_speed else ("restitution", "contact time")
        for program in programs:
            for ratio in steps:
                add(name, program, ratio, lambda: runs.collide(folder, program, law, ratio), quantities)
    for program in (p for p in programs if p != "lammps" and not chosen):
        for ratio in steps:
            add("bouncing grain", program, ratio, lambda: runs.bounce(folder, program, ratio), ("energy",))
            for hertz, name in ((False, "dense elastic gas, linear"), (True, "dense elastic gas, Hertz")):
                add(name, program, ratio, lambda: runs.gas(folder, program, hertz, ratio), ("energy",))
    return found


def order(errors):
    """Slope of log error over log step, least squares over the steps below t_c/20; errors: {ratio: error}."""
    points = [(-math.log(r), math.log(e)) for r, e in errors.items() if r > 15 and e > 0]
    if len(points) < 2:
        return math.nan
    x, y = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)


def group(rows):
    """{(case, quantity): {program: {ratio: error}}}"""
    found = {}
    for case, quantity, program, ratio, error in rows:
        found.setdefault((case, quantity), {}).setdefault(program, {})[ratio] = error
    return found


def fronts(groups, costs):
    """{(case, quantity): ({(program, ratio): cost in seconds}, members of the Pareto front)}"""
    found = {}
    for key, series in groups.items():
        hertz = "Hertz" in key[0]
        points = {(p, r): (costs[p, hertz] * r, e) for p, errors in series.items() for r, e in errors.items()
                  if math.isfinite(e)}
        found[key] = {a: cost for a, (cost, _) in points.items()}, front_of(points)
    return found


def front_of(points):
    """Members of the Pareto front of {name: (cost, error)}."""
    return {a for a, (cost, error) in points.items()
            if not any(c < cost and e <= alike * error for c, e in points.values())}


def table(series, front):
    """Markdown; members of the Pareto front are bold."""
    text = tables.head("", *(f"t_c/{r}" for r in ratios), "order")
    for program, errors in series.items():
        cells = [("refused" if math.isnan(errors[r]) else f"**{errors[r]:.1e}**" if (program, r) in front else
                  f"{errors[r]:.1e}") for r in ratios]
        text += tables.row(names[program], *cells, f"{order(errors):.2f}")
    return text


def cost_table(costs):
    text = tables.head("ns per particle-step", "linear dashpot, friction", "viscoelastic")
    for program in dict.fromkeys(p for p, _ in costs):
        text += tables.row(names[program], *(f"{costs[program, hertz] * 1e9:.1f}" for hertz in (False, True)))
    return text


def cost_at(error, errors, costs_of, program):
    """Cost in seconds at which a program reaches an error, logarithmic between two steps; nan outside of them."""
    points = sorted((costs_of[program, r], e) for r, e in errors.items() if (program, r) in costs_of)
    for (c, e), (next_c, next_e) in zip(points, points[1:]):
        if next_e <= error <= e:
            share = math.log(e / error) / math.log(e / next_e)
            return c * (next_c / c) ** share
    return math.nan


def equal_table(groups, found):
    """Markdown: what the same error of the restitution coefficient costs."""
    text = tables.head("case", "program", *(f"{error:.0e}" for error in compared))
    for case in ("linear e=0.88", "linear e=0.88, pulls", "Hertz e=0.42", "Hertz e=0.42, pulls"):
        key = case, "restitution"
        for program, errors in groups[key].items():
            costs = (cost_at(error, errors, found[key][0], program) * 1e9 for error in compared)
            text += tables.row(case, names[program], *("-" if math.isnan(c) else f"{c:.0f}" for c in costs))
    return text


def column(program):
    return program.replace(", ", "_").replace("-", "_")


def picture(key, series, costs_of):
    """CSV with a column for each program, and the picture of it."""
    name = "-".join("".join(c if c.isalnum() or c == "." else " " for c in " ".join(key)).split())
    wide = results / f"{name}.csv"
    with open(wide, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["cost[ns]", *map(column, series)])
        for (program, ratio), cost in costs_of.items():
            writer.writerow([cost * 1e9, *(series[p][ratio] if p == program else "nan" for p in series)])
    out = wide.with_suffix(".svg")
    subprocess.run([sys.executable, measure.root / "tools/plot.py", out, wide, "cost",
                    ",".join(map(column, series)), "--log", "xy"], check=True)
    return out


def write(groups, found, costs, document):
    results.mkdir(parents=True, exist_ok=True)
    with open(results / "accuracy.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(fields)
        for key, series in groups.items():
            costs_of, front = found[key]
            for at, cost in costs_of.items():
                writer.writerow([*key, *at, series[at[0]][at[1]], cost * 1e9, int(at in front)])
    pictures = {key: picture(key, series, found[key][0]) for key, series in groups.items()}
    text = "".join(f"\n### {case}: {quantity}\n\n{table(series, found[case, quantity][1])}"
                   for (case, quantity), series in groups.items())
    equal = equal_table(groups, found)
    print(cost_table(costs) + "\n" + equal + text)
    print(f"bold: on the Pareto front; CSV and pictures in {results.relative_to(measure.root)}")
    if document:
        page = measure.root / "docs/accuracy.md"
        tables.fill(page, "cost", f"{measure.machine()}.\n\n{cost_table(costs)}")
        tables.fill(page, "equal", equal)
        tables.fill(page, "errors", text)
        for case in ("linear e=0.88", "Hertz e=0.42"):
            kind = case.split()[0].lower()
            shutil.copy(pictures[case, "restitution"], measure.root / f"docs/pictures/accuracy-{kind}.svg")


# Lowest and highest order of the restitution coefficient. A force that jumps at the touch, as that of the dashpot:
# first. It grows as t^(1/2) there, viscoelastic: 1.5, which second-order terms of Verlet hide at long steps. As t,
# a spring: 2. As t^(3/2), Hertz: 2.5.
expected = {"linear e=0.88": (0.9, 1.15), "linear e=0.5": (0.9, 1.15), "linear elastic": (1.9, 2.1),
            "Hertz e=0.9": (1.4, 1.95), "Hertz e=0.42": (1.4, 1.95), "Hertz elastic": (2.4, 2.6)}
resolved_order = (1.7, 6.0)  # second with loss, fourth without


def check():
    """Fitted orders against theory, without timings."""
    wrong = 0
    for (case, quantity), series in group(evaluate(integrators, expected, ratios[2:])).items():
        if quantity != "restitution":
            continue
        for program, errors in series.items():
            low, high = resolved_order if program == resolved else expected[case]
            slope = order(errors)
            good = low <= slope <= high
            wrong += not good
            print(f"{case:<18}{program:<26}order {slope:5.2f}, expected {low} to {high}{'' if good else '  WRONG'}")
    return 1 if wrong else 0


def main(options):
    if options.check:
        return check()
    programs = integrators
    if shutil.which("lmp"):
        programs += ("lammps",)
    else:
        print("LAMMPS is left out: no lmp here; on Debian: apt-get install lammps")
    costs = runs.costs(results / "cost", integrators, "lammps" in programs, options.rounds, options.seconds)
    groups = group(evaluate(programs))
    write(groups, fronts(groups, costs), costs, options.write)
    return 0
