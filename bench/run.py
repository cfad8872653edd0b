#!/usr/bin/env python3
"""Benchmarks of sandlane. Without a command: a short default set, about a minute.

Rates are particle-steps per second; beside each stands the share of the roofline of its case: the smaller of what
memory and arithmetic units, both measured in the same run, allow for the bytes and operations that a step needs.
"""
import argparse
import importlib
import json
import pathlib
import re
import subprocess
import sys
import time

import measure
import scene_runs
import tables


skipped = 77  # exit code, known to ctest


def case(method="half", law="linear+friction", phi=0.82, n=10000, isa="avx512", threads=1, dimension=2):
    return f"md{'3' if dimension == 3 else ''}/{method}/{law}/phi={phi}/N={n}/{isa}/threads={threads}"


def show(found):
    print(f"{'case':<64}{'steps/s':>10}{'spread':>8}{'touching':>9}{'of bound':>9}  bound by")
    for name, records in found.items():
        rates = [r["particle_steps_per_second"] for r in records]
        middle = measure.median(records)
        by = "memory" if records[0]["bound_bytes"] < records[0]["bound_compute"] else "arithmetic"
        print(f"{name:<64}{middle / 1e6:>8.1f} M{(max(rates) - min(rates)) / middle:>7.0%}"
              f"{measure.median(records, 'neighbours'):>9.2f}{measure.median(records, 'of_bound'):>9.0%}  {by}")


def default(_):
    isas, _, cpus = measure.info()
    cases = [case(isa=isa) for isa in isas]
    cases += [case(phi=phi, isa=isa) for phi in (0.2, 0.5, 0.88) for isa in (isas[0], isas[-1])]
    cases += [case(method, isa=isas[-1]) for method in ("verlet", "lattice", "cells")]
    cases += [case(law="hertz+friction", isa=isas[-1])]
    cases += [case(n=100000, isa=isas[-1], threads=t) for t in range(1, min(2, cpus) + 1)]
    show(measure.steps(cases, rounds=3, seconds=0.2, save="short"))


def kernels(options):
    print("one line per case as it ends; JSON in build/bench/kernels.json", file=sys.stderr)
    arguments = [f"--benchmark_filter={options.filter}", f"--benchmark_min_time={options.seconds}",
                 f"--rounds={options.rounds}"]
    found = {}
    for record in measure.program("bench_md", arguments, "kernels"):
        found.setdefault(measure.short(record["name"]), []).append(record)
    show(found)


def everything(options):
    roofline(options)
    options.filter, options.rounds, options.seconds = ".", 1, 0.2
    kernels(options)


def roofline(_):
    for name, value in measure.roofline().items():
        kind = name.split("/")[0]
        text = {"rate": f"{value / 1e9:10.2f} G operations/s", "bandwidth": f"{value / 1e9:10.1f} GB/s",
                "latency": f"{value * 1e9:10.1f} ns"}[kind]
        print(f"{name:<44}{text}")


def table(options):
    isas, _, cpus = measure.info()
    found = measure.steps(tables.cases(case, isas, cpus), options.rounds, options.seconds, "table")
    tables.write(found, measure.roofline(), case, isas, cpus)


def skips(options):
    """The same state with and without computing what it has no need of, in turn."""
    isa = measure.info()[0][-1]
    smooth, rough, equal = "hertz", "hertz+friction", "hertz+friction+equal"

    def pair(what, method, law, spare):
        return what, case(method, f"{law}+spare_{spare}", isa=isa), case(method, law, isa=isa), 1

    rows = [pair("rotation", m, smooth, "rotation") for m in ("verlet", "half")]
    rows += [pair("memory of contacts", "verlet", smooth, "memory"), pair("many radii", "half", equal, "radii")]
    rows += [pair("many materials", m, rough, "materials") for m in ("verlet", "half")]
    rows += [pair("third dimension", "verlet", rough, "space")]
    # As many sites, twice as many grains: rates count grains.
    rows += [("empty sites and rows", case("half", rough, n=20000, isa=isa),
              case("half", f"{rough}+half_empty", isa=isa), 2)]
    rows += [("walls out of reach *", "part/walls/all", "part/walls/near", 1),
             ("tiles at rest", "part/rest/computed", "part/rest/frozen", 1),
             ("outputs not due", "part/outputs/always", "part/outputs/never", 1),
             ("choice of the step **", "part/adaptive/on", "part/adaptive/off", 1)]
    found = measure.steps(sorted({c for row in rows for c in row[1:3]}), options.rounds, options.seconds, "skips")
    print(f"{'skipped':<24}{'method':<9}{'computed':>12}{'skipped':>12}{'gain':>9}")
    for what, with_it, without, sites in rows:
        a, b = found[with_it], found[without]
        print(f"{what:<24}{with_it.split('/')[1]:<9}{measure.median(a) / sites / 1e6:>10.1f} M"
              f"{measure.median(b) / 1e6:>10.1f} M{sites * measure.ratio(b, a):>9.2f}")
    print("* their part of a step alone")
    print(f"** md.adaptive_dt: {measure.median(found['part/adaptive/on'], 'mean_step'):.2f} of the step that does not adapt")


