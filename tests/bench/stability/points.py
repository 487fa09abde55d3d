"""The points of the map: one factor at a time from three base points, then corners."""

import dataclasses

# factor: what it is
FACTORS = {
    "interval": "coupling interval over the predicted limit 2 eps^2 m / B",
    "gas_step": "largest gas step, s",
    "void": "void fraction",
    "density_ratio": "density of the grains over that of the gas",
    "cell": "edge of a gas cell over the grain diameter",
    "velocity": "superficial velocity, or that of the jet, m/s",
    "l": "coarse-grain ratio",
    "spring": "spring constant of the original particle, N/m",
}


@dataclasses.dataclass(frozen=True)
class Point:
    scene: str  # plug, bed, jet
    interval: float = 0.25  # over the predicted limit; 0: the default of the coupling
    gas_step: float = 1e-4  # s
    void: float = 0.6  # plug only; a bed has what its grains settle to
    density_ratio: float = 2000.0
    cell: float = 1.5
    velocity: float = 0.3  # m/s; bed: over the velocity of minimum fluidization
    l: float = 1.0
    spring: float = 100.0  # N/m
    diameter: float = 5e-4  # of the original, m
    varied: str = ""  # the factor, or the corner's name

    @property
    def name(self):
        value = f"={getattr(self, self.varied):g}" if self.varied in FACTORS else ""
        return f"{self.scene} {self.varied or 'base'}{value}"

    @property
    def is_within(self):
        """No refusal is allowed here."""
        return (self.interval <= 0.5 and self.cell >= 1.2
                and (self.scene != "plug" or self.void >= 0.35) and self.velocity <= 50)


PLUG = Point("plug", diameter=2e-4)
BED = Point("bed", velocity=0.3)
JET = Point("jet", velocity=15.0, diameter=2e-3, interval=0.0, spring=1e4)

VALUES = {
    "plug": {
        "interval": (0.1, 0.25, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0),
        "gas_step": (1e-6, 1e-5, 1e-3),
        "void": (0.30, 0.35, 0.4, 0.5, 0.7, 0.75, 0.85, 0.9, 0.95, 0.99, 0.999),
        "density_ratio": (1.2, 2.0, 5.0, 20.0, 200.0, 1e4),
        "cell": (1.0, 1.2, 2.0, 3.0, 4.0, 6.0, 8.0),
        "velocity": (0.01, 0.1, 1.0, 5.0, 20.0, 50.0),
        "l": (2, 5, 10, 20),
    },
    "bed": {
        "interval": (0.0, 0.1, 0.5, 1.0, 2.0),
        "gas_step": (1e-5, 1e-3),
        "density_ratio": (1.2, 2.0, 10.0, 1e4),
        "cell": (1.0, 1.2, 2.0, 4.0, 8.0),
        "velocity": (0.1, 0.2),
        "l": (2, 5, 20),
        "spring": (1.0, 10.0, 1e3, 1e4, 1e5),
    },
    "jet": {
        "interval": (0.1, 0.5, 1.0, 2.0),
        "gas_step": (1e-5, 1e-3),
        "density_ratio": (10.0, 100.0, 1e4),
        "cell": (1.2, 2.0, 3.0),
        "velocity": (5.0, 30.0, 50.0),
        "l": (4, 20),
        "spring": (1e3, 1e5),
    },
}

CORNERS = (
    (PLUG, "dense light long", {"void": 0.35, "density_ratio": 1.2, "interval": 0.5}),
    (PLUG, "dense light short", {"void": 0.35, "density_ratio": 1.2, "interval": 0.05}),
    (PLUG, "dense light fine", {"void": 0.35, "density_ratio": 1.2, "cell": 1.2}),
    (PLUG, "dense fast", {"void": 0.35, "velocity": 50.0, "cell": 1.2}),
    (PLUG, "dilute light", {"void": 0.95, "density_ratio": 1.2, "interval": 0.5}),
    (PLUG, "dense heavy long coarse", {"void": 0.35, "density_ratio": 1e4, "interval": 0.5,
                                       "cell": 8.0}),
    (BED, "light long", {"density_ratio": 1.2, "interval": 0.5}),
    (BED, "hard coarse", {"spring": 1e4, "l": 20, "cell": 4.0}),
    (BED, "light fine soft", {"density_ratio": 1.2, "cell": 1.2, "spring": 1.0}),
    (JET, "fast long", {"velocity": 50.0, "interval": 0.5, "cell": 1.2}),
    (JET, "fast light", {"velocity": 50.0, "density_ratio": 100.0, "interval": 0.5}),
)


def all_points():
    points = []
    for base in (PLUG, BED, JET):
        points.append(base)
        for factor, values in VALUES[base.scene].items():
            points += [dataclasses.replace(base, varied=factor, **{factor: value})
                       for value in values]
    points += [dataclasses.replace(base, varied=name, **changed) for base, name, changed in CORNERS]
    return points
