"""Checkpoints of coupled runs: a continued job has the bits of the one that wrote them."""

import os
import pathlib
import re
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree

import coupled_bed as bed
from liggghts_run import ENVIRONMENT, GASGRAIN, MPIEXEC

EXCHANGE = ('exchange_interval = 1e-4\nseries_interval = 1e-4\n'
            'monitor = {profile = true, bubble_void_fraction = 0.8, mixing = "z", '
            'plane = [{name = "middle", direction = "z", position = 0.004}]}\n')
DUMP = ("dump d all custom 50 grains.dump id x y z vx vy vz omegax omegay omegaz fx fy fz\n"
        "dump_modify d append yes format \"%d" + " %.17g" * 12 + "\"\n")


def commands(runs, every=200):
    return f"gasgrain_checkpoint {every} points\n{DUMP}{runs}"


def start(runs, every=200):
    return bed.script(commands(runs, every))


def go_on(runs, every=200, file="points/latest.restart"):
    return start(runs, every).replace("read_data grains.data", f"read_restart {file}")


def case():
    return bed.case(coupling=EXCHANGE, interval=2e-3)


def frames(bench):
    """Text of every whole frame. Of the step at which a job was continued the first one: the
    set-up of a run shows the forces of the step to come. A killed job may have ended within a
    frame, in the middle of a line; the next job wrote on from there."""
    text = (bench.directory / "grains.dump").read_text()
    found, before = {}, -1
    for part in text.split("ITEM: TIMESTEP\n")[1:]:
        lines = part.splitlines()
        if len(lines) < 3 or len(lines) < 8 + int(lines[2] or 0):
            continue
        step = int(lines[0])
        if not (step <= before and step in found):
            found[step] = lines[:8 + int(lines[2])]
        before = step
    return found


def frame_times(bench):
    index = ElementTree.parse(bench.directory / "out" / "gas.xdmf")
    return [float(time.get("Value")) for time in index.iter("Time")]


def kill_processes_in(directory):
    """Kills the ranks that outlive their mpirun; the number of them."""
    found = 0
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cwd").resolve() == directory.resolve():
                os.kill(int(process.name), signal.SIGKILL)
                found += 1
        except OSError:  # ended meanwhile, or not ours
            continue
    return found


def files(bench):
    return sorted(os.listdir(bench.directory / "points"))


def latest_step(bench):
    """Of the last complete checkpoint; 0 before there is one."""
    try:
        return int(os.readlink(bench.directory / "points" / "latest.restart").split(".")[1])
    except FileNotFoundError:
        return 0


def names_of_points(bench):
    points = bench.directory / "points"
    return files(bench) if points.exists() else []


def rows_so_far(bench):
    series = bench.directory / "out" / "timeseries.csv"
    return len(series.read_text().splitlines()) if series.exists() else 0


def newer(bench, pattern):
    """Of the points' names those of steps after the last complete checkpoint."""
    found = [re.fullmatch(pattern, name) for name in names_of_points(bench)]
    return [match[0] for match in found if match and int(match[1]) > latest_step(bench)]


# Whether the job has come so far; step: of the last checkpoint when it began, rows: of the series.
MOMENTS = {
    "before the first checkpoint": lambda bench, step, rows: rows_so_far(bench) > 1,
    "gas half written": lambda bench, step, rows: newer(bench, r"gas\.(\d+)\.state\.h5\.partial"),
    "grains half written": lambda bench, step, rows: (
        newer(bench, r"gas\.(\d+)\.state\.h5") and newer(bench, r"grains\.(\d+)\.restart\.partial")),
    "whole files without a link": lambda bench, step, rows: newer(bench, r"grains\.(\d+)\.restart"),
    "right after a checkpoint": lambda bench, step, rows: latest_step(bench) > step,
    "between two checkpoints": lambda bench, step, rows: (latest_step(bench) > step
                                                          and rows_so_far(bench) > rows + 10),
}


# mpirun kills the ranks so many seconds after it has handed on SIGTERM, and always waits as long; its
# one second is too short for a checkpoint on a busy machine.
PATIENCE = {"OMPI_MCA_odls_base_sigkill_timeout": "5"}


