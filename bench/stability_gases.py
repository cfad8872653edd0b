"""Stress cases of gases: event-driven.md, 9, and dsmc.md, 9."""
import math
import re
import subprocess

import measure
from trial import Run, Verdict, case, sandlane, tested

events, monte_carlo = "event-driven.md", "dsmc.md"


def hard(particles=200, box=30.0, more="", edmd="duration = 20", gas="", periodic='["x", "y"]', lower=0.0, temperature=1.0,
         sides=""):
    """Discs of diameter 1 in a square box."""
    return f"""method = "edmd"
[domain]
lower = [{lower!r}, {lower!r}]
upper = [{lower + box!r}, {lower + box!r}]
periodic = {periodic}
{more}
[gas]
particles = {particles}
temperature = {temperature!r}
{gas}
{sides}
[edmd]
{edmd}
"""


def drift(run):
    """Largest relative change of the energy."""
    energy = run.log["energy"]
    return max(abs(e - energy[0]) for e in energy) / (energy[0] or 1)


def conserves(run, tolerance=1e-11):
    if run.code:
        return Verdict(f"exit {run.code}: {run.said[:120]}", False)
    return Verdict(f"{run.summary['collisions']} collisions, energy within {drift(run):.1e}", drift(run) < tolerance)


@case("edmd 1e6 radii from the origin", events, "elastic: energy to 1e-11, no overlap beyond the resolution of places")
def far(folder):
    return conserves(Run(folder, hard(lower=5e5)))


@case("edmd size ratio 1:100", events, "no contact missed: energy to 1e-11, and the simple algorithm sees the same events")
def sizes(folder):
    scene = hard(2, 12.0, sides="[[species]]\nparticles = 60\ndiameter = 0.01\nmass = 0.0001", gas="mass = 1",
                 edmd="events = 400").replace("temperature = 1.0", "temperature = 1.0\ndiameter = 1.0")
    found = [Run(folder / a, scene, "--set", f"edmd.algorithm={a}") for a in ("improved", "simple")]
    if any(run.code for run in found):
        return Verdict(f"exit {[run.code for run in found]}: {found[0].said[:100]}", False)
    same = found[0].summary["event_log_hash"] == found[1].summary["event_log_hash"]
    return Verdict(f"events {'the same' if same else 'differ'}, energy within {drift(found[0]):.1e}",
                   same and drift(found[0]) < 1e-11)


@case("edmd masses over 12 decades", events, "elastic mixture of masses 1 and 1e-12: energy to 1e-11")
def masses(folder):
    return conserves(Run(folder, hard(50, sides="[[species]]\nparticles = 50\nmass = 1e-12", edmd="events = 20000")))


@case("edmd denormal energies", events, "masses of 1e-310 kg: refused, or energy as conserved as its digits allow")
def denormals(folder):
    scene = hard(edmd="duration = 10", temperature=1e-310, gas="mass = 1e-310")
    run = Run(folder, scene)
    if run.code:
        return run.refuses(2, "gas.")
    return conserves(run, 1e-9)


@case("edmd cold gas", events, "T = 1e-300 J, velocities of 1e-150 m/s, times of 1e150 s: the same events as at T = 1 J")
def cold(folder):
    warm = Run(folder / "warm", hard(edmd="events = 5000"))
    run = Run(folder / "cold", hard(edmd="events = 5000", temperature=2.0**-996))
    if run.code:
        return Verdict(f"exit {run.code}: {run.said[:100]}", False)
    a, b = warm.summary["time"], run.summary["time"] * 2.0**-498
    return Verdict(f"time of 5000 events {a:.9g} s, scaled {b:.9g} s", abs(a - b) <= 1e-12 * a)


@case("edmd inelastic collapse", events, "eps = 0.2: without a rule the run stops with a report; with edmd.contact_time it finishes")
def collapse(folder):
    # A dense gas, which clusters.
    scene = dict(particles=100, box=18.0, gas="restitution = 0.2")
    bare = Run(folder / "bare", hard(edmd="duration = 1e6", **scene))
    ruled = Run(folder / "ruled", hard(edmd="duration = 1e3\ncontact_time = 1e-3", **scene))
    stop = bare.refuses(6, "collapse")
    return Verdict(f"{stop.observed}; with the rule exit {ruled.code}", stop.good and ruled.code == 0)


