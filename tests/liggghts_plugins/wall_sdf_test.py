"""fix wall/sdf against stock LIGGGHTS: primitive walls where there are such, a frozen grain as sphere
wall; balance of a grain resting in corners; conservation of energy with a sampled field."""

import math
import unittest

from liggghts_run import (Bench, Grain, STOCK_OPTIONS, cgm_properties, damping, data_file,
                          dump_command, largest_difference, preamble, sphere_mass,
                          stock_properties, thermo)

R0, DENSITY, K, E, L = 50e-6, 2500.0, 50.0, 0.9, 5.0
RADIUS = L * R0
MASS = sphere_mass(RADIUS, DENSITY)
SPEED, STEP = 0.1, 2e-7  # Tc/80 of the wall contact
BOX = [-2e-3] * 3, [2e-3] * 3

# walls that contain the origin in the flow domain
BODIES = """
[[body]]
name = "plane"
plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}
[[body]]
name = "pipe"
complement = {cylinder = {point = [0, 0, 0], axis = [0, 0, 1], radius = 0.6e-3}}
[[body]]
name = "ball"
sphere = {center = [0, 0, -0.8e-3], radius = 0.5e-3}
[[body]]
name = "belt"
plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}
surface_velocity = [0.05, 0.02, 0]
[[body]]
name = "left"
plane = {point = [-0.3e-3, 0, 0], normal = [1, 0, 0]}
[[body]]
name = "front"
plane = {point = [0, -0.3e-3, 0], normal = [0, 1, 0]}
[[body]]
name = "slope"
plane = {point = [0.3e-3, 0, 0], normal = [-1, 0, 1]}
[[body]]
name = "piston"
plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}
motion = {translate = {velocity = [0.03, -0.02, 0.05]}}
[[body]]
name = "drum"
complement = {cylinder = {point = [0, 0, 0], axis = [0, 0, 1], radius = 0.6e-3}}
motion = {rotate = {point = [0, 0, 0], axis = [0, 0, 1], rate = 300}}
[[body]]
name = "mantle"
complement = {cylinder = {point = [0, 0, 0], axis = [0, 0, 1], radius = 0.6e-3}}
motion = {rotate = {point = [0, 0, 0], axis = [0, 0, 1], rate = 300}, surface_only = true}
[[body]]
name = "paddle"
box = {lower = [-1e-3, -0.2e-3, -1e-3], upper = [1e-3, -0.3e-4, -0.3e-3]}
motion = {rotate = {point = [0, 0, -0.3e-3], axis = [0, 1, 0], rate = 80}}
[[body]]
name = "bin"
complement = {box = {lower = [-0.3e-3, -0.3e-3, -0.3e-3], upper = [2e-3, 2e-3, 2e-3]}}
[[body]]
name = "sampled_bin"
complement = {box = {lower = [-0.3e-3, -0.3e-3, -0.3e-3], upper = [2e-3, 2e-3, 2e-3]}}
spacing = 0.06e-3
lower = [-1e-3, -1e-3, -1e-3]
upper = [1e-3, 1e-3, 1e-3]
cut = true
[[body]]
name = "groove"
union = [{plane = {point = [0, 0, -0.3e-3], normal = [0, 0, 1]}},
         {plane = {point = [0.3e-3, 0, 0], normal = [-1, 0, 1]}}]
[[body]]
name = "turning_bin"
complement = {box = {lower = [-0.3e-3, -0.3e-3, -0.3e-3], upper = [0.35e-3, 0.3e-3, 0.4e-3]}}
motion = {rotate = {point = [0, 0, 0], axis = [1, 2, 0], rate = 60}}
[grid]
cells = [1, 1, 1]
"""


def flying_grain(velocity, spin=(20, -50, 30)):
    return [Grain((0, 0, 0), RADIUS, velocity, spin)]


def bench_of(grains):
    return Bench({"case.toml": BODIES, "grains.data": data_file(grains, *BOX, types=2)})


def script(l, pair, properties, walls, steps=8000, every=50, dump="x y z vx vy vz omegax omegay "
           "omegaz fx fy fz", extra=""):
    return (preamble("grains.data", skin=1e-5, l=l) + properties +
            f"pair_style gran model {pair}\npair_coeff * *\ntimestep {STEP}\n"
            f"fix integrate all nve/sphere\n{walls}\n{extra}\n" + dump_command("d", every, dump) +
            f"run {steps}\n")