def sizes(options):
    """A few large grains among many small ones: a grid of cells for each class of radii, or one for all."""
    isa = measure.info()[0][-1]
    rows = [(space, method, case(method, f"linear+friction+large{grid}", phi, 40000, isa).replace("md/", space))
            for space, phi in (("md/", 0.5), ("md3/", 0.3)) for method in ("verlet", "cells")
            for grid in ("", "+one_grid")]
    found = measure.steps([name for _, _, name in rows], options.rounds, options.seconds, "sizes")
    print(f"{'radii':<8}{'method':<8}{'one grid':>10}{'classes':>10}{'gain':>7}")
    for (space, method, classes), (_, _, one) in zip(rows[::2], rows[1::2]):
        print(f"{'1:100' if space == 'md/' else '1:20':<8}{method:<8}{measure.median(found[one]) / 1e6:>8.2f} M"
              f"{measure.median(found[classes]) / 1e6:>8.2f} M{measure.ratio(found[classes], found[one]):>7.1f}")


def scaling(options):
    """From few grains to many, one thread: particle-steps per second, and what is lost against the best number of grains."""
    isa = measure.info()[0][-1]
    rows = {"discs, linear dashpot": [case("verlet", n=n, isa=isa) for n in (4000, 16000, 64000, 250000, 1000000, 10000000)],
            "spheres, Hertz, springs": [case("verlet", "hertz+springs", 0.64, n, isa, dimension=3)
                                        for n in (4096, 32768, 262144, 1000000, 10000000)]}
    rows = {name: [c for c in cases if int(c.split("N=")[1].split("/")[0]) <= options.most] for name, cases in rows.items()}
    found = measure.steps([c for cases in rows.values() for c in cases], options.rounds, options.seconds, "scaling")
    print(f"{'state':<26}{'grains':>10}{'steps/s':>10}{'loss':>7}{'bytes/grain':>13}")
    for name, cases in rows.items():
        best = max(measure.median(found[c]) for c in cases)
        for c in cases:
            n = int(c.split("N=")[1].split("/")[0])
            print(f"{name:<26}{n:>10}{measure.median(found[c]) / 1e6:>8.1f} M{1 - measure.median(found[c]) / best:>7.0%}"
                  f"{measure.median(found[c], 'working_set') / n:>13.0f}")


def packings(options):
    """Random start states of small grains around two large ones: seconds of `sandlane check`, which makes them."""
    scene = measure.results / "packing.toml"
    scene.parent.mkdir(parents=True, exist_ok=True)
    print(f"{'radii':<12}{'grains':>8}{'seconds':>9}")
    for dimension, ratio, small in ((2, 10, 0.004), (2, 100, 0.001), (2, 1000, 0.0002), (3, 10, 0.016), (3, 20, 0.01)):
        large, upper = ratio * small, [1] * dimension
        items = ", ".join(f"{{ position = {[at] * dimension}, radius = {large} }}" for at in (0.25, 0.75))
        fraction = (0.4 if dimension == 2 else 0.2) * options.part
        scene.write_text(f'title = "packing"\ndomain = {{ dimension = {dimension}, upper = {upper} }}\n'
                         'md = { normal = "linear-dashpot", tangential = "none" }\n'
                         'materials = [{ name = "m", stiffness = 3e5 }]\n'
                         f'[[grains]]\nkind = "list"\nitems = [{items}]\n[[grains]]\nkind = "random"\n'
                         f'radius = {{ law = "uniform", min = {0.9 * small}, max = {small} }}\npacking_fraction = {fraction}\n')
        begin = time.perf_counter()
        text = subprocess.run([measure.build / "sandlane", "check", scene], capture_output=True, text=True, check=True).stdout
        seconds = time.perf_counter() - begin
        print(f"1:{ratio}, {dimension}D{'':<5}{re.search(r'grains +([0-9]+)', text)[1]:>8}{seconds:>9.2f}", flush=True)


