"""The program on a scene of fifty grains: what holds for every run, whatever the grains do. Run by
ctest, one test each; TRACKBED names the program."""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["TRACKBED"]
FUZZERS = os.environ.get("FUZZERS", "")  # the folder they are in
HERE = pathlib.Path(__file__).resolve().parent
# Not the same in two runs of the same scene: how long they took.
CLOCK = {"timing.csv", "summary.csv"}
# A load cycle of some hundred steps after a short ramp.
SHORT = {"Loading/Ramp time": "0.002", "Loading/Frequency": "250", "Loading/Cycles": "1"}


def rows(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def plain(file):
    """The bytes of a file without XML comments: deal.II writes the date into them."""
    return re.sub(rb"<!--.*?-->", b"", file.read_bytes(), flags=re.DOTALL)


def write_block(file, low, high, cells, volumes=("body",)):
    """A Gmsh file of a block; its volumes, from the top down, share the cells over the height."""
    nx, ny, nz = cells
    sides = ("bottom", "top", "x_min", "x_max", "y_min", "y_max")
    names = [f'2 {k + 1} "{name}"' for k, name in enumerate(sides)]
    names += [f'3 {k + 7} "{name}"' for k, name in enumerate(volumes)]
    node = {}
    for k in range(nz + 1):
        for j in range(ny + 1):
            for i in range(nx + 1):
                node[i, j, k] = len(node) + 1
    lines = []
    for (i, j, k), number in node.items():
        at = [a + (b - a) * n / m for a, b, n, m in zip(low, high, (i, j, k), cells)]
        lines.append(" ".join(map(str, [number, *at])))
    cell, corners = [], [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    faces = [((0, 3, 2, 1), 2, 0), ((4, 5, 6, 7), 2, nz), ((0, 4, 7, 3), 0, 0), ((1, 2, 6, 5), 0, nx),
             ((0, 1, 5, 4), 1, 0), ((3, 7, 6, 2), 1, ny)]
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                eight = [node[i + a, j + b, k + c] for a, b, c in corners]
                for side, (four, axis, end) in enumerate(faces):
                    if (i, j, k)[axis] + (end > 0) == end:
                        cell.append(f"3 2 {side + 1} {side + 1} " + " ".join(str(eight[n]) for n in four))
                volume = 7 + (nz - 1 - k) * len(volumes) // nz
                cell.append(f"5 2 {volume} {volume} " + " ".join(map(str, eight)))
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", len(names), *names, "$EndPhysicalNames",
            "$Nodes", len(lines), *lines, "$EndNodes", "$Elements", len(cell),
            *(f"{n + 1} {text}" for n, text in enumerate(cell)), "$EndElements", ""]
    file.write_text("\n".join(map(str, text)))


class SceneTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="trackbed_"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(HERE / "tiny.prm", self.folder)

    def trackbed(self, *arguments, exit_code=0, **options):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.assertEqual(done.returncode, exit_code, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def run_scene(self, output, *options, change=None, **more):
        changes = {"Packing/Folder": "packings", **(change or {})}
        sets = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
        self.trackbed("run", "tiny.prm", "--output", output, *options, *sets, **more)
        return self.folder / output

    def summary(self, run):
        return {row["quantity"]: row["value"] for row in rows(run / "summary.csv")}

    def assert_sound(self, run, places=9):
        """Every number is one, the ledger closes to 1 %, what a run promises is there."""
        for file in run.glob("*.csv"):
            for row in rows(file):
                for key, cell in row.items():
                    self.assertNotIn(cell.lower(), ("nan", "inf", "-nan", "-inf"), f"{file} {key}")
        self.assertLess(float(self.summary(run)["closure"]), 0.01)
        for name in ("scene.resolved.prm", "snapshots.h5", "snapshots.xdmf", "checkpoint.h5", "gradation.csv",
                     "grains.csv", "timing.csv", "history.csv", "energy.csv", "cycles.csv", "porosity.csv",
                     "sections.csv", "library.csv", "classes.csv"):
            self.assertTrue((run / name).stat().st_size > 0, name)
        # Layers of equal thickness make up the whole; classes and layers lose no grain.
        whole, *layers = rows(run / "porosity.csv")
        self.assertAlmostEqual(float(whole["porosity"]), sum(float(r["porosity"]) for r in layers) / len(layers),
                               places)
        self.assertEqual(int(whole["grains"]), sum(int(r["grains"]) for r in layers))
        self.assertEqual(len(rows(run / "grains.csv")), sum(int(r["grains"]) for r in rows(run / "classes.csv")))

    def assert_same(self, one, other, names=None):
        files = names or sorted(p.name for p in one.iterdir()
                                if p.suffix in (".csv", ".vtu", ".pvd") and p.name not in CLOCK)
        self.assertGreater(len(files), 2)
        for name in files:
            self.assertEqual(plain(one / name), plain(other / name), f"{name} differs")

    def stop_after(self, stage, output, resume, more=()):
        """Ctrl-C in the stage that follows `stage`."""
        command = [PROGRAM, "run", "tiny.prm", "--output", output, "--set", "Packing/Reuse=false",
                   "--set", "Packing/Folder=packings", *more] + (["--resume"] if resume else [])
        with subprocess.Popen(command, cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as program:
            seen = ""
            for line in program.stderr:
                seen += line
                if line.startswith(stage):
                    program.send_signal(signal.SIGINT)
            program.stdout.read()
        self.assertEqual(program.returncode, 128 + signal.SIGINT, seen)
        self.assertIn("--resume", seen)

    def contents(self, folder):
        return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


class Runs(SceneTest):
    def test_elastic(self):
        run = self.run_scene("a")
        self.assert_sound(run)
        cycles = rows(run / "cycles.csv")
        self.assertEqual([row["cycle"] for row in cycles], ["1", "2"])
        for row in cycles:
            self.assertAlmostEqual(float(row["load_min_N"]), 20, delta=1e-6)
            self.assertAlmostEqual(float(row["load_max_N"]), 100, delta=1e-6)
        stages = list(dict.fromkeys(row["stage"] for row in rows(run / "history.csv")))
        self.assertEqual(stages, ["deposit", "tamping", "sleeper in", "hardening", "seating", "loading"])
        self.assertTrue(list(run.glob("structure_sleeper_*.vtu")))
        self.assertTrue(list(run.glob("structure_subgrade_*.vtu")))
        contacts = {row["contacts"] for row in rows(run / "history.csv") if row["stage"] == "loading"}
        self.assertTrue(all(int(n) > 20 for n in contacts))
        (seat,) = rows(run / "rail_seats.csv")
        self.assertEqual(float(seat["load_N"]), 100)

    def test_subgrade_pressure(self):
        """Once at rest (tenths of a second), between walls without friction, the ground carries ballast, sleeper and load."""
        run = self.run_scene("a", change={"Container/Friction": "0", "Loading/Largest": "21",
                                          "Loading/Ramp time": "0.4", "Contact/Local damping": "0.7",
                                          "Sleeper/Model": "rigid", "Sleeper/Degrees of freedom": "vertical"})
        pressure = rows(run / "subgrade_pressure.csv")
        area = 0.13 * 0.11 / len(pressure)
        weight = 9.81 * (float(self.summary(run)["grain mass"]) + 2800 * 0.07 * 0.08 * 0.03)
        carried = sum(float(row["pressure_Pa"]) for row in pressure) * area
        self.assertAlmostEqual(carried, 21 + weight, delta=0.05 * (21 + weight))
        profile = rows(run / "subgrade_pressure_profile.csv")
        mean = sum(float(row["pressure_Pa"]) for row in profile) / len(profile)
        self.assertAlmostEqual(mean * 0.13 * 0.11, carried, delta=1e-6 * carried)

    def test_rigid(self):
        run = self.run_scene("a", change={"Sleeper/Model": "rigid", "Subgrade/Model": "rigid"})
        self.assert_sound(run)
        self.assertFalse(list(run.glob("*.vtu")))
        self.assertNotIn("unknowns of the sleeper", self.summary(run))

    def test_half_by_symmetry(self):
        change = {"Container/Half by symmetry": "true", "Container/Length": "0.2", "Sleeper/Length": "0.14"}
        self.assert_sound(self.run_scene("a", change={**SHORT, **change}))

    def test_periodic(self):
        self.assert_sound(self.run_scene("a", change={
            **SHORT, "Container/Periodic along track": "true", "Container/Width": "0.19",
            "Container/Ballast depth": "0.06"}))

    def test_every_shape(self):
        shapes = {"sphere": {"Shape": "sphere"},
                  "dilated": {"Shape": "dilated", "Dilation": "0.1"},
                  "mixed": {"Other shape": "clump", "Other share": "0.5"}}
        for name, keys in shapes.items():
            with self.subTest(name):
                change = {**SHORT, **{f"Grains/{key}": value for key, value in keys.items()}}
                run = self.run_scene(name, change=change)
                self.assert_sound(run, places=3)  # round grains are measured by slices
                damped = float(rows(run / "energy.csv")[-1]["dissipated_contact_damping_J"])
                self.assertGreater(damped, 0)
                forces = [float(row["largest_force_N"]) for row in rows(run / "grains.csv")]
                self.assertGreater(sum(force > 0 for force in forces), len(forces) / 2)

    def test_every_subgrade_model(self):
        parameters = json.loads(self.trackbed("parameters", "--format", "json").stdout)
        # In deal.II's JSON a parameter has a "value"; what has none is a section.
        models = [name.replace("_5f", "_") for name, entry in parameters["Subgrade"].items()
                  if "value" not in entry]
        self.assertGreaterEqual(len(models), 4)
        for model in ["rigid", *models]:
            with self.subTest(model):
                run = self.run_scene(model, change={**SHORT, "Subgrade/Model": model})
                self.assert_sound(run)
                self.assertEqual("unknowns of the subgrade" in self.summary(run), model != "rigid")
        self.assertEqual(len(list((self.folder / "packings").glob("*.h5"))), 1, "all on the same packing")


    def test_meshes_from_files(self):
        """The blocks of the scene, drawn elsewhere: the same answer as from parameters."""
        layers = {**SHORT, "Subgrade/layered_elastic/Layers": "0.05:1e8:0.3:2000, 0.05:6e7:0.3:1900",
                  "Subgrade/Element size": "0.05"}
        plain_run = self.run_scene("plain", change=layers)
        write_block(self.folder / "sleeper.msh", (-0.035, -0.04, 0), (0.035, 0.04, 0.03), (2, 2, 1))
        write_block(self.folder / "soil.msh", (-0.065, -0.055, -0.1), (0.065, 0.055, 0), (3, 3, 2),
                    ("layer_1", "layer_2"))
        meshed = self.run_scene("meshed", change={**layers, "Sleeper/Mesh": "sleeper.msh",
                                                  "Subgrade/layered_elastic/Mesh": "soil.msh"})
        self.assert_sound(meshed)
        for one, other in zip(rows(plain_run / "cycles.csv"), rows(meshed / "cycles.csv")):
            self.assertAlmostEqual(float(one["u_max_m"]), float(other["u_max_m"]), delta=1e-6)


class Structures(SceneTest):
    def test_reduced_and_other_structures(self):
        """On one packing: reduced bodies give the full ones' peak to 1 %, a beam and other schemes close to it."""
        def peak(name, **change):
            run = self.run_scene(name, change={**SHORT, **change})
            self.assert_sound(run)
            return float(rows(run / "cycles.csv")[0]["u_max_m"])
        full = peak("full")
        reduced = peak("reduced", **{"Sleeper/Reduction": "modal", "Subgrade/Reduction": "condensed"})
        self.assertAlmostEqual(reduced, full, delta=0.01 * abs(full))
        self.assertTrue(list((self.folder / "reduced").glob("structure_sleeper_*.vtu")))
        report = self.summary(self.folder / "reduced")
        self.assertLess(float(report["frequency error of the reduced sleeper"]), 1e-4)
        self.assertLess(float(report["pressure error of the reduced subgrade"]), 1e-4)
        beam = peak("beam", **{"Sleeper/Model": "beam"})
        self.assertAlmostEqual(beam, full, delta=0.05 * abs(full))
        zhai = peak("zhai", **{"Sleeper/Model": "beam", "Numerics/Structure scheme": "zhai"})
        self.assertAlmostEqual(zhai, beam, delta=0.01 * abs(full))
        absorbing = peak("absorbing", **{"Subgrade/Absorbing": "all"})
        self.assertGreater(absorbing, 0)
        peak("damped", **{"Subgrade/Damping ratio": "0.05"})
        for name, damps in (("full", False), ("damped", True)):
            lost = float(rows(self.folder / name / "energy.csv")[-1]["dissipated_structure_damping_J"])
            self.assertEqual(lost > 0, damps)

    def test_rail_pads(self):
        """Pad and sleeper are springs in series: one load, deflections add. The sleeper itself does not feel it."""
        pad = {"Sleeper/Pad stiffness": "1e6"}
        models = {"rigid": {"Sleeper/Model": "rigid"}, "beam": {"Sleeper/Model": "beam"}, "elastic": {},
                  "reduced": {"Sleeper/Reduction": "modal"}}
        for name, model in models.items():
            with self.subTest(name):
                bare = self.run_scene(name, change={**SHORT, **model})
                padded = self.run_scene(name + "_pad", change={**SHORT, **model, **pad})
                self.assert_same(bare, padded, ["cycles.csv", "moment.csv", "compaction.csv"])
                for without, row in zip(rows(bare / "energy.csv"), rows(padded / "energy.csv"), strict=True):
                    self.assertAlmostEqual(float(row["dissipated_rail_pads_J"]), 0, delta=1e-15)
                    stored = float(row["structure_J"]) - float(without["structure_J"])
                    for key in without.keys() - {"structure_J", "work_J", "dissipated_rail_pads_J"}:
                        self.assertEqual(row[key], without[key], key)
                self.assertAlmostEqual(stored, 20**2 / 1e6 / 2, delta=1e-9)  # under the least load, at the end
                count = 0
                for row in rows(padded / "history.csv"):
                    if row["stage"] == "loading":
                        u, rail, load = (float(row[k]) for k in ("u_m", "rail_displacement_m", "load_N"))
                        self.assertAlmostEqual(rail, u + load / 1e6, delta=1e-15)
                        count += 1
                self.assertGreater(count, 10)
                (seat,) = rows(padded / "rail_seats.csv")
                self.assertAlmostEqual(float(seat["rail_displacement_m"]), float(seat["displacement_m"]) + 100 / 1e6,
                                       delta=1e-12)
        for row in rows(self.folder / "rigid" / "history.csv"):
            self.assertEqual(row["rail_displacement_m"], row["u_m"])

    def test_degrees_of_freedom(self):
        """A vertical sleeper does not tilt by a bit; one free to turn about y does, and about nothing else."""
        def run(name, freedom):
            change = {**SHORT, "Sleeper/Model": "rigid", "Subgrade/Model": "rigid",
                      "Sleeper/Degrees of freedom": freedom}
            run = self.run_scene(name, change=change)
            self.assert_sound(run)
            return [float(row["deflection_m"]) for row in rows(run / "moment.csv")]
        self.assertEqual(len(set(run("vertical", "vertical"))), 1)
        level = run("about_x", "x, y, z, turn x")
        self.assertLess(max(level) - min(level), 1e-15)
        tilted = run("about_y", "z, turn y")
        self.assertGreater(max(tilted) - min(tilted), 1e-9)

    def test_push(self):
        """The actuator takes the sleeper along. How much a bed of fifty grains resists says nothing."""
        push = {**SHORT, "Loading/Push": "longitudinal", "Loading/Push speed": "0.02",
                "Loading/Push distance": "0.0003"}
        mass = 2800 * 0.07 * 0.08 * 0.03
        for model, given in (("rigid", 1e5), ("elastic", 1e5), ("elastic", 1e9)):
            run = self.run_scene(f"{model}_{given:g}", change={**push, "Sleeper/Model": model,
                                                               "Loading/Push stiffness": str(given)})
            spring = float(self.summary(run)["push stiffness"])
            self.assertEqual(spring == given, given < 1e9)   # so stiff a one is lowered
            dashpot = (spring * mass) ** 0.5
            table = [{key: float(cell) for key, cell in row.items()} for row in rows(run / "push.csv")]
            self.assertGreaterEqual(len(table), 3)
            for row in table[1:]:
                way = 0.02 * (row["time_s"] - table[0]["time_s"])
                # F = k (way - x) + c (v0 - v), c = sqrt(k m); grains may throw it back or on by 3 v0 at most.
                self.assertAlmostEqual(row["displacement_m"] + row["force_N"] / spring, way,
                                       delta=4 * dashpot / spring * 0.02)
                self.assertNotEqual(row["force_N"], 0)
                self.assertLess(abs(row["force_N"]), 100)
                self.assertAlmostEqual(row["load_N"], 20, delta=1e-9)
            self.assertGreater(table[-1]["displacement_m"], 0.8 * table[-1]["time_s"] * 0.02
                               - 0.8 * table[0]["time_s"] * 0.02)

    def test_load_table(self):
        """Its peak is a third of the way, which is no whole number of exchanges of four steps."""
        (self.folder / "load.csv").write_text("time_s,load_N\n0,20\n0.0015,100\n0.003,50\n0.0045,20\n")
        for steps in (1, 4):
            run = self.run_scene(f"a{steps}", change={
                "Loading/Ramp time": "0.002", "Loading/Waveform": "table", "Loading/Table": "load.csv",
                "Numerics/Exchange": "predicted" if steps == 1 else "several_steps",
                "Numerics/Grain steps per exchange": steps})
            self.assert_sound(run)
            cycles = rows(run / "cycles.csv")
            self.assertEqual(len(cycles), 2)
            for row in cycles:
                self.assertAlmostEqual(float(row["load_max_N"]), 100, delta=2)
                self.assertAlmostEqual(float(row["load_min_N"]), 20, delta=1e-6)

    def test_sleeper_type(self):
        (self.folder / "b70.prm").write_text("subsection Sleeper\n  set Type = B70\n  set Width = 0.27\nend\n"
                                             "subsection Container\n  set Length = 3\nend\n")
        text = self.trackbed("check", "b70.prm").stdout
        self.assertIn("2.6 x 0.27 x 0.21 m", text)


class Exchange(SceneTest):
    def test_exchange_schedules(self):
        """Every schedule but the lagged one ends where the default does, ledger closed."""
        # A lumped sleeper of few cells turns less easily: explicit is compared under a rigid one.
        settled = {}
        for model in ("elastic", "rigid"):
            run = self.run_scene(model, change={**SHORT, "Sleeper/Model": model})
            settled[model] = float(rows(run / "cycles.csv")[0]["u_max_m"])
        for schedule, n in (("explicit", 1), ("iterated", 1), ("several_steps", 2), ("several_steps", 5)):
            with self.subTest(schedule, n=n):
                model = "rigid" if schedule == "explicit" else "elastic"
                change = {**SHORT, "Sleeper/Model": model, "Numerics/Exchange": schedule,
                          "Numerics/Grain steps per exchange": n}
                run = self.run_scene(f"{schedule}_{n}", change=change)
                self.assert_sound(run)
                self.assertAlmostEqual(float(rows(run / "cycles.csv")[0]["u_max_m"]), settled[model],
                                       delta=0.01 * abs(settled[model]))

    def test_settlement_with_steps_per_exchange(self):
        """Within 1 % up to ten grain steps per exchange; a hundred are refused."""
        change = {**SHORT, "Numerics/Margin": 0.1, "Numerics/Exchange": "several_steps"}
        settled = {}
        for n in (1, 2, 5, 10):
            run = self.run_scene(f"steps_{n}", change={**change, "Numerics/Grain steps per exchange": n})
            settled[n] = float(rows(run / "cycles.csv")[-1]["settlement_m"])
            self.assertAlmostEqual(settled[n], settled[1], delta=0.01 * abs(settled[1]), msg=str(n))
        self.assertNotEqual(settled[1], settled[10])
        words = [f"--set={k}={v}" for k, v in {**change, "Packing/Folder": "packings"}.items()]
        done = self.trackbed("run", "tiny.prm", "--output", "many", *words,
                             "--set=Numerics/Grain steps per exchange=100", exit_code=2)
        self.assertRegex(done.stderr, r"stability limit.*\d+ would do")

    def test_energy_lines_at_an_interval(self):
        few = self.run_scene("few", change=SHORT)
        many = self.run_scene("many", change={**SHORT, "Output/Energy interval": 3})
        self.assertGreater(len(rows(many / "energy.csv")), 2 * len(rows(few / "energy.csv")))
        self.assertEqual(plain(few / "cycles.csv"), plain(many / "cycles.csv"))

    def test_open_ledger_fails_the_run(self):
        done = self.trackbed("run", "tiny.prm", "--output", "a", "--set=Packing/Folder=packings",
                             "--set=Numerics/Closure=1e-12", *[f"--set={k}={v}" for k, v in SHORT.items()],
                             exit_code=1)
        line = done.stderr.strip().splitlines()[-1]
        self.assertRegex(line, r"step \d+ \(loading.*Numerics/Closure allows.*(halve|exchange)")

    def test_law_that_stores_no_energy(self):
        """Only what exchange and structures make is held to the tolerance then, and the plan says so."""
        change = {**SHORT, "Contact/Law": "shao2017", "Numerics/Closure": "1e-4"}
        plan = self.trackbed("check", "tiny.prm", *[f"--set={k}={v}" for k, v in change.items()]).stdout
        self.assertRegex(plan, "Numerics/Closure = 1e-4: .*shao2017 stores no energy")
        report = self.summary(self.run_scene("shao", change=change))
        self.assertGreater(float(report["closure"]), 1e-4)
        self.assertLess(float(report["exchange gain"]), 1e-4)

    def test_steps_per_exchange_without_its_schedule(self):
        done = self.trackbed("check", "tiny.prm", "--set=Numerics/Grain steps per exchange=4", exit_code=2)
        self.assertIn("several_steps", done.stderr)


class Ranks(SceneTest):
    def test_mpirun(self):
        """Two ranks share the bodies, elastic or of soil that yields; only one prints and writes."""
        mpirun = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-n", "2"]
        root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

        def run(*arguments):
            return subprocess.run([*mpirun, PROGRAM, "run", "tiny.prm", "--threads", "1", *arguments],
                                  cwd=self.folder, text=True, capture_output=True, env={**os.environ, **root})
        for model, more in (("layered_elastic", {}),
                            ("drucker_prager", {"Depth": "0.1", "Cohesion": "200", "Dilation angle": "5"})):
            with self.subTest(model):
                change = {**SHORT, "Subgrade/Model": model,
                          **{f"Subgrade/{model}/{key}": value for key, value in more.items()}}
                alone, shared = self.run_scene(f"{model}_alone", change=change), self.folder / model
                sets = [f"--set={k}={v}" for k, v in {**change, "Packing/Folder": "packings"}.items()]
                done = run("--output", model, *sets)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stdout.count("results in"), 1)
                self.assert_sound(shared)
                for file, keys in (("cycles.csv", ("u_max_m", "settlement_m")),
                                   ("energy.csv", ("structure_J", "dissipated_structure_plastic_J"))):
                    self.assertEqual(len(rows(alone / file)), len(rows(shared / file)))
                    for one, other in zip(rows(alone / file), rows(shared / file)):
                        for key in keys:
                            self.assertAlmostEqual(float(one[key]), float(other[key]),
                                                   delta=1e-5 * abs(float(one[key])))
                yielded = float(rows(shared / "energy.csv")[-1]["dissipated_structure_plastic_J"])
                self.assertEqual(yielded > 0, model == "drucker_prager")
        wrong = run("--output", "wrong", "--set=Numerics/Margin=7")
        self.assertEqual(wrong.returncode, 2)
        self.assertEqual(wrong.stderr.count("is out of range"), 1, wrong.stderr)


class Packings(SceneTest):
    """Beds without a load: what the packing methods promise."""
    VIBRATED = {"Packing/Method": "quasi_vibration", "Packing/Target porosity": "0.53", "Container/Friction": "0",
                "Packing/Porosity tolerance": "3e-3", "Packing/Friction path": "0.8, 0.2, 0", "Packing/Settle time": "3",
                "Numerics/Packing margin": "0.6", "Output/Snapshot interval": "0"}

    def pack(self, output, *options, change=None, **more):
        changes = {"Packing/Folder": "packings", "Output/Snapshot interval": "0", **(change or {})}
        sets = [word for path, value in changes.items() for word in ("--set", f"{path}={value}")]
        done = self.trackbed("pack", "tiny.prm", "--output", output, *options, *sets, **more)
        return done if more.get("exit_code") else self.folder / output

    def grains(self, run):
        return rows(run / "packing.csv")

    def test_quasi_vibration(self):
        run = self.pack("a", change=self.VIBRATED)
        path = rows(run / "friction_path.csv")
        self.assertTrue(any(abs(float(p["porosity"]) - 0.53) <= 3e-3 for p in path))
        frictions = [float(p["friction"]) for p in path if p["from_trial"] == "" or
                     int(p["from_trial"]) == int(p["trial"]) - 1]
        self.assertEqual(frictions[0], 0.8)
        porosity = [float(p["porosity"]) for p in path]
        self.assertGreater(porosity[0], porosity[1], "less friction, denser")
        self.assertTrue(all(float(p["unbalanced_share"]) < 0.01 for p in path))
        self.assertFalse(list(run.glob("path_*.h5")), "kept beds are removed in the end")
        # A stopped search goes on to the same bed.
        self.stop_and_go_on(path)
        # Taken from the store with its curve.
        (run / "friction_path.csv").unlink()
        self.trackbed("run", "tiny.prm", "--output", "b", "--set=Packing/Folder=packings",
                      *(f"--set={k}={v}" for k, v in {**self.VIBRATED, **SHORT}.items()))
        self.assertEqual(rows(self.folder / "b" / "friction_path.csv"), path)

    def stop_and_go_on(self, path):
        sets = [f"--set={k}={v}" for k, v in {**self.VIBRATED, **SHORT, "Packing/Folder": "packings",
                                               "Packing/Reuse": "false"}.items()]
        command = [PROGRAM, "run", "tiny.prm", "--output", "stopped", *sets]
        with subprocess.Popen(command, cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as program:
            for line in program.stderr:
                if line.startswith("quasi-vibration"):
                    program.send_signal(signal.SIGINT)
                    break
            program.communicate()
        self.assertEqual(program.returncode, 128 + signal.SIGINT)
        self.assertLess(len(rows(self.folder / "stopped" / "friction_path.csv")), len(path))
        self.trackbed(*command[1:], "--resume")
        self.assertEqual(rows(self.folder / "stopped" / "friction_path.csv"), path)

    def test_unreachable_porosity(self):
        done = self.pack("a", change={**self.VIBRATED, "Packing/Target porosity": "0.2",
                                      "Packing/Friction path": "0.8, 0"}, exit_code=2)
        self.assertRegex(done.stderr.splitlines()[-1], r"tiny.prm: Packing/Target porosity = 0.2: a porosity of 0.2000 "
                         r"cannot be reached; these grains reach 0\.4\d+ \(friction 0\) to 0\.5\d+ \(friction 0.8\)")

    def test_layers(self):
        change = {"Packing/Method": "deposit", "Packing/Settle time": "1.5", "Packing/Packing friction": "0.3"}
        deep = {"Container/Ballast depth": "0.14", "Packing/Layers": "2"}
        one = self.pack("one", "--export", "csv", change=change)
        two = self.pack("two", "--export", "csv", change={**change, **deep})
        self.assertEqual(len(self.grains(two)), 2 * len(self.grains(one)))
        heights = [sum(float(g["z_m"]) for g in self.grains(run)) / len(self.grains(run)) for run in (one, two)]
        self.assertAlmostEqual(heights[1] / heights[0], 2, delta=0.25)
        self.assertLess(float(self.summary(two)["largest overlap"]), 0.05)
        stages = list(dict.fromkeys(row["stage"] for row in rows(two / "history.csv")))
        self.assertEqual(stages, ["deposit", "layers", "sleeper in", "hardening"])

    def test_bays(self):
        change = {"Packing/Method": "deposit", "Container/Periodic along track": "true", "Container/Width": "0.38",
                  "Packing/Bays": "2", "Container/Ballast depth": "0.06", "Packing/Settle time": "1.5"}
        run = self.pack("a", "--export", "csv", change=change)
        grains = self.grains(run)
        half = len(grains) // 2
        # The seam of a periodic sample needs no settling: the second bay still is the first one moved on.
        moved = [float(b["y_m"]) - float(a["y_m"]) for a, b in zip(grains[:half], grains[half:])]
        self.assertLess(sorted(abs(m - 0.19) for m in moved)[half // 2], 1e-3)

    def test_cylinder(self):
        run = self.pack("a", "--export", "csv", change={"Container/Shape": "cylinder", "Container/Width": "0.13"})
        radius = max((float(g["x_m"]) ** 2 + float(g["y_m"]) ** 2) ** 0.5 for g in self.grains(run))
        self.assertLess(radius, 0.065)
        self.assertGreater(radius, 0.045)
        self.assertTrue(rows(run / "compaction.csv"), "the plate is round too")

    def test_zones(self):
        change = {"Zones/Use": "true", "Container/Length": "0.3", "Container/Ballast depth": "0.08",
                  "Zones/Margin": "0.02", "Zones/Transition": "0.02", "Zones/Size ratio": "1.2", **SHORT}
        run = self.run_scene("a", change=change)
        fine, mixed, coarse = rows(run / "zones.csv")
        for zone in (fine, mixed, coarse):
            self.assertEqual(int(zone["grains"]), int(zone["fine_grains"]) + int(zone["coarse_grains"]))
        self.assertGreater(int(fine["fine_grains"]), 0.9 * int(fine["grains"]))
        self.assertGreater(int(coarse["coarse_grains"]), 0.9 * int(coarse["grains"]))
        self.assertGreater(float(coarse["grains_if_all_fine"]), 1.4 * int(coarse["grains"]))
        self.assertLess(float(coarse["mean_faces"]), float(fine["mean_faces"]))

    def test_export_and_start_from_it(self):
        run = self.pack("a", "--export", "off,vtu,csv")
        self.assertIn("VTKFile", (run / "packing.vtu").read_text())
        first = self.grains(run)
        # Put in place and written again, without time to move: the same to rounding.
        still = {"Packing/Method": "deposit", "Packing/Settle time": "1e-6", "Packing/Start from": "a/packing.csv"}
        for file in ("a/packing.csv", "a/packing.off"):
            again = self.pack("b", "--overwrite", "--export", "csv", change={**still, "Packing/Start from": file})
            self.assertEqual(len(self.grains(again)), len(first))
            for one, other in zip(first, self.grains(again)):
                for key in ("x_m", "y_m", "z_m"):
                    self.assertAlmostEqual(float(one[key]), float(other[key]), delta=1e-6)
                self.assertAlmostEqual(float(one["sieve_m"]), float(other["sieve_m"]), delta=1e-6)
        # The store tells packings from different files apart.
        self.assertEqual(len(list((self.folder / "packings").glob("*.h5"))), 3)


    def test_shoulders_leave_the_bed_its_depth(self):
        """Sleeper 0.07 m long, crest 0.02 m beyond its ends, sides of 1:1 down to the subgrade."""
        change = {"Container/Length": "0.26", "Container/Shoulder width": "0.02", "Container/Shoulder slope": "1"}
        grains = self.grains(self.pack("a", "--export", "csv", change=change))
        whole = self.grains(self.pack("b", "--export", "csv", change={"Container/Length": "0.26"}))
        self.assertLess(len(grains), len(whole))
        under = [[float(g["z_m"]) for g in bed if abs(float(g["x_m"])) < 0.03] for bed in (grains, whole)]
        top, top_whole = (max(heights) for heights in under)
        self.assertGreater(top, top_whole - 0.012)  # half a grain: nothing is taken from under the sleeper

        def outside(bed):  # beyond the slope, drawn from the crest at the sleeper's base
            base = top + 0.02
            return [g for g in bed if abs(float(g["x_m"])) > 0.055 + max(0, base - float(g["z_m"])) + 0.003]

        self.assertEqual(outside(grains), [])
        self.assertGreater(len(outside(whole)), 3)  # what was there to be trimmed

    def test_packing_in_coordinates_of_a_survey(self):
        """The scene's own origin lies a thousand kilometres off in the files: nothing else changes."""
        origin = (1e6, -2e6, 300)
        survey = {"Packing/Origin": "1e6, -2e6, 300"}
        first = self.grains(self.pack("a", "--export", "csv"))
        there = self.grains(self.pack("b", "--export", "csv", change=survey))
        self.assertEqual(len(list((self.folder / "packings").glob("*.h5"))), 1)  # it is the same packing
        still = {"Packing/Method": "deposit", "Packing/Settle time": "1e-6", "Packing/Start from": "b/packing.csv"}
        back = self.grains(self.pack("c", "--export", "csv", change={**still, **survey}))
        for one, other, again in zip(first, there, back, strict=True):
            for key, offset in zip(("x_m", "y_m", "z_m"), origin):
                self.assertAlmostEqual(float(other[key]) - offset, float(one[key]), delta=5e-10)
                self.assertAlmostEqual(float(again[key]) - offset, float(one[key]), delta=1e-6)
        told = self.pack("d", change=still, exit_code=2).stderr
        self.assertIn("outside the scene's container", told)
        self.assertIn("Packing/Origin", self.pack("e", change={"Packing/Origin": "1, 2"}, exit_code=2).stderr)

    def test_grains_of_several_pieces(self):
        def box(low, high):
            return [[(low, high)[bit][axis] for axis, bit in enumerate(bits)]
                    for bits in ((0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1), (1, 1, 0), (1, 1, 1))]

        # An L of two boxes that share a face, five of them.
        corners = box((0, 0, 0), (0.02, 0.01, 0.01)) + box((0, 0.01, 0), (0.01, 0.02, 0.01))
        faces = [[k + n for n in f] for k in (0, 8)
                 for f in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))]
        lines = ["OFF", "16 12 0", *(" ".join(map(str, c)) for c in corners),
                 *(" ".join(map(str, [4, *f])) for f in faces), ""]
        (self.folder / "ell_shapes").mkdir()
        (self.folder / "ell_shapes" / "0.off").write_text("\n".join(lines))
        header = "shape,x_m,y_m,z_m,qw,qx,qy,qz,sieve_m,kind"
        places = [(0, 0.01 * (k % 2), 0.012 + 0.025 * k, *((1, 0, 0, 0), (0.6, 0.8, 0, 0))[k % 2]) for k in range(5)]
        (self.folder / "ell.csv").write_text("\n".join(
            [header, *("0," + ",".join(map(str, p)) + ",0.02,pieces" for p in places), ""]))
        run = self.pack("a", "--export", "csv", change={"Packing/Method": "deposit", "Packing/Start from": "ell.csv",
                                                        "Packing/Settle time": "0.4", "Contact/Torsional friction": "1"})
        grains = self.grains(run)
        self.assertEqual([g["kind"] for g in grains], 5 * ["pieces"])
        for g in grains:
            self.assertAlmostEqual(float(g["volume_m3"]), 3e-6, delta=1e-15)
            # Come down from up to 0.11 m, and neither sunk in nor held up.
            self.assertTrue(0.004 < float(g["z_m"]) < 0.05, g)

    def test_export_of_round_grains(self):
        change = {"Packing/Method": "deposit", "Grains/Shape": "clump", "Grains/Other share": "0.5"}
        self.assertIn("Grains/Shape = clump", self.pack("a", "--export", "off", change=change, exit_code=2).stderr)
        run = self.pack("a", "--export", "vtu,csv", change=change)
        self.assertGreater(len(list((run / "packing_shapes").glob("*.csv"))), 20)
        # Started from by a scene of polyhedra, and left alone for a while: a bed at rest stays.
        again = self.pack("b", "--export", "csv", change={"Packing/Method": "deposit", "Packing/Settle time": "0.02",
                                                          "Packing/Start from": "a/packing.csv"})
        self.assertEqual({g["kind"] for g in self.grains(again)}, {"spheres"})
        # Grains that no law of contact holds would fall by millimetres.
        ways = sorted(abs(float(one["z_m"]) - float(other["z_m"])) for one, other in zip(self.grains(run), self.grains(again)))
        self.assertLess(ways[len(ways) // 2], 5e-4)


class GrainTests(SceneTest):
    """Tests of grains: blocks with a known answer, and tiny.prm's stones for what holds for any grains."""
    RIGID = {"Sleeper/Model": "rigid", "Subgrade/Model": "rigid", "Packing/Method": "deposit",
             "Output/Snapshot interval": "0"}

    def write_cubes(self, *bottoms):
        """blocks.off: cubes of 0.1 m on each other."""
        corners, faces = [], []
        for z in bottoms:
            n = len(corners)
            corners += [(x, y, z + up) for up in (0, .1) for y in (-.05, .05) for x in (-.05, .05)]
            faces += [[n + k for k in f] for f in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3),
                                                   (0, 4, 6, 2), (1, 3, 7, 5))]
        lines = ["OFF", f"{len(corners)} {len(faces)} 0", *(" ".join(map(repr, c)) for c in corners),
                 *("4 " + " ".join(map(str, f)) for f in faces), ""]
        (self.folder / "blocks.off").write_text("\n".join(lines))

    def cubes(self, output, change):
        """A run of cubes that fill their box; its strength by state and stress, and its curve by stress."""
        run = self.run_scene(output, change={
            **self.RIGID, "Packing/Start from": "blocks.off", "Container/Length": "0.1", "Container/Width": "0.1",
            "Packing/Quiet": "1e-8", "Contact/Packing modulus": "1e8", "Contact/Local damping": "0.2",
            "Test/Samples": "20", **change})
        strength = {(r["state"], r["stress_Pa"]): {k: float(v) if v else None for k, v in r.items()
                                                   if k not in ("test", "state")}
                    for r in rows(run / "strength.csv")}
        curve = [{k: float(v) for k, v in r.items()} for r in rows(run / f"{change['Test/Type']}.csv")]
        (closure,) = (float(r["value"]) for r in rows(run / "summary.csv") if r["quantity"] == "closure")
        self.assertLess(closure, 1e-3)
        return strength, curve

    def test_shear_of_two_blocks(self):
        """Two blocks slide on each other: shear stress is friction times normal stress. The pushed one tilts
        with its contacts' compliance, which is why they are stiff here; with a hundredth of this modulus the
        ratio is 0.3 % too large."""
        self.write_cubes(0, .1)
        strength, curve = self.cubes("shear", {
            "Test/Type": "direct_shear", "Test/Stresses": "25e3, 50e3", "Test/Travel": "0.001",
            "Test/Speed": "0.005", "Container/Ballast depth": "0.2", "Contact/Contact modulus": "1e10",
            "Grains/Friction": "0.5", "Container/Friction": "0.5", "Subgrade/Friction": "0.5"})
        for stress in ("25000", "50000"):
            residual = strength["residual", stress]
            self.assertAlmostEqual(residual["ratio"], 0.5, delta=2e-4)
            self.assertAlmostEqual(residual["friction_angle_deg"], 26.565, delta=0.01)
            end = [r for r in curve if r["stress_Pa"] == float(stress)][-1]
            self.assertAlmostEqual(end["normal_stress_Pa"], float(stress), delta=1e-4 * float(stress))
            self.assertAlmostEqual(end["shear_force_N"], 0.5 * float(stress) * 0.01, delta=2e-4 * float(stress) * 0.01)
        fit = strength["residual fit", ""]
        self.assertAlmostEqual(fit["friction_angle_deg"], 26.565, delta=0.02)
        self.assertLess(abs(fit["cohesion_Pa"]), 5)
        self.assertFalse((self.folder / "shear" / "test_bed.h5").exists())

    def test_triaxial_of_one_cube(self):
        """One cube between six walls: its sides stay at the confining pressure, and its axial stress grows with
        the stiffness of two faces in series, F = c E sqrt(A) d, c = 2/(3 sqrt(pi)), d the way of the top."""
        self.write_cubes(0)
        strength, curve = self.cubes("cube", {
            "Test/Type": "triaxial", "Test/Stresses": "25e3, 50e3", "Test/Largest strain": "0.005",
            "Test/Strain rate": "0.05", "Container/Ballast depth": "0.1", "Contact/Contact modulus": "1e8",
            "Test/Tolerance": "2e-3"})
        stiffness = 2 / (3 * math.sqrt(math.pi)) * 1e8   # of stress over strain: E sqrt(A) H / A = E
        for stress in (25e3, 50e3):
            part = [r for r in curve if r["stress_Pa"] == stress]
            self.assertEqual(len(part), 20)
            for r in part:
                for side in ("sigma3_x_Pa", "sigma3_y_Pa"):
                    self.assertAlmostEqual(r[side], stress, delta=2e-3 * stress)
                # The specimen's area has shrunk by its sides' overlaps, a few 1e-4.
                self.assertAlmostEqual(r["sigma1_Pa"], stress + stiffness * r["axial_strain"],
                                       delta=2e-3 * (stress + stiffness * r["axial_strain"]))
                self.assertAlmostEqual(r["volumetric_strain"], r["axial_strain"], delta=2e-5)
                # The cube's volume in a space that the overlaps of three directions have made smaller.
                self.assertAlmostEqual(r["porosity"], -3 * stress / stiffness - r["axial_strain"], delta=1e-4)
                self.assertAlmostEqual(r["deviator_Pa"], r["sigma1_Pa"] - r["sigma3_Pa"], delta=1e-6 * r["sigma1_Pa"])
                sine = (r["sigma1_Pa"] - r["sigma3_Pa"]) / (r["sigma1_Pa"] + r["sigma3_Pa"])
                self.assertAlmostEqual(r["mobilised_angle_deg"], math.degrees(math.asin(sine)), delta=1e-6)
            self.assertLess(strength["peak", f"{stress:g}"]["held_within"], 2e-3)
            # It does not yield: the highest five rows of twenty are the last.
            self.assertAlmostEqual(strength["peak", f"{stress:g}"]["position"], 0.005 * 17.5 / 20, delta=2e-5)

    # Some dozen soft stones, consolidated and compressed by a little: not a test of strength.
    STONES = {**RIGID, "Packing/Unbalanced force": "0.1", "Contact/Contact modulus": "2e7",
              "Contact/Local damping": "0.3", "Test/Samples": "10", "Test/Type": "triaxial",
              "Test/Stresses": "2e3, 4e3", "Test/Strain rate": "0.5", "Test/Largest strain": "0.01",
              "Test/Tolerance": "0.05"}

    def test_triaxial_of_stones(self):
        """The top hardly moves here: all sides carry the confining stress within the tolerance, the state stays
        isotropic; the ledger closes; threads change nothing."""
        held = {**self.STONES, "Test/Strain rate": "1e-3", "Test/Largest strain": "2e-5", "Test/Stresses": "4e3",
                "Test/Tolerance": "0.02"}
        one = self.run_scene("one", "--threads", "1", change=held)
        curve = [{k: float(v) for k, v in r.items()} for r in rows(one / "triaxial.csv")]
        self.assertEqual(len(curve), 10)
        for column in ("sigma1_Pa", "sigma3_x_Pa", "sigma3_y_Pa"):
            self.assertAlmostEqual(curve[0][column], 4e3, delta=0.05 * 4e3, msg=column)
            self.assertAlmostEqual(curve[-1][column], 4e3, delta=0.1 * 4e3, msg=column)
        (closure,) = (float(r["value"]) for r in rows(one / "summary.csv") if r["quantity"] == "closure")
        self.assertLess(closure, 0.01)
        self.assert_same(one, self.run_scene("two", "--threads", "2", change={**held, "Packing/Reuse": "false"}))

    def test_resume_of_a_grain_test(self):
        change = {**self.STONES, "Packing/Reuse": "false"}
        whole = self.run_scene("whole", change=change)
        more = [word for path, value in change.items() for word in ("--set", f"{path}={value}")]
        self.stop_after("consolidation 2", "parts", False, more)   # in the first compression
        self.stop_after("compression 2", "parts", True, more)      # in the second consolidation
        parts = self.run_scene("parts", "--resume", change=change)
        self.assert_same(whole, parts)

    def test_angle_of_repose(self):
        """The lifted wall lets the stones out: none is lost, the heap is lower, and its profile holds them."""
        run = self.run_scene("heap", change={
            **self.RIGID, "Test/Type": "angle_of_repose", "Test/Speed": "1", "Test/Floor length": "0.2",
            "Contact/Packing damping": "0.6", "Contact/Contact modulus": "2e7"})
        profile = [{k: float(v) for k, v in r.items()} for r in rows(run / "repose.csv")]
        self.assertAlmostEqual(profile[0]["distance_m"] * 2 * len(profile), 0.13 + 0.2, delta=1e-9)
        self.assertGreater(max(r["height_m"] for r in profile if r["distance_m"] > 0.13), 0.01)
        (row,) = rows(run / "strength.csv")
        self.assertEqual((row["test"], row["state"]), ("angle_of_repose", "repose"))
        energy = [{k: float(v) for k, v in r.items()} for r in rows(run / "energy.csv")]
        fallen = max(r["gravity_J"] for r in energy) - energy[-1]["gravity_J"]
        self.assertGreater(fallen, 0.01)
        self.assertLess(max(abs(r["closure_J"]) for r in energy), 0.01 * fallen)

    def test_check_of_a_grain_test(self):
        more = [f"--set={path}={value}" for path, value in self.STONES.items()]
        text = self.trackbed("check", "tiny.prm", *more).stdout
        for word in ("Test        triaxial, confining stress 2 4 kPa", "inertial number", "not quasi-static",
                     "consolidation 2 kPa", "compression 4 kPa"):
            self.assertIn(word, text)
        self.assertNotIn("Sleeper ", text)


class SameAnswer(SceneTest):
    def test_threads(self):
        # A hundred grains: enough for a second thread.
        change = {**SHORT, "Container/Ballast depth": "0.135", "Packing/Settle time": "0.2", "Packing/Reuse": "false"}
        runs = [self.run_scene(f"threads_{n}", "--threads", n, change=change) for n in (1, 2, 8)]
        self.assertGreaterEqual(float(self.summary(runs[0])["grains"]), 100)
        self.assert_same(runs[0], runs[1])
        self.assert_same(runs[0], runs[2])

    def test_kept_packing(self):
        fresh = self.run_scene("fresh")
        taken = self.run_scene("taken")
        self.assert_same(fresh, taken, ["cycles.csv", "energy.csv", "compaction.csv", "gradation.csv",
                                        "pressure.csv", "moment.csv"])
        loading = [row for row in rows(fresh / "history.csv") if row["stage"] in ("seating", "loading")]
        self.assertEqual(loading, rows(taken / "history.csv"))

    def test_packed_by_the_pack_command(self):
        self.trackbed("pack", "tiny.prm", "--output", "packed", "--set", "Packing/Folder=packings")
        self.assertFalse(rows(self.folder / "packed" / "cycles.csv"))
        run = self.run_scene("taken")
        self.assertEqual(rows(run / "history.csv")[0]["stage"], "seating")
        self.assert_same(run, self.run_scene("fresh", change={"Packing/Reuse": "false"}),
                         ["cycles.csv", "energy.csv", "compaction.csv"])

    def test_resume(self):
        change = {"Packing/Reuse": "false"}
        whole = self.run_scene("whole", change=change)
        self.stop_after("deposit", "parts", False)
        self.stop_after("sleeper in", "parts", True)
        self.stop_after("seating", "parts", True)
        self.assertLess(len(rows(self.folder / "parts" / "history.csv")), len(rows(whole / "history.csv")))
        parts = self.run_scene("parts", "--resume", change=change)
        self.assert_same(whole, parts)
        self.assertEqual((whole / "snapshots.xdmf").read_bytes(), (parts / "snapshots.xdmf").read_bytes())

    def test_resume_of_two_shapes(self):
        change = {"Packing/Reuse": "false", "Grains/Other shape": "clump", "Grains/Other share": "0.5"}
        whole = self.run_scene("whole", change=change)
        more = [word for path, value in change.items() for word in ("--set", f"{path}={value}")]
        self.stop_after("deposit", "parts", False, more)
        self.stop_after("seating", "parts", True, more)
        parts = self.run_scene("parts", "--resume", change=change)
        self.assert_same(whole, parts)


class Commands(SceneTest):
    def test_check_writes_nothing(self):
        before = self.contents(self.folder)
        text = self.trackbed("check", "tiny.prm").stdout
        self.assertEqual(self.contents(self.folder), before)
        for word in ("Grains", "elastic sleeper", "Off", "time step", "steps", "memory", "nothing was run"):
            self.assertIn(word, text)

    def test_parameters_name_every_subgrade_file(self):
        text = self.trackbed("parameters", "--format", "markdown").stdout
        files = [f.stem for f in (HERE.parents[1] / "fem" / "subgrades").glob("*.cc") if f.stem != "registry"]
        self.assertGreaterEqual(len(files), 5)
        for name in files:
            self.assertRegex(text, rf"Subgrade/{name}\b|\b{name}\b", name)
            self.assertIn(f"Subgrade/{name}", text)

    def test_compare(self):
        options = [f"--set={path}={value}" for path, value in SHORT.items()]
        self.trackbed("compare", "tiny.prm", "--output", "c", "--set=Packing/Folder=packings", *options)
        table = rows(self.folder / "c" / "compare.csv")
        self.assertTrue(any("settlement" in " ".join(map(str, row.values())) for row in table))
        self.assertIn("verdict", table[0])
        self.assertTrue(all(row["verdict"] for row in table))
        self.assertGreater((self.folder / "c" / "compare.html").stat().st_size, 1000)
        for name in ("rigid", "elastic", "rigid_repeat", "elastic_repeat"):
            self.assert_sound(self.folder / "c" / name)
        self.assertEqual(len(list((self.folder / "packings").glob("*.h5"))), 1, "one packing for all")

    def cost(self, *options, **more):
        sets = [f"--set={path}={value}" for path, value in {**SHORT, "Packing/Settle time": "0.2"}.items()]
        return self.trackbed("cost", "tiny.prm", "--output", "c", "--seeds", "2", "--knobs", "sleeper_elements",
                             *sets, *options, **more)

    def test_cost(self):
        dry = self.cost("--dry-run")
        self.assertIn("2 packings and 8 runs", dry.stdout)
        self.assertFalse((self.folder / "c").exists())
        self.cost("--tolerance", "settlement=1000%")
        runs = rows(self.folder / "c" / "runs.csv")
        self.assertEqual({row["status"] for row in runs}, {"done"})
        self.assertEqual(len([row for row in runs if row["knob"] == "sleeper_elements"]), 6)
        self.assertTrue(all(float(row["run_processor_s"]) > 0 for row in runs))
        table = {(row["value"], row["quantity"]): row for row in rows(self.folder / "c" / "cost.csv")}
        self.assertEqual(table["4, 4, 2", "settlement"]["verdict"], "reference")
        self.assertEqual(table["2, 2, 1", "settlement"]["own"], "1")
        self.assertEqual(float(table["2, 2, 1", "settlement"]["time_over_own"]), 1)
        self.assertGreater((self.folder / "c" / "cost.html").stat().st_size, 1000)
        # The scene's own rung is the scene's own run.
        own = next(row["folder"] for row in runs if row["knob"] == "own")
        self.assertIn(own, [row["folder"] for row in runs if row["knob"] == "sleeper_elements"])
        if (self.folder / "c" / "recommended.prm").exists():
            self.trackbed("check", "c/recommended.prm")
        # Finished runs are recognised; a lost one is made again.
        stamp = {p: p.stat().st_mtime_ns for p in (self.folder / "c" / "runs").rglob("cycles.csv")}
        lost = self.folder / "c" / own / "job.csv"
        lost.unlink()
        self.cost("--resume")
        again = [p for p, time in stamp.items() if p.stat().st_mtime_ns != time]
        self.assertEqual(again, [lost.parent / "cycles.csv"])
        self.assertEqual(len(rows(self.folder / "c" / "cost.csv")), len(table))

    def test_report(self):
        self.run_scene("a", change=SHORT)
        self.trackbed("report", "a")
        self.assertIn("<html", (self.folder / "a" / "report.html").read_text().lower())
        # Nothing of it is left when another run takes its place, and nothing else is taken away.
        (self.folder / "a" / "mine.png").write_text("")
        (self.folder / "a" / "structure_of_mine.vtu").write_text("")
        names = lambda run: {p.name for p in (self.folder / run).iterdir()}
        self.trackbed("pack", "tiny.prm", "--output", "a", "--overwrite")
        self.trackbed("pack", "tiny.prm", "--output", "b")
        self.assertEqual(names("a") - names("b"), {"mine.png", "structure_of_mine.vtu"})

    def test_settings_change_the_run(self):
        one = self.run_scene("one", change=SHORT)
        two = self.run_scene("two", change={**SHORT, "Loading/Largest": "150"})
        peak = max(float(row["load_max_N"]) for row in rows(two / "cycles.csv"))
        self.assertAlmostEqual(peak, 150, delta=1e-6)
        self.assertNotEqual((one / "cycles.csv").read_bytes(), (two / "cycles.csv").read_bytes())


class Refusals(SceneTest):
    def refused(self, *arguments):
        """Exit 2, one line, and nothing of what is there changes."""
        before = self.contents(self.folder)
        done = self.trackbed(*arguments, exit_code=2)
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        self.assertEqual(len(lines), 1, done.stderr)
        after = self.contents(self.folder)
        for name, content in before.items():
            self.assertEqual(after.get(name), content, f"{name} was changed")
        return lines[0]

    def test_truncated_checkpoint(self):
        run = self.run_scene("a", change=SHORT)
        whole = (run / "checkpoint.h5").read_bytes()
        sets = [f"--set={path}={value}" for path, value in {"Packing/Folder": "packings", **SHORT}.items()]
        for content in (whole[: len(whole) // 2], whole[:100], b""):
            (run / "checkpoint.h5").write_bytes(content)
            self.assertIn("a/checkpoint.h5", self.refused("run", "tiny.prm", "--output", "a", "--resume", *sets))

    def test_truncated_packing(self):
        self.run_scene("a", change=SHORT)
        (kept,) = (self.folder / "packings").glob("*.h5")
        kept.write_bytes(kept.read_bytes()[: kept.stat().st_size // 2])
        line = self.refused("run", "tiny.prm", "--output", "b", "--set=Packing/Folder=packings")
        self.assertIn(f"packings/{kept.name}", line)

    def test_changed_scene(self):
        self.run_scene("a", change=SHORT)
        line = self.refused("run", "tiny.prm", "--output", "a", "--resume", "--set=Grains/Density=2700")
        self.assertIn("the scene has changed", line)

    def test_time_step_over_the_limit(self):
        for command in (("run", "tiny.prm", "--output", "a"), ("check", "tiny.prm")):
            line = self.refused(*command, "--set=Numerics/Time step=1e-3")
            self.assertRegex(line, r"stability limit .* would do")


class GoesWrong(SceneTest):
    def stopped(self, output, *options, change):
        """Exit 1 and one line: step, stage, time, cause and remedy."""
        done = self.run_scene_that_fails(output, *options, change=change)
        (line,) = [line for line in done.stderr.splitlines() if line.startswith("trackbed: ")]
        self.assertRegex(line, r"step \d+ \(\w+, [0-9.e+-]+ s\): .*Likely cause: .*Remedy: ")
        for file in (self.folder / output).glob("*.csv"):
            self.assertNotIn("nan", file.read_text().lower(), file)
        return line

    def run_scene_that_fails(self, output, *options, change):
        sets = [f"--set={path}={value}" for path, value in {"Packing/Folder": "packings", **change}.items()]
        return self.trackbed("run", "tiny.prm", "--output", output, *options, *sets, exit_code=1)

    def test_a_grain_that_flies_off(self):
        change = {"Numerics/Largest speed": "0.3"}
        line = self.stopped("a", change=change)
        self.assertRegex(line, r"grain (\d+) flies off at .* with 0\.3\d* m/s \(at most 0\.3 m/s.*strongest contact is")
        # The state before it goes on to the same end, bitwise.
        self.assertIn("a/checkpoint.h5", line)
        history = (self.folder / "a" / "history.csv").read_bytes()
        self.assertEqual(self.stopped("a", "--resume", change=change), line)
        self.assertEqual((self.folder / "a" / "history.csv").read_bytes(), history)
        # The pair alone runs into the same, with the same law and step.
        self.assertIn("trackbed run a/offender.prm", line)
        self.assertIn("valid", self.trackbed("check", "a/offender.prm").stdout)
        again = self.trackbed("run", "a/offender.prm", "--output", "b", exit_code=1).stderr
        self.assertRegex(again, r"replay, .* grain 0 flies off at .* with 0\.3")
        # Without the limit it ends, and the two have parted with no more energy than they had.
        self.trackbed("run", "a/offender.prm", "--output", "c", "--set=Numerics/Largest speed=0")
        energy = rows(self.folder / "c" / "energy.csv")
        self.assertLess(abs(float(energy[-1]["closure_J"])), 1e-2 * float(energy[0]["kinetic_J"]))

    def test_contacts_too_soft(self):
        line = self.stopped("a", change={"Contact/Packing modulus": "1e5"})
        self.assertRegex(line, r"grain \d+ and .* overlap by .* % of the smaller one's size \(allowed 20 %\)")
        self.trackbed("run", "a/offender.prm", "--output", "b")
        self.assertGreater(float(rows(self.folder / "b" / "history.csv")[-1]["contacts"]), 0)

    def test_a_grain_too_deep_in_a_structure(self):
        line = self.stopped("a", change={"Sleeper/Model": "elastic", "Loading/Largest": "5e6"})
        self.assertRegex(line, r"grain \d+ and the (sleeper|subgrade) overlap by .* % of the grain's size \(allowed 20 %\)")
        self.assertRegex(line, r"Grain \d+ and a held block in place of the (sleeper|subgrade) alone, .*trackbed run a/offender.prm")
        # The block goes on as the surface did: it works on the grain, no energy is made.
        self.trackbed("run", "a/offender.prm", "--output", "b")
        end = rows(self.folder / "b" / "energy.csv")[-1]
        self.assertGreater(float(end["work_J"]), 0)
        self.assertLess(abs(float(end["closure_J"])), 1e-2 * float(end["work_J"]))

    def test_a_grain_inside_another(self):
        def box(edge):
            corners = [f"{x} {y} {z}" for x in (0, edge) for y in (0, edge) for z in (0, edge)]
            faces = ["0 1 3 2", "4 6 7 5", "0 4 5 1", "2 3 7 6", "0 2 6 4", "1 5 7 3"]
            return "\n".join(["OFF", "8 6 0", *corners, *("4 " + f for f in faces), ""])

        (self.folder / "in_shapes").mkdir()
        for k, edge in enumerate((0.03, 0.008)):
            (self.folder / "in_shapes" / f"{k}.off").write_text(box(edge))
        (self.folder / "in.csv").write_text("shape,x_m,y_m,z_m,qw,qx,qy,qz,sieve_m\n"
                                            "0,0,0,0.02,1,0,0,0,0.03\n1,0.01,0.012,0.031,1,0,0,0,0.008\n")
        done = self.run_scene_that_fails("a", change={"Packing/Start from": "in.csv"})
        self.assertRegex(done.stderr, r"step 0 .*grain 0 and grain 1 overlap .*100 % of its volume lies inside")
        # So it does alone.
        self.assertIn("step 0", self.trackbed("run", "a/offender.prm", "--output", "b", exit_code=1).stderr)

    def test_a_pair_that_a_fuzzer_keeps(self):
        # As an offender would be: it runs, the two touch, and no energy is made.
        for name, pair in (("fuzz_pairs", 8), ("fuzz_dilated", 0), ("fuzz_surface", 4)):
            subprocess.run([pathlib.Path(FUZZERS) / name, "--pairs", str(pair + 1), "--keep", str(pair), "--output", name],
                           cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
            scene = f"{name}/seed_1_pair_{pair}.prm"
            self.assertIn("valid", self.trackbed("check", scene).stdout)
            self.trackbed("run", scene, "--output", name + "_run")
            energy = rows(self.folder / (name + "_run") / "energy.csv")
            most = max(float(row["kinetic_J"]) for row in energy)
            self.assertGreater(most, 0)
            self.assertLess(abs(float(energy[-1]["closure_J"])), 1e-2 * most)


if __name__ == "__main__":
    unittest.main()