@case("edmd eps = 0", events, "pairs leave with no normal velocity and no endless events: finishes with the rule, energy falls")
def plastic(folder):
    run = Run(folder, hard(gas="restitution = 0", edmd="duration = 100\ncontact_time = 1e-3"))
    if run.code:
        return Verdict(f"exit {run.code}: {run.said[:100]}", False)
    energy = run.log["energy"]
    return Verdict(f"{run.summary['collisions']} collisions, energy falls to {energy[-1] / energy[0]:.1e}",
                   all(b <= a * (1 + 1e-12) for a, b in zip(energy, energy[1:])))


@case("edmd one and two particles", events, "valid runs to the end of their time")
def few(folder):
    runs = [Run(folder / str(n), hard(n, 10.0)) for n in (1, 2)]
    good = all(run.code == 0 and abs(run.summary["time"] - 20) < 1e-9 and drift(run) < 1e-12 for run in runs)
    return Verdict(", ".join(f"N = {run.summary.get('particles')}: t = {run.summary.get('time')} s" for run in runs), good)


@case("edmd intervals that are too short", events, "below a billionth of the run: refused with key, value and least value")
def intervals(folder):
    return Run(folder, hard(), "--set", "output.log_every=1e-12").refuses(2, "output.log_every", "1e-12", "at least 2e-08")


@case("edmd slow growth to a dense start", events, "edmd.start = growth at rates of 1e-1 to 1e-4 reaches phi = 0.7; slower ones "
      "that would take too many events are refused")
def growth(folder):
    length = math.sqrt(200 * math.pi / 4 / 0.7)
    said = []
    for rate in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5):
        run = Run(folder / f"{rate:g}", hard(box=length, edmd=f'events = 100\nstart = "growth"\ngrowth_rate = {rate!r}'))
        said.append(f"{rate:g}: " + ("reached" if run.code == 0 else "refused" if "out of range" in run.said else run.said[:60]))
    return Verdict("; ".join(said), all(s.endswith("reached") for s in said[:4]) and said[4].endswith(("reached", "refused")))


@case("edmd jammed by growth", events, "growth beyond random close packing (3D, phi = 0.7): ends with a message, not a hang")
def jammed(folder):
    length = (300 * math.pi / 6 / 0.7)**(1 / 3)
    scene = hard(300, edmd='events = 100\nstart = "growth"\ngrowth_rate = 1').replace("[domain]", "[domain]\ndimension = 3")
    scene = scene.replace("lower = [0.0, 0.0]\nupper = [30.0, 30.0]", f"upper = [{length}, {length}, {length}]")
    return Run(folder, scene.replace('["x", "y"]', '["x", "y", "z"]')).refuses(2, "jammed at packing fraction")


@case("edmd lattice start, equal velocities", events, "many events at one time: exact symmetry in the counts, energy to 1e-13")
def at_once(folder):
    # Closest to a lattice that a scene can ask for: dense, and so started from one.
    run = Run(folder, hard(400, math.sqrt(400 * math.pi / 4 / 0.75), edmd="events = 20000"))
    return conserves(run, 1e-12)


@case("edmd 1e9 events", events, "2D, phi = 0.5, N = 1e4, elastic: smallest gap above -1e-12 R, energy within 1e-10", soak=True)
def billion(folder):
    done = subprocess.run([measure.build / "bench/bench_edmd", "--stress", "1e9"], stdout=subprocess.PIPE, text=True)
    return Verdict(done.stdout.strip().splitlines()[-1], done.returncode == 0)


@case("edmd 1e8 mean free times", events, "four discs, 2e8 events, one epoch after the other: energy within a rounding, 2.2e-16, of each "
      "event: 4.4e-8", soak=True)
def long(folder):
    run = Run(folder, hard(4, 6.0, edmd="events = 200000000"), patience=4000)
    return conserves(run, 4.4e-8)


