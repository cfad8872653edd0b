"""Event-driven dynamics against the same in long double (edmd_accuracy.cpp): times of events, energy, and what an event
costs by both algorithms."""
import csv
import math
import statistics
import subprocess

import accuracy_tables as common
import measure
import tables

# Dimension, packing fraction, particles, gravity: above 0 a box with walls, periodic else.
systems = {"30 discs, periodic": (2, 0.5, 30, 0), "30 spheres, periodic": (3, 0.3, 30, 0),
           "12 discs, walls and gravity": (2, 0.3, 12, 0.2)}
short = {"30 discs, periodic": "discs", "30 spheres, periodic": "spheres", "12 discs, walls and gravity": "walls"}
seeds, most = 8, 600
shown = (10, 50, 100, 200)
distances = (0.0, 1e3, 1e6, 1e9)
sizes = (30, 300, 1000, 10000, 100000)
largest_simple = 1000  # every pair is remembered


def program(*words):
    """Rows of its CSV."""
    text = subprocess.run([measure.build / "bench/edmd_accuracy", *map(str, words)], capture_output=True, text=True,
                          check=True).stdout
    return [{k: float(v) if k != "hash" else v for k, v in row.items()} for row in csv.DictReader(text.splitlines())]


def course(system, distance, seed, events):
    dimension, phi, particles, gravity = systems[system]
    return program("errors", dimension, phi, particles, events, distance, gravity, seed)


def middle(runs, event, key):
    """Median over seeds of the size of a value at an event; nan where fewer than half the runs have come so far."""
    values = [abs(run[event - 1][key]) for run in runs if len(run) >= event]
    return statistics.median(values) if 2 * len(values) > len(runs) else math.nan


def growth(runs):
    """Rate at which the error of the time grows, per collision of a particle: slope of the log of its median."""
    points = [(n, middle(runs, n, "error")) for n in range(5, most, 5)]
    points = [(n, math.log(e)) for n, e in points if 1e-14 < e < 1e-3]
    mean = [sum(p[k] for p in points) / len(points) for k in (0, 1)]
    return sum((a - mean[0]) * (b - mean[1]) for a, b in points) / sum((a - mean[0]) ** 2 for a, _ in points)


def evaluate():
    found = {"courses": {name: [course(name, 0, seed, most) for seed in range(1, seeds + 1)] for name in systems}}
    found["far"] = {str(d): [course("30 discs, periodic", d, seed, 100) for seed in range(1, seeds + 1)] for d in distances}
    return found


def times(rounds, events=200000):
    """{(algorithm, particles): row of the program with the median of its times}"""
    found = {}
    for _ in range(rounds):
        for n in sizes:
            for algorithm in ("simple", "improved"):
                if algorithm == "improved" or n <= largest_simple:
                    some = max(1000, 10 * events // (7 * n)) if algorithm == "simple" else events
                    row = program("cost", algorithm, 2, 0.5, n, some)[0]
                    found.setdefault((algorithm, n), []).append(row)
    return {key: dict(rows[0], ns=statistics.median(r["ns"] for r in rows)) for key, rows in found.items()}


def course_table(courses):
    text = tables.head("error of the time, median of 8 starts", *(f"event {n}" for n in shown), "grows per event by",
                       "events in the same order", "of one prediction", "energy, largest")
    for name, runs in courses.items():
        cells = [middle(runs, n, "error") for n in shown]
        steps = [abs(r["predicted"]) for run in runs for r in run]
        drift = max(abs(r["energy"]) for run in runs for r in run)
        order = statistics.median(len(run) for run in runs)
        text += tables.row(name, *("-" if math.isnan(c) else f"{c:.1e}" for c in cells), f"{math.exp(growth(runs)):.3f}",
                           f"all {most}" if order == most else int(order), f"{statistics.median(steps):.1e}", f"{drift:.1e}")
    return text


def far_table(far):
    text = tables.head("box at, diameters", "of one prediction, median", "event 50", "event 100", "energy, largest")
    for distance, runs in far.items():
        steps = [abs(r["predicted"]) for run in runs for r in run]
        drift = max(abs(r["energy"]) for run in runs for r in run)
        text += tables.row(f"{float(distance):.0e}" if float(distance) else "0", f"{statistics.median(steps):.1e}",
                           *("-" if math.isnan(e) else f"{e:.1e}" for e in (middle(runs, n, "error") for n in (50, 100))),
                           f"{drift:.1e}")
    return text


def cost_table(found):
    text = tables.head("discs", "simple, ns per event", "improved, ns per event", "energy after the events of improved")
    for n in sizes:
        ns = {a: found[a, n]["ns"] for a in ("simple", "improved") if (a, n) in found}
        # The same events, bit for bit: the cheaper one is the front.
        cells = [f"**{ns[a]:.0f}**" if ns[a] == min(ns.values()) else f"{ns[a]:.0f}" for a in ns]
        text += tables.row(n, *(["-"] * (2 - len(cells))), *cells, f"{found['improved', n]['energy']:+.1e}")
    return text


def check():
    runs = [course("30 discs, periodic", 0, seed, 120) for seed in (1, 2, 3)]
    wrong = common.verdict(0, "edmd: error of one prediction, median",
                           statistics.median(r["predicted"] for run in runs for r in run), 0, 4e-16)
    wrong = common.verdict(wrong, "edmd: error of the time after 50 events", middle(runs, 50, "error"), 0, 1e-12)
    wrong = common.verdict(wrong, "edmd: energy", max(abs(r["energy"]) for run in runs for r in run), 0, 2e-14)
    wrong = common.verdict(wrong, "edmd: events in the order of the reference", min(map(len, runs)), 120, 120)
    far = [[r["predicted"] for r in course("30 discs, periodic", d, 1, 60)] for d in distances[1:]]
    slope = common.power(distances[1:], [statistics.median(f) for f in far])
    wrong = common.verdict(wrong, "edmd: order of that error in the distance from the origin", slope, 0.8, 1.2)
    both = [program("cost", a, 2, 0.5, 30, 2000)[0]["hash"] for a in ("simple", "improved")]
    return common.verdict(wrong, "edmd: hash of the events of both algorithms, differences", both[0] != both[1], 0, 0)


def main(options):
    if options.check:
        return check()
    found = common.remembered("edmd-errors", options, evaluate)
    costs = times(options.rounds)
    rows = [[n, *(middle(runs, n, "error") for runs in found["courses"].values())] for n in range(1, most + 1)]
    rows = [[cell if cell else math.nan for cell in row] for row in rows]
    path = common.save("edmd-times", ["event", *(short[name] for name in found["courses"])], rows)
    common.draw(path, "event", list(short.values()), "y", "accuracy-events" if options.write else None)
    common.save("edmd", ("algorithm", "discs", "ns_per_event", "energy", "smallest_gap", "hash"),
                [(*key, r["ns"], r["energy"], r["gap"], r["hash"]) for key, r in costs.items()])
    common.publish(options, {"edmd-times": course_table(found["courses"]), "edmd-far": far_table(found["far"]),
                             "edmd-cost": f"{measure.machine()}.\n\n{cost_table(costs)}"})
    return 0
