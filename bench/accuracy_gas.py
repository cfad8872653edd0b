"""Direct simulation Monte Carlo against kinetic theory (dsmc_accuracy.cpp): what cells, time steps and few particles do to
the viscosity, and how often each scheme of choosing pairs lets them collide."""
import math
import statistics
import subprocess

import numpy

import accuracy
import accuracy_tables as common
import measure
import tables

# Viscosity over the true one: 1 + a (edge/l)^2 (Alexander, Garcia and Alder 1998), 1 + b (c_0 dt/l)^2, c_0 = sqrt(2 T/m)
# (Hadjiconstantinou 2000); c_0 over l times the collision rate is sqrt(pi)/2.
by_edge = 16 / (45 * math.pi)
by_step = 16 / (75 * math.pi) * math.pi / 4
edges = (0.5, 0.75, 1.0, 1.5, 2.0)     # of cells, mean free paths
steps = (0.25, 0.5, 1.0, 1.5, 2.0)     # times the collision rate
crowds = (3, 6, 12, 24, 48)            # particles per cell
schemes = ("no-time-counter", "direction-first", "majorant-frequency", "nanbu-babovsky", "bernoulli")
loads = (0.1, 0.5, 1.0, 2.0)
grid = [(e, s, n) for e in (0.5, 1.0, 2.0) for s in (0.25, 0.5, 1.0, 2.0) for n in (5, 20)]


def program(what, scheme, edge, step, per_cell, particles, seed):
    """Value, nanoseconds per particle-step."""
    done = subprocess.run([measure.build / "bench/dsmc_accuracy", what, scheme, str(edge), str(step), str(per_cell),
                           str(particles), str(seed)], capture_output=True, text=True, check=True)
    return [float(v) for v in done.stdout.split()]


def viscosity(edge, step, per_cell, seeds, particles=1000000):
    """Mean over seeds, its standard error."""
    values = [program("viscosity", schemes[0], edge, step, per_cell, particles, s + 1)[0] for s in range(seeds)]
    return statistics.mean(values), (statistics.stdev(values) / math.sqrt(seeds) if seeds > 1 else math.nan)


def fit(x, values, power=None):
    """v_0, c and p of v_0 (1 + c x^p), least squares; the power is given or the best one."""
    x, values = numpy.array(x), numpy.array(values)

    def linear(p):
        matrix = numpy.column_stack([numpy.ones_like(x), x**p])
        solution, *_ = numpy.linalg.lstsq(matrix, values, rcond=None)
        return ((matrix @ solution - values) ** 2).sum(), solution

    power = power or min(numpy.arange(-3, 3.5, 0.01)[numpy.abs(numpy.arange(-3, 3.5, 0.01)) > 0.3],
                         key=lambda p: linear(p)[0])
    start, slope = linear(power)[1]
    return float(start), float(slope / start), float(power)


def scans(seeds, particles):
    """{axis: [[x, value, standard error], ...]}; what is not varied is small, but for the particles per cell: there steps
    and cells are long, since pairs that flights do not part meet again."""
    return {"edge": [[e, *viscosity(e, 0.1, 50, seeds, particles)] for e in edges],
            "step": [[s, *viscosity(0.5, s, 100, seeds, particles)] for s in steps],
            "crowd": [[n, *viscosity(1.0, 0.5, n, seeds, particles)] for n in crowds]}


def evaluate():
    found = scans(2, 500000)
    found["grid"] = [[*at, *viscosity(*at, 2, 250000)] for at in grid]
    found["rates"] = {scheme: [program("rate", scheme, 0.5, load, 10, 100000, 1)[0] for load in loads]
                      for scheme in schemes}
    found["sonine"] = {scheme: [program("sonine", scheme, 0.5, load, 48, 200000, 1)[0] for load in (0.05, 0.2, 0.5)]
                       for scheme in (schemes[0], schemes[2], schemes[3], schemes[4])}
    return found


def fits(found):
    """{axis: ((v_0, c at the order of theory), best order)}"""
    out = {}
    for axis, order, far in (("edge", 2, 1.6), ("step", 2, 1.6), ("crowd", -1, math.inf)):
        points = [p for p in found[axis] if p[0] < far]
        x, values = [p[0] for p in points], [p[1] for p in points]
        out[axis] = fit(x, values, order)[:2], fit(x, values)[2]
    return out


