"""Faults of the surroundings, for hundreds of runs of each engine: killed at random moments, full and read-only disks,
damaged and swapped checkpoints, two runs in one folder. A run that goes on must end with the bits and files of the
undisturbed one. tools/test has a short part of it (tests/app/every_engine_test.cpp)."""
import csv
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

import measure
import tables
import trial

page = measure.root / "docs/stability.md"
columns = ("scene", "fault", "expected", "observed", "verdict")
outputs = "[output]\npicture_width = 64\nmovie = false\nreport = false\n"
told_by_the_process = {".lock", "summary.json", "report.html", "scene.toml"}  # scene.toml: intervals of checkpoints differ
stopped, refused, failed = 7, 2, 5  # exit codes

# {name: (scene, interval of checkpoints)}; about a second each.
scenes = {
    "md, discs": ("""[domain]
upper = [0.2, 0.2]
gravity = [0, -9.81]
[[materials]]
name = "glass"
young = "10 MPa"
dissipation = "50 us"
friction = 0.5
tangential_stiffness = 1e4
[[grains]]
radius = { law = "uniform", min = "2 mm", max = "2.5 mm" }
lower = [0.02, 0.02]
counts = [28, 28]
spacing = [0.006, 0.006]
jitter = 0.05
[[walls]]
kind = "polyline"
closed = true
points = [[0.005, 0.005], [0.195, 0.005], [0.195, 0.195], [0.005, 0.195]]
[md]
tangential = "cundall-strack"
duration = 0.1
[[analysis]]
name = "chains"
kind = "force-chains"
every = 0.005
""" + outputs + 'trajectory = ["dump", "book", "xyz", "vtp"]\ntrajectory_every = 0.02\npicture_every = 0.02\n', "0.001"),
    "md, spheres": ("""[domain]
dimension = 3
upper = [0.08, 0.08, 0.08]
gravity = [0, 0, -9.81]
[[materials]]
name = "glass"
young = "10 MPa"
dissipation = "50 us"
friction = 0.5
tangential_damping = 0.1
[[grains]]
radius = "4 mm"
lower = [0.008, 0.008, 0.005]
counts = [8, 8, 8]
spacing = [0.009, 0.009, 0.009]
[[walls]]
kind = "box"
points = [[0, 0, 0], [0.08, 0.08, 0.08]]
[md]
duration = 0.05
adaptive_dt = true
""" + outputs + "trajectory_every = 0.01\npicture_every = -1\n", "0.0005"),
    "edmd": ("""method = "edmd"
[domain]
upper = [60, 60]
periodic = ["x"]
[gas]
particles = 1500
temperature = 1
restitution = 0.95
[[sides]]
side = "-y"
kind = "heated"
temperature = 1
[edmd]
duration = 150
structure_every = -1
""" + outputs + "picture_every = 50\ntrajectory_every = 30\nlog_every = 0.37\n", "1"),
    "edmd, logarithmic": ("""method = "edmd"
[domain]
upper = [40, 40]
periodic = ["x", "y"]
[gas]
particles = 800
temperature = 1
restitution = 0.95
[edmd]
duration = 500
output_spacing = "log-time"
structure_every = 10
""" + outputs, "3"),
    "dsmc": ("""method = "dsmc"
[domain]
dimension = 3
upper = [10, 10, 10]
periodic = ["x", "y"]
[gas]
particles = 5000
diameter = 0.3
temperature = 1
restitution = 0.9
[[sides]]
side = "+z"
kind = "heated"
temperature = 1
[dsmc]
duration = 400
""" + outputs + "trajectory_every = 100\n", "2"),
    "lattice gas": ("""method = "lattice-gas"
[lattice_gas]
rule = "fhp-3"
columns = 300
rows = 200
velocity = [0.1, 0]
drive = 0.01
steps = 20000
[[obstacles]]
centre = [60, 100]
radius = 15
""" + outputs + "picture_every = 5000\n", "200"),
    "pipe flow": ("""method = "pipe-flow"
[pipe_flow]
length = 1000
width = 21
dissipation = 0.1
gravity = 0.5
roughness = 0.5
steps = 60000
""" + outputs + "picture_every = 10000\n", "500"),
    "sandpile": ("""method = "sandpile"
[sandpile]
columns = 100
rows = 100
drive = "random"
steps = 60000
""" + outputs + "picture_every = 10000\n", "500"),
    "heap": ("""method = "heap"
[heap]
columns = 300
roughness = 0.5
heaps = 64
steps = 3000
""" + outputs, "30"),
    "ripples": ("""method = "ripples"
[ripples]
columns = 200
rows = 100
transport = 0.6
wind = 2
length = 7.3
creep = 0.8
steps = 3000
""" + outputs + "picture_every = 1000\n", "30"),
}


