"""How well two kinds of grains are mixed."""

import numpy


def index(frame, first_kind, cell_size):
    """Lacey's index: 0 unmixed, 1 as mixed as by chance.

    `first_kind`: 1.0 or 0.0 per grain. Cells of the section (m) with fewer than ten grains are left
    out.
    """
    cells = numpy.floor(numpy.stack([frame["x"], frame["z"]]) / cell_size).astype(int)
    _, cell = numpy.unique(cells, axis=1, return_inverse=True)
    in_cell = numpy.bincount(cell.ravel())
    of_first = numpy.bincount(cell.ravel(), weights=first_kind)
    full = in_cell >= 10
    share, p = of_first[full] / in_cell[full], first_kind.mean()
    variance = numpy.average((share - p) ** 2, weights=in_cell[full])
    by_chance = p * (1 - p) / numpy.average(in_cell[full], weights=in_cell[full])
    return (p * (1 - p) - variance) / (p * (1 - p) - by_chance)
