"""The tables of README.md and docs/performance.md, from one run of interleaved repetitions."""
import measure

packing_fractions = (0.2, 0.5, 0.82, 0.88)
sizes = (1000, 10000, 100000, 1000000)
methods = {"verlet": "Verlet lists", "half": "lattice, half mask", "lattice": "lattice, full mask",
           "cells": "link cells"}
main = ("verlet", "half")
# Whole steps by lists: name, law, packing fraction, grains, dimension.
steps = (("discs, dense", "linear+friction", 0.82, 100000, 2), ("discs, dilute", "linear+friction", 0.2, 100000, 2),
         ("spheres, dense, viscoelastic with springs", "hertz+springs", 0.64, 32768, 3),
         ("spheres, dense, without friction", "linear", 0.64, 32768, 3))
laws = {"linear+friction": "linear dashpot, friction", "hertz+friction": "viscoelastic, friction",
        "linear": "linear dashpot", "hertz": "viscoelastic"}


def cases(case, isas, cpus):
    """Names of all cases that the tables need."""
    ends = (isas[0], isas[-1])
    names = [case(method, phi=phi, isa=isa) for phi in packing_fractions for method in methods for isa in ends]
    names += [case(method, isa=isa) for method in main for isa in isas]
    names += [case(main[0], law=law, isa=isa) for law in laws for isa in ends]
    names += [case(method, n=n, isa=isas[-1], threads=t) for method in main for n in sizes
              for t in range(1, min(2, cpus) + 1)]
    names += step_cases(case, isas)
    return list(dict.fromkeys(names))


def step_cases(case, isas):
    return [case(main[0], law=law, phi=phi, n=n, isa=isas[-1], dimension=dimension)
            for _, law, phi, n, dimension in steps]


def millions(records):
    return f"{measure.median(records) / 1e6:.1f}"


def row(*cells):
    return "| " + " | ".join(str(c) for c in cells) + " |\n"


def head(*cells):
    return row(*cells) + "|" + "---|" * len(cells) + "\n"


def pair_row(found, name, first, last, *more):
    """Reference and best instruction set of one case."""
    a, b = found[first], found[last]
    return row(name, f"{measure.median(b, 'neighbours'):.2f}", millions(a), millions(b), f"{measure.ratio(b, a):.1f}",
               f"{measure.median(b, 'of_bound'):.0%}", *more)


def kernel_table(found, case, isas):
    text = head("pair finding", "packing fraction", "touching neighbours", "scalar", isas[-1], "ratio",
                f"{isas[-1]}: share of its roofline", "over the fastest scalar")
    for phi in packing_fractions:
        fastest = max(measure.median(found[case(method, phi=phi, isa=isas[0])]) for method in methods)
        for method, name in methods.items():
            first, last = (case(method, phi=phi, isa=isa) for isa in (isas[0], isas[-1]))
            over = measure.median(found[last]) / fastest
            text += pair_row(found, f"{name} | {phi}", first, last, f"{over:.1f}")
    return text


def law_table(found, case, isas):
    text = head("laws", "touching neighbours", "scalar", isas[-1], "ratio", f"{isas[-1]}: share of its roofline")
    for law, name in laws.items():
        text += pair_row(found, name, *(case(main[0], law=law, isa=i) for i in (isas[0], isas[-1])))
    return text


def isa_table(found, case, isas):
    text = head("instruction set", *(f"{methods[m]}{what}" for m in main for what in ("", ": over scalar")))
    for isa in isas:
        cells = [isa]
        for method in main:
            records = found[case(method, isa=isa)]
            cells += [millions(records), f"{measure.ratio(records, found[case(method, isa=isas[0])]):.2f}"]
        text += row(*cells)
    return text


def size_table(found, case, isas, cpus):
    two = cpus > 1
    text = head("pair finding", "grains", "working set", "1 thread", *(("2 threads", "ratio") if two else ()))
    for method in main:
        for n in sizes:
            one = found[case(method, n=n, isa=isas[-1])]
            cells = [methods[method], n, f"{measure.median(one, 'working_set') / 2**20:.1f} MiB", millions(one)]
            if two:
                both = found[case(method, n=n, isa=isas[-1], threads=2)]
                cells += [millions(both), f"{measure.ratio(both, one):.2f}"]
            text += row(*cells)
    return text


