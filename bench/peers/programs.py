"""The programs that race: each writes its input into a folder, runs some steps, and tells its rate and its memory."""
import json
import math
import os
import re
import shutil
import subprocess
import sys

import bed
import measure
from dump import loop_rate


# The kernel counts what a process held before it became another program: the one that starts the program must be small.
starter = """import os, resource, sys
code = os.spawnvp(os.P_WAIT, sys.argv[2], sys.argv[2:])
with open(sys.argv[1], "w") as memory: print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, file=memory)
sys.exit(code)"""


def run(command, folder, cores):
    """Standard output and the largest resident set, bytes, of a command on so many cores."""
    allowed = sorted(os.sched_getaffinity(0))[:cores]
    if len(allowed) < cores:
        raise SystemExit(f"{cores} cores asked for, {len(allowed)} allowed")
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    with open(folder / "output.txt", "w+") as output:
        words = [sys.executable, "-SE", "-c", starter, "memory.txt", *map(str, command)]
        code = subprocess.run(words, cwd=folder, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                              env=environment, preexec_fn=lambda: os.sched_setaffinity(0, allowed)).returncode
        output.seek(0)
        text = output.read()
    if code != 0:
        raise SystemExit(f"{' '.join(map(str, command))} failed in {folder}:\n{text[-2000:]}")
    return text, float((folder / "memory.txt").read_text()) * 1024.0


def parallel(command, cores):
    """A program of MPI on so many cores."""
    return command if cores == 1 else ["mpirun", "--allow-run-as-root", "--bind-to", "none", "-np", str(cores), *command]


class Program:
    """Works in a folder of its own below `folder`."""
    name = command = ""

    def __init__(self, folder):
        self.folder = folder / self.name

    def write_file(self, name, text):
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)


class Sandlane(Program):
    name, command = "sandlane", str(measure.build / "sandlane")

    def version(self):
        return subprocess.run([self.command, "--version"], capture_output=True, text=True).stdout.split()[-1]

    def write(self, case, law, box, grains):
        bed.write_csv(self.folder / "grains.csv", grains)
        text = 'kind = "file"\nfile = "grains.csv"'
        self.write_file("scene.toml", bed.scene(case, law, box, text))

    def run(self, steps, cores, trajectory=False):
        command = [self.command, "run", "scene.toml", "--out", "out", "--steps", steps, "-j", cores, "--quiet", "--json"]
        if trajectory:
            command += ["--set", f"output.trajectory_every={steps * bed.time_step!r}"]
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        text, memory = run(command, self.folder, cores)
        return json.loads(text)["particle_steps_per_second"], memory


class Lammps(Program):
    name, command = "LAMMPS", "lmp"
    # gran/hertz/history is the fastest style with memory; `granular` has a spring of constant stiffness, as ours is.
    fast = True

    def version(self):
        text = subprocess.run([self.command, "-h"], capture_output=True, text=True).stdout
        return re.search(r"Simulator - (.*)", text)[1].replace(" - Update", ", update")

    def styles(self, law_name):
        law = bed.laws[law_name]
        if law_name == "linear":
            def hooke(mass):
                return f"hooke {law.stiffness} NULL {law.damping / mass} {law.dashpot / mass} {law.friction} 1 limit_damping"
            return f"gran/{hooke(bed.effective_mass)}", "* *", hooke(1.0)
        def gamma(mass):
            return law.damping * law.stiffness / mass
        if self.fast:
            def history(mass):
                return f"hertz/history {law.stiffness} {law.spring} {gamma(mass)} 0 {law.friction} 1 limit_damping"
            return f"gran/{history(bed.effective_mass)}", "* *", history(1.0)
        def granular(mass):
            return (f"hertz {law.stiffness} {gamma(mass)} tangential linear_history {law.spring} 0 {law.friction} "
                    "damping viscoelastic limit_damping")
        return "granular", "* * " + granular(bed.effective_mass), "granular " + granular(1.0)

    def write(self, case, law, box, grains):
        write_data(self.folder / "data.lmp", box, grains)
        pair, coefficients, wall = self.styles(law)
        g = bed.gravity[case]
        self.write_file("in.lmp", f"""units si
atom_style sphere
boundary p p f
newton off
comm_modify vel yes
read_data data.lmp
pair_style {pair}
pair_coeff {coefficients}
neighbor {bed.skin} bin
neigh_modify every 1 delay 0 check yes
fix weight all gravity 1 vector {g[0]!r} {g[1]!r} {g[2]!r}
fix floor all wall/gran {wall} zplane 0 NULL
fix move all nve/sphere
timestep {bed.time_step!r}
thermo 1000000
run ${{steps}}
if "${{write}} == 1" then "write_dump all custom lammps.dump id x y z vx vy vz omegax omegay omegaz radius mass &
    modify sort id format float %.17g"
""")

    def run(self, steps, cores, trajectory=False):
        command = [self.command, "-in", "in.lmp", "-log", "none", "-var", "steps", steps, "-var", "write", int(trajectory)]
        text, memory = run(parallel(command, cores), self.folder, cores)
        return loop_rate(text), memory