def with_sdf(body, **options):
    return script(L, "cgm tangential history", cgm_properties(2, K, E),
                  f"fix w all wall/sdf case case.toml body {body} type 2", **options)


def with_stock(wall, **options):
    eta_wall = damping(E, MASS, L**3 * K)
    properties = stock_properties(L**3 * K, damping(E, MASS / 2, L**3 * K), eta_wall)
    pair = f"hooke/stiffness tangential history {STOCK_OPTIONS}"
    return script(1.0, pair, properties, wall, **options)


def primitive(arguments, more=""):
    return (f"fix w all wall/gran model hooke/stiffness tangential history primitive type 2 "
            f"{arguments} {STOCK_OPTIONS} {more}")


SCALE = [RADIUS] * 3 + [SPEED] * 3 + [SPEED / RADIUS] * 3 + [MASS * SPEED / 1e-5] * 3


class BouncingGrain(unittest.TestCase):
    def assert_equal(self, velocity, sdf, stock, tolerance, grains=None):
        bench = bench_of(grains or flying_grain(velocity))
        bench.run(stock)
        reference = bench.frames("d.dump")
        bench.run(sdf)
        frames = bench.frames("d.dump")
        ids = {1}
        frames = [{i: f[i] for i in ids} for f in frames]
        reference = [{i: f[i] for i in ids} for f in reference]
        self.assertLess(largest_difference(frames, reference, SCALE), tolerance)
        turned = max(abs(a - b) for a, b in zip(reference[0][1][3:6], reference[-1][1][3:6]))
        self.assertGreater(turned, 0.1 * SPEED)  # it did bounce

    def test_plane_equals_stock_primitive(self):
        velocity = (0.06, 0.01, -SPEED)
        self.assert_equal(velocity, with_sdf("plane"), with_stock(primitive("zplane -0.3e-3")),
                          1e-11)

    def test_cylinder_equals_stock_primitive(self):
        velocity = (SPEED, 0.03, 0.05)
        self.assert_equal(velocity, with_sdf("pipe", steps=60000, every=500),
                          with_stock(primitive("zcylinder 0.6e-3 0 0"), steps=60000, every=500),
                          1e-9)

    def test_sphere_equals_frozen_grain(self):
        velocity = (0.02, 0.01, -SPEED)
        fixed = [*flying_grain(velocity), Grain((0, 0, -0.8e-3), 0.5e-3, type=2)]
        hold = "group ball type 2\nfix hold ball freeze"
        move = "group free type 1\nunfix integrate\nfix integrate free nve/sphere\n"
        bench = bench_of(fixed)
        bench.run(with_stock("", extra=move + hold, steps=12000))
        reference = [{1: f[1]} for f in bench.frames("d.dump")]
        alone = bench_of(flying_grain(velocity))
        alone.run(with_sdf("ball", steps=12000))
        self.assertLess(largest_difference(alone.frames("d.dump"), reference, SCALE), 1e-10)
        self.assertGreater(reference[-1][1][5], 0)

    def test_moving_belt_equals_grain_thrown_the_other_way(self):
        """Galilean invariance: a belt moving with V is a plane hit with the velocity less V."""
        belt, plane = bench_of(flying_grain((0.06, 0.01, -SPEED))), \
            bench_of(flying_grain((0.06 - 0.05, 0.01 - 0.02, -SPEED)))
        belt.run(with_sdf("belt"))
        plane.run(with_sdf("plane"))
        on_belt, on_plane = belt.frames("d.dump")[-1][1], plane.frames("d.dump")[-1][1]
        for value, reference, shift in zip(on_belt[3:9], on_plane[3:9], (0.05, 0.02, 0, 0, 0, 0)):
            self.assertAlmostEqual(value, reference + shift, delta=1e-9)

    def test_wall_gran_with_model_cgm_equals_wall_sdf(self):
        bench = bench_of(flying_grain((0.06, 0.01, -SPEED)))
        bench.run(with_sdf("plane"))
        reference = bench.frames("d.dump")
        bench.run(script(L, "cgm tangential history", cgm_properties(2, K, E),
                         "fix w all wall/gran model cgm tangential history primitive type 2 "
                         "zplane -0.3e-3"))
        self.assertLess(largest_difference(bench.frames("d.dump"), reference, SCALE), 1e-11)


def last_states(script_text, grains, ranks=1):
    bench = bench_of(grains)
    bench.run(script_text, ranks=ranks)
    return bench.frames("d.dump")


