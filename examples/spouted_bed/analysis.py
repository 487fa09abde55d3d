"""What a spouted bed is judged by: mean motion of the grains, spout, annulus and fountain."""

import math

import frames
import numpy

WIDTH, DEPTH, HEIGHT = 0.1, 0.012, 0.248  # m
JET = 0.012  # width of the slot, m
MIDDLE = 0.03  # level of the spout's width and of the plane `mid`, m


def minimum_fluidization_velocity(diameter, density, gas_density, viscosity):
    """Superficial velocity, m/s (Wen and Yu, AIChE Journal 12, 1966, 610-612)."""
    archimedes = gas_density * (density - gas_density) * 9.81 * diameter**3 / viscosity**2
    reynolds = math.sqrt(33.7**2 + 0.0408 * archimedes) - 33.7
    return reynolds * viscosity / (gas_density * diameter)


def mean_motion(all_grains, columns, layers):
    """Means over time and depth on a grid of x and z: grains per cell, and their velocity
    [z, x, xz] (m/s; 0 where there never was a grain)."""
    edges = [numpy.linspace(0, HEIGHT, layers + 1), numpy.linspace(0, WIDTH, columns + 1)]
    count = numpy.zeros((layers, columns))
    motion = numpy.zeros((layers, columns, 2))
    times = 0
    for grains in all_grains:
        place = grains["position"][:, [2, 0]]
        count += numpy.histogramdd(place, edges)[0]
        for number, axis in enumerate((0, 2)):
            motion[..., number] += numpy.histogramdd(place, edges,
                                                     weights=grains["velocity"][:, axis])[0]
        times += 1
    return count / times, motion / numpy.maximum(count, 1)[..., None]


def spout_width(x, rise):
    """Distance, m, between the places on both sides of the largest rise where the mean vertical
    motion `rise` at `x` (ascending, m) changes its sign; nan where it does not."""
    top = int(numpy.argmax(rise))
    if rise[top] <= 0:
        return math.nan
    sides = []
    for direction in (-1, 1):
        here = top
        while 0 <= here < len(x) and rise[here] > 0:
            here += direction
        if not 0 <= here < len(x):
            return math.nan
        inner = here - direction
        share = rise[inner] / (rise[inner] - rise[here])
        sides.append(x[inner] + share * (x[here] - x[inner]))
    return sides[1] - sides[0]


def annulus_height(void, columns=5):
    """Level, m, at which the mean void fraction [z, x] of the outer columns crosses 0.8."""
    profile = numpy.concatenate([void[:, :columns], void[:, -columns:]], axis=1).mean(axis=1)
    dense = numpy.flatnonzero(profile < 0.8)
    if len(dense) == 0:
        return 0.0
    last, cell = dense[-1], HEIGHT / len(profile)
    if last + 1 == len(profile):
        return HEIGHT
    share = (0.8 - profile[last]) / (profile[last + 1] - profile[last])
    return (last + 0.5 + share) * cell


def fountain_top(grains, share=1e-3):
    """Level, m, above which a thousandth of the grains lie."""
    return numpy.quantile(grains["position"][:, 2], 1 - share)


def read_late(directory, start):
    """Frames of the grains from `start`, s, on."""
    return [frames.read_frame(file) for time, file in frames.frame_files(directory, "grains")
            if time >= start]


def analyse(directory, start):
    """Mean fields and the numbers that come from frames."""
    void, gas = frames.mean_gas(directory, start)
    late = read_late(directory, start)
    layers, columns = void.shape
    count, motion = mean_motion(late, columns, layers)
    x = WIDTH * (numpy.arange(columns) + 0.5) / columns
    level = int(MIDDLE / HEIGHT * layers)
    tops = numpy.array([fountain_top(grains) for grains in late])
    annulus = annulus_height(void)
    return {"void": void, "gas": gas, "grains": count, "motion": motion,
            "spout_width": spout_width(x, (count[..., None] * motion)[level, :, 1]),
            "annulus_height": annulus, "fountain_height": tops.mean() - annulus}
