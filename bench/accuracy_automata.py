"""Cellular automata are exact: vector kernels give the bits of the scalar reference, and what is conserved stays so to the
last particle."""
import csv
import pathlib
import subprocess
import tempfile

import accuracy_tables as common
import measure
import tables

# Scene, changes, steps, columns of log.csv that must not change.
cases = {"vortex-street": ((), 20, ("particles",)),
         "pipe-waves": (("pipe_flow.gravity=0", "pipe_flow.roughness=0", "pipe_flow.dissipation=0"), 200,
                        ("particles", "momentum_x")),
         "sandpile-source": ((), 200, ()), "heap-energy": ((), 200, ()), "ripples": ((), 20, ())}


def run(*words, cwd=None):
    return subprocess.run([measure.build / "sandlane", *map(str, words)], cwd=cwd, capture_output=True, text=True)


def one(name):
    """Is the reference equalled, and {column: largest change}."""
    changes, steps, columns = cases[name]
    scene = measure.root / f"data/scenes/{name}.toml"
    settings = [word for c in changes for word in ("--set", c)]
    compared = run("compare", scene, "--steps", steps, *settings)
    with tempfile.TemporaryDirectory() as folder:
        done = run("run", scene, "--steps", steps, "--quiet", "--out", pathlib.Path(folder) / "out", "--set",
                   "output.log_every=1", "--set", "output.report=false", *settings)
        if done.returncode:
            raise SystemExit(done.stderr)
        with open(pathlib.Path(folder) / "out/log.csv") as file:
            rows = [{k.split("[")[0]: v for k, v in row.items()} for row in csv.DictReader(file)]
    changed = {c: max(abs(float(r[c]) - float(rows[0][c])) for r in rows) for c in columns}
    return "identical, bit for bit" in compared.stdout, changed


def check():
    wrong = 0
    for name in ("pipe-waves",):
        same, changed = one(name)
        wrong = common.verdict(wrong, f"{name}: differs from the scalar reference", not same, 0, 0)
        for column, change in changed.items():
            wrong = common.verdict(wrong, f"{name}: change of {column}", change, 0, 0)
    return wrong


def main(options):
    if options.check:
        return check()
    text = tables.head("scene", "steps", "vector and scalar", "changes")
    rows = []
    for name, (_, steps, _) in cases.items():
        same, changed = one(name)
        what = ", ".join(f"{column}: {change:g}" for column, change in changed.items()) or "-"
        rows.append((name, steps, int(same), what))
        text += tables.row(f"`{name}.toml`", steps, "the same bits" if same else "DIFFERENT", what)
    common.save("automata", ("scene", "steps", "same", "changes"), rows)
    common.publish(options, {"automata": text})
    return 0
