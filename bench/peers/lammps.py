"""Runs the same discs in sandlane and in LAMMPS (`lmp`) on one core: same state, laws and time step.

First both go some hundred steps from one state and their energies, contacts and positions are compared; then they run
in turn for their rates. What each of them reads and writes stays in build/bench/peers/.
"""
import json
import shutil
import statistics

import discs
import measure
import programs
from dump import loop_rate

agitate_steps = 2000
check_steps = 300  # six collision times of t_c = 50 dt
# Both integrators are far below this after check_steps: the largest error of the energy of an undamped gas at t_c/50
# is 3.4e-4 with velocity Verlet and 2.1e-4 with Gear's fifth order (docs/physics.md, 4.4)
energy_tolerance = 1e-3
skins = (0.1, 0.2, 0.4)  # LAMMPS runs with the fastest of them


def run(command, folder):
    return programs.run(command, folder, cores=1)[0]


def time_step(folder):
    return json.loads(run([measure.build / "sandlane", "check", "scene.toml", "--json"], folder))["dt"]


def sandlane(folder, steps, overrides, trajectory=False):
    """Summary of a run; with trajectory, a frame of the last step in out/trajectory.dump."""
    command = [measure.build / "sandlane", "run", "scene.toml", "--out", "out", "--steps", str(steps), "-j", "1",
               "--quiet", "--json"]
    if trajectory:
        overrides = [*overrides, f"output.trajectory_every={steps * time_step(folder)!r}"]
    shutil.rmtree(folder / "out", ignore_errors=True)
    return json.loads(run(command + [word for key in overrides for word in ("--set", key)], folder))


def lammps(folder, steps, trajectory=False):
    """Particle-steps per second of the run loop; with trajectory, a frame of the last step in lammps.dump."""
    text = run(["lmp", "-in", "in.lmp", "-log", "none", "-var", "steps", str(steps), "-var", "write",
                str(int(trajectory))], folder)
    return loop_rate(text)


def prepare(folder, law, phi, grains):
    """Files of an agitated state for both programs; returns the discs, the box and the time step."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    state, box = discs.start(grains, phi)
    discs.write_sandlane(folder, state, box, law, 0)
    dt = time_step(folder)
    sandlane(folder, agitate_steps, [], trajectory=True)
    state = discs.read_dump(folder / "out/trajectory.dump")
    discs.write_sandlane(folder, state, box, law, dt)
    return state, box, dt


def compare_physics(folder, law, state, box, overrides):
    """Both programs for check_steps from one state: do energy and contacts agree."""
    sandlane(folder, check_steps, overrides, trajectory=True)
    lammps(folder, check_steps, trajectory=True)
    ours, theirs = discs.read_dump(folder / "out/trajectory.dump"), discs.read_dump(folder / "lammps.dump")
    before, _ = discs.observables(state, box, law)
    (energy, contacts), (their_energy, their_contacts) = (discs.observables(s, box, law) for s in (ours, theirs))
    apart = max(abs((ours[c] - theirs[c] + size / 2) % size - size / 2).max() for c, size in zip("xy", box))
    difference = abs(energy - their_energy) / before
    same = difference < energy_tolerance and abs(contacts - their_contacts) <= 4 * max(1, contacts) ** 0.5
    print(f"    from energy {before:.6g}: {energy:.6g} and {their_energy:.6g} after {check_steps} steps (difference "
          f"{difference:.1e}), contacts {contacts} and {their_contacts}, positions apart by at most {apart:.1e} R: "
          f"{'the same physics' if same else 'NOT THE SAME PHYSICS'}")
    return same


def race(folder, steps, rounds, overrides):
    """Rates of both, run in turn, and how sandlane finds pairs."""
    ours, theirs, plan = [], [], {}
    for _ in range(rounds):
        summary = sandlane(folder, steps, overrides)
        ours.append(summary["particle_steps_per_second"])
        plan = summary["plan"]
        theirs.append(lammps(folder, steps))
    return ours, theirs, plan["neighbours"]


def one_case(law, phi, grains, options):
    folder = measure.results / f"peers/{law}-{phi}-{grains}"
    state, box, dt = prepare(folder, law, phi, grains)
    n = state["x"].size
    trial = max(20, int(2e6 / n))
    rates = {}
    for skin in skins:
        discs.write_lammps(folder, state, box, law, dt, skin)
        rates[skin] = lammps(folder, trial)
    skin = max(rates, key=rates.get)
    discs.write_lammps(folder, state, box, law, dt, skin)
    print(f"{law}, packing fraction {phi}, {n} discs, dt {dt:.4g}, LAMMPS skin {skin}")
    same = compare_physics(folder, law, state, box, options.set)
    steps = max(20, int(options.seconds * rates[skin] / n))
    ours, theirs, method = race(folder, steps, options.rounds, options.set)
    ratio = statistics.median(a / b for a, b in zip(ours, theirs))
    rates = [f"{statistics.median(r) / 1e6:.2f}" for r in (ours, theirs)]
    print(f"    sandlane ({method}) {rates[0]}, LAMMPS {rates[1]} million particle-steps/s: ratio {ratio:.2f}",
          flush=True)
    return same


def main(options, skipped):
    if shutil.which("lmp") is None:
        print("skipped: no lmp here; on Debian: apt-get install lammps")
        return skipped
    same = [one_case(law, phi, n, options) for law in options.law for n in options.grains for phi in options.phi]
    return 0 if all(same) else 1