class MovingWall(unittest.TestCase):
    def test_piston_equals_grain_in_its_frame(self):
        """Galilean invariance, now with a wall that is elsewhere at every step."""
        velocity, piston = (0.06, 0.01, -SPEED), (0.03, -0.02, 0.05)
        thrown = tuple(v - p for v, p in zip(velocity, piston))
        moving = last_states(with_sdf("piston"), flying_grain(velocity))
        resting = last_states(with_sdf("plane"), flying_grain(thrown))
        self.assertGreater(resting[-1][1][5], 0.5 * SPEED)  # it did bounce
        for n, (frame, reference) in enumerate(zip(moving, resting)):
            time = n * 50 * STEP
            for d in range(3):
                self.assertAlmostEqual((frame[1][d] - piston[d] * time) / RADIUS,
                                       reference[1][d] / RADIUS, delta=1e-9)
                self.assertAlmostEqual((frame[1][3 + d] - piston[d]) / SPEED,
                                       reference[1][3 + d] / SPEED, delta=1e-9)
                self.assertAlmostEqual(frame[1][6 + d] * RADIUS / SPEED,
                                       reference[1][6 + d] * RADIUS / SPEED, delta=1e-9)

    def test_turning_drum_equals_a_moving_surface(self):
        """The drum is round: that it turns shows in the velocity of its surface alone, but for the
        turn of the spring within a step, of second order in rate * step = 6e-5."""
        velocity = (SPEED, 0.03, 0.05)
        turning = last_states(with_sdf("drum", steps=30000, every=500), flying_grain(velocity))
        surface = last_states(with_sdf("mantle", steps=30000, every=500), flying_grain(velocity))
        still = last_states(with_sdf("pipe", steps=30000, every=500), flying_grain(velocity))
        self.assertLess(largest_difference(turning, surface, SCALE), 1e-3)
        self.assertGreater(largest_difference(turning, still, SCALE), 0.1)

    def test_engine_and_stock_loop_agree(self):
        for body in ("piston", "paddle", "turning_bin", "bin"):
            with self.subTest(body=body):
                frames = [last_states(f"gasgrain_engine {mode}\n" +
                                      with_sdf(body, steps=20000, every=200),
                                      flying_grain((0.06, -0.08, -SPEED)))
                          for mode in ("off", "fused")]
                self.assertLess(largest_difference(*frames, SCALE), 1e-7)
                turned = max(abs(a - b) for a, b in zip(frames[0][0][1][3:6], frames[0][-1][1][3:6]))
                self.assertGreater(turned, 0.1 * SPEED)

    def test_a_paddle_reaches_grains_that_never_move(self):
        """The wall alone comes near: it must ask for new lists."""
        grains = flying_grain((0, 0, 0), spin=(0, 0, 0))
        for mode in ("off", "fused"):
            frames = last_states(f"gasgrain_engine {mode}\n" + with_sdf("paddle", steps=60000,
                                                                        every=1000), grains)
            self.assertGreater(math.hypot(*frames[-1][1][3:6]), 0.02)


