"""Shipped scenes by every method of finding pairs: the same steps from the start, in turn."""
import collections
import json
import statistics
import subprocess
import tempfile

import measure

methods = ("auto", "verlet", "link-cells", "lattice", "lattice-half", "brute-force")
most_for_all_pairs = 500  # grains
refused = 2  # exit code: the method does not suit the scene

Row = collections.namedtuple("Row", "steps seconds loss")


def run(name, method, *options):
    """Summary of a run without outputs, or None where the scene refuses the method."""
    quiet = [f"output.{kind}_every=-1" for kind in ("log", "picture", "trajectory")] + ["output.report=false"]
    settings = [f"md.neighbours={method}", *quiet]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([measure.build / "sandlane", "run", measure.root / f"data/scenes/{name}.toml",
                               "--out", f"{folder}/out", "--threads", "1", "--json", "--quiet", *options,
                               *(word for s in settings for word in ("--set", s))],
                              capture_output=True, text=True)
    if done.returncode == refused:
        return None
    if done.returncode not in (0, 7):
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def compare(name, seconds, rounds):
    """As many steps as `auto` takes in `seconds`, the methods forwards and backwards in turn; medians of times."""
    first = run(name, "auto", "--walltime", str(seconds))
    steps = str(max(1, first["step"]))
    found = collections.defaultdict(list)
    for turn in range(rounds):
        for method in methods[::-1 if turn % 2 else 1]:
            if method == "brute-force" and first["particles"] > most_for_all_pairs:
                continue
            summary = run(name, method, "--steps", steps)
            if summary is not None:
                found[method].append(summary["loop_seconds"])
    medians = {method: statistics.median(times) for method, times in found.items()}
    return Row(int(steps), medians, medians["auto"] / min(medians.values()) - 1)