def scan_table(found):
    what = {"edge": ("cell edge/l", "2", f"{by_edge:.4f}"), "step": ("dt times collision rate", "2", f"{by_step:.4f}"),
            "crowd": ("particles per cell", "-1", "-")}
    text = tables.head("", *(f"{k + 1}" for k in range(5)), "order, theory", "order, fitted", "coefficient, theory",
                       "coefficient, fitted")
    for axis, ((start, slope), order) in fits(found).items():
        points = found[axis]
        name, expected, coefficient = what[axis]
        text += tables.row(name, *(f"{p[0]:g}" for p in points), "", "", "", "")
        text += tables.row("viscosity/limit - 1", *(f"{p[1] / start - 1:+.4f}" for p in points), expected, f"{order:.2f}",
                           coefficient, f"{slope:.4f}")
        text += tables.row("standard error", *(f"{p[2] / start:.4f}" for p in points), "", "", "", "")
    return text


def scheme_table(found):
    text = tables.head("scheme", *(f"dt times rate {x}" for x in loads))
    for scheme, values in found["rates"].items():
        text += tables.row(scheme, *(f"{v - 1:+.4f}" for v in values))
    text += "\n" + tables.head("scheme", *(f"a2, dt times rate {x}" for x in (0.05, 0.2, 0.5)))
    for scheme, values in found["sonine"].items():
        text += tables.row(scheme, *(f"{v:.4f}" for v in values))
    return text


def costs(rounds, particles=200000):
    """{(step, particles per cell): nanoseconds per particle-step}, medians of turns; cells do not matter."""
    found = {}
    for _ in range(rounds):
        for step in sorted({s for _, s, _ in grid}):
            for crowd in sorted({n for _, _, n in grid}):
                found.setdefault((step, crowd), []).append(program("rate", schemes[0], 1.0, step, crowd, particles, 1)[1])
    return {key: statistics.median(values) for key, values in found.items()}


def front_table(found, cost_of):
    """Error of the viscosity against the time for the gas in one cubic mean free path to live through one collision time."""
    limit = statistics.mean(fits(found)[axis][0][0] for axis in ("edge", "step"))
    points = {(e, s, n): (cost_of[s, n] * n / e**3 / s, abs(value / limit - 1)) for e, s, n, value, _ in found["grid"]}
    noise = max(p[4] for p in found["grid"]) / limit
    front = accuracy.front_of({a: (c, max(e, noise)) for a, (c, e) in points.items()})
    text = tables.head("cell edge/l", "dt times rate", "particles per cell", "error",
                       "ns per cubic free path and collision time")
    for at, (cost, error) in sorted(points.items(), key=lambda item: item[1][0]):
        cell = f"{error:.4f}"
        text += tables.row(*(f"{v:g}" for v in at), f"**{cell}**" if at in front else cell, f"{cost:.0f}")
    return text + f"\nErrors below {noise:.4f} are noise.\n", points, front


def check():
    particles = 100000  # scatter of the viscosity: 0.01
    wrong = 0
    edge = [viscosity(e, 0.1, 40, 1, particles)[0] for e in (0.5, 1.0, 1.5)]
    start, slope, _ = fit((0.5, 1.0, 1.5), edge, 2)
    wrong = common.verdict(wrong, "dsmc: viscosity of small cells and steps over theory", start, 0.93, 1.05)
    wrong = common.verdict(wrong, "dsmc: coefficient of the cell edge", slope, 0.65 * by_edge, 1.35 * by_edge)
    step = [viscosity(0.5, s, 100, 1, particles)[0] for s in (0.5, 1.0, 2.0)]
    slope = fit((0.5, 1.0, 2.0), step, 2)[1]
    wrong = common.verdict(wrong, "dsmc: coefficient of the time step", slope, 0.6 * by_step, 1.4 * by_step)
    for scheme in schemes[:3]:
        rate = program("rate", scheme, 0.5, 0.5, 10, 50000, 1)[0]
        wrong = common.verdict(wrong, f"dsmc: collision rate of {scheme} over theory", rate, 0.995, 1.005)
    return wrong


def main(options):
    if options.check:
        return check()
    found = common.remembered("dsmc-errors", options, evaluate)
    front_text, points, front = front_table(found, costs(options.rounds))
    common.save("dsmc", ("cell_edge", "step", "per_cell", "cost[ns]", "error", "front"),
                [(*at, cost, error, int(at in front)) for at, (cost, error) in points.items()])
    limits = {axis: at[0][0] for axis, at in fits(found).items()}
    path = common.save("dsmc-scans", ("x", "cell_edge", "time_step"),
                       [(p[0], abs(p[1] / limits["edge"] - 1), math.nan) for p in found["edge"]] +
                       [(p[0], math.nan, abs(p[1] / limits["step"] - 1)) for p in found["step"]])
    common.draw(path, "x", ["cell_edge", "time_step"], "xy", "accuracy-gas" if options.write else None)
    common.publish(options, {"dsmc": scan_table(found), "dsmc-schemes": scheme_table(found),
                             "dsmc-front": f"{measure.machine()}.\n\n{front_text}"})
    return 0
