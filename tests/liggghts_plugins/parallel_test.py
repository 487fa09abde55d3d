"""A bed on several ranks moves as on one; a restarted run continues as if it had not stopped."""

import unittest

import bed_of_grains as bed
from liggghts_run import Bench, largest_difference, thermo

SCALE = [bed.RADIUS] * 3 + [0.3] * 3 + [0.3 / bed.RADIUS] * 3
# Round-off grows by a factor of 50 per 500 steps here (with stock LIGGGHTS, too): 1e-10 after 2000.
STEPS = 2000


class Parallel(unittest.TestCase):
    def run_on(self, ranks, processors="* * *"):
        bench = Bench(bed.FILES)
        run = bench.run(bed.start(processors) + bed.output(1000).replace('thermo 500', 'thermo 250') + f"run {STEPS}\n", ranks=ranks)
        return bench.frames("d.dump"), thermo(run.log)

    def test_ranks_do_not_change_the_motion(self):
        frames, rows = self.run_on(1)
        rows = [row for row in rows if len(row) == 18]
        self.assertEqual(len(rows), STEPS // 250 + 1)
        self.assertGreater(max(row[9] for row in rows), 5)  # grains on the floor ...
        self.assertGreater(max(row[16] for row in rows), 1)   # ... and on the tube
        moved = [abs(frames[-1][i][0] - frames[0][i][0]) for i in frames[0]]
        self.assertGreater(sorted(moved)[len(moved) // 2], bed.RADIUS)
        for ranks, processors in ((2, "2 1 1"), (3, "3 1 1"), (4, "2 1 2")):
            with self.subTest(ranks=ranks):
                others, other_rows = self.run_on(ranks, processors)
                self.assertLess(largest_difference(others, frames, SCALE), 1e-8)
                other_rows = [row for row in other_rows if len(row) == 18]
                for row, other in zip(rows, other_rows, strict=True):
                    for column, (value, reference) in enumerate(zip(other, row)):
                        unit = max(abs(r[column]) for r in rows) or 1.0
                        self.assertLess(abs(value - reference) / unit, 1e-7, (row[0], column))


class Restart(unittest.TestCase):
    def test_restarted_run_continues(self):
        whole = Bench(bed.FILES)
        whole.run(bed.start() + bed.output(500) + "run 3000\nwrite_restart bed.restart\nrun 1000\n")
        expected = whole.frames("d.dump")[-1]
        restarted = bed.start().replace("read_data grains.data", "read_restart bed.restart")
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                whole.run(restarted + bed.output(500) + "run 1000\n", ranks=ranks)
                frames = whole.frames("d.dump")
                self.assertLess(largest_difference([frames[-1]], [expected], SCALE), 1e-9)

    def test_restart_without_wall_history_would_differ(self):
        """The test above can fail: forgetting the tangential springs of the walls shows."""
        whole = Bench(bed.FILES)
        whole.run(bed.start() + bed.output(500) + "run 3000\nwrite_restart bed.restart\nrun 1000\n")
        expected = whole.frames("d.dump")[-1]
        renamed = bed.start().replace("read_data grains.data", "read_restart bed.restart").replace(
            "fix floor", "fix ground")
        whole.run(renamed + bed.output(500).replace("f_floor", "f_ground") + "run 1000\n")
        changed = largest_difference([whole.frames("d.dump")[-1]], [expected], SCALE)
        self.assertGreater(changed, 1e-6)


if __name__ == "__main__":
    unittest.main()
