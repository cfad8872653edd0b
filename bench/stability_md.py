"""Stress cases of force-based dynamics: md-spheres.md, section 10, and md-vectorised-lattice.md, table 4."""
import math

from trial import Run, Verdict, case, sandlane, tested

book, lattice = "md-spheres.md 10", "md-vectorised-lattice.md table 4"


def dashpot(stiffness, restitution, mass):
    """Damping of a linear dashpot that is cut at zero force, e = 0.88 and the like, for an effective mass."""
    # Closed form of the uncut one; the cut changes e in the third digit, which the tests of the laws know.
    log = math.log(restitution)
    return -2 * log * math.sqrt(stiffness * mass / (math.pi**2 + log**2))


def discs(items, more="", stiffness=1e6, damping=0.0, box=10.0, lower=0.0, domain="", md="", length=1.0, duration=0.0):
    """A scene of discs given one by one: [(x, y, vx, vy, radius, mass)]; lengths in units of `length`."""
    rows = ",\n".join(f"{{ position = [{lower + x * length!r}, {lower + y * length!r}], "
                      f"velocity = [{vx * length!r}, {vy * length!r}], radius = {r * length!r}, mass = {m!r} }}"
                      for x, y, vx, vy, r, m in items)
    low, high = lower, lower + box * length
    return f"""[domain]
lower = [{low!r}, {low!r}]
upper = [{high!r}, {high!r}]
{domain}
[[materials]]
name = "m"
stiffness = {stiffness!r}
damping = {damping!r}
{more}
[[grains]]
kind = "list"
items = [{rows}]
[md]
normal = "linear-dashpot"
tangential = "none"
duration = {duration!r}
{md}
"""


def pair(speed=0.5, first=(1.0, 1.0), second=(1.0, 1.0), gap=0.01, y=5.0):
    (r1, m1), (r2, m2) = first, second
    return [(4.0, y, speed, 0.0, r1, m1), (4.0 + r1 + r2 + gap, y, -speed, 0.0, r2, m2)]


def restitution(run, m1=1.0, m2=1.0, speed=0.5):
    """From the kinetic energy in the frame of the centre of mass."""
    log = run.log
    total = m1 + m2
    drift = (m1 - m2) * speed / total
    after = log["kinetic_energy"][-1] - 0.5 * total * drift**2
    return math.sqrt(2 * after / (m1 * m2 / total)) / (2 * speed)


def collide(folder, stiffness=1e6, masses=(1.0, 1.0), radii=(1.0, 1.0), e=0.88, md="", length=1.0, **more):
    mass = masses[0] * masses[1] / sum(masses)
    time = math.pi * math.sqrt(mass / stiffness)
    grains = pair(0.5, (radii[0], masses[0]), (radii[1], masses[1]), gap=touch * time)
    run = Run(folder, discs(grains, stiffness=stiffness, damping=dashpot(stiffness, e, mass),
                            md=f"{md}\nmax_speed = {length!r}", length=length, duration=8 * time, **more))
    return run, restitution(run, *masses, 0.5 * length) if run.code == 0 else math.nan


# Time until the touch over t_c: in the middle of a step, wherever rounding puts it.
touch = 2.011
# The error of t_c/50 with the onset inside a step: 1.4e-3 (docs/accuracy.md), and the cut.
coefficient_error = 0.02


@case("md stiffness over 8 decades", book, "e as at k = 1e6 N/m to 1e-3 for k = 1e2 to 1e10 N/m: the time step follows")
def stiffness(folder):
    middle = collide(folder / "6", 1e6)[1]
    worst = max(abs(collide(folder / str(n), 10.0**n)[1] - middle) for n in range(2, 11))
    return Verdict(f"e = {middle:.4f}, largest difference {worst:.1e}", worst < 1e-3 and abs(middle - 0.88) < 0.02)


