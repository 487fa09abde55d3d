#!/usr/bin/env python3
"""gasgrain-gas stopped, killed and continued: the files equal those of the uninterrupted run.

usage: gas_restart_test.py GASGRAIN_GAS MPIEXEC
"""
import csv
import filecmp
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from gas_case import changed, gas_case, inlet  # noqa: E402

CASE = gas_case((0.032, 0.016, 0.048), (16, 8, 24), x="no-slip", below=inlet(0.3),
                gravity=(0, 0, -9.81)) + """
[[body]]
name = "tube"
cylinder = {point = [0.015, 0, 0.03], axis = [0, 1, 0], radius = 0.005}
[fixed_bed]
void_fraction = 0.5
diameter = 1e-3
upper = [0.032, 0.016, 0.012]
[[probe]]
name = "wake"
point = [0.015, 0.008, 0.04]
[[probe]]
name = "axis"
interval = 0.01
line = {from = [0.016, 0.008, 0], to = [0.016, 0.008, 0.048], samples = 7}
[[probe]]
name = "above"
plane = {direction = "z", position = 0.02}
[[probe]]
name = "drag"
body = "tube"
[run]
end_time = 0.25
checkpoint_interval = 0.025
[output]
interval = 0.0333
"""
STOPPED = 75


class Program:
    def __init__(self, executable, mpiexec, directory):
        self.executable, self.mpiexec, self.directory = executable, mpiexec, directory

    def command(self, out, ranks=1, text=CASE, options=()):
        case = os.path.join(self.directory, "case.toml")
        with open(case, "w") as file:
            file.write(text)
        command = [self.executable, case, "--out", self.path(out), *options]
        if ranks > 1:
            command = [self.mpiexec, "-n", str(ranks), "--oversubscribe", *command]
        return command

    def path(self, *parts):
        return os.path.join(self.directory, *parts)

    def run(self, *args, **kwargs):
        return subprocess.run(self.command(*args, **kwargs), capture_output=True, text=True,
                              timeout=250)

    def start(self, *args, **kwargs):
        return subprocess.Popen(self.command(*args, **kwargs), stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)

    def checkpoints(self, out):
        directory = self.path(out)
        files = os.listdir(directory) if os.path.isdir(directory) else []
        return sorted(f for f in files if f.startswith("gas_checkpoint") and f.endswith(".h5"))

    def finished(self, *args, **kwargs):
        result = self.run(*args, **kwargs)
        check(result.returncode == 0, result.stderr + result.stdout)
        return result.stdout


def check(condition, message):
    if not condition:
        sys.exit("FAILED: " + message)


def wait_for(condition, what, process):
    limit = time.monotonic() + 60
    while not condition():
        check(process.poll() is None, "the run ended before " + what + ": " + str(process.stdout))
        check(time.monotonic() < limit, "waited in vain for " + what)
        time.sleep(0.002)


def ranks_of(process, ranks):
    """Process numbers of the ranks."""
    if ranks == 1:
        return [process.pid]
    children = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(process.pid)],
                              capture_output=True, text=True).stdout
    return [int(line.split()[0]) for line in children.splitlines() if "gasgrain-gas" in line]


def check_same_files(program, expected, actual, what):
    names = sorted(os.listdir(program.path(expected)))
    check(names == sorted(os.listdir(program.path(actual))),
          "%s: %s instead of %s" % (what, sorted(os.listdir(program.path(actual))), names))
    for name in names:
        if name == "summary.json":  # holds wall times
            continue
        check(filecmp.cmp(program.path(expected, name), program.path(actual, name), shallow=False),
              "%s: %s differs" % (what, name))


def killed_runs_continue_bit_for_bit(program):
    for ranks in (1, 2):
        program.finished("whole%d" % ranks, ranks)
        process = program.start("killed", ranks)
        wait_for(lambda: len(program.checkpoints("killed")) == 2, "two checkpoints", process)
        for pid in ranks_of(process, ranks):
            os.kill(pid, signal.SIGKILL)
        process.communicate()
        check("summary.json" not in os.listdir(program.path("killed")), "it ended before the kill")
        output = program.finished("killed", ranks, options=["--restart", "latest"])
        check("continues from" in output, output)
        leave_no_parts(program, "killed")
        check_same_files(program, "whole%d" % ranks, "killed", "killed on %d ranks" % ranks)
        shutil.rmtree(program.path("killed"))