tested("edmd grazing pairs", events, "an event with no impulse, or none; never NaN", "EdmdEvents.GrazingPairs")
tested("edmd events at the same time", events, "one order, whatever threads and lanes", "EdmdBits.ManyEventsAtOnce")
tested("edmd symmetric triple contact", events, "deterministic, conserves", "EdmdEvents.SimultaneousContactsConserve")
tested("edmd touching at the start", events, "approaching: at once; parting: no event", "EdmdEvents.TouchingPairs")
tested("edmd near closest packing", events, "Z -> d/(1 - phi/phi_cp), no overlap", "SlowEdmdGas.NearClosestPacking")
tested("edmd wraps of a single particle", events, "image count exact, place exact or to 4 eps", "EdmdEvents.WrapsExactly")
tested("edmd v = 0", events, "no events, ends in time", "EdmdEvents.NothingHappens")
tested("edmd radii ratio 10 and both algorithms", events, "identical event logs, 1e4 events", "EdmdBits.SimpleAndImprovedAlgorithmSlow")
tested("edmd threads, lanes, sizes of cells", events, "identical event logs", "EdmdBits.CellsThreadsAndDivisionOfTheRun")
tested("edmd gas colder than its rounding", events, "ends with a message", "SlowEdmdGas.ColdestThatRoundingAllows")
tested("edmd states of something else", events, "refused, by both algorithms", "EdmdBits.StatesOfSomethingElseAreRefused")
tested("edmd rows at the clock, cut anywhere", events, "the same rows wherever a run is looked at", "Events.RowsDoNotDependOnWhereARunIsCut")


def gas(particles=2000, box=10.0, cells=(4, 4, 4), more="", dsmc="duration = 20", periodic='["x", "y", "z"]', lower=0.0,
        temperature=1.0, diameter=0.3, sides=""):
    corner, top = [lower] * 3, [lower + box] * 3
    return f"""method = "dsmc"
[domain]
dimension = 3
lower = {corner}
upper = {top}
periodic = {periodic}
[gas]
particles = {particles}
diameter = {diameter!r}
temperature = {temperature!r}
{more}
{sides}
[dsmc]
cells = {list(cells)}
{dsmc}
"""


def steady(run, tolerance=1e-11):
    if run.code:
        return Verdict(f"exit {run.code}: {run.said[:120]}", False)
    return Verdict(f"{run.summary['step']} steps, {run.log['collisions_per_particle'][-1]:.4g} collisions of a particle, energy "
                   f"within {drift(run):.1e}", drift(run) < tolerance)


@case("dsmc empty and one-particle cells", monte_carlo, "20 particles in 4096 cells: no NaN, energy to 1e-12")
def empty(folder):
    return steady(Run(folder, gas(20, cells=(16, 16, 16), dsmc="duration = 100\ndt = 0.05", diameter=1.0)), 1e-12)


@case("dsmc 1e6 diameters from the origin", monte_carlo, "the same collision rate as at the origin within 3 %, energy to 1e-11")
def away(folder):
    near, there = Run(folder / "near", gas()), Run(folder / "far", gas(lower=3e5))
    a, b = (run.log["collisions_per_particle"][-1] if run.code == 0 else math.nan for run in (near, there))
    return Verdict(f"{a:.4g} and {b:.4g} collisions of a particle, {steady(there).observed}",
                   abs(b / a - 1) < 0.03 and drift(there) < 1e-11)


@case("dsmc eps = 0", monte_carlo, "cools by Haff's law with the rate of theory within 5 %, no NaN")
def inelastic(folder):
    run = Run(folder, gas(20000, 10.0, (1, 1, 1), "restitution = 0", "duration = 20\nadaptive = true", diameter=0.1))
    if run.code:
        return Verdict(f"exit {run.code}: {run.said[:120]}", False)
    ratio = run.log["temperature"][-1] / run.log["theory_temperature"][-1]
    return Verdict(f"T falls to {run.log['temperature'][-1]:.4g}, {ratio:.3f} of theory", abs(ratio - 1) < 0.05)


@case("dsmc denormal temperature", monte_carlo, "T = 1e-300 J: the same collisions as at T = 1 J in scaled time")
def frozen(folder):
    warm = Run(folder / "warm", gas(dsmc="duration = 10\ndt = 0.03125"))
    cold_run = Run(folder / "cold", gas(dsmc=f"duration = {10 * 2.0**498!r}\ndt = {0.03125 * 2.0**498!r}", temperature=2.0**-996))
    a, b = (run.log["collisions_per_particle"][-1] if run.code == 0 else math.nan for run in (warm, cold_run))
    return Verdict(f"{a:.6g} and {b:.6g} collisions of a particle" + (f"; {cold_run.said[:100]}" if cold_run.code else ""), a == b)


