"""Bed heights by other definitions than that of fix couple/gas, from the frames: their spread."""

import frames
import numpy

SURFACE = 0.8  # void fraction


def crossing(void, spacing):
    """Highest level at which a profile from below crosses SURFACE, linear between cells; m."""
    dense = numpy.flatnonzero(void < SURFACE)
    if len(dense) == 0:
        return 0.0
    last = dense[-1]
    if last + 1 == len(void):
        return (last + 1) * spacing
    share = (SURFACE - void[last]) / (void[last + 1] - void[last])
    return (last + 0.5 + share) * spacing


def level_with(profile, share, spacing):
    """Level below which `share` of a positive profile lies, m."""
    below = numpy.concatenate([[0.0], numpy.cumsum(profile)])
    return spacing * numpy.interp(share * below[-1], below, numpy.arange(len(below)))


def of_frame(void, open_share, spacing):
    """Heights of one frame, m. Arrays [z, y, x]; `open_share` of each cell."""
    solid = ((1 - void) * open_share).sum(axis=(1, 2))
    columns = [crossing(void[:, j, i], spacing) for j in range(void.shape[1])
               for i in range(void.shape[2])]
    return {"bed_height_columns": numpy.mean(columns),
            "bed_height_top": numpy.max(columns),
            "bed_height_95": level_with(solid, 0.95, spacing) / 0.95,
            "bed_height_centre": 2 * (solid * (numpy.arange(len(solid)) + 0.5)).sum()
                                 / solid.sum() * spacing}


MEANING = {
    "bed_height_columns": "mean over the cross-section of the highest 0.8 of each column",
    "bed_height_top": "highest 0.8 of any column",
    "bed_height_95": "level below which 95 % of the grains lie, over 0.95",
    "bed_height_centre": "twice the height of the centre of mass",
    "bed_height_of_mean_field": "0.8 of the time mean of the void fraction",
}


def alternatives(directory, start, height):
    """Time means from `start` on, as quantities of summary.json. `height` of the grid, m."""
    found, profile = [], 0.0
    for time, file in frames.frame_files(directory, "gas"):
        if time < start:
            continue
        gas = frames.read_frame(file)
        void, open_share = gas["void_fraction"], 1 - gas["wall_fraction"]
        spacing = height / void.shape[0]
        found.append(of_frame(void, open_share, spacing))
        profile = profile + (void * open_share).sum(axis=(1, 2)) / open_share.sum(axis=(1, 2))
    means = {name: float(numpy.mean([row[name] for row in found])) for name in found[0]}
    means["bed_height_of_mean_field"] = crossing(profile / len(found), spacing)
    return [{"name": name, "value": value, "unit": "m", "reference": None, "tolerance": None,
             "source": MEANING[name]} for name, value in means.items()]
