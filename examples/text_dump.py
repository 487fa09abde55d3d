"""Reading LIGGGHTS's own text output: dumps and tables of fix print."""

import csv

import numpy


def read_table(path):
    """A CSV file with a line of column names: name -> array."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}


def read_dump(path):
    """Frames of a dump of style custom: (step, column name -> array), in order."""
    with open(path) as file:
        lines = iter(file)
        for line in lines:
            if not line.startswith("ITEM: TIMESTEP"):
                continue
            step = int(next(lines))
            next(lines)
            count = int(next(lines))
            for _ in range(4):
                next(lines)
            columns = next(lines).split()[2:]
            rows = numpy.array([next(lines).split() for _ in range(count)], dtype=float)
            rows = rows.reshape(count, len(columns))
            yield step, dict(zip(columns, rows.T))