class ConcaveEdge(unittest.TestCase):
    """One body with a concave edge equals the walls that it is made of."""

    PLANES = "\n".join(f"fix {b} all wall/sdf case case.toml body {b} type 2"
                       for b in ("left", "front", "plane"))

    def of_bodies(self, walls, grains, **options):
        return last_states(script(L, "cgm tangential history", cgm_properties(2, K, E), walls,
                                  **options), grains)

    def test_box_corner_equals_three_planes(self):
        grain = flying_grain((-0.07, -0.08, -SPEED))
        one = last_states(with_sdf("bin", steps=12000), grain)
        three = self.of_bodies(self.PLANES, grain, steps=12000)
        self.assertLess(largest_difference(one, three, SCALE), 1e-9)
        for d in range(3):
            self.assertGreater(three[-1][1][3 + d], 0)  # all walls were hit

    def test_groove_of_a_union_equals_two_planes(self):
        grain = flying_grain((0.07, 0.01, -SPEED))
        walls = "\n".join(f"fix {b} all wall/sdf case case.toml body {b} type 2"
                          for b in ("plane", "slope"))
        one = last_states(with_sdf("groove", steps=12000), grain)
        self.assertLess(largest_difference(one, self.of_bodies(walls, grain, steps=12000), SCALE),
                        1e-9)

    def settled_in(self, walls, gravity=(-3.0, -4.0, -9.0), friction=0.3):
        g = math.sqrt(sum(c * c for c in gravity))
        direction = " ".join(str(c / g) for c in gravity)
        text = script(L, "cgm tangential history", cgm_properties(2, 0.05, 0.05, friction), walls,
                      steps=100000, every=10000,
                      extra=f"fix gravity all gravity {g} vector {direction}\n")
        return last_states(text.replace(f"timestep {STEP}", "timestep 1e-6"),
                           flying_grain((0, 0, 0), spin=(0, 0, 0)))

    def test_a_grain_rests_in_a_corner_of_samples(self):
        """Samples a quarter of the radius apart: the corner is where the planes meet, to a
        fiftieth of the overlap of the softest load, and the grain lies still; with friction too."""
        for friction in (0.0, 0.3):
            with self.subTest(friction=friction):
                self.check_corner_of_samples(friction)

    def check_corner_of_samples(self, friction):
        sampled = self.settled_in("fix w all wall/sdf case case.toml body sampled_bin type 2",
                                  friction=friction)
        planes = self.settled_in(self.PLANES, friction=friction)
        overlap = 9.0 * MASS / (L**3 * 0.05)
        for d in range(3):
            self.assertAlmostEqual(sampled[-1][1][d], planes[-1][1][d], delta=0.02 * overlap)
            self.assertLess(abs(sampled[-1][1][3 + d]), 1e-4 * SPEED)
            self.assertAlmostEqual(sampled[-1][1][9 + d] / (MASS * 9),
                                   planes[-1][1][9 + d] / (MASS * 9), delta=1e-2)

    def test_springs_survive_the_first_new_lists(self):
        """A grain that slides and comes to roll moves alike with new lists in every step."""
        overlap = 9.81 * MASS / (L**3 * 0.05)
        grain = [Grain((0, 0, -0.3e-3 + RADIUS - overlap), RADIUS, (0.01, 0, 0))]
        frames = {}
        for every in (1, 300):
            text = script(L, "cgm tangential history", cgm_properties(2, 0.05, 0.8),
                          "fix w all wall/sdf case case.toml body plane type 2", steps=600,
                          extra="fix gravity all gravity 9.81 vector 0 0 -1")
            text = text.replace("delay 0", f"delay 0 every {every} check no")
            frames[every] = last_states("gasgrain_engine off\n" +
                                        text.replace(f"timestep {STEP}", "timestep 1e-6"), grain)
        self.assertGreater(abs(frames[1][6][1][9]), 0.1 * MASS * 9.81)  # when lists are made anew
        self.assertLess(largest_difference(frames[1], frames[300], SCALE), 1e-12)

    def test_springs_of_an_edge_survive_a_restart(self):
        walls = "fix w all wall/sdf case case.toml body bin type 2"
        text = script(L, "cgm tangential history", cgm_properties(2, 0.05, 0.05), walls,
                      steps=30000, every=1000,
                      extra="fix gravity all gravity 10 vector -0.3 -0.5 -0.8\n")
        text = text.replace(f"timestep {STEP}", "timestep 1e-6")
        bench = bench_of(flying_grain((0, 0, 0)))
        bench.run(text.replace("run 30000", "restart 15000 r1 r2\nrun 30000"))
        whole = bench.frames("d.dump")[-1]
        bench.run(text.replace("read_data grains.data", "read_restart r1")
                  .replace("run 30000", "run 15000"))
        self.assertLess(largest_difference([bench.frames("d.dump")[-1]], [whole], SCALE), 1e-9)