class Restart(unittest.TestCase):
    def whole(self, ranks, steps=1000):
        bench = bed.bench(case())
        bench.run(start(f"run {steps}"), ranks=ranks)
        return bench

    def assert_same(self, bench, whole):
        self.assertGreater(len(frames(whole)), 5)
        self.assertEqual(frames(bench), frames(whole))
        for name in ("void_fraction_profile.csv", "timeseries.csv"):
            rows = [(b.directory / "out" / name).read_text() for b in (bench, whole)]
            if name == "timeseries.csv":
                self.assertEqual(*rows)
            else:  # the job that ended showed its end as well
                self.assertLessEqual(set(rows[1].splitlines()), set(rows[0].splitlines()))
        self.assertGreater(len(rows[0].splitlines()), 30)
        results = [bed.quantities(b.directory) for b in (bench, whole)]
        for name, value in results[1].items():
            if not re.search("time|per_second|commit", name):
                self.assertEqual(results[0][name], value, name)
        # the job that ended showed its end as well
        times = [frame_times(b) for b in (bench, whole)]
        self.assertLessEqual(set(times[1]), set(times[0]))
        self.assertEqual(times[0], sorted(set(times[0])))

    def test_continued_job_has_the_bits_of_the_whole_one(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                whole = self.whole(ranks)
                self.assertEqual(files(whole), ["gas.1000.state.h5", "gas.800.state.h5",
                                                "grains.1000.restart", "grains.800.restart",
                                                "latest.restart"])
                parts = bed.bench(case())
                parts.run(start("run 400"), ranks=ranks)
                done = parts.run(go_on("run 1000 upto"), ranks=ranks)
                self.assertIn("Gas continues at t =", done.text)
                self.assert_same(parts, whole)

    def test_killed_job_continues_from_its_last_whole_checkpoint(self):
        bench = bed.bench(case())
        process = self.start_process(bench, start("run 100000000"), 2)
        self.wait_for(lambda: (bench.directory / "points" / "grains.600.restart").exists())
        process.kill()
        process.communicate()
        self.wait_for(lambda: not kill_processes_in(bench.directory))
        step = latest_step(bench)
        # 400 if the kill came before the gas of 600 was written
        self.assertGreaterEqual(step, 400)
        end = step + 400
        bench.run(go_on(f"run {end} upto"), ranks=2)
        whole = self.whole(2, end)
        kept, expected = frames(bench), frames(whole)
        self.assertEqual({n: kept[n] for n in expected}, expected)

    def test_killed_at_any_moment_a_job_continues_with_the_same_bits(self):
        """One job after the other is killed; all together they are one run."""
        bench = bed.bench(case())
        for has_come in MOMENTS.values():
            self.kill_once(has_come, bench, self.next_script(bench, "run 100000000"))
        end = max(500, latest_step(bench) + 100)
        bench.run(self.next_script(bench, f"run {end} upto"))
        whole = bed.bench(case())
        whole.run(start(f"run {end}", every=50))
        self.assert_same(bench, whole)

    def next_script(self, bench, runs):
        if latest_step(bench) > 0:
            return go_on(runs, every=50)
        return start(runs, every=50)

    def kill_once(self, has_come, bench, script, seconds=4):
        """The job runs in slices, between which it is looked at while it stands still: the kill hits
        what was seen. A moment that is too short to be seen becomes any other."""
        step, rows = latest_step(bench), rows_so_far(bench)
        (bench.directory / "in.script").write_text(script)
        process = subprocess.Popen([GASGRAIN, "-in", "in.script", "-log", "log.txt"],
                                   cwd=bench.directory, env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            time.sleep(0.002)
            process.send_signal(signal.SIGSTOP)
            stop = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
            self.assertEqual(stop.si_code, os.CLD_STOPPED, "the job ended by itself")
            if has_come(bench, step, rows):
                break
            process.send_signal(signal.SIGCONT)
        process.kill()
        process.wait()

    def test_sigterm_writes_a_checkpoint_and_says_how_to_go_on(self):
        self.assert_signal_writes_a_checkpoint(signal.SIGTERM, ranks=2)

    def test_sigint_writes_a_checkpoint_and_says_how_to_go_on(self):
        # mpirun ends its ranks by SIGTERM when it gets SIGINT
        self.assert_signal_writes_a_checkpoint(signal.SIGINT, ranks=1)
        self.assert_signal_writes_a_checkpoint(signal.SIGINT, ranks=2)

    def assert_signal_writes_a_checkpoint(self, number, ranks):
        bench = bed.bench(case())
        process = self.start_process(bench, start("run 100000000", every=1000000), ranks)
        self.wait_for(lambda: rows_so_far(bench) > 20)
        process.send_signal(number)
        text = process.communicate(timeout=120)[0]
        self.assertIn("Ended by a signal at step", text)
        self.assertIn("read_restart points/latest.restart", text)
        before = len(bed.series(bench.directory))
        bench.run(go_on("run 500", every=1000000), ranks=ranks)
        rows = bed.series(bench.directory)
        times = [row["time"] for row in rows]
        self.assertGreater(len(rows), before)
        self.assertEqual(times, sorted(set(times)))

    def test_another_number_of_ranks_goes_on_correctly(self):
        whole = self.whole(1, steps=440)
        other = bed.bench(case())
        other.run(start("run 400"), ranks=1)
        other.run(go_on("run 440 upto"), ranks=3)
        for row, expected in zip(bed.series(other.directory), bed.series(whole.directory),
                                 strict=True):
            for name in ("pressure_drop", "kinetic_energy", "bed_height"):
                self.assertAlmostEqual(row[name], expected[name],
                                       delta=1e-6 * max(abs(expected[name]), 1e-9), msg=name)

    def test_stock_restart_files_carry_the_gas(self):
        whole = bed.bench(case())
        whole.run(bed.script(DUMP + "run 300\nwrite_restart a.restart\nrun 200"))
        other = bed.bench(case())
        other.run(bed.script(DUMP + "run 300\nwrite_restart a.restart\n"))
        other.run(bed.script(DUMP + "run 200").replace("read_data grains.data",
                                                       "read_restart a.restart"))
        self.assertEqual(frames(other)[500], frames(whole)[500])

    def test_bad_input(self):
        for words, expected in (("0 points", "whole number > 0"), ("100", "a number of steps and a"),
                                ("ten points", "whole number > 0")):
            with self.subTest(words):
                done = bed.bench(case()).run(bed.script(f"gasgrain_checkpoint {words}\nrun 1"),
                                             check=False)
                self.assertNotEqual(done.code, 0)
                self.assertIn(expected, done.text)
        done = bed.bench(case()).run(start("run 10 every 2 NULL"), check=False)
        self.assertNotEqual(done.code, 0)
        self.assertIn("keyword every cannot be divided", done.text)

    def assert_continued_after_400_steps_of_600(self, text):
        whole, parts = bed.bench(text), bed.bench(text)
        whole.run(start("run 600"), ranks=2)
        parts.run(start("run 400"), ranks=2)
        parts.run(go_on("run 600 upto"), ranks=2)
        self.assert_same(parts, whole)

    def test_drag_that_follows_the_grains_is_continued_too(self):
        self.assert_continued_after_400_steps_of_600(
            bed.case(coupling=EXCHANGE + 'drag_update = "dem-step"\n', interval=2e-3))

    def test_lagged_gradient_of_light_grains_and_viscous_stress_are_continued_too(self):
        # intervals of changing length, from the limits
        coupling = EXCHANGE.replace("exchange_interval = 1e-4\n", "viscous_stress = true\n")
        text = bed.case(coupling=coupling, interval=2e-3)
        self.assert_continued_after_400_steps_of_600(
            bed.changed(text, "density = 1\n", f"density = {bed.DENSITY / 20}\n"))

    def test_another_gas_is_refused(self):
        bench = bed.bench(case())
        bench.run(start("run 200"))
        (bench.directory / "case.toml").write_text(bed.changed(case(), "viscosity = 1.8e-05",
                                                               "viscosity = 2e-05"))
        done = bench.run(go_on("run 10"), check=False)
        self.assertNotEqual(done.code, 0)
        self.assertIn("gas.viscosity = 1.8e-05, but the case file states 2e-05", done.text)

    def test_state_of_another_grid_is_refused(self):
        bench = bed.bench(case())
        bench.run(start("run 200"))
        (bench.directory / "case.toml").write_text(bed.changed(case(), "cells = [6, 4, 16]",
                                                               "cells = [6, 4, 20]"))
        done = bench.run(go_on("run 10"), check=False)
        self.assertNotEqual(done.code, 0)
        self.assertIn("gas.200.state.h5", done.text)

    def start_process(self, bench, script, ranks):
        (bench.directory / "in.script").write_text(script)
        command = [GASGRAIN, "-in", "in.script"]
        if ranks > 1:
            command = [MPIEXEC, "--oversubscribe", "-n", str(ranks), *command]
        return subprocess.Popen(
            command, cwd=bench.directory, env={**ENVIRONMENT, **PATIENCE}, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def wait_for(self, condition, seconds=120):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, "timed out")
            time.sleep(0.05)


if __name__ == "__main__":
    unittest.main()
