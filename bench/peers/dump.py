"""What LAMMPS, LIGGGHTS and sandlane write alike."""
import re

import numpy


def read_dump(path):
    """Last frame of a LAMMPS dump in the order of ids: {column: values}."""
    frame = path.read_text().split("ITEM: ATOMS ")[-1].splitlines()
    names = frame[0].split()
    values = numpy.array([line.split() for line in frame[1:] if line and not line.startswith("ITEM")], dtype=float)
    return dict(zip(names, values[numpy.argsort(values[:, names.index("id")])].T))


def loop_rate(text):
    """Particle-steps per second of the last run that LAMMPS or LIGGGHTS reports."""
    seconds, steps, atoms = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text)[-1]
    return int(steps) * int(atoms) / float(seconds)
