"""From the frames of a run to the quantities an engineer uses.

frames: list of arrays, a row per grain: id, x, y, z, vx, vy, vz (SI), sorted by id.
"""

import csv
import math

import numpy


def read_frames(path):
    """Frames of a text dump with the columns id x y z vx vy vz."""
    frames = []
    with open(path) as file:
        while file.readline():  # ITEM: TIMESTEP
            for _ in range(2):
                file.readline()
            count = int(file.readline())
            for _ in range(5):
                file.readline()
            text = "".join(file.readline() for _ in range(count))
            rows = numpy.array(text.split(), dtype=float).reshape(count, 7)
            frames.append(rows[numpy.argsort(rows[:, 0])])
    return frames


def series(directory):
    """Columns of timeseries.csv of the coupling."""
    with open(directory / "timeseries.csv") as file:
        rows = list(csv.DictReader(file))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}


def cell_numbers(places, edge):
    """Number of the cell of each place (columns: x and z, say), counted from 0 without gaps."""
    cells = numpy.floor(places / edge).astype(int)
    return numpy.unique(cells, axis=0, return_inverse=True)[1].ravel()


def lacey_index(marked, places, edge):
    """Mixing of marked and other grains, 0 apart to 1 at random (Lacey 1954), cells of this edge.

    (S0^2 - S^2)/(S0^2 - SR^2) with S0^2 = p(1-p) and SR^2 = p(1-p)/n of each cell, cells weighted
    by their n grains.
    """
    cell = cell_numbers(places, edge)
    n = numpy.bincount(cell)
    p = marked.mean()
    share = numpy.bincount(cell, weights=marked) / n
    apart = p * (1 - p)
    variance = (n * (share - p) ** 2).sum() / n.sum()
    random = apart * len(n) / n.sum()
    return (apart - variance) / (apart - random)


def granular_temperature(frame, plane, edge):
    """Mean square of a velocity component about the mean of its cell, m^2/s^2; the cells have this
    edge along the two columns of `plane`."""
    cell = cell_numbers(frame[:, plane], edge)
    n = numpy.bincount(cell)
    total = 0.0
    for column in (4, 5, 6):
        mean = numpy.bincount(cell, weights=frame[:, column]) / n
        square = numpy.bincount(cell, weights=frame[:, column] ** 2) - n * mean**2
        total += square[n > 1].sum()
    return total / 3 / (n[n > 1] - 1).sum()


def first_crossing(times, values, level):
    """Time at which the values first reach the level, between frames linear; nan when never."""
    for i in range(1, len(values)):
        a, b = values[i - 1] - level, values[i] - level
        if a * b <= 0 and a != b:
            return times[i - 1] + (times[i] - times[i - 1]) * a / (a - b)
    return math.nan


def mean_crossing_frequency(times, values, smoothing):
    """Half the number of crossings of the mean per time, Hz; `smoothing`: of a running mean, s."""
    width = max(1, round(smoothing / numpy.diff(times).mean()))
    smooth = numpy.convolve(values - values.mean(), numpy.ones(width) / width, mode="valid")
    return (smooth[1:] * smooth[:-1] < 0).sum() / 2 / (times[-1] - times[0])