def scenes(options):
    """Every shipped scene, the same steps from its start: `auto` against every method of finding pairs."""
    names = options.scene or sorted(p.stem for p in (measure.root / "data/scenes").glob("*.toml"))
    print(f"{'scene':<22}{'steps':>8}" + "".join(f"{m:>14}" for m in scene_runs.methods) + f"{'loss of auto':>14}")
    for name in names:
        row = scene_runs.compare(name, options.seconds, options.rounds)
        cells = "".join(f"{row.seconds[m]:>12.3f} s" if m in row.seconds else f"{'-':>14}" for m in scene_runs.methods)
        print(f"{name:<22}{row.steps:>8}{cells}{row.loss:>13.1%}", flush=True)


def peer(name):
    """A module of bench or bench/peers; None and a message where Python lacks what it needs."""
    sys.path.append(str(pathlib.Path(__file__).parent / "peers"))
    try:
        return importlib.import_module(name)
    except ImportError as missing:
        print(f"skipped: {missing}; on Debian: apt-get install python3-scipy")
        return None


def choice(options):
    chosen = peer("accuracy_choice")
    return chosen.main(options) if chosen else skipped


def peers(options):
    lammps = peer("lammps")
    return lammps.main(options, skipped) if lammps else skipped


def equal_error(options):
    chute = peer("chute")
    return chute.main(options, skipped) if chute else skipped


def spheres(options):
    race = peer("spheres")
    return race.main(options) if race else skipped


def accuracy(options):
    parts = {"md": "accuracy", "contacts": "accuracy_contacts", "precision": "accuracy_precision",
             "edmd": "accuracy_events", "dsmc": "accuracy_gas", "automata": "accuracy_automata"}
    failed = 0
    for name in options.part or parts:
        laboratory = peer(parts[name])
        if not laboratory:
            return skipped
        failed += laboratory.main(options)
    return 1 if failed else 0


def compare(options):
    old, new = ({}, {})
    for path, records in ((options.old, old), (options.new, new)):
        for r in json.loads(pathlib.Path(path).read_text())["benchmarks"]:
            records.setdefault(measure.short(r["name"]), []).append(r)
    print(f"{'case':<64}{'old':>10}{'new':>10}{'new/old':>9}")
    for name in (n for n in old if n in new):
        a, b = measure.median(old[name]), measure.median(new[name])
        print(f"{name:<64}{a / 1e6:>8.1f} M{b / 1e6:>8.1f} M{b / a:>9.3f}")


def events(options):
    """Event-driven dynamics: collisions per second, medians of rounds through all cases. Beside each the share of
    two bounds: four loads that depend on each other per collision, at the latency measured in the same run for memory
    as large as the state; and 1.5 M/s, of compact states in spatial order."""
    arguments = [f"--benchmark_filter={options.filter}", f"--benchmark_min_time={options.seconds}"]
    found = measure.in_turn("bench_edmd", arguments, options.rounds, "events")
    print(f"{'case':<48}{'collisions/s':>13}{'spread':>8}{'crossings':>10}{'B/particle':>11}{'latency':>9}"
          f"{'of loads':>9}{'of 1.5 M':>9}")
    for name, records in found.items():
        rates = [r["collisions_per_second"] for r in records]
        middle = measure.median(records, "collisions_per_second")
        print(f"{name:<48}{middle / 1e6:>11.2f} M{(max(rates) - min(rates)) / middle:>7.0%}"
              f"{measure.median(records, 'crossings'):>10.2f}{measure.median(records, 'bytes_per_particle'):>11.0f}"
              f"{measure.median(records, 'chase_ns'):>6.0f} ns{measure.median(records, 'of_chase_bound'):>9.0%}"
              f"{middle / 1.5e6:>9.0%}")


