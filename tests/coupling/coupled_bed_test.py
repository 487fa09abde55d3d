"""A LIGGGHTS script with gas, from the script to the files, at several rank counts."""

import csv
import re
import unittest
import xml.etree.ElementTree as ElementTree

import coupled_bed as bed
from engine_scenes import SCALE, stl
from liggghts_run import dump_command, largest_difference

NAMES = ["bed_height_mean", "pressure_drop_mean", "pressure_drop_force_balance",
         "momentum_balance_residual", "solid_volume_residual", "overlap_max", "time_dem",
         "time_coupling", "time_gas", "grain_steps_per_second"]


class CoupledBed(unittest.TestCase):
    def test_closes_the_vertical_momentum_balance_at_any_number_of_ranks(self):
        for ranks in bed.ranks_to_test():
            with self.subTest(ranks=ranks):
                bench = bed.bench(bed.case(coupling="average_from = 0.01"))
                bench.run(bed.script("run 2500"), ranks=ranks)
                found = bed.quantities(bench.directory)
                self.assertLess(found["momentum_balance_residual"], 1e-9)
                self.assertLess(found["third_law_residual"], 1e-12)
                self.assertLess(found["third_law_accumulated"], 1e-10)
                self.assertLess(found["solid_volume_residual"], 1e-12)
                self.assertAlmostEqual(found["pressure_drop_weight_over_area"],
                                       bed.weight() / bed.AREA, delta=1e-6)

    def test_fields_do_not_depend_on_the_ranks(self):
        # a few exchanges, before rounding errors of the grains' contacts have grown
        reference = None
        for ranks in bed.ranks_to_test():
            bench = bed.bench(bed.case(coupling="exchange_interval = 6e-5", interval=1e-5))
            bench.run(bed.script("run 30"), ranks=ranks)
            rows = bed.series(bench.directory)
            self.assertEqual(len(rows), 6)
            reference = reference or rows
            for row, expected in zip(rows, reference, strict=True):
                self.assert_rows_agree(row, expected, ranks)

    def test_ranks_with_grains_or_with_gas_alone(self):
        """The left half of the gas grid is solid and its ranks own all the grains."""
        reference = None
        for ranks in (1, 3, 4, 8):
            case = bed.changed(bed.case(coupling="exchange_interval = 6e-5", interval=1e-5),
                               "lower = [0, 0, 0]\nupper", "lower = [-0.0075, 0, 0]\nupper")
            case = bed.changed(case, "cells = [6, 4, 16]", "cells = [12, 4, 16]")
            case = bed.changed(case, "[numerics]\n", '[[body]]\nname = "rock"\nacts_on = ["gas"]\n'
                               "plane = {point = [0, 0, 0], normal = [1, 0, 0]}\n"
                               f"[numerics]\nranks = [{ranks}, 1, 1]\n")
            bench = bed.bench(case)
            # the bed fills the lower 8 of 20 mm: the upper ranks own no grains, but the gas
            bench.run(bed.script("run 30").replace("processors * * 1", "processors 1 1 *"),
                      ranks=ranks)
            rows = bed.series(bench.directory)
            self.assertEqual(rows[-1]["grains_outside"], 0)
            reference = reference or rows
            for row, expected in zip(rows, reference, strict=True):
                self.assertLess(abs(row["third_law_residual"]), 1e-12)
                self.assertLess(abs(row["momentum_residual"]), 1e-9)
                self.assertLess(abs(row["solid_volume_residual"]), 1e-12)
                self.assert_rows_agree(row, expected, ranks)

    def assert_rows_agree(self, row, expected, ranks):
        for name in ("pressure_drop", "bed_height", "kinetic_energy", "bodies_on_gas",
                     "walls_on_grains", "smallest_void_fraction"):
            self.assertAlmostEqual(row[name], expected[name],
                                   delta=1e-8 * max(abs(expected[name]), 1e-9),
                                   msg=f"{name} at {ranks} ranks")

    def test_drop_of_pressure_carries_the_bed(self):
        # residual aside, the time mean of the balance: drop times area = weight + walls + change
        bench = bed.bench(bed.case())
        bench.run(bed.script("run 2500"), ranks=2)
        rows = bed.series(bench.directory)
        late = rows[len(rows) // 2:]
        drop = sum(row["pressure_drop"] for row in late) / len(late)
        carried = sum(row["grain_momentum_rate"] + row["gas_momentum_rate"] - row["grain_weight"]
                      - row["gas_weight"] - row["walls_on_grains"] - row["bodies_on_gas"]
                      - row["walls_by_drag"] - row["gas_through_sides"] - row["in_transit"]
                      for row in late) / len(late)
        self.assertAlmostEqual(drop * bed.AREA, carried, delta=0.05 * bed.weight())

    def test_writes_what_the_issue_asks_for(self):
        bench = bed.bench(bed.case(coupling='case_name = "small bed"', interval=0.003))
        bench.run(bed.script("run 1000"), ranks=2)
        result = bed.summary(bench.directory)
        self.assertEqual(result["case"], "small bed")
        self.assertTrue(result["commit"])
        names = [quantity["name"] for quantity in result["quantities"]]
        for name in NAMES:
            self.assertIn(name, names)
        for quantity in result["quantities"]:
            self.assertEqual(set(quantity),
                             {"name", "value", "unit", "reference", "tolerance", "source"})
        times = {}
        for name in ("gas", "grains"):
            index = ElementTree.parse(bench.directory / "out" / f"{name}.xdmf")
            times[name] = [float(time.get("Value")) for time in index.iter("Time")]
        self.assertEqual(times["gas"], times["grains"])  # one time line
        self.assertEqual(len(times["gas"]), 5)  # start, three whole intervals, last exchange

    def test_monitors_reach_files_and_thermo_output(self):
        monitor = ('series_interval = 1e-3\nmonitor = {profile = true, bubble_void_fraction = 0.8, '
                   'mixing = "x", plane = [{name = "low", direction = "z", position = 0.004}]}')
        probe = '[[probe]]\nname = "bottom"\npoint = [0.001, 0.001, 0.001]\ninterval = 1e-3\n'
        bench = bed.bench(bed.case(coupling=monitor, interval=5e-3) + probe)
        done = bench.run(bed.script("thermo_style custom step f_gas[3] f_gas[11] f_gas[13] f_gas[17] f_gas[23]"
                                    "\nthermo 500\nrun 1000"), ranks=2)
        rows = bed.series(bench.directory)
        last = rows[-1]
        # 0.7 is crossed lower down than 0.8, and 0.9 above it
        self.assertLess(last["bed_height_void_0.7"], last["bed_height"])
        self.assertGreater(last["bed_height_void_0.9"], last["bed_height"])
        # the bed is uniform but for the tube: all heights agree within a tenth or so
        for name in ("bed_height_solid_99", "bed_height_twice_centre"):
            self.assertAlmostEqual(last[name], last["bed_height"], delta=0.15 * last["bed_height"])
        self.assertGreater(rows[0]["mixing_index"], 0.0)
        self.assertLess(rows[0]["mixing_index"], 0.5)  # two halves beside each other
        self.assertGreater(max(row["flux_up_low"] for row in rows), 0.0)
        means = bed.quantities(bench.directory)
        self.assertAlmostEqual(means["bed_height_void_0.9_mean"],
                               sum(row["bed_height_void_0.9"] for row in rows) / len(rows),
                               delta=1e-3 * last["bed_height"])
        printed = [line.split() for line in done.text.splitlines() if line.split()[:1] == ["1000"]]
        for text, name in zip(printed[0][2:], ("bed_height_void_0.7", "bed_height_solid_99",
                                               "mixing_index")):
            self.assertAlmostEqual(float(text), last[name], delta=1e-4 * abs(last[name]), msg=name)
        with open(bench.directory / "out" / "void_fraction_profile.csv") as file:
            profile = [[float(word) for word in line.split(",")] for line in file.readlines()[1:]]
        self.assertEqual(len(profile) % 16, 0)
        self.assertLess(min(row[2] for row in profile[-16:]), 0.6)
        self.assertAlmostEqual(profile[-1][2], 1.0, delta=1e-9)
        with open(bench.directory / "out" / "probe_bottom.csv") as file:
            probe = list(csv.DictReader(file))
        self.assertEqual(len(probe), len(rows))
        pressure = float(probe[-1]["pressure_Pa"])  # ten and nine values come before the probe's
        self.assertAlmostEqual(float(printed[0][5]), pressure, delta=1e-4 * abs(pressure))

    def test_warns_of_grains_that_are_alone(self):
        bench = bed.bench(bed.case())
        lone = re.sub(r"\d+ atoms", "1 atoms", bed.grains_data().split("\n2 1 ")[0]) + "\n"
        (bench.directory / "grains.data").write_text(lone)
        text = bench.run(bed.script("run 2000")).text
        self.assertEqual(text.count("1 of 1 grains are alone"), 1)
        self.assertIn("set coupling.kernel_width", text)

    def test_drag_that_follows_the_grains_keeps_the_momentum(self):
        # intervals of changing length, from the limits; the engines agree
        rows = {}
        for engine, ranks in (("auto", 2), ("off", 1), ("auto", 1)):
            with self.subTest(engine=engine, ranks=ranks):
                bench = bed.bench(bed.case(coupling='series_interval = 5e-4\n'
                                                    'drag_update = "dem-step"'))
                bench.run(bed.script(f"gasgrain_engine {engine}\nrun 400"), ranks=ranks)
                found = bed.quantities(bench.directory)
                self.assertLess(found["momentum_balance_residual"], 1e-9)
                self.assertLess(found["third_law_residual"], 1e-12)
                rows[engine, ranks] = bed.series(bench.directory)
        for row, expected in zip(rows["auto", 1], rows["off", 1], strict=True):
            for name in ("pressure_drop", "kinetic_energy", "in_transit"):
                self.assertAlmostEqual(row[name], expected[name],
                                       delta=1e-6 * max(abs(expected[name]), 1e-6), msg=name)

    def test_drag_that_follows_the_grains_returns_the_difference_of_impulses(self):
        # What was given and not yet received stays the force on the grains times one interval;
        # differences that were lost would add up (a change of 0.07 here).
        bench = bed.bench(bed.case(coupling='series_interval = 5e-4\nexchange_interval = 3e-4\n'
                                            'drag_update = "dem-step"'))
        bench.run(bed.script("run 600"))
        impulse, time, shares = 0.0, 0.0, []
        for row in bed.series(bench.directory):
            impulse -= row["in_transit"] * (row["time"] - time)
            time = row["time"]
            shares.append(impulse / (row["pressure_drop"] * bed.AREA * row["interval"]))
        self.assertGreater(shares[0], 0.5)
        self.assertAlmostEqual(shares[-1], shares[0], delta=0.03)

    def test_audit_does_not_take_the_work_of_a_moving_wall_for_heating(self):
        # the tube shakes the bed far above the energy that the gas gives
        moving = ('name = "tube"\nmotion = {oscillate = {amplitude = [0.0005, 0, 0.0005], '
                  'frequency = 100}}')
        bench = bed.bench(bed.changed(bed.case(coupling="series_interval = 5e-4"),
                                      'name = "tube"', moving))
        done = bench.run(bed.script("run 400"), ranks=2)
        self.assertNotIn("audit", done.text)
        found = bed.quantities(bench.directory)
        self.assertEqual(found["audit_violations"], 0)
        self.assertLess(found["momentum_balance_residual"], 1e-9)
        self.assertLess(min(row["dissipation"] for row in bed.series(bench.directory)), 0.0)

    def test_balance_knows_grains_that_leave_and_that_are_inserted(self):
        jet = ("region jet block 0.001 0.0065 0.001 0.004 0.0073 0.009 units box\n"
               "group jet region jet\nvelocity jet set 0 0 3.0\n")
        insertion = ("region space block 0.001 0.0065 0.001 0.004 0.012 0.018 units box\n"
                     "fix original all particletemplate/sphere 15485863 atom_type 1 density constant "
                     "2500 radius constant 50e-6\n"
                     "fix mixture all particledistribution/discrete 32452843 1 original 1.0\n"
                     "fix insert all insert/pack seed 49979687 distributiontemplate mixture "
                     "insert_every 400 overlapcheck yes all_in yes vel constant 0.1 0.2 -0.7 "
                     "particles_in_region 30 region space\n")
        for engine in ("auto", "off"):
            with self.subTest(engine=engine):
                bench = bed.bench(bed.case(coupling="series_interval = 2e-4"))
                bench.run(bed.script(f"gasgrain_engine {engine}\n" + jet + "run 700\n" + insertion
                                     + "run 1000\n"), ranks=2)
                found = bed.quantities(bench.directory)
                self.assertGreater(found["grains_left"], 10)
                self.assertGreater(found["grains_appeared"], 20)
                self.assertLess(found["momentum_balance_residual"], 1e-9)
                rows = bed.series(bench.directory)
                self.assertEqual({row["unexplained_grains"] for row in rows}, {0.0})
                self.assertGreater(max(abs(row["grain_passage"]) for row in rows),
                                   0.1 * bed.weight())

    def test_bed_between_stock_mesh_walls(self):
        """Floor and left side as triangles: of the floor's force the balance has to know."""
        width, depth, height = bed.BOX
        floor = stl([((0, 0, 0), (width, 0, 0), (width, depth, 0)),
                     ((0, 0, 0), (width, depth, 0), (0, depth, 0))])
        left = stl([((0, 0, 0), (0, depth, 0), (0, depth, height)),
                    ((0, 0, 0), (0, depth, height), (0, 0, height))])
        text = bed.script(dump_command("d", 100) + "run 700")
        for name in ("floor", "left"):
            text = text.replace(f"fix {name} all wall/sdf case case.toml body {name} type 2",
                                f"fix {name} all mesh/surface file {name}.stl type 2")
        text = text.replace("fix gas ", "fix meshes all wall/gran model cgm tangential history "
                                        "mesh n_meshes 2 meshes floor left\nfix gas ")
        frames = {}
        for engine in ("off", "fused"):
            with self.subTest(engine=engine):
                bench = bed.bench(bed.case(bottom=bed.inlet(0.02), coupling="series_interval = 2e-4"))
                (bench.directory / "floor.stl").write_text(floor)
                (bench.directory / "left.stl").write_text(left)
                bench.run(f"gasgrain_engine {engine}\n{text}", ranks=2)
                found = bed.quantities(bench.directory)
                self.assertLess(found["momentum_balance_residual"], 1e-9)
                self.assertGreater(max(abs(row["walls_on_grains"])
                                       for row in bed.series(bench.directory)), 0.1 * bed.weight())
                frames[engine] = bench.frames("d.dump")
        self.assertLess(largest_difference(frames["fused"], frames["off"], SCALE), 1e-8)

    def test_stops_at_a_residual_beyond_its_bound_when_asked(self):
        script = bed.script("fix push all addforce 0 0 1e-8\nrun 2000")  # nobody measures it
        script = script.replace("coarsegraining 5", "coarsegraining 5 model_check warn")
        for reaction in ("warn", "stop"):
            with self.subTest(reaction=reaction):
                bench = bed.bench(bed.case(coupling=f'audit = {{on_violation = "{reaction}"}}'))
                done = bench.run(script, check=False)
                self.assertIn("momentum residual", done.text)
                self.assertIn("exceeds coupling.audit.momentum = 1e-06", done.text)
                if reaction == "stop":
                    self.assertNotEqual(done.code, 0)
                    self.assertEqual(len(bed.series(bench.directory)), 1)
                else:
                    self.assertEqual(done.code, 0)
                    self.assertEqual(done.text.count("WARNING: audit"), 1)
                    self.assertGreater(bed.quantities(bench.directory)["audit_violations"], 5)

    def test_energy_that_the_gas_and_weight_give_is_dissipated(self):
        bench = bed.bench(bed.case(coupling="series_interval = 2e-4"))
        bench.run(bed.script("run 4000"), ranks=2)
        found, rows = bed.quantities(bench.directory), bed.series(bench.directory)
        stored = [row["kinetic_energy"] + row["rotation_energy"] + row["potential_energy"]
                  + row["elastic_energy"] for row in rows]
        interval = [b["time"] - a["time"] for a, b in zip(rows, rows[1:])]
        for before, after, row, time in zip(stored, stored[1:], rows[1:], interval):
            self.assertAlmostEqual(after - before, (row["gas_power"] - row["dissipation"]) * time,
                                   delta=1e-6 * max(stored))
        self.assertGreater(found["dissipated_energy"], 0.0)
        self.assertGreater(found["elastic_energy"], 0.0)
        self.assertLess(found["heating_max"], 0.1)

    def test_several_runs_continue_one_another(self):
        whole = bed.bench(bed.case(coupling="series_interval = 1e-4"))
        whole.run(bed.script("run 200"))
        pieces = bed.bench(bed.case(coupling="series_interval = 1e-4"))
        pieces.run(bed.script("run 0\nrun 100\nrun 100"))
        for row, expected in zip(bed.series(pieces.directory), bed.series(whole.directory),
                                 strict=True):
            for name, value in expected.items():
                self.assertAlmostEqual(row[name], value, delta=1e-9 * max(1.0, abs(value)),
                                       msg=name)

    def test_grains_come_to_rest_without_a_flow(self):
        bench = bed.bench(bed.case(bottom="no-slip"))
        bench.run(bed.script("run 15000"), ranks=2)
        energy = [row["kinetic_energy"] for row in bed.series(bench.directory)]
        self.assertLess(energy[-1], 1e-4 * max(energy))
        self.assertLess(max(energy[-10:]), max(energy[-40:-30]))


class BadInput(unittest.TestCase):
    def assert_fails(self, expected, case_text=None, script=None, ranks=2):
        bench = bed.bench(case_text or bed.case())
        done = bench.run(script or bed.script("run 10"), ranks=ranks, check=False)
        self.assertNotEqual(done.code, 0)
        errors = [line for line in done.text.splitlines() if line.startswith("ERROR")]
        self.assertEqual(len(errors), 1, done.text[-2000:])
        for part in expected:
            self.assertIn(part, errors[0])
        self.assertFalse((bench.directory / "out" / "summary.json").exists())

    def test_case_file_that_does_not_exist(self):
        script = bed.script("run 10").replace("couple/gas case case.toml", "couple/gas case x.toml")
        self.assert_fails(["x.toml", "cannot read"], script=script)

    def test_unknown_key_suggests_the_nearest(self):
        self.assert_fails(["coupling.exchange_intervl", "exchange_interval"],
                          bed.case(coupling="exchange_intervl = 1e-4"))

    def test_unknown_drag_law(self):
        self.assert_fails(["coupling.drag", "gidaspow"], bed.case(coupling='drag = "ergn"'))

    def test_value_out_of_range(self):
        self.assert_fails(["coupling.exchange_interval", "-1"],
                          bed.case(coupling="exchange_interval = -1"))

    def test_unknown_keyword_of_the_fix(self):
        script = bed.script("run 10").replace("out out", "output out")
        self.assert_fails(["fix gas couple/gas", "'output'"], script=script)

    def test_more_ranks_than_layers(self):
        thin = bed.changed(bed.case(), "cells = [6, 4, 16]", "cells = [1, 1, 2]")
        self.assert_fails(["cells"], thin, ranks=3)


if __name__ == "__main__":
    unittest.main()
