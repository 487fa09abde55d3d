"""Errors of the stored runs against the originals (l = 1), with error bars.

A quantity's deviation is (mean over seeds - mean of the originals), over the latter where the
scene counts it relative. Its error bar is half the 95 % interval of that difference (Student's t
with the variances of both added, the smaller number of seeds less one degrees of freedom). The
error of a law at an l is the root mean square of the deviations of all quantities of the scene;
the scatter of the originals themselves, in the same measure, is what no law can be told from.
"""

import collections
import csv
import math
import statistics

# Half width of the 95 % interval in standard errors, by degrees of freedom.
STUDENT = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57}


def read_rows(results, scene):
    """Rows of the runs that worked."""
    path = results / f"{scene}.csv"
    if not path.exists():
        return []
    with open(path) as file:
        return [row for row in csv.DictReader(file) if row["status"] == "ok"]


Group = collections.namedtuple("Group", "law l factor value")


def group_rows(rows):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[Group(row["law"], float(row["l"]), row["factor"], row["value"])].append(row)
    return groups


def mean_and_variance(rows, name):
    """Mean over the seeds and the variance of that mean; nan when a seed has no value."""
    values = [float(row[name]) for row in rows]
    if len(values) == 1:
        return values[0], math.nan
    return statistics.mean(values), statistics.variance(values) / len(values)


Deviation = collections.namedtuple("Deviation", "value bar")


def deviation(rows, truth, name, kind):
    value, variance = mean_and_variance(rows, name)
    reference, reference_variance = mean_and_variance(truth, name)
    scale = abs(reference) if kind == "relative" else 1.0
    freedom = min(max(1, min(len(rows), len(truth)) - 1), 5)
    bar = STUDENT[freedom] * math.sqrt(variance + reference_variance)
    return Deviation((value - reference) / scale, bar / scale)


def deviations(rows, truth, scene):
    return {name: deviation(rows, truth, name, kind)
            for name, (_, kind) in scene.quantities.items()}


def total_error(parts):
    """Root mean square over the quantities that have a value; (error, how many have none)."""
    values = [part.value for part in parts.values() if math.isfinite(part.value)]
    if not values:
        return math.nan, len(parts)
    return (math.sqrt(statistics.mean(v * v for v in values)), len(parts) - len(values))


def scatter(truth, scene):
    """The error that one more set of runs of the originals would have."""
    squares = []
    for name, (_, kind) in scene.quantities.items():
        value, variance = mean_and_variance(truth, name)
        if math.isfinite(variance):
            squares.append(2 * variance / (value**2 if kind == "relative" else 1.0))
    return math.sqrt(statistics.mean(squares)) if squares else math.nan


def cost(rows, name):
    return statistics.mean(float(row[name]) for row in rows)
