#!/usr/bin/env python3
"""ASE reads trajectory.dump and trajectory.xyz and finds what was written. usage: ase_reads.py SAMPLES"""
import json
import pathlib
import sys

try:
    import ase.io
    import ase.units
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; Debian's python3-ase brings it")
    sys.exit(77)


def close(found, wanted, what):
    # Both files hold the shortest text that reads back to the same bits.
    np.testing.assert_array_equal(np.asarray(found), np.asarray(wanted), err_msg=what)


def grains(frame, key):
    """Values of grains, then of wall discs where the format has them as atoms too."""
    return frame[key] + [disc[key] for disc in frame["discs"]]


def check_common(atoms, frame):
    close(atoms.positions[:, 0], grains(frame, "x"), "x")
    close(atoms.positions[:, 1], grains(frame, "y"), "y")
    close(atoms.positions[:, 2], np.zeros(len(atoms)), "z")
    close(atoms.pbc, frame["periodic"] + [False], "periodic")
    wide, high = (frame["upper"][k] - frame["lower"][k] for k in (0, 1))
    # ASE computes the cell from differences of its own: an ulp or two.
    np.testing.assert_allclose(atoms.cell.lengths()[:2], [wide, high], rtol=1e-15)


def check_dump(atoms, frame):
    # The order of positions shows the ids: ASE sorts by them and then forgets them.
    check_common(atoms, frame)
    close(atoms.get_celldisp().ravel()[:2], frame["lower"], "corner of the box")
    # ASE takes the numbers for LAMMPS's "metal" units (A/ps) and converts them: a few roundings.
    for k, key in enumerate(("vx", "vy")):
        wanted = np.asarray(grains(frame, key)) * ase.units.Ang / (1e3 * ase.units.fs)
        np.testing.assert_allclose(atoms.get_velocities()[:, k], wanted, rtol=1e-14)


def check_xyz(atoms, frame):
    check_common(atoms, frame)
    n = len(frame["id"])
    assert atoms.info["Time"] == frame["time"], atoms.info
    assert atoms.info["Step"] == frame["step"], atoms.info
    close(atoms.info["Origin"][:2], frame["lower"], "origin")
    close(atoms.arrays["velo"][:, 0], grains(frame, "vx"), "vx")
    close(atoms.arrays["velo"][:, 1], grains(frame, "vy"), "vy")
    close(atoms.arrays["radius"], grains(frame, "radius"), "radius")
    for key in ("id", "omega", "angle", "mass", "pressure", "material"):
        close(atoms.arrays[key][:n], frame[key], key)
    close(atoms.numbers[:n], [material + 1 for material in frame["material"]], "element stands for material")


def main():
    for case in ("walled", "periodic"):
        folder = pathlib.Path(sys.argv[1]) / case
        expected = json.loads((folder / "expected.json").read_text())
        for name, form, check in (("dump", "lammps-dump-text", check_dump), ("xyz", "extxyz", check_xyz)):
            frames = ase.io.read(folder / f"trajectory.{name}", index=":", format=form)
            assert len(frames) == len(expected), f"{name}: {len(frames)} frames for {len(expected)}"
            for atoms, frame in zip(frames, expected):
                check(atoms, frame)
            print(f"{case}: {len(frames)} frames of {form} read")


main()
