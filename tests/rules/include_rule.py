#!/usr/bin/env python3
"""Who may include whom: one table for our folders, one for the headers of others. One line per violation.
usage: include_rule.py [ROOT]
"""
import pathlib
import re
import sys

# Folder of src/ -> folders it may include besides its own. "door" is simd/tables.hpp and simd/ENGINE/tables.hpp, the only ways
# into simd/.
low = {"core", "scene", "laws", "motion", "analysis"}
engine = low | {"door"}
everything = {"*"}
may = {
    "core": set(),
    "laws": {"core"},
    "scene": {"core", "laws"},  # the list of laws
    "motion": {"core", "scene"},
    "analysis": {"core", "scene", "laws", "motion"},
    "output": {"core", "scene", "laws", "analysis"},
    "app": everything,
    "simd": {"core", "laws", "door"},  # simd/*.hpp and simd/dispatch.cpp
    "kernel": {"laws", "motion", "door", "simd"},  # simd/**/*.ipp, without the exceptions below
}
# What kernels may not include although its folder is open to them: it knows scenes and strings.
kernel_never = {"motion/prescribed.hpp", "laws/restitution.hpp"}
kernel_also = {"core/real.hpp"}

# Header of others -> who alone may include it.
private = [
    (r"xsimd/|(\w*intrin|arm_neon|arm_sve)\.h$", lambda path: path.startswith("simd/")),
    (r"omp\.h$", lambda path: path == "src/core/parallel.hpp"),
    (r"toml\+\+", lambda path: path.startswith("src/scene/")),
    (r"(unsupported/)?Eigen/", lambda path: path.startswith("src/rigid/") or path == "src/automata/spectrum.cpp"),
    (r"CLI/", lambda path: path.startswith("src/app/")),
    # The steady clock only, which setting the time of day does not move.
    (r"(chrono|ctime|time\.h|sys/times?\.h)$", lambda path: path == "src/core/progress.hpp"),
]
include = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]')


def layer_of(path):
    """The layer a file of src/ or simd/ belongs to."""
    parts = path.split("/")
    if parts[0] == "src":
        return parts[1]
    return "kernel" if path.endswith((".ipp", ".cpp.in")) else "simd"


def target_of(name):
    """The layer that an include with quotes names."""
    if re.fullmatch(r"simd/(\w+/)?tables\.hpp", name):
        return "door"
    if name.startswith("simd/") or name == "isas.def":
        return "simd"
    return name.split("/")[0]


def wrong(path, quote, name):
    """Why this include is not allowed, or None."""
    for pattern, allowed in private:
        if re.match(pattern, name) and not allowed(path):
            return f"<{name}> is closed to it"
    layer = layer_of(path)
    if quote == "<":
        outside = "." in name or "/" in name
        if layer == "kernel" and outside:
            return f"a kernel includes only laws, motion, simd and the standard library, not <{name}>"
        return None
    target = target_of(name)
    if path.startswith("src/") and target == "simd":
        return f'only "tables.hpp" of simd/ and its folders is open to src/, not "{name}"'
    if layer == "kernel":
        if name in kernel_also:
            return None
        if name in kernel_never:
            return f'kernels do not see "{name}"'
    allowed = may.get(layer, engine)
    if target == layer or "*" in allowed or target in allowed:
        return None
    return f'{layer} may not include {target} ("{name}")'


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    violations = seen = 0
    for folder in ("src", "simd"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".hpp", ".cpp", ".ipp", ".in"):
                continue
            path = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text().splitlines(), 1):
                found = include.match(line)
                if not found:
                    continue
                seen += 1
                reason = wrong(path, found[1], found[2])
                if reason:
                    violations += 1
                    print(f"{path}:{number}: {reason}")
    if not violations:
        print(f"{seen} includes, all allowed")
    return 0 if seen and not violations else 1


sys.exit(main())
