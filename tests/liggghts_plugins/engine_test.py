"""The fused engine moves grains as LIGGGHTS's own loop does with the same script.

Reference: the same executable with `gasgrain_engine off`, whose contact law and walls are tested
against stock liggghts elsewhere. Differences are round-off and grow with time (collisions of many
grains are chaotic); a wrong force, a lost contact history or a stale ghost shows as 1e-3 or more.
"""

import pathlib
import random
import re
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import bed_of_grains as bed  # noqa: E402
from engine_scenes import (FORCES, RADIUS, SCALE, SIDE, SPEED, UNWRAPPED, WALLS,  # noqa: E402
                           EngineTest, crowd, files, plate, reference_log, scene, thermo_of)
from gas_case import gas_case, inlet  # noqa: E402
from liggghts_run import (ENVIRONMENT, GASGRAIN, MPIEXEC, Bench, Grain,  # noqa: E402
                          cgm_properties, data_file, dump_command, largest_difference, thermo)


class SameMotion(EngineTest):
    def check(self, scene_text, scene_files, ranks=1, rest=None,
              limits=((300, 1e-10), (1000, 1e-8))):
        rest = rest or dump_command("d", 100) + "run 1000\n"
        reference, fused, _ = self.off_and_fused(scene_text, rest, scene_files, ranks)
        return self.assert_same_motion(reference, fused, limits)

    def test_two_grains(self):
        grains = [Grain((SIDE, SIDE / 2, SIDE), RADIUS, (0.3, 0.1, 0), (50, -30, 20)),
                  Grain((SIDE + 2.1 * RADIUS, SIDE / 2 + 0.4 * RADIUS, SIDE), RADIUS,
                        (-0.3, 0, 0), (0, 80, -60))]
        frames = self.check(scene(), files(grains), limits=((1000, 1e-12),))
        self.assertGreater(frames[-1][2][3], 0.05)  # they have collided

    def test_agitated_crowd_between_sdf_walls(self):
        self.check(scene(), files(crowd()))

    def test_without_friction(self):
        self.check(scene(tangential="off"), files(crowd()))

    def test_without_history(self):
        self.check(scene(tangential="no_history"), files(crowd()))

    def test_two_types_of_different_ratio_and_size(self):
        properties = cgm_properties(3, k=50.0, e=0.8, mu=0.4)
        for name, values in (("cgmSpringConstant", "50 40 45 40 30 35 45 35 60"),
                             ("coefficientRestitution", ".8 .7 .9 .7 .6 .8 .9 .8 .5"),
                             ("cgmTangentialStiffnessRatio", ".8 1 1 1 .7 1 1 1 .9")):
            properties = re.sub(rf"fix {name} .*\n", "", properties)
            properties += f"fix {name} all property/global {name} peratomtypepair 3 {values}\n"
        walls = WALLS.replace("type 2", "type 3")
        for exponent in (3, 2):
            with self.subTest(exponent=exponent):
                text = scene(properties=properties, walls=walls, l=2.0).replace(
                    "tangential history", f"tangential history stiffness_exponent {exponent}")
                text = text.replace("coarsegraining 2 ", "coarsegraining 2 1.5 1 ")
                self.check(text, files(crowd(types=2, radii=(RADIUS, 0.8 * RADIUS)), types=3))

    def test_many_sizes(self):
        radii = tuple(RADIUS * (0.7 + 0.3 * n / 9) for n in range(10))
        self.check(scene(), files(crowd(radii=radii)))

    def test_periodic_box(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                # grains are wrapped at reneighbourings, which the engine chooses itself
                self.check(scene(boundary="p p p", walls=""), files(crowd()), ranks,
                           dump_command("d", 100, UNWRAPPED) + "run 1000\n")

    def test_shrink_wrapped_box_grows_with_the_grains(self):
        for boundary in ("s s s", "m m m", "s p m"):
            for ranks in (1, 2):
                with self.subTest(boundary=boundary, ranks=ranks):
                    frames = self.check(scene(boundary=boundary, walls=""), files(crowd()), ranks,
                                        dump_command("d", 100, UNWRAPPED) + "run 1000\n")
                    self.assertEqual(len(frames[-1]), len(frames[0]))
                    beyond = [g for g in frames[-1].values() if not 0 < g[0] < 2 * SIDE]
                    self.assertGreater(len(beyond), 0)

    PRIMITIVES = "".join(
        f"fix {name} all wall/gran model {{model}} primitive type 2 {kind} {place:.17g}{more}\n"
        for name, kind, place, more in (
            ("west", "xplane", 0, ""), ("east", "xplane", 2 * SIDE, ""),
            ("south", "yplane", 0, ""), ("north", "yplane", SIDE, ""),
            ("floor", "zplane", 0, " shear x 0.2"), ("lid", "zplane", 2 * SIDE, "")))

    def test_stock_primitive_walls(self):
        """Walls of LIGGGHTS, moving in their plane and with a model of their own, too."""
        stock = ("fix kn all property/global kn peratomtypepair 2 50 50 50 50\n"
                 "fix kt all property/global kt peratomtypepair 2 40 40 40 40\n"
                 "fix gn all property/global gamman_abs peratomtypepair 2 1e-4 1e-4 1e-4 1e-4\n"
                 "fix gt all property/global gammat_abs peratomtypepair 2 1e-4 1e-4 1e-4 1e-4\n")
        for model, more, ranks in (
                ("cgm tangential history", "", 1), ("cgm tangential history", "", 2),
                ("hooke/stiffness tangential history absolute_damping on", stock, 1)):
            with self.subTest(model=model, ranks=ranks):
                names = model.split(" absolute")[0]
                walls = more + self.PRIMITIVES.format(model=names)
                if more:
                    walls = "".join(line + (" absolute_damping on" if "wall/gran" in line else "") +
                                    "\n" for line in walls.splitlines())
                rest = dump_command("d", 100) + "run 500\nrun 500\n"
                _, fused, run = self.off_and_fused(scene(walls=walls), rest, files(crowd()), ranks)
                self.assertIn("wall/gran primitive x 6", run.text)
                self.check(scene(walls=walls), files(crowd()), ranks, rest)
                low = min(grain[2] for grain in fused.frames("d.dump")[-1].values())
                self.assertGreater(low, 0.5 * RADIUS)  # the floor has held them

    def test_ranks(self):
        for ranks in (2, 4):
            with self.subTest(ranks=ranks):
                walls = "".join(line + "\n" for line in WALLS.splitlines()
                                if "south" not in line and "north" not in line)
                self.check(scene(boundary="f p f", walls=walls), files(crowd()), ranks,
                           dump_command("d", 100, UNWRAPPED) + "run 1000\n")

    def test_code_for_other_processors(self):
        """All kernels this processor can run give the same result within round-off."""
        for kernel in ("generic", "avx2", "avx512"):
            bench = Bench(files(crowd()))
            run = bench.run(f"gasgrain_engine fused kernel {kernel}\n" + scene() +
                            dump_command("d", 100) + "run 1000\n", check=False)
            if "no kernel" in run.text and kernel != "generic":
                continue
            with self.subTest(kernel):
                self.assertEqual(run.code, 0, run.text[-2000:])
                reference = Bench(files(crowd()))
                reference.run("gasgrain_engine off\n" + scene() + dump_command("d", 100) +
                              "run 1000\n")
                self.assert_same_motion(reference, bench)

    def test_wall_loads(self):
        """Force, torque, contacts and overlap of walls, in every line of output."""
        bodies = ("floor", "sides", "tube")
        reference, fused, _ = self.off_and_fused(
            bed.start(), bed.LOADS.replace("thermo 500", "thermo 10") + "run 1000\n", bed.FILES)
        rows = [row for row in thermo(reference_log(reference)) if len(row) == 18]
        others = [row for row in thermo(reference_log(fused)) if len(row) == 18]
        self.assertEqual(len(rows), 101)
        self.assertGreater(max(row[9] for row in rows), 5)
        self.assertEqual(len(bodies), 3)
        for column in range(18):
            unit = max(abs(row[column]) for row in rows) or 1.0
            for row, other in zip(rows, others, strict=True):
                self.assertLess(abs(row[column] - other[column]) / unit, 1e-7, (column, row[0]))


class ManyGrains(EngineTest):
    def test_energies_of_50_000_grains(self):
        """Kinetic and rotational energy to 8 digits after 400 steps."""
        numbers = random.Random(5)
        pitch, counts = 2.01 * RADIUS, (50, 20, 50)
        grains = [Grain(tuple((n + 0.5) * pitch for n in (i, j, k)), RADIUS,
                        tuple(numbers.gauss(0, SPEED) for _ in range(3)),
                        tuple(numbers.gauss(0, SPEED / RADIUS) for _ in range(3)))
                  for k in range(counts[2]) for j in range(counts[1]) for i in range(counts[0])]
        data = data_file(grains, [0, 0, 0], [n * pitch for n in counts], types=2)
        rest = ("compute er all erotate/sphere\n" + thermo_of("c_er") + "run 400\n")
        text = scene(boundary="p p p", walls="")
        reference, fused, _ = self.off_and_fused(text, rest, {"grains.data": data})
        rows = [thermo(reference_log(bench))[-1] for bench in (reference, fused)]
        self.assertEqual(rows[0][0], 400)
        self.assertEqual(rows[0][1], 50000)
        for value, expected in zip(rows[1][2:], rows[0][2:], strict=True):
            self.assertLess(abs(value - expected), 1e-8 * expected)
            self.assertGreater(expected, 0)


class HandingOver(EngineTest):
    def test_two_runs_and_back_to_the_stock_loop(self):
        """Contact histories are whole wherever the engine hands back, with `pre no` too."""
        reference, fused = Bench(files(crowd())), Bench(files(crowd()))
        dump = dump_command("d", 100, FORCES)
        runs = "run 300\nrun 200 pre no\n{}run 200\n{}run 200\nrun 100 pre no\n"
        reference.run("gasgrain_engine off\n" + scene() + dump + runs.format("", ""))
        fused.run("gasgrain_engine fused\n" + scene() + dump +
                  runs.format("gasgrain_engine off\n", "gasgrain_engine fused\n"))
        frames, others = reference.frames("d.dump"), fused.frames("d.dump")
        self.assertGreaterEqual(len(frames), 11)
        force = max(abs(value) for frame in frames for grain in frame.values()
                    for value in grain[9:12])
        scale = SCALE + [force] * 3 + [force * RADIUS] * 3
        self.assertEqual(len(frames), len(others))
        self.assertLess(largest_difference(others, frames, scale), 1e-8)

    def test_steps_with_pressure(self):
        """Pressure needs the stock pair style in its steps; before and after them we are fused."""
        rest = ("compute p all pressure thermo_temp virial\n" + thermo_of("c_p") +
                dump_command("d", 50) + "run 500\n")
        reference, fused, _ = self.off_and_fused(scene(), rest, files(crowd()))
        self.assert_same_motion(reference, fused, ((300, 1e-10), (500, 1e-9)), every=50)
        rows = [row for row in thermo(reference_log(reference)) if len(row) == 4]
        others = [row for row in thermo(reference_log(fused)) if len(row) == 4]
        self.assertEqual(len(rows), 6)
        self.assertGreater(abs(rows[-1][3]), 0)
        for row, other in zip(rows, others, strict=True):
            self.assertLess(abs(row[3] - other[3]), 1e-7 * abs(rows[-1][3]))

    def test_averages_of_fixes(self):
        """fix ave/time samples the ends of steps, more often than output does."""
        rest = ("compute er all erotate/sphere\ncompute k all ke\n"
                "fix a all ave/time 10 5 50 c_er c_k f_floor[3] file a.txt\n"
                "run 500\n")
        reference, fused, _ = self.off_and_fused(scene(), rest, files(crowd()))
        values = [[[float(word) for word in line.split()]
                   for line in (bench.directory / "a.txt").read_text().splitlines()
                   if not line.startswith("#")] for bench in (reference, fused)]
        self.assertEqual(len(values[0]), 10)
        for row, other in zip(*values, strict=True):
            for a, b in zip(row, other, strict=True):
                self.assertLess(abs(a - b), 2e-5 * abs(a) + 1e-12)

    def test_restart(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                whole = Bench(files(crowd()))
                start = "gasgrain_engine fused\n" + scene()
                dump = dump_command("d", 100)
                whole.run(start + dump + "run 400\nwrite_restart r.restart\nrun 300\n", ranks=ranks)
                expected = whole.frames("d.dump")[-1]
                again = start.replace("read_data grains.data", "read_restart r.restart")
                whole.run(again + dump + "run 300\n", ranks=ranks)
                self.assertLess(
                    largest_difference([whole.frames("d.dump")[-1]], [expected], SCALE), 1e-9)

    def test_periodic_restart_files_do_not_disturb(self):
        reference, fused, _ = self.off_and_fused(
            scene(), "restart 150 r.*.restart\n" + dump_command("d", 100) + "run 600\n",
            files(crowd()))
        self.assert_same_motion(reference, fused, ((300, 1e-10), (600, 1e-9)))
        self.assertTrue((fused.directory / "r.450.restart").exists())


GAS = (gas_case((2 * SIDE, SIDE, 2 * SIDE), (6, 3, 6), gravity=(0, 0, -9.81), below=inlet(0.5))
       + "[numerics]\npressure_tolerance = 1e-12\n[coupling]\nexchange_interval = 5e-5\n")


class Gas(EngineTest):
    def test_gas_force_and_momentum_balance(self):
        """The held force acts as in the stock loop, and the audit closes: loads of walls and the
        impulse of the gas are those that the grains got."""
        gas = "fix gas all couple/gas case gas.toml out out\n"
        rest = gas + dump_command("d", 50) + "run 500\nrun 100\n"
        scene_files = {**files(crowd()), "gas.toml": GAS}
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                reference, fused, run = self.off_and_fused(scene(), rest, scene_files, ranks)
                self.assertIn("couple/gas", run.text)
                self.assert_same_motion(reference, fused, ((300, 1e-9), (600, 1e-8)), every=50)
                residual = re.search(r"vertical momentum +largest residual (\S+)", run.text)
                self.assertLess(float(residual[1]), 1e-10)
        without = Bench(scene_files)
        without.run("gasgrain_engine fused\n" + scene() + rest.replace(gas, ""))
        self.assertGreater(largest_difference(without.frames("d.dump"), fused.frames("d.dump"),
                                              SCALE), 1e-3)


class Signal(EngineTest):
    def test_interrupt_ends_the_run_after_a_whole_step(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                bench = Bench(files(crowd()))
                (bench.directory / "in.script").write_text(
                    "gasgrain_engine fused\n" + scene() + thermo_of("") +
                    "run 100\nprint READY\nrun 100000000\nprint ENDED\n")
                command = [GASGRAIN, "-in", "in.script", "-log", "log.txt"]
                if ranks > 1:
                    command = [MPIEXEC, "--oversubscribe", "-n", str(ranks), *command]
                process = subprocess.Popen(command, cwd=bench.directory, env=ENVIRONMENT,
                                           stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                           stderr=subprocess.STDOUT, text=True)
                for line in process.stdout:
                    if line.startswith("READY"):
                        break
                time.sleep(1)
                process.send_signal(signal.SIGINT if ranks == 1 else signal.SIGTERM)
                text = process.communicate(timeout=60)[0]
                self.assertRegex(text, r"Loop time of \S+ on")


PLATE = plate(1e-4, (1e-3, 1e-3), (2 * SIDE - 1e-3, SIDE - 1e-3))


class Plan(EngineTest):
    def run_mode(self, mode, commands, check=True):
        bench = Bench({**files(crowd()), "plate.stl": PLATE})
        return bench, bench.run(f"gasgrain_engine {mode}\n" + scene() + commands +
                                dump_command("d", 100) + "run 200\n", check=check)

    OBSTACLES = {
        "fix freeze": "group some id 1:100\nfix frozen some freeze\n",
        "fix drag viscous": "fix drag all viscous 1e-6\n",
        "fix every ave/time": "fix every all ave/time 1 1 100 f_floor[3] file t.txt\n",
        "fix mesh wall/gran": "fix plate all mesh/surface file plate.stl type 2\n"
                              "fix mesh all wall/gran model cgm tangential history "
                              "store_force yes mesh n_meshes 1 meshes plate\n",
        "compute pair/gran/local": "compute c all pair/gran/local id force\n"
                                   "dump l all local 100 l.dump c_c[1]\n",
    }

    def test_what_is_not_understood_runs_in_the_stock_loop_and_is_named(self):
        for name, commands in self.OBSTACLES.items():
            with self.subTest(name):
                reference, _ = self.run_mode("off", commands)
                bench, run = self.run_mode("auto", commands)
                self.assertRegex(run.text, "Engine: stock time integration.*" + name)
                self.assertEqual(bench.frames("d.dump"), reference.frames("d.dump"))

    def test_fused_refuses_what_it_does_not_understand(self):
        for name, commands in self.OBSTACLES.items():
            with self.subTest(name):
                _, run = self.run_mode("fused", commands, check=False)
                self.assertNotEqual(run.code, 0)
                self.assertRegex(run.text, "gasgrain_engine fused: .*" + name)

    def test_unknown_mode(self):
        _, run = self.run_mode("on", "", check=False)
        self.assertNotEqual(run.code, 0)
        self.assertIn("auto, fused, off", run.text)

    def test_run_style_keeps_the_engine(self):
        _, run = self.run_mode("auto", "run_style verlet\n")
        self.assertIn("Engine: fused", run.text)


class SameBits(EngineTest):
    def test_repeated_runs_are_identical(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                dumps = []
                for _ in range(2):
                    bench = Bench(files(crowd()))
                    bench.run("gasgrain_engine fused\n" + scene() + dump_command("d", 100, FORCES) +
                              "run 500\n", ranks=ranks)
                    dumps.append((bench.directory / "d.dump").read_text())
                self.assertEqual(*dumps)


if __name__ == "__main__":
    unittest.main()
