"""Runs of small scenes that a script writes: a case says what it expects before it runs."""
import collections
import csv
import json
import pathlib
import re
import shutil
import subprocess

import measure

quiet = """[output]
picture_every = -1
trajectory_every = -1
report = false
movie = false
"""

Case = collections.namedtuple("Case", "name source expected run soak")
Tested = collections.namedtuple("Tested", "name source expected test")  # in tools/test already
Verdict = collections.namedtuple("Verdict", "observed good")

cases = []


def case(name, source, expected, soak=False):
    """Registers a function of a folder that returns Verdict; source: where the specification asks for it."""
    def add(run):
        cases.append(Case(name, source, expected, run, soak))
        return run
    return add


def tested(name, source, expected, test):
    cases.append(Tested(name, source, expected, test))


def clear(folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


class Run:
    """`sandlane run` of a scene in a fresh folder, to its end: code, said, summary, log. patience: s, after which it hangs."""

    def __init__(self, folder, scene, *options, output=quiet, threads=1, patience=300):
        self.folder = clear(folder)
        (self.folder / "scene.toml").write_text(scene + output)
        done = sandlane(self.folder, "run", "scene.toml", "--out", "out", "-j", threads, "--quiet", *options,
                        timeout=patience)
        self.code, self.said = done.returncode, done.stderr.strip()
        path = self.folder / "out/summary.json"
        self.summary = json.loads(path.read_text()) if path.exists() else {}

    @property
    def log(self):
        """{column without its unit: numbers}"""
        with open(self.folder / "out/log.csv") as file:
            rows = list(csv.DictReader(file))
        return {name.split("[")[0]: [float(row[name]) for row in rows] for name in rows[0]}

    def refuses(self, code, *words):
        """A verdict on an error message of one line."""
        good = self.code == code and all(word in self.said for word in words)
        return Verdict(f"exit {self.code}: {shortened(self.said)}", good)


def shortened(text, most=150):
    line = " ".join(text.split())
    return line if len(line) <= most else line[:most - 3] + "..."


def sandlane(folder, *arguments, **more):
    return subprocess.run([measure.build / "sandlane", *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                          **more)


def exists(test):
    """Whether a GoogleTest "Suite.Name" stands in the sources of the tests."""
    suite, name = test.split(".")
    pattern = re.compile(rf"TEST(?:_F|_P)?\({suite}, {name}\)")
    return any(pattern.search(path.read_text()) for path in (measure.root / "tests").rglob("*.cpp"))
