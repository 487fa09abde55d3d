"""Reading what gasgrain writes: frames of gas and grains (HDF5) and the time series (CSV)."""

import csv
import pathlib
import re

import h5py
import numpy


def frame_files(directory, series):
    """Times and files of a series ('gas' or 'grains'), in order, from its XDMF index."""
    text = (pathlib.Path(directory) / f"{series}.xdmf").read_text()
    times = [float(value) for value in re.findall(r'<Time Value="([^"]+)"', text)]
    files = list(dict.fromkeys(re.findall(r">\s*([^<>:\s]+\.h5):", text)))
    return list(zip(times, (pathlib.Path(directory) / name for name in files)))


def read_frame(file):
    """All arrays of one frame: name -> array; grid arrays are indexed [z, y, x]."""
    with h5py.File(file, "r") as data:
        return {name: data[name][...] for name in data if isinstance(data[name], h5py.Dataset)}


def read_table(file):
    """A CSV file with names in its first line and comments (#): column name -> array."""
    with open(file, newline="", encoding="ascii") as text:
        rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}


def read_time_series(directory):
    """timeseries.csv: column name -> array."""
    return read_table(pathlib.Path(directory) / "timeseries.csv")


def mean_gas(directory, start):
    """Means over time and depth: void fraction [z, x] and superficial velocity eps u [z, x, xz]."""
    void, flux, count = 0.0, 0.0, 0
    for time, file in frame_files(directory, "gas"):
        if time < start:
            continue
        gas = read_frame(file)
        void = void + gas["void_fraction"].mean(axis=1)
        flux = flux + (gas["void_fraction"][..., None] * gas["velocity"])[..., [0, 2]].mean(axis=1)
        count += 1
    return void / count, flux / count
