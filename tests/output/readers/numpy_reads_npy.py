#!/usr/bin/env python3
"""Reads a field as numpy does: shape, type, order of rows.
usage: numpy_reads_npy.py SAMPLES
"""
import pathlib
import sys

try:
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; Debian's python3-numpy brings it")
    sys.exit(77)

field = np.load(pathlib.Path(sys.argv[1]) / "fields" / "field.npy")
assert field.shape == (5, 7) and field.dtype == np.dtype("<f4"), (field.shape, field.dtype)
assert (field == 10 * np.arange(5)[:, None] + np.arange(7)).all(), field
print("field.npy: 5 rows of 7 numbers")