def step_table(found, case, isas):
    text = head("state", "grains", "touching neighbours", "10^6 steps/s", "cycles per grain and step", "bytes, least",
                "operations", "10^6 steps/s that memory allows", "that arithmetic allows", "share of the smaller")
    for (name, _, _, n, _), key in zip(steps, step_cases(case, isas)):
        r = found[key]
        text += row(name, n, f"{measure.median(r, 'neighbours'):.2f}", millions(r),
                    *(f"{measure.median(r, c):.0f}" for c in ("cycles_per_step", "bytes_per_step", "operations_per_step")),
                    *(f"{measure.median(r, c) / 1e6:.0f}" for c in ("bound_bytes", "bound_compute")),
                    f"{measure.median(r, 'of_bound'):.0%}")
    return text


def roof_table(roof, isas, cpus):
    text = head("operation, 10^9/s, one thread", *isas)
    names = {"double": "double + and *", "single": "single + and *", "multiply-add": "multiply-add",
             "divide": "double /", "sqrt": "double sqrt"}
    for key, name in names.items():
        text += row(name, *(f"{roof[f'rate/{key}/{isa}/threads=1'] / 1e9:.1f}" for isa in isas))
    kib = [name.split("/")[1].split("=")[1] for name in roof if name.startswith("latency/")]
    text += "\n" + head("working set", *(f"{int(k)} KiB" if int(k) < 1024 else f"{int(k) // 1024} MiB" for k in kib))
    for threads in range(1, min(2, cpus) + 1):
        text += row(f"in-place bandwidth, GB/s, {threads} thread{'s' if threads > 1 else ''}",
                    *(f"{roof[f'bandwidth/KiB={k}/{isas[-1]}/threads={threads}'] / 1e9:.0f}" for k in kib))
    text += row("dependent load, ns", *(f"{roof[f'latency/KiB={k}'] * 1e9:.1f}" for k in kib))
    return text


def threads_ratio(found, case, isas, method):
    one, two = (found[case(method, n=100000, isa=isas[-1], threads=t)] for t in (1, 2))
    return f"{measure.ratio(two, one):.2f}"


def summary(found, case, isas, cpus):
    """The short table of the README."""
    text = f"Million particle-steps per second of 10 000 discs, one thread; {measure.machine()}.\n\n"
    text += head("pair finding", "packing fraction", "touching neighbours", "scalar reference", isas[-1], "ratio",
                 "share of the roofline")
    for phi in packing_fractions:
        for method in main:
            text += pair_row(found, f"{methods[method]} | {phi}",
                             *(case(method, phi=phi, isa=isa) for isa in (isas[0], isas[-1])))
    if cpus > 1:
        ratios = [f"{threads_ratio(found, case, isas, method)} ({methods[method]})" for method in main]
        text += f"\nTwo threads over one with 100 000 discs: {' and '.join(ratios)}.\n"
    return text


def fill(path, name, text):
    """Replaces what stands between the marks of `name` in a document."""
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    document = path.read_text()
    if document.count(begin) != 1 or document.count(end) != 1:
        raise SystemExit(f"{path}: needs one {begin} and one {end}")
    before, rest = document.split(begin)
    after = rest.split(end)[1]
    path.write_text(f"{before}{begin}\n{text.strip()}\n{end}{after}")
    print(f"{path.relative_to(measure.root)}: {name} written")


def write(found, roof, case, isas, cpus):
    performance = measure.root / "docs/performance.md"
    fill(measure.root / "README.md", "bench", summary(found, case, isas, cpus))
    fill(performance, "machine", f"{measure.machine()}; {len(next(iter(found.values())))} repetitions.")
    fill(performance, "kernels", kernel_table(found, case, isas))
    fill(performance, "isas", isa_table(found, case, isas))
    fill(performance, "laws", law_table(found, case, isas))
    fill(performance, "steps", step_table(found, case, isas))
    fill(performance, "sizes", size_table(found, case, isas, cpus))
    fill(performance, "roofline", roof_table(roof, isas, cpus))