class RestingGrain(unittest.TestCase):
    """Gravity pushes a grain into a corner; after the bounces have died down each body carries what
    the balance of forces says."""

    def settle(self, bodies, gravity, mu=0.0):
        walls = "\n".join(f"fix {b} all wall/sdf case case.toml body {b} type 2" for b in bodies)
        g = math.sqrt(sum(c * c for c in gravity))
        direction = " ".join(str(c / g) for c in gravity)
        columns = " ".join(f"f_{b}[{i}]" for b in bodies for i in range(1, 9))
        bench = bench_of(flying_grain((0, 0, 0), spin=(0, 0, 0)))
        # a soft spring and strong damping, so that it comes to rest soon
        result = bench.run(
            script(L, "cgm tangential history", cgm_properties(2, 0.05, 0.05, mu), walls,
                   steps=150000, every=150000,
                   extra=f"fix gravity all gravity {g} vector {direction}\nthermo 150000\n"
                   f"thermo_style custom step {columns}\nthermo_modify format float %.15g\n")
            .replace(f"timestep {STEP}", "timestep 1e-6"))
        row = thermo(result.log)[-1][1:]
        return {b: row[8 * n:8 * n + 8] for n, b in enumerate(bodies)}

    def test_in_a_box_corner_each_wall_carries_its_component(self):
        gravity = (-3.0, -4.0, -9.0)
        loads = self.settle(("left", "front", "plane"), gravity)
        for axis, body in enumerate(("left", "front", "plane")):
            force = loads[body][:3]
            for d in range(3):
                expected = MASS * gravity[d] if d == axis else 0.0
                self.assertAlmostEqual(force[d] / (MASS * 9), expected / (MASS * 9), delta=1e-6)
            self.assertEqual(loads[body][6], 1)
            # overlap of the spring l^3 k
            self.assertAlmostEqual(loads[body][7], -MASS * gravity[axis] / (L**3 * 0.05),
                                   delta=1e-5 * RADIUS)

    def test_between_floor_and_slope_of_two_bodies(self):
        """Floor normal (0, 0, 1), slope normal (-1, 0, 1)/sqrt 2, gravity with a part along +x."""
        gravity = (5.0, 0.0, -9.0)
        loads = self.settle(("plane", "slope"), gravity)
        slope = MASS * 5.0 * math.sqrt(2)  # its x component balances gravity
        floor = MASS * 9.0 - slope / math.sqrt(2)
        self.assertAlmostEqual(-loads["plane"][2] / floor, 1, delta=1e-5)
        self.assertAlmostEqual(loads["slope"][0] / (slope / math.sqrt(2)), 1, delta=1e-5)
        self.assertAlmostEqual(-loads["slope"][2] / (slope / math.sqrt(2)), 1, delta=1e-5)

    def test_torque_on_body_is_lever_times_force(self):
        loads = self.settle(("left", "plane"), (-3.0, 0.0, -9.0))
        # normal force of the floor, through the centre at x = -0.3 mm + r (less the overlap)
        x = -0.3e-3 + RADIUS - loads["left"][7]
        self.assertAlmostEqual(loads["plane"][4] / (x * -loads["plane"][2]), 1, delta=1e-5)


class ElasticGrain(unittest.TestCase):
    """e = 1, no friction. The force is the gradient of a potential, so free flights between bounces
    keep their energy but for the error of the time step (Tc/80, Tc/320; about 25 bounces)."""

    VESSELS = """
[[body]]
name = "vessel"
complement = {sphere = {center = [0, 0, 0], radius = 1.0e-3}}
SAMPLING
"""
    SAMPLED = "spacing = 0.1e-3\nlower = [-1.6e-3, -1.6e-3, -1.6e-3]\nupper = [1.6e-3, 1.6e-3, 1.6e-3]\n"

    def energy_drift(self, sampling, step):
        grain = Grain((1e-4, 2e-4, -1e-4), RADIUS, (0.3, -0.2, 0.25))
        bench = Bench({"case.toml": self.VESSELS.replace("SAMPLING", sampling),
                       "grains.data": data_file([grain], *BOX, types=2)})
        steps = round(0.08 / step)
        bench.run(script(L, "cgm tangential off", cgm_properties(2, K, 1.0),
                         "fix w all wall/sdf case case.toml body vessel type 2 tangential off",
                         steps=steps, every=steps // 1000, dump="vx vy vz fx fy fz",
                         ).replace(f"timestep {STEP}", f"timestep {step}"))
        energies = [sum(v * v for v in f[1][:3]) for f in bench.frames("d.dump")
                    if not any(f[1][3:])]  # in free flight
        bounces = sum(1 for a, b in zip(energies, energies[1:]) if a != b)
        self.assertGreater(bounces, 10)
        return max(abs(e / energies[0] - 1) for e in energies)

    def check(self, sampling):
        # the drift of the time step vanishes with it; a force that is not a gradient keeps its own
        self.assertLess(self.energy_drift(sampling, 2e-7), 4e-3)
        self.assertLess(self.energy_drift(sampling, 5e-8), 2e-4)

    def test_exact_sphere_keeps_energy(self):
        self.check("")

    def test_sampled_sphere_keeps_energy(self):
        self.check(self.SAMPLED)


if __name__ == "__main__":
    unittest.main()