@case("md stiff contact at a fixed step", book, "a warning above t_c/20; above the critical step an error that says so")
def fixed_step(folder):
    soft = discs(pair(), duration=0.01, md="dt = 5e-5")
    first = Run(folder / "soft", soft)
    near = Run(folder / "near", discs(pair(), duration=0.01, stiffness=5e6, md="dt = 5e-5"))
    told = "t_c/20" in sandlane_check(folder / "near")
    stiff = Run(folder / "stiff", discs(pair(), duration=0.01, stiffness=1e10, md="dt = 5e-5"))
    end = stiff.refuses(2, "md.dt", "critical time step")
    return Verdict(f"t_c/44: exit {first.code}; t_c/20: exit {near.code}, warning {'yes' if told else 'no'}; Y x 1e4: "
                   + end.observed, first.code == 0 and near.code == 0 and told and end.good)


def sandlane_check(folder):
    done = sandlane(folder, "check", "scene.toml")
    return done.stdout + done.stderr


@case("md mass ratio 1e6", book, "dt from the smallest effective mass; e within the error of the step")
def masses(folder):
    run, e = collide(folder, masses=(1.0, 1e-6))
    return Verdict(f"dt = {run.summary['plan']['dt']:.2e} s, e = {e:.4f}", abs(e - 0.88) < coefficient_error)


@case("md size ratio 1:100", book, "Verlet lists as all pairs: equal positions to 1e-9 R; lattice refuses the ratio")
def sizes(folder):
    scene = """[domain]
upper = [6, 6]
periodic = ["x"]
gravity = [0, -10]
[[materials]]
name = "m"
stiffness = 1e6
damping = 20
[[grains]]
kind = "list"
items = [{ position = [3, 3], radius = 1 }]
[[grains]]
radius = 0.01
counts = [60, 3]
lower = [0.05, 1.7]
spacing = [0.1, 0.03]
[[walls]]
kind = "plane"
points = [[0, 0]]
normal = [0, 1]
[md]
normal = "linear-dashpot"
tangential = "none"
max_speed = 8
duration = 0.2
"""
    found = {}
    for method in ("verlet", "link-cells", "brute-force", "lattice"):
        found[method] = Run(folder / method, scene, "--set", f"md.neighbours={method}")
    refused = found["lattice"].refuses(2, "ratio")
    energies = {m: found[m].log["total_energy"][-1] for m in ("verlet", "link-cells", "brute-force")}
    spread = max(energies.values()) / min(energies.values()) - 1
    deepest = max(found["verlet"].log["largest_overlap"])
    return Verdict(f"energies differ by {spread:.1e}, largest overlap {deepest:.2g} R_min; lattice: {refused.observed}",
                   spread < 1e-9 and refused.good)


@case("md 1e6 radii from the origin", book, "the same collision, to the resolution of the coordinates: 1e6 R eps = 1e-10 R "
      "of an overlap of 1e-3 R, 1e-6 of e")
def far(folder):
    _, near = collide(folder / "near", 1e6)
    worst = 0.0
    for method in ("verlet", "link-cells", "lattice", "lattice-half", "brute-force"):
        worst = max(worst, abs(collide(folder / method, 1e6, md=f'neighbours = "{method}"', lower=1e6)[1] - near))
    return Verdict(f"e = {near:.6f}, largest difference of five methods {worst:.1e}", worst < 1e-6)


@case("md denormal energies and tiny units", book, "masses of 1e-140 kg, lengths of 1e-86 m, energies of 1e-313 J, below the normal "
      "numbers: e unchanged; stiffness whose square is no number: refused")
def denormals(folder):
    speeds = []
    for name, more in (("normal", {}), ("tiny", dict(stiffness=1e-134, masses=(1e-140, 1e-140), length=1e-86))):
        run, _ = collide(folder / name, **more)
        speeds.append(run.log["largest_speed"][-1] / run.log["largest_speed"][0] if run.code == 0 else math.nan)
    refused = collide(folder / "refused", stiffness=1e-294, masses=(1e-300, 1e-300), length=1e-3)[0].refuses(2, "no duration that is a number")
    return Verdict(f"e = {speeds[0]:.9f} and {speeds[1]:.9f}; {refused.observed}",
                   abs(speeds[0] - speeds[1]) < 1e-9 and refused.good)