def gases(options):
    """Direct simulation Monte Carlo: rates against the bound of bandwidth, and what physics costs that a scene does without."""
    isas, _, cpus = measure.info()
    best = isas[-1]

    def gas(name, n=100000, isa=best, threads=1):
        return f"dsmc/{name}/N={n}/{isa}/threads={threads}"

    extras = [("gravity", "spheres+gravity"), ("reflecting walls", "spheres+walls"),
              ("restitution by impact speed", "spheres+viscoelastic"), ("pair correlation", "spheres+enskog"),
              ("spins", "spheres+rough"), ("thermostat", "spheres+kicks"), ("kinds of particles", "spheres+kinds")]
    rates = [gas("spheres", n, isa, t) for n in options.particles for isa in isas for t in range(1, min(2, cpus) + 1)]
    cells = [gas(f"spheres+per_cell={n}") for n in (30, 100, 1000, 10000)]
    names = [*rates, gas("discs"), *(gas(name) for _, name in extras), *cells]
    arguments = [f"--benchmark_filter=^({'|'.join(n.replace('+', '.') for n in names)})/",
                 f"--benchmark_min_time={options.seconds}"]
    found = measure.in_turn("bench_dsmc", arguments, options.rounds, "gases")

    def ratio(a, b, digits=">12.2f"):
        return format(measure.ratio(found[a], found[b]), digits) if a in found and b in found else f"{'-':>12}"

    print(f"{'case':<44}{'steps/s':>10}{'spread':>8}{'over scalar':>12}{'of 1 thread':>12}{'of bound':>9}{'B/particle':>11}"
          f"{'collisions':>11}")
    for name in (n for n in names if n in found):
        records = found[name]
        values = [r["particle_steps_per_second"] for r in records]
        middle = measure.median(records)
        isa, threads = name.split("/")[3], name.split("/")[4]
        print(f"{name:<44}{middle / 1e6:>8.1f} M{(max(values) - min(values)) / middle:>7.0%}"
              f"{ratio(name, name.replace(isa, 'scalar'))}{ratio(name, name.replace(threads, 'threads=1'))}"
              f"{measure.median(records, 'of_bound'):>9.0%}{measure.median(records, 'bytes_per_particle'):>11.0f}"
              f"{measure.median(records, 'collisions'):>11.4f}")
    print(f"\n{'not skipped':<32}{'of the plain case':>18}")
    for what, name in extras:
        print(f"{what:<32}{ratio(gas(name), gas('spheres'), '>18.2f')}")


def stability(options):
    return importlib.import_module("stability").main(options)


def faults(options):
    return importlib.import_module("faults").main(options)


