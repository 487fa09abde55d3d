"""Runs in pieces with a small program in place of gasgrain: packing, stop, going on, record."""

import fcntl
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
sys.path.insert(0, str(EXAMPLES))

import common  # noqa: E402
import pieces  # noqa: E402

# Counts to `time` in a checkpoint file; each start tells its variables. SIGTERM: checkpoint, the
# words of gasgrain in its log, and an exit code that mpirun may make of it.
STAND_IN = """
import json, pathlib, signal, sys, time
variables = json.loads(sys.argv[1])
points = pathlib.Path("points")
points.mkdir(exist_ok=True)
state = points / "latest.restart"
if variables["resume"] == 0:
    pathlib.Path(variables["packed"]).write_text("packed")
step = int(pathlib.Path(state).resolve().name) if state.is_symlink() else 0
def keep():
    (points / str(step)).touch()
    state.unlink(missing_ok=True)
    state.symlink_to(str(step))
def stop(*_):
    keep()
    pathlib.Path("restart_forced_liggghts_%d.data" % step).touch()
    pathlib.Path("log.liggghts").write_text("Ended by a signal at step %d" % step)
    sys.exit(1)
signal.signal(signal.SIGTERM, stop)
with open("starts.txt", "a") as file:
    file.write(json.dumps({**variables, "at": step}) + "\\n")
while step < variables["time"]:
    step += 1
    time.sleep(variables["pause"])
keep()
if not variables["silent"]:
    pathlib.Path("summary.json").write_text("{}")
sys.exit(variables["code"])
"""


class Pieces(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.directory = pathlib.Path(temporary.name) / "run"
        self.directory.mkdir()
        (self.directory / "bed.in").write_text("settle\nlabel gas\nrun")
        (self.directory / "gas.toml").write_text("x = 1")
        root, common.ROOT = common.ROOT, pathlib.Path(temporary.name)
        start, common.start_gasgrain = common.start_gasgrain, self.start
        self.addCleanup(lambda: (setattr(common, "ROOT", root),
                                 setattr(common, "start_gasgrain", start)))

    @staticmethod
    def start(directory, script, ranks, variables):
        return subprocess.Popen([sys.executable, "-c", STAND_IN, json.dumps(variables)], cwd=directory)

    def run_piece(self, hours=1.0, fresh=False, **changes):
        variables = {"k": 1.0, "velocity": 0.2, "time": 3, "pause": 0.0, "code": 0,
                     "silent": False, **changes}
        job = pieces.Job(self.directory, "bed.in", variables, packing=("k",))
        pieces.run_piece(job, types.SimpleNamespace(ranks=1, hours=hours, fresh=fresh))
        return job

    def starts(self):
        return [json.loads(line) for line in (self.directory / "starts.txt").read_text().splitlines()]

    def test_stops_with_75_after_its_hours_and_goes_on(self):
        with self.assertRaises(SystemExit) as stopped:
            self.run_piece(hours=1.0 / 3600, time=100, pause=0.02)
        self.assertEqual(stopped.exception.code, 75)
        self.assertEqual(list(self.directory.glob("restart_forced*")), [])
        self.run_piece(time=100, pause=0.02)
        starts = self.starts()
        self.assertEqual([start["resume"] for start in starts], [0, 1])
        self.assertGreater(starts[1]["at"], 0)
        self.assertEqual(starts[1]["from"], "points/latest.restart")
        record = pieces.read_record(self.directory)
        self.assertEqual(len(record["pieces"]), 2)
        self.assertGreaterEqual(record["pieces"][0]["seconds"], 1.0)

    def test_complete_run_is_left_alone_and_longer_time_goes_on(self):
        self.run_piece()
        self.run_piece()
        self.assertEqual(len(self.starts()), 1)
        self.run_piece(time=5)
        self.assertEqual(self.starts()[-1]["at"], 3)
        self.run_piece(time=5, fresh=True)
        self.assertEqual(self.starts()[-1]["at"], 0)

    def test_other_settings_begin_anew_from_the_stored_packing(self):
        self.run_piece()
        job = self.run_piece(velocity=0.3)
        second = self.starts()[-1]
        self.assertEqual((second["at"], second["resume"]), (0, 1))
        self.assertEqual(second["from"], str(job.packed))
        (self.directory / "gas.toml").write_text("x = 2")
        self.run_piece(velocity=0.3)
        self.assertEqual(self.starts()[-1]["at"], 0)

    def test_another_packing_is_made_for_another_spring(self):
        first, second = self.run_piece(), self.run_piece(k=2.0)
        self.assertNotEqual(first.packed, second.packed)
        self.assertEqual([start["resume"] for start in self.starts()], [0, 0])

    def test_failure_of_gasgrain_is_an_error_that_names_the_log(self):
        with self.assertRaises(SystemExit) as failed:
            self.run_piece(code=3)
        self.assertIn("exit code 3", str(failed.exception))
        self.assertIn("log.liggghts", str(failed.exception))

    def test_directory_of_a_living_run_is_left_alone(self):
        self.run_piece()
        before = (self.directory / pieces.RECORD).read_text()
        with open(self.directory / ".running", "w") as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            with self.assertRaises(SystemExit) as refused:
                self.run_piece(fresh=True)
        self.assertIn("another run", str(refused.exception))
        self.assertEqual((self.directory / pieces.RECORD).read_text(), before)
        self.run_piece(fresh=True)
        self.assertEqual(len(self.starts()), 2)

    def test_end_without_a_summary_is_not_complete(self):
        with self.assertRaises(SystemExit) as stopped:
            self.run_piece(silent=True)
        self.assertEqual(stopped.exception.code, 75)
        self.assertNotIn("complete", pieces.read_record(self.directory))

    def test_killed_piece_counts_until_its_last_row(self):
        record = {"pieces": [{"began": 1000.0, "seconds": None}]}
        series = self.directory / "timeseries.csv"
        series.write_text("time\n0\n")
        os.utime(series, (1600.0, 1600.0))
        pieces.close_killed_piece(self.directory, record)
        self.assertEqual(record["pieces"][0]["seconds"], 600.0)


if __name__ == "__main__":
    unittest.main()
