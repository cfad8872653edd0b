#!/usr/bin/env python3
"""A run that is stopped and resumed leaves the files of an undisturbed one, pictures and replay included.
usage: resumed_run.py SANDLANE FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys

scene = """
title = "Falling grains"
[domain]
lower = [0, 0]
upper = [0.2, 0.2]
gravity = [0, -9.81]
[[materials]]
name = "soft"
young = 1e6
friction = 0.5
dissipation = 1e-5
tangential_damping = 0.1
[[grains]]
kind = "lattice"
radius = "5 mm"
lower = [0.02, 0.05]
counts = [12, 8]
spacing = [0.013, 0.012]
[[walls]]
kind = "segment"
points = [[0, 0.01], [0.2, 0.02]]
motion = "shake"
[[motions]]
name = "shake"
kind = "oscillate"
amplitude = [0, 0.005]
omega = 60
[md]
duration = 0.1
[output]
picture_width = 120
trajectory = ["dump", "xyz", "vtp", "book"]
movie = false
"""
# Process and timings differ; a stopped run keeps its last checkpoints.
other = {".lock", "summary.json", "report.html"}


def run(*arguments):
    result = subprocess.run([*map(str, arguments), "--quiet", "--threads", "1"], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def files(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in other and path.suffix != ".checkpoint"
    }


def shown(folder):
    """Data of plots and replay in the report."""
    page = (folder / "report.html").read_text()
    return re.findall(r'<script type="application/.*?</script>', page, re.DOTALL)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "scene.toml").write_text(scene)
    whole, broken = folder / "whole", folder / "broken"
    run(program, "run", folder / "scene.toml", "--out", whole)
    steps = int(re.search(r'"step": (\d+)', (whole / "summary.json").read_text())[1])
    first = int(0.37 * steps)
    run(program, "run", folder / "scene.toml", "--out", broken, "--steps", first)
    checkpoint = next((broken / "checkpoints").glob("*.checkpoint"))
    kept = folder / "kept.checkpoint"
    shutil.copy(checkpoint, kept)
    # Beyond the checkpoint and back to it: what came after is cut off.
    run(program, "run", "--resume", checkpoint, "--steps", int(0.2 * steps))
    shutil.copy(kept, checkpoint)
    run(program, "run", "--resume", checkpoint)
    a, b = files(whole), files(broken)
    assert a.keys() == b.keys(), a.keys() ^ b.keys()
    different = [name for name in a if a[name] != b[name]]
    assert not different, different
    assert len(shown(whole)) == 2 and shown(whole) == shown(broken), "the report shows something else"
    print(f"{len(a)} files of {steps} steps are the same")


main()
