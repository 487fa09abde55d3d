"""What a point's results say: stable and accurate, refused, or failed."""

import collections
import math
import pathlib
import sys

import numpy

import scenes

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "examples"))

import frames  # noqa: E402

ACCURATE = 0.02  # pressure drop against the law
MOMENTUM, EXCHANGE = 1e-6, 1e-11  # the audit's bounds; heating, a ratio of nothings for grains at
# rest and as rough as the trapezoidal rule over long intervals, is in the table only
AT_REST = 1e-5  # kinetic energy over that at the gas's velocity: speeds of 0.3 % of it


def bulk(point, void, box):
    """Indices of the first and last layer whose pressures are compared: away from the floor and
    from surfaces by four widths of the kernel: the drag sees eps smoothed twice."""
    kernel = max(0.8 * point.cell, 1.2) * point.diameter * point.l
    margin = 4 * kernel / box.thickness
    dense = numpy.flatnonzero(void < 0.5 * (1 + void.min()))
    return math.ceil(dense[0] + margin), int(dense[-1] - margin)


def pressure_drop(point, file, box, what):
    """Measured in the frame and by the law, layer by layer."""
    frame = frames.read_frame(file)
    void, pressure = (frame[name].mean(axis=(1, 2)) for name in ("void_fraction", "pressure"))
    first, last = bulk(point, void, box)
    if last <= first:
        return math.nan, math.nan  # no layers away from the ends
    gradients = numpy.array([scenes.pressure_gradient(eps, what.velocity, point.diameter,
                                                      what.gas_density) for eps in void])
    law = box.thickness * (gradients[first:last] + gradients[first + 1:last + 1]).sum() / 2
    return pressure[first] - pressure[last], law


def measure(point, directory):
    rows = frames.read_time_series(directory)
    box, what = scenes.layout(point), scenes.physics(point)
    mass = scenes.GRAIN_DENSITY * numpy.pi / 6 * (point.diameter * point.l) ** 3
    grains, energy = int(rows["grains_inside"][-1]), rows["kinetic_energy"]
    of_gas = 0.5 * grains * mass * what.velocity**2
    free = numpy.ones(len(energy), dtype=bool)  # rows in which the grains move by themselves
    values = {"used_interval": numpy.median(rows["interval"][1:]) / what.limit, "grains": grains}
    found = frames.frame_files(directory, "gas")
    if point.scene == "plug":
        free[:numpy.flatnonzero(energy > 0)[0] + 1] = False
        late = energy[free][-int(free.sum()) // 3:]
        push = 0.5 * grains * mass * scenes.push_of(point, what)**2
        values["growth"] = late.max() / push
        held = found[1]  # the first is that of the start
    elif point.scene == "bed":
        quarter = -len(energy) // 4
        values["growth"] = (energy[quarter:].mean()
                            / max(energy[:-quarter].mean(), AT_REST * of_gas))
        held = found[-1]
    else:
        values["growth"] = energy.max() / of_gas
    values |= {"heating": rows["heating"][free].max(),
               "momentum": abs(rows["momentum_residual"][free]).max(),
               "exchange": abs(rows["third_law_residual"]).max()}
    if point.scene == "jet":
        return values
    measured, law = pressure_drop(point, held[1], box, what)
    return values | {"pressure_drop": measured, "law": law, "deviation": measured / law - 1}


def verdict(status, measured, directory):
    """("good", "") or ("refused" or "failed", why). Refused: an error before the second exchange."""
    if status != "ok":
        rows = directory / "timeseries.csv"
        began = rows.exists() and len(rows.read_text().splitlines()) > 2
        refused = "ERROR" in status and not began
        return ("refused" if refused else "failed"), status.replace("failed: ", "")
    reasons = []
    for name, bound in (("growth", 1.02), ("momentum", MOMENTUM), ("exchange", EXCHANGE),
                        ("deviation", ACCURATE)):
        value = measured.get(name, 0.0)
        if not abs(value) <= bound:
            reasons.append(f"{name} {value:.2g}")
    return ("failed" if reasons else "good"), "; ".join(reasons)


def print_totals(rows):
    counts = collections.Counter((row["verdict"], row["within"]) for row in rows)
    for (name, within), count in sorted(counts.items()):
        print(f"{count:4} {name} {'within' if within == '1' else 'beyond'} the region of no refusal")
    print(f"{sum(float(row['cpu_seconds']) for row in rows) / 60:.1f} min of CPU")
