"""Stress cases of cellular automata: cellular-automata.md, the line of stress cases."""
from trial import Run, Verdict, case, tested

source = "cellular-automata.md"


def lattice(rule="fhp-3", columns=128, rows=64, density=0.3, steps=200, more=""):
    return (f'method = "lattice-gas"\n[lattice_gas]\nrule = "{rule}"\ncolumns = {columns}\nrows = {rows}\n'
            f"density = {density!r}\nsteps = {steps}\n{more}\n")


def pipe(length=100, width=9, density=1.0, p=0.1, g=0.5, b=0.5, steps=500, variant="one-rest"):
    return (f'method = "pipe-flow"\n[pipe_flow]\nvariant = "{variant}"\nlength = {length}\nwidth = {width}\ndensity = {density!r}\n'
            f"dissipation = {p!r}\ngravity = {g!r}\nroughness = {b!r}\nsteps = {steps}\nwindow = {min(10, length)}\n")


def mass(run):
    """Column of the log that counts particles, grains or sand."""
    log = run.log
    return next(log[name] for name in ("particles", "mean_height") if name in log)


def keeps(run):
    column = mass(run)
    return run.code == 0 and len(set(column)) == 1


@case("automata widths of words", source, "L = 1, 7, 63, 64, 65, 127 and W = 1: mass exact, scalar reference and kernels equal")
def widths(folder):
    bad = []
    for length in (1, 7, 63, 64, 65, 127):
        for width in (1, 2, 9):
            runs = [Run(folder / f"{length}-{width}-{isa}", pipe(length, width), "--isa", isa) for isa in ("scalar", "auto")]
            same = runs[0].code == 0 and runs[0].summary.get("state_hash") == runs[1].summary.get("state_hash")
            if not same or not keeps(runs[1]):
                bad.append(f"{length} x {width}: exit {runs[0].code} {runs[0].said[:60]}")
    return Verdict("18 pipes: " + ("; ".join(bad) if bad else "mass exact, equal"), not bad)


@case("automata probabilities 0 and 1", source, "p, g, b in {0, 1}: mass exact")
def certain(folder):
    runs = [Run(folder / f"{p}{g}{b}", pipe(p=p, g=g, b=b)) for p in (0.0, 1.0) for g in (0.0, 1.0) for b in (0.0, 1.0)]
    good = sum(keeps(run) for run in runs)
    return Verdict(f"{good} of 8 pipes keep their mass", good == 8)


@case("automata empty and full lattices", source, "fixed points of the collisions: nothing changes")
def fixed(folder):
    changed = []
    for rule in ("hpp", "fhp-1", "fhp-2", "fhp-3"):
        for density in (0.0, 1.0):
            run = Run(folder / f"{rule}-{density}", lattice(rule, density=density), output="[output]\nreport = false\n")
            maps = {path.name.rsplit("-", 1)[0]: set() for path in run.folder.glob("out/maps/*.npy")}
            for path in run.folder.glob("out/maps/*.npy"):
                maps[path.name.rsplit("-", 1)[0]].add(path.read_bytes())
            if not maps or any(len(contents) > 1 for contents in maps.values()):
                changed.append(f"{rule} at {density}")
    return Verdict("8 lattices: " + (", ".join(changed) + " change" if changed else "none changes"), not changed)


@case("automata threads", source, "1, 2, 7 and 64 threads: bitwise equal, or more threads than CPUs refused")
def threads(folder):
    hashes, refused = set(), 0
    for n in (1, 2, 7, 64):
        run = Run(folder / str(n), lattice(columns=700, rows=300, steps=50), threads=n)
        if run.code == 0:
            hashes.add(run.summary["state_hash"])
        else:
            refused += run.code == 4
    return Verdict(f"{len(hashes)} result of {4 - refused} runs, {refused} refused", len(hashes) == 1)


@case("automata high piles", source, "65535 grains on each site: no height wraps, the pile gets quiet")
def high(folder):
    run = Run(folder, 'method = "sandpile"\n[sandpile]\ncolumns = 9\nrows = 5\nheight = 65535\n')
    other = Run(folder / "scalar", 'method = "sandpile"\n[sandpile]\ncolumns = 9\nrows = 5\nheight = 65535\n', "--isa", "scalar")
    same = run.code == 0 and run.summary["state_hash"] == other.summary["state_hash"]
    return Verdict(f"exit {run.code} after {run.summary.get('step')} sweeps, {'as the reference' if same else 'not the reference'}", same)


@case("automata narrow sandpiles", source, "1 x N and N x 1: quiet at the end, reference and kernels equal")
def narrow(folder):
    good = []
    for columns, rows in ((1, 1), (1, 200), (200, 1), (65, 2)):
        scene = f'method = "sandpile"\n[sandpile]\ncolumns = {columns}\nrows = {rows}\nheight = 4\n'
        a, b = (Run(folder / f"{columns}x{rows}-{isa}", scene, "--isa", isa) for isa in ("scalar", "auto"))
        good.append(a.code == 0 and a.summary["state_hash"] == b.summary["state_hash"])
    return Verdict(f"{sum(good)} of 4 equal", all(good))


@case("automata ripples at their limits", source, "L0 whole, b = 0, D = 0, flights of several lattices: sand exact")
def ripples(folder):
    kept = []
    for number, (length, wind, creep) in enumerate(((10.0, 1.0, 0.4), (10.5, 0.0, 0.4), (10.5, 1.0, 0.0), (1000.5, 2.0, 0.4))):
        run = Run(folder / str(number), f'method = "ripples"\n[ripples]\ncolumns = 100\nrows = 20\nlength = {length}\nwind = {wind}\n'
                  f"creep = {creep}\nsteps = 300\n")
        column = mass(run) if run.code == 0 else [1, 2]
        kept.append(len(set(column)) == 1)
    return Verdict(f"{sum(kept)} of 4 keep their sand to the last bit", all(kept))


@case("automata 1e8 site updates", source, "FHP-III with drive 0: mass and momentum exact")
def short(folder):
    return updates(folder, 1000)


@case("automata 1e10 site updates", source, "FHP-III with drive 0: mass and momentum exact", soak=True)
def long(folder):
    return updates(folder, 100000)


def updates(folder, steps):
    run = Run(folder, lattice(columns=512, rows=200, steps=steps, more="velocity = [0.1, 0]"), patience=4000)
    log = run.log
    moving = [name for name in log if "momentum" in name or "velocity" in name]
    constant = {name: max(log[name]) - min(log[name]) for name in moving}
    good = keeps(run) and all(change <= 1e-12 for change in constant.values())
    return Verdict(f"{run.summary['step'] * 512 * 200:.3g} updates: mass {'exact' if keeps(run) else 'changes'}, "
                   + ", ".join(f"{name} changes by {change:g}" for name, change in constant.items()), good)


tested("automata still mass in the pipe", source, "p = 1, g = 0: movers never increase", "CountedPipe.AllCollisionsStop")
tested("automata reversal", source, "without collisions the way back is the way", "Gas.WithoutCollisionsTheWayBackIsTheWay")
tested("automata tiles passed over", source, "bitwise equal", "Gas.EmptySegmentsChangeNothing")
tested("automata quiet tiles of piles", source, "bitwise equal", "Sandpile.QuietTilesChangeNothing")
tested("automata heights near the limit of ripples", source, "refused at the same step",
       "Ripples.HeightsBeyondTheNumbersOfKernelsAreRefusedAtTheSameStep")
tested("automata growth factors", source, "|G| as the formulas", "Ripples.GrowthFactorsOfSmallWaves")
