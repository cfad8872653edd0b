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
    close(atoms.positions[:, 2], frame.get("z", np.zeros(len(atoms))), "z")
    close(atoms.pbc, frame["periodic"], "periodic")
    axes = frame["dimension"]
    lengths = np.subtract(frame["upper"], frame["lower"])[:axes]
    # ASE computes the cell from differences of its own: an ulp or two.
    np.testing.assert_allclose(atoms.cell.lengths()[:axes], lengths, rtol=1e-15)


def check_dump(atoms, frame):
    # The order of positions shows the ids: ASE sorts by them and then forgets them.
    check_common(atoms, frame)
    axes = frame["dimension"]
    close(atoms.get_celldisp().ravel()[:axes], frame["lower"][:axes], "corner of the box")
    # ASE takes the numbers for LAMMPS's "metal" units (A/ps) and converts them: a few roundings.
    for k, key in enumerate(("vx", "vy", "vz")[:axes]):
        wanted = np.asarray(grains(frame, key)) * ase.units.Ang / (1e3 * ase.units.fs)
        np.testing.assert_allclose(atoms.get_velocities()[:, k], wanted, rtol=1e-14)


def check_xyz(atoms, frame):
    check_common(atoms, frame)
    n = len(frame["id"])
    assert atoms.info["Time"] == frame["time"], atoms.info
    assert atoms.info["Step"] == frame["step"], atoms.info
    axes = frame["dimension"]
    close(atoms.info["Origin"][:axes], frame["lower"][:axes], "origin")
    for k, key in enumerate(("vx", "vy", "vz")[:axes]):
        close(atoms.arrays["velo"][:, k], grains(frame, key), key)
    close(atoms.arrays["radius"], grains(frame, "radius"), "radius")
    for key in ("id", "mass", "pressure", "material"):
        close(atoms.arrays[key][:n], frame[key], key)
    if axes == 2:
        close(atoms.arrays["omega"][:n], frame["omega"], "omega")
        close(atoms.arrays["angle"][:n], frame["angle"], "angle")
    else:
        close(atoms.arrays["omega"], np.transpose([frame[key] for key in ("omega_x", "omega_y", "omega")]), "omega")
        assert ("orientation" in atoms.arrays) == bool(frame["orientation"])
        if frame["orientation"]:
            close(atoms.arrays["orientation"], np.roll(frame["orientation"], -1, axis=1), "x y z w")
    close(atoms.numbers[:n], [material + 1 for material in frame["material"]], "element stands for material")


def main():
    for case in ("walled", "periodic", "space", "periodic-space"):
        folder = pathlib.Path(sys.argv[1]) / case
        expected = json.loads((folder / "expected.json").read_text())
        for name, form, check in (("dump", "lammps-dump-text", check_dump), ("xyz", "extxyz", check_xyz)):
            frames = ase.io.read(folder / f"trajectory.{name}", index=":", format=form)
            assert len(frames) == len(expected), f"{name}: {len(frames)} frames for {len(expected)}"
            for atoms, frame in zip(frames, expected):
                check(atoms, frame)
            print(f"{case}: {len(frames)} frames of {form} read")


main()