def leave_no_parts(program, out):
    """A file that was being written when the kill came stays as .part."""
    for name in os.listdir(program.path(out)):
        if name.endswith(".part"):
            os.remove(program.path(out, name))


def stopped_runs_say_how_to_continue_and_do_so_bit_for_bit(program):
    signals = {1: signal.SIGINT, 2: signal.SIGTERM}
    for ranks in (1, 2):
        process = program.start("stopped", ranks)
        wait_for(lambda: len(program.checkpoints("stopped")) == 1, "a checkpoint", process)
        os.kill(ranks_of(process, ranks)[-1], signals[ranks])  # one rank only
        output = process.communicate(timeout=60)[0]
        check(process.returncode == STOPPED, "exit code %d: %s" % (process.returncode, output))
        check("--restart latest" in output and "stopped by a signal" in output, output)
        stopped = program.checkpoints("stopped")
        check(stopped[-1] in output, output)
        program.finished("stopped", ranks, options=["--restart", "latest"])
        check_same_files(program, "whole%d" % ranks, "stopped", "stopped on %d ranks" % ranks)
        shutil.rmtree(program.path("stopped"))


def mpirun_hands_on_sigusr1(program):
    process = program.start("usr1", 2)
    wait_for(lambda: program.checkpoints("usr1"), "a checkpoint", process)
    process.send_signal(signal.SIGUSR1)
    output = process.communicate(timeout=60)[0]
    check(process.returncode == STOPPED and "stopped by a signal" in output, output)


def rows_of(program, out):
    with open(program.path(out, "gas.csv")) as file:
        return list(csv.DictReader(file))


def continues_on_another_number_of_ranks(program):
    text = CASE + "[numerics]\npressure_tolerance = 1e-12\n"
    program.finished("one", 1, text=text)
    first = program.path("one", program.checkpoints("one")[0])
    program.finished("three", 3, text=text, options=["--restart", first])
    three = rows_of(program, "three")
    one = rows_of(program, "one")[-len(three):]
    check(10 < len(three) < 100, "%d rows after the restart" % len(three))
    for key in ("time_s", "largest_speed_m_s", "z_lower_pressure_Pa", "z_upper_flux_m3_s"):
        for a, b in zip((float(row[key]) for row in one), (float(row[key]) for row in three)):
            check(abs(a - b) < 1e-7 * abs(a), "%s: %.17g on one rank, %.17g on three" % (key, a, b))


def a_failed_step_leaves_the_last_good_state(program):
    """The pressure of the outlet jumps beyond all bounds half-way: with a sane one the run goes on as
    if it had been there from the start."""
    outlet = 'z_upper = {type = "outlet"'
    check(outlet in CASE, "the case has no outlet above")
    table = ", pressure = 1.0, time_table = {times = [%s], values = [%s]}"
    before, after = CASE.split(outlet)
    rest = after[after.index("}") + 1:]
    short = before + outlet + table % ("0, 0.15, 0.150001, 0.3", "1, 2, 1e200, 1e200") + "}" + rest
    whole = before + outlet + table % ("0, 0.15, 0.3", "1, 2, 3") + "}" + rest
    for ranks in (1, 2):
        out = "failed%d" % ranks
        result = program.run(out, ranks, text=short)
        check(result.returncode == 1, result.stderr)
        check("step " in result.stderr and "dt = " in result.stderr, result.stderr)
        check(program.checkpoints(out)[-1] in result.stderr, result.stderr)
        program.finished(out, ranks, text=whole, options=["--restart", "latest"])
        program.finished("ramp%d" % ranks, ranks, text=whole)
        for name in ("gas.csv", "probe_axis.csv", "probe_drag.csv"):
            check(filecmp.cmp(program.path(out, name), program.path("ramp%d" % ranks, name), False),
                  name + " differs after a failed step")