@case("md simultaneous contacts", book, "a disc hit from both sides, and a row of seven: mirror images to the last bit, the "
      "middle at rest, momentum 0; sideways motion and spin exactly 0")
def simultaneous(folder):
    row = [(11 + 2.0 * k, 5.0, 0.0, 0.0, 1.0, 1.0) for k in range(-3, 4)]
    row[0] = (row[0][0] - 0.01, 5.0, 1.0, 0.0, 1.0, 1.0)
    row[-1] = (row[-1][0] + 0.01, 5.0, -1.0, 0.0, 1.0, 1.0)
    run = Run(folder, discs(row, "friction = 0.5\ntangential_damping = 10", damping=20.0, box=24.0, duration=0.1,
                            md='inertia = "disc"').replace('tangential = "none"', 'tangential = "haff-werner"'))
    log = run.log
    momentum = max(abs(p) for p in log["momentum_x"])
    side = max(max(map(abs, log["momentum_y"])), max(log["rotational_energy"]))
    return Verdict(f"exit {run.code}, |momentum| up to {momentum:.1e} of 1, sideways and spin {side:g}",
                   run.code == 0 and momentum < 1e-13 and side == 0)


@case("md contact across a periodic side", lattice, "a collision on the seam, with the frame moving: e as inside, to 1e-9")
def seam(folder):
    _, inside = collide(folder / "inside")
    worst = 0.0
    for method in ("verlet", "link-cells", "lattice", "lattice-half"):
        time = math.pi * math.sqrt(0.5 / 1e6)
        grains = [((x + 5.0) % 10, y, vx, vy, r, m) for x, y, vx, vy, r, m in pair(gap=touch * time)]
        run = Run(folder / method, discs(grains, damping=dashpot(1e6, 0.88, 0.5), duration=8 * time,
                                         domain='periodic = ["x", "y"]', md=f'neighbours = "{method}"'))
        worst = max(worst, abs(restitution(run) - inside))
    return Verdict(f"e = {inside:.6f}, largest difference {worst:.1e}", worst < 1e-9)


@case("md perfect hexagonal packing", lattice, "compressed by 1e-3: three contacts per disc and nothing moves, by all methods")
def hexagonal(folder):
    spacing = 2 * 0.999
    scene = f"""[domain]
upper = [{12 * spacing!r}, {12 * spacing * math.sqrt(3) / 2!r}]
periodic = ["x", "y"]
[[materials]]
name = "m"
stiffness = 1e6
damping = 10
[[grains]]
radius = 1
lower = [0, 0]
counts = [12, 12]
spacing = [{spacing!r}, {spacing * math.sqrt(3) / 2!r}]
triangular = true
[md]
normal = "linear-dashpot"
tangential = "none"
duration = 0.1
"""
    speeds, contacts = {}, set()
    for method in ("verlet", "link-cells", "lattice", "lattice-half", "brute-force"):
        log = Run(folder / method, scene, "--set", f"md.neighbours={method}").log
        speeds[method] = max(log["largest_speed"])
        contacts.add(log["contacts"][-1])
    return Verdict(f"{sorted(contacts)} contacts of 144 discs, largest speed {max(speeds.values()):.1e} m/s",
                   contacts == {432.0} and max(speeds.values()) < 1e-9)


def floor_and_lid(height, motion):
    return f"""[[walls]]
kind = "plane"
points = [[0, 0]]
normal = [0, 1]
[[walls]]
kind = "plane"
points = [[0, {height}]]
normal = [0, -1]
motion = "press"
[[motions]]
name = "press"
{motion}
"""


