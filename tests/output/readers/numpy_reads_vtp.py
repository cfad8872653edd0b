#!/usr/bin/env python3
"""Reads frames/*.vtp and trajectory.pvd by the rules of VTK's XML format: header, appended blocks, cells.
usage: numpy_reads_vtp.py SAMPLES
"""
import json
import pathlib
import sys
import xml.etree.ElementTree as xml

try:
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}; Debian's python3-numpy brings it")
    sys.exit(77)

types = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8"}


def read_vtp(path):
    """(piece, arrays by name, time): every appended block is a UInt64 length in bytes and the values."""
    content = path.read_bytes()
    start = content.index(b'<AppendedData encoding="raw">')
    underscore = content.index(b"_", start) + 1
    end = content.rindex(b"</AppendedData>")
    root = xml.fromstring(content[:underscore] + content[end:])
    assert root.attrib["type"] == "PolyData" and root.attrib["byte_order"] == "LittleEndian"
    assert root.attrib["header_type"] == "UInt64"
    piece = root.find("PolyData/Piece")
    arrays, used = {}, 0
    for array in piece.iter("DataArray"):
        at = underscore + int(array.attrib["offset"])
        length = int(np.frombuffer(content, "<u8", 1, at)[0])
        values = np.frombuffer(content[at + 8 : at + 8 + length], types[array.attrib["type"]])
        components = int(array.attrib["NumberOfComponents"])
        arrays[array.attrib["Name"]] = values.reshape(-1, components) if components > 1 else values
        used += 8 + length
    assert content[underscore + used : end] == b"\n", "bytes that no array claims"
    return piece, arrays, float(root.find("PolyData/FieldData/DataArray").text)


def check_grains(path, frame):
    piece, arrays, time = read_vtp(path)
    n = len(frame["id"])
    assert time == frame["time"] and int(piece.attrib["NumberOfPoints"]) == n
    single = lambda key: np.asarray(frame[key], "f4")
    axes = frame["dimension"]
    for k, key in enumerate(("x", "y", "z")[:axes]):
        np.testing.assert_array_equal(arrays["Points"][:, k], single(key))
        np.testing.assert_array_equal(arrays["velocity"][:, k], single("v" + key))
    if axes == 2:
        assert not arrays["Points"][:, 2].any() and not arrays["velocity"][:, 2].any()
    else:
        spin = np.transpose([single(key) for key in ("omega_x", "omega_y", "omega")])
        np.testing.assert_array_equal(arrays["omega"], spin)
        assert ("orientation" in arrays) == bool(frame["orientation"])
        if frame["orientation"]:
            np.testing.assert_array_equal(arrays["orientation"], single("orientation"))
    for key in ("radius", "mass", "pressure") + (("omega", "angle") if axes == 2 else ()):
        np.testing.assert_array_equal(arrays[key], single(key), err_msg=key)
    for key in ("id", "material"):
        np.testing.assert_array_equal(arrays[key], frame[key], err_msg=key)
    np.testing.assert_array_equal(arrays["connectivity"], np.arange(n))
    np.testing.assert_array_equal(arrays["offsets"], np.arange(1, n + 1))


def check_triangles(path, frame):
    piece, arrays, _ = read_vtp(path)
    count = len(frame["triangles"])
    assert int(piece.attrib["NumberOfPolys"]) == count and int(piece.attrib["NumberOfLines"]) == 0
    np.testing.assert_array_equal(arrays["offsets"], 3 * np.arange(1, count + 1))
    corners = arrays["Points"][arrays["connectivity"]].reshape(count, 3, 3)
    np.testing.assert_array_equal(corners, np.asarray(frame["triangles"], "f4"))


def check_walls(path, frame):
    if frame["dimension"] == 3:
        check_triangles(path, frame)
        return
    piece, arrays, _ = read_vtp(path)
    assert int(piece.attrib["NumberOfLines"]) == frame["walls"] == len(arrays["offsets"])
    assert arrays["offsets"][-1] == len(arrays["connectivity"])
    assert arrays["connectivity"].max() < len(arrays["Points"]) == int(piece.attrib["NumberOfPoints"])
    # The polygon of a disc lies on its circle and is closed; float32 has 7 digits.
    for line, disc in zip([1], frame["discs"]):
        points = arrays["Points"][arrays["connectivity"][arrays["offsets"][line - 1] : arrays["offsets"][line]]]
        distance = np.hypot(points[:, 0] - disc["x"], points[:, 1] - disc["y"])
        np.testing.assert_allclose(distance, disc["radius"], rtol=1e-5)
        np.testing.assert_allclose(points[0], points[-1], atol=1e-7)


def main():
    for case in ("walled", "periodic", "space", "periodic-space"):
        folder = pathlib.Path(sys.argv[1]) / case
        expected = json.loads((folder / "expected.json").read_text())
        sets = [entry.attrib for entry in xml.parse(folder / "trajectory.pvd").getroot().iter("DataSet")]
        for part, check in (("0", check_grains), ("1", check_walls)):
            files = [entry for entry in sets if entry["part"] == part]
            assert len(files) == (len(expected) if part == "0" or expected[0]["walls"] else 0)
            for entry, frame in zip(files, expected):
                assert float(entry["timestep"]) == frame["time"]
                check(folder / entry["file"], frame)
        print(f"{case}: {len(sets)} files read")


main()