def results(out):
    """{name: content} of the files of a run but what tells of the process."""
    return {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*")
            if path.is_file() and path.name not in told_by_the_process and path.suffix != ".checkpoint"}


def newest(out):
    return max((out / "checkpoints").glob("*.checkpoint"), default=None) if (out / "checkpoints").exists() else None


class Scene:
    """A scene of its own folder, with the undisturbed run in it."""

    def __init__(self, folder, name):
        self.folder, self.name = trial.clear(folder), name
        self.text, self.every = scenes[name]
        (self.folder / "scene.toml").write_text(self.text)
        self.out = self.folder / "out"
        begin = time.monotonic()
        done = trial.sandlane(self.folder, "run", "scene.toml", "--out", "whole", "--quiet", "-j", 1)
        if done.returncode:
            raise SystemExit(f"{name}: {done.stderr}")
        self.seconds = time.monotonic() - begin
        self.whole = results(self.folder / "whole")
        self.hash = self.state_hash(self.folder / "whole")

    @staticmethod
    def state_hash(out):
        return (out / "summary.json").read_text().split('"state_hash"')[1]

    def command(self, checkpoint):
        words = ["run", "--resume", checkpoint] if checkpoint else [
            "run", "scene.toml", "--out", "out", "--set", f"output.checkpoint_every={self.every}"]
        return [str(measure.build / "sandlane"), *map(str, words), "--quiet", "-j", "1"]

    def fresh(self):
        shutil.rmtree(self.out, ignore_errors=True)

    def finish(self, checkpoint):
        done = subprocess.run(self.command(checkpoint), cwd=self.folder, capture_output=True, text=True)
        return f"exit {done.returncode}: {done.stderr.strip()[:100]}" if done.returncode else ""

    def difference(self):
        """From the undisturbed run; empty: none."""
        if self.state_hash(self.out) != self.hash:
            return "another state"
        found = results(self.out)
        wrong = sorted(name for name in self.whole.keys() | found.keys() if self.whole.get(name) != found.get(name))
        return "other files: " + ", ".join(wrong[:4]) if wrong else ""


def killed(scene, kills, seed):
    """SIGKILL after random times, and again on the way from each checkpoint; rounds from a fresh start."""
    dice = random.Random(f"{seed} {scene.name}")
    done, ends, at_once = 0, 0, 0
    while done < kills:
        scene.fresh()
        checkpoint, patience = None, 1.0
        while done < kills:
            process = subprocess.Popen(scene.command(checkpoint), cwd=scene.folder, stderr=subprocess.PIPE, text=True)
            # A quarter of them early, while files are opened or continued.
            wait = scene.seconds * patience * (dice.uniform(0, 0.5) if dice.random() > 0.25 else dice.uniform(0, 0.02))
            try:
                process.wait(wait)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
            said = process.communicate()[1]
            if process.returncode == 0:
                break
            if process.returncode != -signal.SIGKILL:
                return False, f"after {done} kills exit {process.returncode}: {trial.shortened(said)}"
            done += 1
            latest = newest(scene.out)
            patience = patience * 1.3 if latest == checkpoint else 1.0
            checkpoint = latest
            if checkpoint is None:
                at_once += 1
                scene.fresh()
        else:
            trouble = scene.finish(checkpoint)
            if trouble:
                return False, f"after {done} kills {trouble}"
        ends += 1
        wrong = scene.difference()
        if wrong:
            return False, f"after {done} kills {wrong}"
    return True, f"{done} kills, {at_once} before the first checkpoint; {ends} runs ended, all with the bits and files of the undisturbed"


