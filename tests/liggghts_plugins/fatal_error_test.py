"""An error of all or of some ranks is printed exactly once, and the program ends non-zero."""

import os
import subprocess
import unittest

from liggghts_run import ENVIRONMENT, MPIEXEC

PROBE = os.environ["GASGRAIN_FATAL_ERROR_PROBE"]


class FatalErrors(unittest.TestCase):
    def run_failing(self, *ranks):
        done = subprocess.run([MPIEXEC, "--oversubscribe", "-n", "3", PROBE, *map(str, ranks)],
                              env=ENVIRONMENT, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=60)
        errors = [line for line in done.stdout.splitlines() if line.startswith("ERROR")]
        return done.returncode, errors

    def test_without_failure_it_ends_normally(self):
        self.assertEqual(self.run_failing(), (0, []))

    def test_all_ranks(self):
        code, errors = self.run_failing(0, 1, 2)
        self.assertNotEqual(code, 0)
        self.assertEqual(errors, ["ERROR: rank 0 failed"])

    def test_some_ranks_while_the_others_wait(self):
        for ranks in ((2,), (1, 2), (0,)):
            with self.subTest(ranks=ranks):
                code, errors = self.run_failing(*ranks)
                self.assertNotEqual(code, 0)
                self.assertEqual(errors, [f"ERROR: rank {ranks[0]} failed"])


if __name__ == "__main__":
    unittest.main()
