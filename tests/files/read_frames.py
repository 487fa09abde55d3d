#!/usr/bin/env python3
"""Reads a series of frames as an XDMF reader would: through the index, without gasgrain's code.

usage: read_frames.py MPIEXEC FRAME_WRITER_TEST
"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

try:
    import h5py
    import numpy as np
except ImportError:
    print("h5py is missing; test skipped")
    sys.exit(77)

TIMES = [0.0, 0.1, 0.25]


def numbers(text):
    return [int(n) for n in text.split()]


def load(directory, item):
    """The array of a DataItem, checked against its declared size and type."""
    if item.get("Format") == "XML":
        return np.array([float(n) for n in item.text.split()])
    file, dataset = item.text.strip().split(":")
    with h5py.File(os.path.join(directory, file), "r") as data:
        array = data[dataset][()]
    assert list(array.shape) == numbers(item.get("Dimensions")), item.text
    kind = {"Float": "f", "Int": "i"}[item.get("NumberType")]
    assert array.dtype.kind == kind and array.dtype.itemsize == int(item.get("Precision"))
    return array


def frames(directory, name):
    root = ElementTree.parse(os.path.join(directory, name + ".xdmf")).getroot()
    collection = root.find("./Domain/Grid")
    assert root.tag == "Xdmf" and root.get("Version") == "3.0"
    assert collection.get("CollectionType") == "Temporal"
    grids = collection.findall("Grid")
    assert [float(g.find("Time").get("Value")) for g in grids] == TIMES
    return grids


def arrays(directory, grid, center):
    result = {}
    for attribute in grid.findall("Attribute"):
        assert attribute.get("Center") == center
        result[attribute.get("Name")] = load(directory, attribute.find("DataItem"))
    return result


def check_gas(directory):
    for time, grid in zip(TIMES, frames(directory, "gas")):
        nodes = numbers(grid.find("Topology").get("Dimensions"))
        origin, spacing = (load(directory, i) for i in grid.findall("Geometry/DataItem"))
        assert nodes == [8, 5, 6]
        assert origin.tolist() == [-3, -2, -1] and spacing.tolist() == [0.3, 0.2, 0.1]
        values = arrays(directory, grid, "Cell")
        k, j, i = np.meshgrid(*(np.arange(n - 1) for n in nodes), indexing="ij")
        assert np.array_equal(values["place"], 100 * k + 10 * j + i + 1000 * time)
        assert np.array_equal(values["velocity"], np.stack([i, j, k], axis=-1))


def check_grains(directory, ranks):
    grains = ranks * (ranks - 1) // 2
    for grid in frames(directory, "grains"):
        topology = grid.find("Topology")
        assert int(topology.get("NumberOfElements")) == grains
        assert load(directory, topology.find("DataItem")).tolist() == list(range(grains))
        position = load(directory, grid.find("Geometry/DataItem"))
        values = arrays(directory, grid, "Node")
        assert np.array_equal(position, values["id"][:, None] * np.array([1, 2, 3]))
        assert np.array_equal(values["radius"], 0.5 * values["id"])
        assert len(set(values["id"].tolist())) == grains


def main():
    mpiexec, program = sys.argv[1:3]
    ranks = 3
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([mpiexec, "-n", str(ranks), "--oversubscribe", program,
                        "--gtest_filter=*WritesASample*"], check=True, cwd=directory,
                       env={**os.environ, "GASGRAIN_SAMPLE_FRAMES": directory})
        check_gas(directory)
        check_grains(directory, ranks)
    print("frames read back equal")


if __name__ == "__main__":
    main()
