"""gasgrain estimate: numbers of a script whose answers are known, no files written, bad input."""

import csv
import pathlib
import re
import statistics
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench" / "coarse_graining"))

import errors  # noqa: E402
from cases import RATIOS, SCENES, TRUTH  # noqa: E402
from gas_case import gas_case, inlet  # noqa: E402
from liggghts_run import (Bench, ENVIRONMENT, GASGRAIN, Grain, cgm_properties,  # noqa: E402
                          data_file, preamble)

R0, L, STEP = 50e-6, 5.0, 1e-6
# k = 50 N/m, e = 0.9: contact time of two originals (docs/coarse_graining.md), s
CONTACT_TIME = 1.137e-5


def bench():
    grains = [Grain((1.2 * i * 2 * L * R0, 1.2 * j * 2 * L * R0, 0), L * R0)
              for i in range(10) for j in range(10)]
    return Bench({"grains.data": data_file(grains, [-1e-3] * 3, [8e-3] * 3)})


def script(steps, n=3, step=STEP):
    return (preamble("grains.data", skin=1e-4, l=L) + cgm_properties() +
            f"pair_style gran model cgm tangential history stiffness_exponent {n}\n"
            f"pair_coeff * *\ntimestep {step}\nfix integrate all nve/sphere\n"
            "dump d all custom 1 d.dump id x\nvariable e equal ke\n"
            'fix energy all print 1 "${e}" file energy.txt\n'
            "gasgrain_checkpoint 1 checkpoints\n"
            f"run {steps}\nwrite_restart end.restart\n")


def estimate(scene, text, *options):
    (scene.directory / "in.script").write_text(text)
    return subprocess.run([GASGRAIN, "estimate", "in.script", *options], cwd=scene.directory,
                          text=True, env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120)


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


RESULTS = pathlib.Path(__file__).parents[1] / "bench" / "coarse_graining" / "results"
GAS = gas_case((8e-3, 8e-3, 8e-3), (4, 4, 4), lower=(-1e-3, -1e-3, -1e-3), below=inlet(0.01))


def measured_change(scene, quantity, ratio):
    """Of the benchmark's rows at l = `ratio` against l = 1."""
    lines = (RESULTS / f"{scene}.csv").read_text().splitlines()
    rows = [row for row in csv.DictReader(lines) if row["status"] == "ok"
            and not row["factor"]]
    means = [statistics.mean(float(row[quantity]) for row in rows if row["l"] == str(l))
             for l in (ratio, 1)]
    return means[0] / means[1] - 1


def stored_errors(scene, n):
    """Per cent at l = 2, 3, 4 of the benchmark's rows, and the scatter of the originals."""
    groups = errors.group_rows(errors.read_rows(RESULTS, scene.name))
    truth = groups[errors.Group(TRUTH, 1.0, "", "")]
    found = [errors.total_error(errors.deviations(
        groups[errors.Group(f"cgm-n{n}", float(l), "", "")], truth, scene))[0]
        for l in sorted(RATIOS)]
    return [100 * error for error in (*found, errors.scatter(truth, scene))]


class Estimate(unittest.TestCase):
    def test_errors_of_the_scenes_are_those_of_the_benchmark(self):
        for n in (1, 3):
            printed = estimate(bench(), script(10**5, n)).stdout
            self.assertIn(f"Measured errors of n = {n} ", printed)
            for scene in SCENES.values():
                line, = (line for line in printed.splitlines() if scene.title in line)
                self.assertTrue(line.startswith(f"  {scene.title} ({scene.size})"), line)
                for shown, stored in zip(line.split()[-4:], stored_errors(scene, n)):
                    self.assertAlmostEqual(float(shown), stored, delta=0.56)

    def test_grain_sizes_at_a_gap_change_what_the_benchmark_measured(self):
        for scene, quantity, across, column in (("hopper", "rate", 16, 2),
                                                ("column", "runout", 20, 3)):
            done = estimate(bench(), script(10**5), "--gap", str(across * 2 * R0))
            rows = {int(r[0]): r for r in (line.split() for line in done.stdout.splitlines())
                    if len(r) in (4, 5) and r[0].isdigit()}
            self.assertEqual(sorted(rows), list(range(1, 11)), done.stdout)
            for ratio in (2, 3, 4):
                with self.subTest(scene=scene, l=ratio):
                    self.assertAlmostEqual(float(rows[ratio][1]), across / ratio, delta=0.01)
                    self.assertAlmostEqual(float(rows[ratio][column]) / 100,
                                           measured_change(scene, quantity, ratio), delta=0.02)
            self.assertIn("*", rows[10])

    def test_gap_is_checked(self):
        for word in ("0", "-1", "wide", "nan"):
            done = estimate(bench(), script(1000), "--gap", word)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(f"--gap is '{word}', but must be a length", done.stdout)

    def test_gas_cells_over_the_grain_diameter(self):
        scene = bench()
        (scene.directory / "gas.toml").write_text(GAS)
        done = estimate(scene, script(1000).replace(
            "run 1000", "run 100\nfix gas all couple/gas case gas.toml\nrun 1000"))
        self.assertEqual(done.returncode, 0, done.stdout)
        ratios = re.search(r"Gas cells of .* l = 1 to 10:(.*)", done.stdout).group(1).split()
        self.assertEqual(len(ratios), 10)
        for l, ratio in enumerate(ratios, 1):
            self.assertAlmostEqual(float(ratio) * 2 * R0 * l / (9e-3 / 4), 1, delta=0.01)

    def test_contact_time_grains_and_steps_of_every_ratio(self):
        for n, stretch in ((3, 1.0), (1, L)):
            with self.subTest(n=n):
                done = estimate(bench(), script(10**7, n))
                self.assertEqual(done.returncode, 0, done.stdout)
                found = number(r"contact time +(\S+) s", done.stdout)
                self.assertAlmostEqual(found / (CONTACT_TIME * stretch), 1, delta=1e-3)
                rows = {int(r[0]): r for r in (line.split() for line in done.stdout.splitlines())
                        if len(r) > 7 and r[0].isdigit() and "e" in r[4]}
                self.assertEqual(sorted(rows), list(range(1, 11)))
                self.assertEqual(int(rows[5][1]), 100)
                self.assertEqual(int(rows[1][1]), 100 * 125)
                # the step keeps its share of the contact time
                share = max(8.0, CONTACT_TIME * stretch / STEP)
                self.assertAlmostEqual(float(rows[2][4]) * share / CONTACT_TIME, 1, delta=1e-3)

    def test_a_step_that_is_too_long_is_named(self):
        text = estimate(bench(), script(1000, step=3e-6)).stdout
        self.assertIn("WARNING: the step is too long", text)
        self.assertNotIn("WARNING: the step", estimate(bench(), script(1000)).stdout)

    def test_writes_no_files(self):
        scene = bench()
        estimate(scene, script(1000))
        self.assertEqual(sorted(path.name for path in scene.directory.iterdir()),
                         ["grains.data", "in.script"])

    def test_script_without_run_is_an_error(self):
        done = estimate(bench(), script(0))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("has no `run`", done.stdout)


if __name__ == "__main__":
    unittest.main()
