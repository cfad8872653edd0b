#!/usr/bin/env python3
"""sand_figures.py [hopper|heap|shear|silo|nut|drum ...]: runs the scenes of docs/scenes.md whose result takes several runs or a
look at the grains, prints the numbers and draws them into docs/pictures. Runs and tables go to build/sand-figures. Standard
library only.

hopper     how many grains leave before an arch forms, 24 seeds (ten minutes)
heap       slope and creep of heaps with and without springs at the contacts (three minutes)
shear      friction and packing fraction of the sheared cell against the inertial number (five minutes)
silo       discharge through outlets of several widths against Beverloo's law (five minutes)
nut        height of the large grain, shaken strongly and weakly (two minutes)
drum       Lacey's index of the drum in three dimensions against turns (two minutes)
"""
import json
import math
import statistics

import gas_figures as figures
from gas_figures import columns, scenes, work

figures.work = work = figures.root / "build/sand-figures"
figures.prefix = ""
quiet = ("output.picture_every=-1", "output.movie=false")


def run(program, name, *settings, scene=None):
    """The folder of a run of a shipped scene."""
    figures.run(program, scenes / f"{scene or name}.toml", name, *quiet, *settings)
    return work / name


def frames(folder):
    """(time, [(id, x, y, z, radius)]) of the trajectory of a run."""
    lines = iter((folder / "trajectory.dump").read_text().splitlines())
    for line in lines:
        if line == "ITEM: TIME":
            time = float(next(lines))
        elif line == "ITEM: NUMBER OF ATOMS":
            count = int(next(lines))
        elif line.startswith("ITEM: ATOMS"):
            at = [line.split()[2:].index(name) for name in ("id", "x", "y", "z", "radius")]
            cells = (next(lines).split() for _ in range(count))
            yield time, [tuple(float(cell[n]) for n in at) for cell in cells]


def line_through(points):
    """Intercept and slope, least squares."""
    x, y = zip(*points)
    slope, intercept = statistics.linear_regression(x, y)
    return intercept, slope


def hopper(program):
    seeds, sizes, jammed = 24, [], 0
    for seed in range(1, seeds + 1):
        out = run(program, f"hopper-{seed}", f"seed={seed}", "output.trajectory_every=-1", scene="hopper")
        end = json.loads((out / "summary.json").read_text())
        sizes.append(end["removed"])
        jammed += end["particles"] > 20 and columns(out / "log.csv")["kinetic_energy"][-1] < 1e-7
    sizes.sort()
    mean = statistics.mean(sizes)
    print(f"{jammed} of {seeds} jam; grains that left: mean {mean:.0f}, median {statistics.median(sizes):.0f}, "
          f"standard deviation {statistics.stdev(sizes):.0f}")
    found = [(s, 1 - (n + 0.5) / seeds) for n, s in enumerate(sizes)]
    figures.plot("hopper-arches", "grains", "11", {"share_above_run": found, "exponential": [
        (s, math.exp(-s / mean)) for s in range(0, int(sizes[-1]) + 1, 5)]}, "--log", "y")


def surface(grains, base=0.03):
    """Angle of the flanks of a heap [degrees]: lines through the highest grains of strips, between a fifth and four fifths of the
    height above the base."""
    top = {}
    for _, x, y, _, _ in grains:
        strip = int(x / 0.02)
        if y > top.get(strip, (0, 0))[1]:
            top[strip] = (x, y)
    peak_x, peak = max(top.values(), key=lambda p: p[1])
    low, high = base + 0.2 * (peak - base), base + 0.8 * (peak - base)
    angles = []
    for side in (-1, 1):
        flank = [p for p in top.values() if side * (p[0] - peak_x) > 0 and low < p[1] < high]
        if len(flank) > 1:
            angles.append(math.degrees(math.atan(abs(line_through(flank)[1]))))
    return statistics.mean(angles)


def heap(program):
    series = {}
    for law in ("cundall-strack", "haff-werner"):
        out = run(program, f"heap-{law}", "md.duration=12")
        states = list(frames(out))
        mean = {t: statistics.mean(g[2] for g in grains) for t, grains in states if t > 5.5}
        late = [surface(grains) for t, grains in states if t > 11]
        early = [surface(grains) for t, grains in states if 5.5 < t < 6.5]
        first, last = min(mean), max(mean)
        log = columns(out / "log.csv")
        print(f"{law}: slope {statistics.mean(early):.1f} degrees at {first:.1f} s, {statistics.mean(late):.1f} at {last:.1f} s; "
              f"mean height fell by {1e6 * (mean[first] - mean[last]):.2f} um; kinetic energy {log['kinetic_energy'][-1]:.1e} J")
        series[law.replace("-", "_")] = [(t, 1e6 * (mean[first] - h)) for t, h in mean.items()]
    figures.plot("heap-creep", "time", ["s", "um"], series)