def a_finished_run_can_be_extended(program):
    output = program.finished("whole1", 1, text=changed(CASE, "end_time = 0.25", "end_time = 0.26"),
                              options=["--restart", "latest"])
    check("from 0.25 to 0.26 s" in output, output)


REFUSED = [
    ("grid.cells", "[16, 8, 24]", "[16, 8, 20]"),
    ("gas.density", "density = 1.2", "density = 1.3"),
    ("body[1].cylinder.radius", "radius = 0.005", "radius = 0.006"),
    ("fixed_bed.diameter", "diameter = 1e-3", "diameter = 2e-3"),
    ("(periodic)", 'y_lower = {type = "slip"}\ny_upper = {type = "slip"}',
     'y_lower = {type = "periodic"}\ny_upper = {type = "periodic"}'),
]


def fails(program, expected, *args, **kwargs):
    result = program.run(*args, **kwargs)
    check(result.returncode == 1, "exit code %d: %s" % (result.returncode, result.stdout))
    check(result.stderr.count("gasgrain-gas: error:") == 1, result.stderr)
    for text in expected:
        check(text in result.stderr, "'%s' is not in: %s" % (text, result.stderr))


def other_cases_are_refused_by_name(program):
    for key, old, new in REFUSED:
        ranks = 2 if key == "gas.density" else 1
        fails(program, ["cannot continue from", key], "whole1", ranks, text=changed(CASE, old, new),
              options=["--restart", "latest"])
    fails(program, ["1.2 in the checkpoint", "1.3 in the case"], "whole1",
          text=changed(CASE, "density = 1.2", "density = 1.3"), options=["--restart", "latest"])


def sides_may_change_and_are_named(program):
    text = changed(CASE, "superficial_velocity = 0.3", "superficial_velocity = 0.2")
    text = changed(text, "end_time = 0.25", "end_time = 0.255")
    first = program.path("whole2", program.checkpoints("whole2")[-1])
    output = program.finished("changed", 1, text=text, options=["--restart", first])
    check("boundary.z_lower.superficial_velocity is 0.3 in the checkpoint" in output, output)


def damaged_and_foreign_files_are_refused(program):
    source = program.path("whole2")
    newest, older = program.checkpoints("whole2")[-1], program.checkpoints("whole2")[0]
    damaged = program.path("damaged")
    shutil.copytree(source, damaged)
    with open(os.path.join(damaged, newest), "r+b") as file:
        file.truncate(os.path.getsize(file.name) // 2)
    for ranks in (1, 2):
        fails(program, [newest, "cannot open"], "damaged", ranks,
              options=["--restart", os.path.join(damaged, newest)])
    output = program.finished("damaged", 1, options=["--restart", "latest"])
    check("continues from" in output and older in output, output)
    fails(program, ["is not a checkpoint"], "damaged",
          options=["--restart", os.path.join(source, "gas_000000.h5")])
    fails(program, ["nowhere.h5"], "damaged", options=["--restart", "nowhere.h5"])
    fails(program, ["no checkpoint to continue from"], "empty", options=["--restart", "latest"])


def main():
    with tempfile.TemporaryDirectory() as directory:
        program = Program(sys.argv[1], sys.argv[2], directory)
        for test in (killed_runs_continue_bit_for_bit,
                     stopped_runs_say_how_to_continue_and_do_so_bit_for_bit,
                     mpirun_hands_on_sigusr1,
                     continues_on_another_number_of_ranks,
                     other_cases_are_refused_by_name,
                     damaged_and_foreign_files_are_refused,
                     sides_may_change_and_are_named,
                     a_failed_step_leaves_the_last_good_state,
                     a_finished_run_can_be_extended):
            start = time.monotonic()
            test(program)
            print("ok %s (%.1f s)" % (test.__name__, time.monotonic() - start), flush=True)


if __name__ == "__main__":
    main()