@case("dsmc time step far too long", monte_carlo, "a warning, and still conserving")
def coarse(folder):
    run = Run(folder, gas(dsmc="duration = 100\ndt = 5"))
    told = re.search(r"Warning: (.*collisions per particle and step.*)", sandlane(folder, "check", "scene.toml").stdout)
    seen = steady(run)
    return Verdict(f"{seen.observed}; warning: {told[1] if told else 'none'}", seen.good and told is not None)


@case("dsmc time step towards zero", monte_carlo, "0.01 candidates in a step: rate of collisions as with long steps, within 5 sigma")
def fine(folder):
    # Collisions are counted in pairs: with n of them the relative error is 1/sqrt(n).
    usual = Run(folder / "usual", gas(1000, cells=(1, 1, 1), dsmc="duration = 40"))
    rate = usual.log["collisions_per_particle"][-1] * 1000 / 2 / 40
    dt = 0.01 / rate
    run = Run(folder / "fine", gas(1000, cells=(1, 1, 1), dsmc=f"duration = {200000 * dt!r}\ndt = {dt!r}"))
    seen = run.log["collisions_per_particle"][-1] * 500
    sigma = math.sqrt(1 / seen + 1 / (rate * 40))
    off = seen / (200000 * dt * rate) - 1
    return Verdict(f"{seen:.0f} collisions, rate off by {off:+.2%}, sigma {sigma:.2%}", abs(off) < 5 * sigma)


@case("dsmc equilibrium for 1e6 steps", monte_carlo, "a2 = 0 within 5 sigma, energy within 1e-9, rate constant within 1e-3", soak=True)
def equilibrium(folder):
    run = Run(folder, gas(1000, 10.0, (4, 4, 4), dsmc="duration = 1e6\ndt = 1\nsample_every = -1", diameter=0.05), "--set",
              "output.log_every=1000", patience=4000)
    log = run.log
    a2 = sum(log["a2"][1:]) / len(log["a2"][1:])
    # One frame: sqrt(8/(15 N)) or so; frames a thousand steps apart are independent.
    sigma = math.sqrt(1.0 / 1000 / len(log["a2"]))
    half = len(log["time"]) // 2
    first = log["collisions_per_particle"][half] / log["time"][half]
    second = (log["collisions_per_particle"][-1] - log["collisions_per_particle"][half]) / (log["time"][-1] - log["time"][half])
    return Verdict(f"a2 = {a2:.1e} +- {sigma:.0e}, rates of the halves {first:.6g} and {second:.6g}, energy within {drift(run):.1e}",
                   abs(a2) < 5 * sigma + 2e-3 and abs(second / first - 1) < 1e-3 and drift(run) < 1e-9)


tested("dsmc two particles in a cell", monte_carlo, "the exact rate of a fixed pair", "Cell.RateOfAPair")
tested("dsmc equal velocities", monte_carlo, "no division, no collision", "Cell.EqualVelocitiesDoNotCollide")
tested("dsmc one very fast particle", monte_carlo, "the majorant follows, violations counted", "Cell.OneVeryFastParticle")
tested("dsmc more candidates than particles", monte_carlo, "conserves", "Cell.TooManyCandidates")
tested("dsmc cooling over 20 decades", monte_carlo, "T^-1/2 linear, no denormals", "Cooling.TwentyDecades")
tested("dsmc three particles per cell", monte_carlo, "rate N omega/2", "Cooling.FewParticlesPerCell")
tested("dsmc schemes", monte_carlo, "T(t) and a2 equal within 4 sigma", "Cooling.SchemesAgreeSlow")
tested("dsmc particles on faces", monte_carlo, "floor rule, count conserved", "Walls.FacesAndImages")
tested("dsmc heated walls, elastic", monte_carlo, "T = T_w, a2 = 0, uniform", "Walls.EquilibriumWithEqualWallsSlow")
tested("dsmc scalar, vector, threads", monte_carlo, "identical hash", "Bits.EveryInstructionSetAndThreadCount")
tested("dsmc crafted states", monte_carlo, "kinds, identities and places that cannot be are refused", "Bits.StatesThatCannotBe")