def main():
    parser = argparse.ArgumentParser(prog="tools/bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.set_defaults(run=default)
    commands = parser.add_subparsers(metavar="COMMAND")

    def command(name, run, text):
        sub = commands.add_parser(name, help=text, description=text)
        sub.set_defaults(run=run)
        return sub

    command("all", everything, "every case: all methods, laws, packing fractions, sizes, instruction sets (an hour)")
    sub = command("kernels", kernels, "the cases whose names match")
    sub.add_argument("--filter", default=r"N=10000/.*threads=1", help="regular expression of names")
    sub.add_argument("--rounds", type=int, default=1, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.2, help="least time of one run")
    command("roofline", roofline, "rates of operations, bandwidth and latency of this machine")
    sub = command("table", table, "one run, written into README.md and docs/performance.md (about five minutes)")
    sub.add_argument("--rounds", type=int, default=5, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.2, help="least time of one run")
    sub = command("skips", skips, "what a scene gains from physics that it does without")
    sub.add_argument("--rounds", type=int, default=5, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.2, help="least time of one run")
    sub = command("sizes", sizes, "grids of cells for classes of radii against one for all")
    sub.add_argument("--rounds", type=int, default=3, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.2, help="least time of one run")
    sub = command("scaling", scaling, "from few grains to many: rates, and what is lost against the best")
    sub.add_argument("--most", type=float, default=1e6, help="largest number of grains; 1e7 takes 12 GB and ten minutes")
    sub.add_argument("--rounds", type=int, default=3, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.5, help="least time of one run")
    sub = command("packings", packings, "random start states of small grains around large ones: time to make them")
    sub.add_argument("--part", type=float, default=1.0, help="of the packing fraction, 0.4 in 2D and 0.2 in 3D")
    sub = command("scenes", scenes, "shipped scenes: what `auto` loses against the best method of finding pairs")
    sub.add_argument("scene", nargs="*", help="names of scenes; all if none is given")
    sub.add_argument("--rounds", type=int, default=3, help="times that all methods run in turn")
    sub.add_argument("--seconds", type=float, default=1.0, help="aimed time of one run")
    sub = command("peers", peers, "the same discs in LAMMPS, physics compared, rates side by side")
    sub.add_argument("--grains", type=int, nargs="+", default=[1000, 10000, 100000])
    sub.add_argument("--phi", type=float, nargs="+", default=[0.2, 0.5, 0.82])
    sub.add_argument("--law", nargs="+", default=["linear", "hertz"], choices=["linear", "hertz"])
    sub.add_argument("--rounds", type=int, default=3, help="times that both programs run in turn")
    sub.add_argument("--seconds", type=float, default=1.0, help="aimed time of one run")
    sub.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                     help="for sandlane, for example md.neighbours=verlet or md.integrator=velocity-verlet")
    sub = command("equal-error", equal_error, "a chute of discs in sandlane and LAMMPS: speed at the same error, and their "
                  "energy balance")
    sub.add_argument("--grains", type=int, default=100000)
    sub.add_argument("--balance-grains", type=int, default=4000)
    sub.add_argument("--balance-only", action="store_true", help="without the race")
    sub.add_argument("--rounds", type=int, default=3, help="times that the programs run in turn")
    sub.add_argument("--seconds", type=float, default=1.0, help="aimed time of one run")
    sub = command("spheres", spheres, "a bed of spheres in sandlane, LAMMPS, LIGGGHTS and YADE, whichever are installed")
    sub.add_argument("--grains", type=int, nargs="+", default=[31360])
    sub.add_argument("--law", nargs="+", default=["linear", "hertz"], choices=["linear", "hertz"])
    sub.add_argument("--case", nargs="+", default=["bed"], choices=["bed", "chute", "column"])
    sub.add_argument("--sizes", action="store_true", help="radii within 20 %% instead of equal ones")
    sub.add_argument("--cores", type=int, nargs="+", default=[1])
    sub.add_argument("--only", nargs="+", help="programs, sandlane among them")
    sub.add_argument("--rounds", type=int, default=3, help="times that all programs run in turn")
    sub.add_argument("--seconds", type=float, default=2.0, help="aimed time of one run")
    sub = command("events", events, "event-driven dynamics: collisions per second (five minutes)")
    sub.add_argument("--filter", default=r"^edmd/.*/avx512", help="regular expression of names")
    sub.add_argument("--rounds", type=int, default=3, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.5, help="least time of one run")
    sub = command("gases", gases, "direct simulation Monte Carlo: rates, bound of bandwidth, what physics costs")
    sub.add_argument("--particles", type=int, nargs="+", default=[100000, 1000000], choices=[10000, 100000, 1000000])
    sub.add_argument("--rounds", type=int, default=3, help="times that all cases run in turn")
    sub.add_argument("--seconds", type=float, default=0.3, help="least time of one run")
    sub = command("stability", stability, "stress cases of the specifications: expected and observed behaviour (a minute)")
    length = sub.add_mutually_exclusive_group()
    length.add_argument("--quick", action="store_true", help="without the long runs; the default")
    length.add_argument("--soak", action="store_true", help="with the long runs: 1e9 events, 1e7 steps, 1e10 site updates (an hour)")
    sub.add_argument("--case", action="append", metavar="NAME", help="only cases whose names contain NAME; may be repeated")
    sub.add_argument("--write", action="store_true", help="writes the table into docs/stability.md; rows of cases not run "
                     "stay as an earlier run left them")
    sub = command("faults", faults, "runs killed at random moments, full disks, damaged checkpoints (a quarter of an hour)")
    sub.add_argument("--kills", type=int, default=100, help="of each engine")
    sub.add_argument("--seed", type=int, default=1, help="of the moments")
    sub.add_argument("--only", nargs="+", metavar="ENGINE", help="names of scenes")
    sub.add_argument("--write", action="store_true", help="writes the table into docs/stability.md")
    sub = command("accuracy", accuracy, "errors of known answers against the time they cost: every engine (some minutes)")
    sub.add_argument("--part", nargs="+", choices=["md", "contacts", "precision", "edmd", "dsmc", "automata"],
                     help="only these; all if left out")
    sub.add_argument("--reuse", action="store_true", help="takes errors from the last run, and measures costs only")
    sub.add_argument("--check", action="store_true", help="only the orders of convergence, against theory")
    sub.add_argument("--write", action="store_true", help="writes tables and pictures into docs")
    sub.add_argument("--rounds", type=int, default=5, help="times that all integrators run in turn for their cost")
    sub.add_argument("--seconds", type=float, default=0.5, help="aimed time of one run for the cost")
    sub = command("choice", choice, "what md.accuracy chooses: the error in runs, and whether something cheaper meets it")
    sub.add_argument("--write", action="store_true", help="writes the table into docs/accuracy.md")
    sub = command("compare", compare, "two result files (build/bench/*.json) of the same cases")
    sub.add_argument("old")
    sub.add_argument("new")
    options = parser.parse_args()
    return options.run(options) or 0


sys.exit(main())
