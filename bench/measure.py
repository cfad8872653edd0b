"""Runs the benchmark programs and hands their results on as plain records."""
import datetime
import json
import os
import pathlib
import re
import statistics
import subprocess

root = pathlib.Path(__file__).resolve().parent.parent
build = pathlib.Path(os.environ.get("SANDLANE_BUILD", root / "build/release"))
results = root / "build/bench"


def program(name, arguments, save):
    """Output of one benchmark program, JSON; progress of the program goes to the terminal's stderr."""
    results.mkdir(parents=True, exist_ok=True)
    out = results / f"{save}.json"
    subprocess.run([build / "bench" / name, f"--benchmark_out={out}", "--benchmark_out_format=json", *arguments],
                   stdout=subprocess.DEVNULL, check=True)
    return json.loads(out.read_text())["benchmarks"]


def short(name):
    """A case by the name it was asked for: without the library's suffixes."""
    return re.sub(r"/(real_time|iterations:\d+|repeats:\d+)", "", name)


def steps(cases, rounds, seconds, save):
    """Whole-step cases, each `rounds` times in turn: {name: [record of round 0, record of round 1, ...]}."""
    pattern = "^(" + "|".join(re.escape(case) for case in cases) + ")/real_time$"
    found = {}
    for record in program("bench_md", [f"--rounds={rounds}", f"--benchmark_filter={pattern}",
                                       f"--benchmark_min_time={seconds}"], save):
        found.setdefault(short(record["name"]), []).append(record)
    missing = [case for case in cases if case not in found]
    if missing:
        raise SystemExit(f"bench_md knows no case {missing[0]}")
    return found


def in_turn(name, arguments, rounds, save):
    """A whole program several times, so that a slow spell meets all cases alike: {case: [record of round 0, ...]}."""
    found = {}
    for n in range(rounds):
        for record in program(name, arguments, f"{save}-{n}"):
            found.setdefault(short(record["name"]), []).append(record)
    return found


def roofline():
    """{name: value} of everything that bench_roofline measures."""
    keys = ("per_second", "bytes_per_second", "seconds")
    return {short(r["name"]): next(r[k] for k in keys if k in r) for r in program("bench_roofline", [], "roofline")}


def median(records, key="particle_steps_per_second"):
    return statistics.median(r[key] for r in records)


def ratio(a, b):
    """Median of the ratios of neighbouring runs, which saw the same state of the machine."""
    key = "particle_steps_per_second"
    return statistics.median(x[key] / y[key] for x, y in zip(a, b))


def info():
    """{instruction sets of this machine, best last}, compiler, CPUs: from `sandlane info`."""
    text = subprocess.run([build / "sandlane", "info"], capture_output=True, text=True, check=True).stdout
    lines = dict(re.split(r"\s+", line, maxsplit=1) for line in text.splitlines())
    isas = [isa for isa in ("scalar", "sse4.2", "avx2", "avx512") if lines.get(isa) == "available"]
    cpus = int(re.search(r"(\d+) CPUs allowed", lines["threads"])[1])
    return isas, lines["compiler"], cpus


def machine():
    """One line: processor, compiler, date."""
    model = "unknown processor"
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith(("model name", "Model")):
            model = line.split(":", 1)[1].strip()
            break
    _, compiler, cpus = info()
    return f"{model}, {cpus} CPUs, {compiler}, {datetime.date.today().isoformat()}"