def shear(program):
    mass, friction, density = 2500 * 4 / 3 * math.pi * 1e-6 * (6**4 - 4**4) / 8 * 1e-3, [], []  # kg, mean of R^3, 4 to 6 mm
    for phi in (0.60, 0.66, 0.70, 0.74, 0.77, 0.79, 0.81):
        out = run(program, f"shear-{phi}", f"grains.0.packing_fraction={phi}", "output.trajectory_every=-1", scene="sheared-cell")
        bulk, height = columns(out / "bulk.csv"), columns(out / "height.csv")
        late = [n for n, t in enumerate(bulk["time"]) if t > 1]
        mean = {key: statistics.mean(bulk[key][n] for n in late) for key in bulk}
        middle = [(y, v) for y, v in zip(height["y"], height["velocity_x"]) if 0.06 < y < 0.16]
        rate = line_through(middle)[1]
        pressure = mean["pressure"] + 0.5 * (mean["kinetic_xx"] + mean["kinetic_yy"])
        number = rate * math.sqrt(mass / pressure)
        friction.append((number, -(mean["stress_xy"] + mean["kinetic_xy"]) / pressure))
        density.append((number, mean["packing_fraction"]))
        print(f"packing fraction {phi} of the start: shear rate {rate:.3f} 1/s, pressure {pressure:.3g} N/m, I = {number:.4f}, "
              f"mu = {friction[-1][1]:.3f}, phi = {density[-1][1]:.3f}, Z = {mean['contact_number']:.2f}")
    figures.plot("shear-friction", "inertial_number", "11", {"friction_run": friction, "packing_fraction_run": density}, "--log", "x")


def silo(program):
    d, rates = 0.006, []
    for radius in (0.012, 0.015, 0.018, 0.021):
        low = 0.0954 - (0.05 - radius) / math.tan(math.radians(30))
        out = run(program, f"silo-{radius}", f"walls.1.radius={radius}", f"walls.1.points=[[0, 0, {low}], [0, 0, 0.0954]]",
                  f"analysis.0.from=[-0.05, -0.05, {low - 0.005}]", f"analysis.0.to=[0.05, 0.05, {low - 0.005}]",
                  f"md.duration={1.2 if radius > 0.02 else 1.5}", "output.trajectory_every=-1", scene="silo")
        flow = columns(out / "outflow.csv")
        steady = [-w for t, w in zip(flow["time"], flow["mass_flow"]) if 0.4 < t < 1.0]
        rates.append((2 * radius, statistics.mean(steady)))
        law = 0.58 * 1500 * math.sqrt(9.81) * (2 * radius - 1.4 * d) ** 2.5
        print(f"outlet {2e3 * radius:.0f} mm: {rates[-1][1]:.4f} kg/s, Beverloo {law:.4f} ({rates[-1][1] / law:.2f})")
    intercept, slope = line_through([(width, w**0.4) for width, w in rates])
    print(f"W^(2/5) = 0 at {-intercept / slope / d:.2f} d; prefactor {slope**2.5 / 1500 / math.sqrt(9.81):.2f}")
    curve = [(0.022 + 0.0005 * n, 0.58 * 1500 * math.sqrt(9.81) * (0.022 + 0.0005 * n - 1.4 * d) ** 2.5) for n in range(43)]
    figures.plot("silo-beverloo", "outlet", ["m", "kg/s"], {"discharge_run": rates, "Beverloo": curve})


def nut(program):
    series = {}
    for name, omega in (("strong", 62.83), ("weak", 40.2)):
        out = run(program, f"nut-{name}", f"motions.0.omega={omega}", scene="brazil-nut")
        below = []
        for t, grains in frames(out):
            large = max(grains, key=lambda g: g[4])
            below.append((t, sum(g[2] < large[2] for g in grains) / (len(grains) - 1)))
        series[name] = below
        late = [share for t, share in below if t > 10]
        print(f"{0.011 * omega**2 / 9.81:.1f} g: share of the small grains below the large one {below[0][1]:.2f} at first, "
              f"{statistics.mean(late):.2f} after 10 s")
    figures.plot("brazil-nut-rise", "time", ["s", "1"], series)


def drum(program):
    out = run(program, "drum-3d", "output.trajectory_every=-1")
    mixing = columns(out / "mixing.csv")
    index = [key for key in mixing if key != "time"][0]
    turns = [(t * 40 / 60, v) for t, v in zip(mixing["time"], mixing[index])]
    for n in (0.5, 1, 2, 4):
        print(f"after {n} turns: {min(turns, key=lambda p: abs(p[0] - n - 0.13))[1]:.2f}")
    figures.plot("drum-3d-mixing", "turns", "11", {"Lacey_index": turns})


if __name__ == "__main__":
    figures.draw((hopper, heap, shear, silo, nut, drum), __doc__, work)