def full(scene, *_):
    """A limit on the size of files below, at and above the size of each file in turn: whatever write meets it first."""
    sizes = {0, 1, 100, 4096} | {size + more for size in map(len, scene.whole.values()) for more in (-1, 0) if size + more >= 0}
    checkpoint = newest(scene.folder / "whole").stat().st_size
    sizes |= {checkpoint // 2, checkpoint - 1}
    stops = resumed = 0
    for size in sorted(sizes):
        scene.fresh()

        def limit(size=size):
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        done = subprocess.run(scene.command(None), cwd=scene.folder, capture_output=True, text=True, preexec_fn=limit)
        if done.returncode == 0:
            continue
        if done.returncode != failed or "File too large" not in done.stderr:
            return False, f"limit {size}: exit {done.returncode}: {trial.shortened(done.stderr)}"
        stops += 1
        left = [path.name for path in scene.folder.rglob("*.tmp")]
        if left:
            return False, f"limit {size}: {left} left behind"
        latest = newest(scene.out)
        if latest is None:
            continue
        trouble = scene.finish(latest) or scene.difference()
        if trouble:
            return False, f"limit {size}: {trouble}"
        resumed += 1
    return True, f"{len(sizes)} limits, {stops} stopped with exit 5 and the name of the file; {resumed} went on to the undisturbed results"


def read_only(scene, *_):
    """Folders that may not be written; root keeps to permissions without two of its capabilities."""
    def obey():
        import ctypes
        if os.geteuid() == 0:
            library = ctypes.CDLL(None, use_errno=True)
            for capability in (1, 2):  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
                library.prctl(24, capability, 0, 0, 0)  # PR_CAPBSET_DROP

    said = []
    for closed in ("out", "out/checkpoints", "out/pictures", "out/maps"):
        scene.fresh()
        trouble = scene.finish(None)
        if trouble:
            return False, trouble
        folder = scene.folder / closed
        if not folder.exists():
            continue
        # Go on from the middle, into a folder that is closed by now.
        first = min((scene.out / "checkpoints").glob("*.checkpoint"))
        mode = folder.stat().st_mode
        before = results(scene.out)
        folder.chmod(0o500)
        done = subprocess.run(scene.command(first), cwd=scene.folder, capture_output=True, text=True, preexec_fn=obey)
        folder.chmod(mode)
        said.append(f"{closed}: exit {done.returncode}")
        if done.returncode == 0 and closed == "out/pictures":
            continue  # no picture was due any more
        if done.returncode != failed or "ermission denied" not in done.stderr:
            return False, f"{closed}: exit {done.returncode}: {trial.shortened(done.stderr)}"
        if closed == "out" and results(scene.out) != before and not set(before) <= set(results(scene.out)):
            return False, "files are lost"
    return True, "; ".join(said)


def damaged(scene, kills, seed):
    """Cut at random places, single bits turned, and checkpoints of all other engines put in its place."""
    dice = random.Random(f"{seed} damage {scene.name}")
    good = newest(scene.folder / "whole").read_bytes()
    before = results(scene.folder / "whole")
    bad = scene.folder / "whole/checkpoints/999999999999.checkpoint"
    count = max(10, kills // 4)
    for n in range(2 * count):
        if n < count:
            content = good[:dice.randrange(len(good))]
        else:
            content = bytearray(good)
            content[dice.randrange(len(good))] ^= 1 << dice.randrange(8)
        bad.write_bytes(content)
        done = trial.sandlane(scene.folder, "run", "--resume", bad, "--quiet")
        if done.returncode != failed or results(scene.folder / "whole") != before:
            return False, f"{'cut' if n < count else 'turned'}, {n}: exit {done.returncode} {trial.shortened(done.stderr)}"
    bad.unlink()
    return True, f"{count} cut ones and {count} with a bit turned: all refused with exit 5, no file changed"


def swapped(scene, *_):
    """Checkpoints of all other scenes, and of the same one with another seed."""
    before = results(scene.folder / "whole")
    place = scene.folder / "whole/checkpoints/999999999999.checkpoint"
    others = []
    for name, (text, _) in {**scenes, "another seed": (scene.text, "")}.items():
        if name == scene.name:
            continue
        (scene.folder / "other.toml").write_text(text)
        shutil.rmtree(scene.folder / "other", ignore_errors=True)
        trial.sandlane(scene.folder, "run", "other.toml", "--out", "other", "--steps", 3, "--quiet", "--set",
                       f"seed={9 if name == 'another seed' else 1}")
        shutil.copy(newest(scene.folder / "other"), place)
        done = trial.sandlane(scene.folder, "run", "--resume", place, "--quiet")
        if done.returncode != failed or results(scene.folder / "whole") != before:
            return False, f"of {name}: exit {done.returncode} {trial.shortened(done.stderr)}"
        others.append(name)
    place.unlink()
    return True, f"{len(others)} of other scenes and another seed: refused with exit 5, no file changed"


def two_at_once(scene, *_):
    """A second run, and a resumed one, into the folder of a running one, and into that of a finished one."""
    scene.fresh()
    first = subprocess.Popen(scene.command(None), cwd=scene.folder, stderr=subprocess.DEVNULL)
    try:
        while first.poll() is None and newest(scene.out) is None:
            time.sleep(0.001)
        codes = []
        for command in (scene.command(None), scene.command(newest(scene.out))):
            done = subprocess.run(command, cwd=scene.folder, capture_output=True, text=True)
            codes.append((done.returncode, first.poll() is None))
    finally:
        first.wait()
    wrong = scene.difference()
    good = first.returncode == 0 and all(code == refused for code, running in codes if running) and not wrong
    return good, f"exits {[code for code, _ in codes]} while the first one ran; it ended {'undisturbed' if not wrong else wrong}"


faults = (
    ("killed by SIGKILL and resumed", "same state hash, log, trajectories, analyses, pictures as undisturbed", killed),
    ("disk full at every write", "exit 5 naming the file, no temporary file, goes on from the last checkpoint", full),
    ("read-only folders", "exit 5, what is there stays", read_only),
    ("truncated and bit-flipped checkpoints", "refused, nothing written", damaged),
    ("checkpoints of other runs", "refused, nothing written", swapped),
    ("two runs in one folder", "the second is refused with exit 2, the first undisturbed", two_at_once),
)


def main(options):
    folder = measure.results / "faults"
    rows, bad = [], 0
    for name in scenes:
        if options.only and not any(word in name for word in options.only):
            continue
        scene = Scene(folder / name.replace(", ", "-").replace(" ", "-"), name)
        for fault, expected, test in faults:
            begin = time.monotonic()
            good, observed = test(scene, options.kills, options.seed)
            print(f"{'ok    ' if good else 'FAILED'} {time.monotonic() - begin:7.1f} s  {name}: {fault}: {observed}", file=sys.stderr,
                  flush=True)
            bad += not good
            rows.append((name, fault, expected, observed, "holds" if good else "FAILS"))
    with open(measure.results / "faults.csv", "w", newline="") as file:
        csv.writer(file).writerows([columns, *rows])
    text = tables.head(*columns) + "".join(tables.row(*row) for row in rows)
    if options.write:
        tables.fill(page, "faults", f"{measure.machine()}; {options.kills} kills of each, seed {options.seed}.\n\n{text}")
    print(text)
    return 1 if bad else 0
