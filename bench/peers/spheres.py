"""Races sandlane, LAMMPS, LIGGGHTS and YADE on spheres: `tools/bench spheres`."""
import statistics

import numpy

import bed
import measure
import programs

check_steps = 100  # two collision times
# What may lie between sandlane and LAMMPS after check_steps from a bed at rest, in diameters: an overlap is about 1e-4
# there, and the programs start springs, and damp in the half step, each in their own way.
apart_tolerance = 1e-4


def settled(law, grains, sizes):
    """The bed, from a file if an earlier call has left it."""
    kind = "sizes" if sizes else "equal"
    folder = measure.results / f"spheres/{law}-{kind}-{grains}"
    box = bed.box_of("bed", grains, sizes)
    if not (folder / "settled.npz").exists():
        folder.mkdir(parents=True, exist_ok=True)
        print(f"settling {grains} spheres", flush=True)
        ours = programs.Sandlane(folder)
        ours.write("bed", law, box, bed.start(grains, sizes))
        ours.run(round(bed.settling / bed.time_step), 1, trajectory=True)
        numpy.savez(folder / "settled.npz", **bed.read_dump(ours.folder / "out/trajectory.dump"))
    return folder, dict(numpy.load(folder / "settled.npz"))


def same_physics(folder, law, box, grains):
    """LAMMPS and sandlane from the settled bed: how far they are apart."""
    ours, theirs = programs.Sandlane(folder), programs.Lammps(folder)
    theirs.fast = False
    for program in (ours, theirs):
        program.write("bed", law, box, grains)
        program.run(check_steps, 1, trajectory=True)
    a, b = bed.read_dump(ours.folder / "out/trajectory.dump"), bed.read_dump(theirs.folder / "lammps.dump")
    apart = max(numpy.abs((a[c] - b[c] + size / 2) % size - size / 2).max() for c, size in zip("xyz", box))
    moved = max(numpy.abs((a[c] - grains[c] + size / 2) % size - size / 2).max() for c, size in zip("xyz", box))
    print(f"    after {check_steps} steps sandlane and LAMMPS are apart by at most {apart:.1e}, moved by {moved:.1e}")
    return apart < apart_tolerance


def race(folder, case, law, box, grains, options):
    """Rates and memory of all programs, run in turn: {(name, cores): [rate ...]}, {name: bytes}."""
    rates, memory = {}, {}
    found = [p for p in programs.present(folder) if not options.only or p.name.lower() in options.only]
    n = grains["x"].size
    for program in found:
        program.write(case, law, box, grains)
    first = {p.name: p.run(20, 1)[0] for p in found}
    for _ in range(options.rounds):
        for cores in options.cores:
            for program in found:
                steps = max(20, round(options.seconds * cores * first[program.name] / n))
                rate, resident = program.run(steps, cores)
                rates.setdefault((program.name, cores), []).append(rate)
                if cores == 1:
                    memory[program.name] = resident
    return rates, memory


def base_memory(law):
    """Resident set of each program with hardly a grain."""
    grains, box, base = bed.start(64, False), bed.box_of("bed", 64, False), {}
    for program in programs.present(measure.results / "spheres/base"):
        program.write("bed", law, box, grains)
        base[program.name] = program.run(20, 1)[1]
    return base


def report(case, law, sizes, n, z, rates, memory, base):
    for (name, cores), found in rates.items():
        ratio = statistics.median(a / b for a, b in zip(rates["sandlane", cores], found))
        per_grain = f"{(memory[name] - base[name]) / n:8.0f}" if cores == 1 else 8 * " "
        print(f"{case:<8}{law:<8}{'sizes' if sizes else 'equal':<7}{n:>9}{z:>6.2f}  {name:<10}{cores:>6}"
              f"{statistics.median(found) / 1e6:>9.2f}{ratio:>9.2f}{per_grain}", flush=True)


def main(options):
    print(", ".join(f"{p.name} {p.version()}" for p in programs.present(measure.results)))
    print(f"{'case':<8}{'law':<8}{'radii':<7}{'grains':>9}{'Z':>6}  {'program':<10}{'cores':>6}{'M/s':>9}{'ours/it':>9}"
          f"{'B/grain':>8}")
    good = True
    for law in options.law:
        base = base_memory(law)
        for wanted in options.grains:
            folder, grains = settled(law, wanted, options.sizes)
            box = bed.box_of("bed", wanted, options.sizes)
            if "LAMMPS" in base:
                good = same_physics(folder, law, box, grains) and good
            for case in options.case:
                rates, memory = race(folder, case, law, bed.box_of(case, wanted, options.sizes), grains, options)
                report(case, law, options.sizes, grains["x"].size, bed.contacts(grains, box), rates, memory, base)
    return 0 if good else 1