@case("md jammed state", book, "a lid presses discs from phi = 0.79 to 0.88: a bounded overlap, finite energies, in the end at rest")
def jammed(folder):
    scene = floor_and_lid(40, 'kind = "oscillate"\namplitude = [0, -4]\nomega = 0.15707963267948966') + """[domain]
lower = [0, -1]
upper = [40, 42]
periodic = ["x"]
[[materials]]
name = "m"
density = 1
stiffness = 1e5
damping = 400
[[grains]]
kind = "random"
radius = { law = "uniform", min = 0.7, max = 1 }
lower = [0, 0]
upper = [40, 40]
packing_fraction = 0.79
thermal_speed = 0.5
[md]
normal = "linear-dashpot"
tangential = "none"
body = "disc"
duration = 10
"""
    run = Run(folder, scene)
    log = run.log
    ratio = log["kinetic_energy"][-1] / max(log["kinetic_energy"])
    deepest = max(log["largest_overlap"])
    return Verdict(f"exit {run.code}, largest overlap {deepest:.2f} R_min, kinetic energy falls to {ratio:.1e}",
                   run.code == 0 and ratio < 1e-3 and deepest < 0.3 and math.isfinite(log['total_energy'][-1]))


@case("md many-body compression", book, "a piston pushes a column far together: an error, or bounded overlap, finite energies")
def piston(folder):
    scene = discs([(5.0, 1.0 + 2.0 * k, 0.0, 0.0, 1.0, 1.0) for k in range(4)], damping=100.0, duration=0.5, stiffness=1e4)
    scene += floor_and_lid(8.01, 'kind = "linear"\nvelocity = [0, -8]')
    run = Run(folder, scene)
    if run.code:
        return run.refuses(6, "overlap" if "overlap" in run.said else "")
    log = run.log
    return Verdict(f"exit 0, largest overlap {max(log['largest_overlap']):.2f} R, energy {log['total_energy'][-1]:.3g} J",
                   math.isfinite(log["total_energy"][-1]) and max(log["largest_overlap"]) <= 1)


@case("md overdamped contact", book, "z = 3: refused, or the discs part without a bounce and never attract: 0 <= e < 0.1")
def overdamped(folder):
    mass, stiff = 0.5, 1e4
    scene = discs(pair(gap=0.001), damping=3 * 2 * math.sqrt(stiff * mass), stiffness=stiff, duration=0.5)
    run = Run(folder, scene)
    if run.code:
        return run.refuses(2, "critical")
    e, momentum = restitution(run), max(map(abs, run.log["momentum_x"]))
    return Verdict(f"e = {e:.4f}, |momentum| {momentum:.0e}", e < 0.1 and momentum < 1e-12)


@case("md fast grain", book, "v dt = 0.7 R towards a wall: an error, not a passage through the wall")
def fast(folder):
    scene = discs([(5.0, 3.0, 0.0, -1000.0, 1e-3, 1.0)], stiffness=1e3, duration=0.02, md="dt = 7e-7\nmax_speed = 1")
    scene += '[[walls]]\nkind = "segment"\npoints = [[0, 1], [10, 1]]\n'
    run = Run(folder, scene)
    if run.code:
        return run.refuses(run.code, "speed")._replace(good=run.code in (2, 6))
    log = run.log
    return Verdict(f"exit 0: largest overlap {max(log['largest_overlap']):.2g} R, removed {log['removed'][-1]:g}",
                   log["removed"][-1] == 0)


@case("md overlap at the start", book, "3 % of R: runs and tells the size in its log; 20 % (the specification only warns), "
      "more than R, equal centres: an error with both ids")
def overlap(folder):
    def two(apart):
        return discs([(4.0, 5.0, 0.0, 0.0, 1.0, 1.0), (4.0 + apart, 5.0, 0.0, 0.0, 1.0, 1.0)], duration=0.001)
    slight = Run(folder / "slight", two(1.97))
    others = [Run(folder / str(apart), two(apart)).refuses(2, "grain 0", "grain 1") for apart in (1.8, 0.9, 0.0)]
    told = slight.log["largest_overlap"][0] if slight.code == 0 else math.nan
    return Verdict(f"3 %: exit {slight.code}, largest overlap {told:.3g} R; " + "; ".join(v.observed for v in others),
                   abs(told - 0.03) < 1e-3 and all(v.good for v in others))