class Liggghts(Program):
    """Its own Hertz and Hooke models: stiffness and damping from Young's modulus and restitution."""
    name, command = "LIGGGHTS", "liggghts"

    def version(self):
        # It leaves a log wherever it is asked.
        text = subprocess.run([self.command, "-log", "none", "-h"], capture_output=True, text=True).stdout
        return re.search(r"PUBLIC (\S+),", text)[1]

    def write(self, case, law_name, box, grains):
        write_data(self.folder / "data.lmp", box, grains)
        law, g = bed.laws[law_name], bed.gravity[case]
        model = "hertz tangential history" if law.spring > 0 else "hooke tangential no_history"
        self.write_file("in.lmp", f"""units si
atom_style granular
atom_modify map array
boundary p p f
newton off
communicate single vel yes
read_data data.lmp
neighbor {bed.skin} bin
neigh_modify delay 0
fix young all property/global youngsModulus peratomtype {1.5 * 0.91 * 1e7}
fix poisson all property/global poissonsRatio peratomtype 0.3
fix restitution all property/global coefficientRestitution peratomtypepair 1 0.88
fix friction all property/global coefficientFriction peratomtypepair 1 {law.friction}
fix speed all property/global characteristicVelocity scalar 1.0
pair_style gran model {model}
pair_coeff * *
fix weight all gravity 1.0 vector {g[0]!r} {g[1]!r} {g[2]!r}
fix floor all wall/gran model {model} primitive type 1 zplane 0.0
fix move all nve/sphere
timestep {bed.time_step!r}
thermo 1000000
run ${{steps}}
""")

    def run(self, steps, cores):
        command = [self.command, "-in", "in.lmp", "-log", "none", "-var", "steps", steps]
        text, memory = run(parallel(command, cores), self.folder, cores)
        return loop_rate(text), memory


class Yade(Program):
    """Its own laws; four walls instead of the periodic sides, and contacts always remember."""
    name, command = "YADE", "yade"

    def version(self):
        text = subprocess.run([self.command, "--version"], capture_output=True, text=True).stdout
        return text.split()[-1]

    def write(self, case, law_name, box, grains):
        bed.write_csv(self.folder / "grains.csv", grains)
        law, g = bed.laws[law_name], bed.gravity[case]
        physics, force = (("Ip2_FrictMat_FrictMat_MindlinPhys(en=0.88)", "Law2_ScGeom_MindlinPhys_Mindlin()")
                          if law_name == "hertz" else
                          ("Ip2_FrictMat_FrictMat_FrictPhys()", "Law2_ScGeom_FrictPhys_CundallStrack()"))
        young = 1.5 * 0.91 * 1e7 if law_name == "hertz" else law.stiffness
        self.write_file("yade.py", f"""import time, math, sys
import numpy
g = numpy.loadtxt("grains.csv", delimiter=",", skiprows=1)
O.materials.append(FrictMat(young={young}, poisson=0.3, density={6 / math.pi}, frictionAngle=math.atan({law.friction})))
for row in g:
    O.bodies.append(utils.sphere(row[:3], row[9]))
    O.bodies[-1].state.vel = row[3:6]
for axis, high in ((0, {box[0]!r}), (1, {box[1]!r})):
    O.bodies.append(utils.wall(0.0, axis=axis, sense=1))
    O.bodies.append(utils.wall(high, axis=axis, sense=-1))
O.bodies.append(utils.wall(0.0, axis=2, sense=1))
O.engines = [ForceResetter(),
             InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist={bed.skin}),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [{physics}], [{force}]),
             NewtonIntegrator(gravity={tuple(g)!r}, damping=0.1)]
O.dt = {bed.time_step!r}
O.run(5, True)
steps = int(open("steps").read())
begin = time.time()
O.run(steps, True)
print("RATE", steps * len(g) / (time.time() - begin))
""")

    def run(self, steps, cores):
        self.write_file("steps", str(steps))
        text, memory = run([self.command, "-n", "-x", f"-j{cores}", "yade.py"], self.folder, cores)
        return float(re.search(r"RATE (\S+)", text)[1]), memory


def write_data(path, box, grains):
    """A data file of LAMMPS and LIGGGHTS: diameter and density."""
    n = grains["x"].size
    volume = 4 / 3 * math.pi * grains["radius"]**3
    lines = [f"spheres\n\n{n} atoms\n1 atom types\n\n0 {box[0]!r} xlo xhi\n0 {box[1]!r} ylo yhi\n-1 {box[2]!r} zlo zhi\n",
             "Atoms\n"]
    lines += [f"{i + 1} 1 {2 * grains['radius'][i]:.17g} {grains['mass'][i] / volume[i]:.17g} {grains['x'][i]:.17g} "
              f"{grains['y'][i]:.17g} {grains['z'][i]:.17g}" for i in range(n)]
    lines.append("\nVelocities\n")
    lines += [f"{i + 1} " + " ".join(f"{grains[c][i]:.17g}" for c in bed.columns[3:9]) for i in range(n)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def present(folder):
    return [kind(folder) for kind in (Sandlane, Lammps, Liggghts, Yade) if shutil.which(kind.command)]
