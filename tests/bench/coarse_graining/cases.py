"""The runs of the benchmark, in the order in which they are made."""

from dry_scenes import COLUMN, DRUM, HOPPER, hopper_mesh
from gas_scenes import BED, DIE, die_mesh
from laws import LAWS
from scene import Case

SCENES = {scene.name: scene for scene in (COLUMN, HOPPER, DRUM, BED, DIE)}
MESHES = {"hopper": ("plates.stl", hopper_mesh), "die": ("ledges.stl", die_mesh)}
SEEDS = (1, 2, 3)
RATIOS = (4, 3, 2)
TRUTH = "cgm-n3"  # l = 1, where n has no meaning

# One factor at a time, at l = 2 with n = 3 (spacing and step also show at l = 2).
FACTOR_RATIO, FACTOR_LAW = 2, "cgm-n3"
STEPS = ("8", "16", "25", "50")  # contact time over step
SPRINGS = {"column": ("1", "10", "1000"), "hopper": ("10", "1000"), "drum": ("10", "1000"),
           "bed": ("1", "10", "500"), "die": ("1", "100")}
INTERVALS = {"bed": ("5e-5", "2e-4", "1e-3"), "die": ("2e-5", "1e-4", "5e-4")}  # s
CELLS = {"bed": ("6.25e-4", "8.3333e-4", "2.5e-3"), "die": ("2.5e-4", "1e-3")}  # m
KERNELS = {"bed": ("6e-4", "2e-3", "3e-3"), "die": ("2.4e-4", "1e-3")}  # m
SPACINGS = ("0.1", "0.25", "0.5")  # over the grain radius


def truths(scene):
    return [Case(scene, TRUTH, 1, seed) for seed in SEEDS]


def coarse(scene):
    return [Case(scene, law, l, seed) for seed in SEEDS for l in RATIOS for law in LAWS]


def factors(scene):
    values = [("step", STEPS), ("spring", SPRINGS.get(scene, ())),
              ("interval", INTERVALS.get(scene, ())), ("cell", CELLS.get(scene, ())),
              ("kernel", KERNELS.get(scene, ())),
              ("spacing", SPACINGS if SCENES[scene].sampled_wall else ())]
    return [Case(scene, FACTOR_LAW, FACTOR_RATIO, seed, factor, value)
            for factor, choices in values for value in choices for seed in SEEDS]


def stock_truths(scene):
    """What the originals cost in stock, and whether its laws agree at l = 1."""
    return [Case(scene, law, 1, 1) for law in ("stock-hand", "stock-hertz")]


def all_cases():
    """Scene by scene the truth and the laws; then the factors."""
    cases = []
    for scene in SCENES:
        cases += truths(scene) + coarse(scene)
    for scene in SCENES:
        cases += factors(scene)
    for scene in SCENES:
        cases += stock_truths(scene)
    return cases
