"""What `md.accuracy` chooses, checked from outside: the error of collisions in runs with the choice, against answers of
SciPy, and whether another integrator could meet the target for 15 % less. docs/accuracy.md, "An error asked for"."""
import json
import pathlib
import tempfile

import numpy

import accuracy_cases as cases
import accuracy_runs as runs
import measure
import tables

laws = ("linear e=0.88", "linear e=0.5", "linear elastic", "linear e=0.88, pulls", "Hertz e=0.9", "Hertz e=0.42",
        "Hertz elastic")
targets = (1e-2, 1e-3, 1e-4)
cheaper = 1.15  # by so much the choice may cost more than another one that meets the target
parts = (0.0, 0.25, 0.5, 0.75)  # of a step more in a contact


def scene_of(law):
    return f"[domain]\nupper = [{runs.box()[0]}, {runs.box()[1]}]\n" + runs.materials(law, law.damping) + runs.quiet


def choose(folder, law, target):
    """The object "accuracy" of `sandlane check --json`, and the time step."""
    grains, _ = runs.pairs(law, 1e-4)
    runs.clear(folder)
    runs.save(folder, scene_of(law), grains)
    text = runs.execute([measure.build / "sandlane", "check", "scene.toml", "--json", "--set",
                         f"md.accuracy={target!r}"], folder)
    plan = json.loads(text)
    return plan["accuracy"], plan["dt"]


def error(folder, law, integrator, dt):
    """Root mean square over the phases of the larger one of both errors, the largest of four steps."""
    eps, time, _ = law.answer
    worst = 0.0
    for part in parts:
        step = time / (time / dt + part)
        grains, _ = runs.pairs(law, step)
        end = runs.sandlane(runs.clear(folder), scene_of(law), grains, integrator, int(1.3 * time / step) + 60, step)
        found = (end["vx"][runs.phases:] - end["vx"][:runs.phases]) / cases.speed
        larger = numpy.maximum(abs(found - eps) / eps, abs(found**2 - eps**2))
        worst = max(worst, runs.rms(larger))
    return worst


def row(folder, name, target):
    """Cells of one law and target, and whether both promises hold."""
    law = cases.laws[name]
    choice, dt = choose(folder, law, target)
    measured = error(folder, law, choice["integrator"], dt)
    own = choice["candidates"][choice["integrator"]]["step_ns"]
    better = []
    for integrator, other in choice["candidates"].items():
        # What would be cheaper by 15 % must fail, or be refused.
        step = dt * other["step_ns"] / own * cheaper
        if integrator == choice["integrator"] or step > other["longest_dt"]:
            continue
        try:
            if error(folder, law, integrator, step) <= target:
                better.append(integrator)
        except runs.Refused:
            continue
    good = measured <= target and not better
    cells = (name, f"{target:.0e}", choice["integrator"], f"t_c/{law.answer[1] / dt:.4g}", f"{choice['error']:.2g}",
             f"{measured:.2g}", f"{choice['cost_ns']:.0f}", ", ".join(better) or "none")
    return cells, good


def main(options):
    text = tables.head("law", "asked for", "chosen", "step", "computed", "measured in runs", "ns per t_c",
                       "15 % cheaper and as good")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in laws:
            for target in targets:
                cells, good = row(pathlib.Path(folder) / "run", name, target)
                wrong += not good
                text += tables.row(*cells)
                print(*cells, "" if good else "WRONG", flush=True)
    if options.write:
        tables.fill(measure.root / "docs/accuracy.md", "choice", text)
    return 1 if wrong else 0