@case("md box smaller than the stencil", book, "a periodic box 3 R wide: a method is found, the same as all pairs")
def small(folder):
    found = {}
    for method in ("auto", "brute-force"):
        grains = [(1.0, 1.0, 0.3, 0.1, 0.5, 1.0), (2.2, 2.0, -0.2, 0.4, 0.5, 1.0)]
        run = Run(folder / method, discs(grains, damping=10.0, box=3.0, domain='periodic = ["x", "y"]', duration=20.0,
                                         md=f'neighbours = "{method}"', stiffness=1e4))
        found[method] = run
    a, b = (found[m].log["total_energy"][-1] if found[m].code == 0 else math.nan for m in found)
    return Verdict(f"auto is {found['auto'].summary.get('plan', {}).get('neighbours')}, energy {a:.6g} J, all pairs {b:.6g} J",
                   abs(a - b) < 1e-9 * abs(b))


@case("md elastic gas for 1e7 steps", book, "the error of the energy grows as a random walk, so it is up to 3 sqrt(100) times that "
      "of 1e5 steps; momentum below 1e-9; time = n dt", soak=True)
def long(folder):
    run, first = (elastic(folder / str(steps), steps) for steps in (10000000, 100000))
    log = run.log
    drift, at_first = (max(abs(e / r.log["total_energy"][0] - 1) for e in r.log["total_energy"]) for r in (run, first))
    momentum = max(max(map(abs, log["momentum_x"])), max(map(abs, log["momentum_y"])))
    exact = run.summary["time"] == run.summary["step"] * run.summary["plan"]["dt"]
    return Verdict(f"{run.summary['step']:.3g} steps: energy within {drift:.1e}, after 1e5 {at_first:.1e}; momentum "
                   f"{momentum:.1e}; time {'exact' if exact else run.summary['time']}",
                   drift < 30 * at_first and momentum < 1e-9 and exact)


def elastic(folder, steps):
    grains = [(1.5 + 2.5 * i, 1.5 + 2.5 * k, 0.3 * ((-1) ** (i + k)), 0.2 * ((-1) ** k), 1.0, 1.0)
              for i in range(4) for k in range(4)]
    scene = discs(grains, stiffness=1e4, domain='periodic = ["x", "y"]', md='integrator = "gear6"\ndt = 2e-4',
                  duration=2e-4 * steps)
    return Run(folder, scene, patience=4000)


tested("md masses, radii not positive or not finite", book, "rejected with record and column", "Refusals.GrainFiles")
tested("md coincident centres", book, "error with both ids, no division", "Guards.CoincidentCentresNameBothGrains")
tested("md Walton-Braun as the load vanishes", book, "no division by zero", "WaltonBraunTangential.FollowsTheLoad")
tested("md memory through lists, wrap and sorting", book, "springs unchanged", "Resume.MemoryOfContactsGoesAlong")
tested("md grains that leave", book, "removed and counted, or an error", "Domain.LeavingGrainsAreRemovedAndCounted")
tested("md N = 0 and 1", book, "valid runs", "Valid.NoGrainsAndOneGrain")
tested("md undefined sites", lattice, "forces of occupied sites unchanged", "ForceSum.MatchesTableOne")
tested("md two centres in one site", lattice, "an announced switch, no lost grain", "Guards.SharedSiteIsAnAnnouncedSwitch")
tested("md ratio above the bound, too many sites", lattice, "rejected at setup", "Refusals.LatticeBounds")
tested("md lanes, threads, instruction sets", lattice, "bitwise equal", "Determinism.SameBitsForEveryIsaAndThreadCount")
tested("md quaternions", book, "norm stays 1, exact at constant spin", "Orientation.FollowsAConstantSpinExactly")
tested("md resting pile for long", book, "springs hold it still", "Wall.SpringsHoldADiscStill")
