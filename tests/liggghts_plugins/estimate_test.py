"""gasgrain estimate: numbers of a script whose answers are known, no files written, bad input."""

import re
import subprocess
import unittest

from liggghts_run import (Bench, ENVIRONMENT, GASGRAIN, Grain, cgm_properties, data_file, preamble)

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


def estimate(scene, text):
    (scene.directory / "in.script").write_text(text)
    return subprocess.run([GASGRAIN, "estimate", "in.script"], cwd=scene.directory, text=True,
                          env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120)


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


class Estimate(unittest.TestCase):
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
