#!/usr/bin/env python3
"""Checks which part of gasgrain includes what, and that each library stays behind its own file.

usage: check_dependencies.py [SOURCE_DIRECTORY]
"""
import pathlib
import re
import sys

# The parts, most special first: a file belongs to the first whose directory it is in.
PARTS = ["coupling/shared", "coupling/files", "coupling", "cfd", "liggghts_plugins"]

# What each part may include of the others. A path that ends in .hpp allows that header alone.
ALLOWED = {
    "coupling/shared": [],
    "coupling/files": ["coupling/shared", "MPI"],
    "cfd": ["coupling/shared", "coupling/files", "MPI"],
    "liggghts_plugins": ["coupling/shared", "coupling/files/sdf_file.hpp",
                         "coupling/files/collective_error.hpp", "LIGGGHTS", "MPI"],
    "coupling": ["coupling/shared", "coupling/files", "cfd", "liggghts_plugins", "LIGGGHTS", "MPI"],
}

# Libraries that one file (or one directory) alone may name.
BOUNDARIES = {
    r"toml\+\+/": ["coupling/shared/config_table.cpp"],
    r"hdf5\.h|H5\w+\.h": ["coupling/files/hdf5_file.cpp"],
    r"HYPRE\w*\.h|_hypre\w*\.h": ["cfd/hypre_struct.cpp", "cfd/hypre_boomeramg.cpp"],
    r"Eigen/": ["coupling/shared/vec3.hpp", "cfd/multigrid.cpp"],  # there: a dense solve
    r"CLI/": ["coupling/files/gasgrain_sdf.cpp", "cfd/gasgrain_gas.cpp", "coupling/gasgrain_main.cpp"],
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def part_of(path):
    return next((part for part in PARTS if path.startswith(part + "/")), None)


# Headers of C++ (no dot in their names), of POSIX and of the compiler.
STANDARD = re.compile(r"[a-z_0-9]+$|(sys/\w+|unistd|signal|fcntl|dlfcn|immintrin)\.h$")


def target_of(header):
    """What a header belongs to: one of PARTS, MPI, LIGGGHTS, a library of BOUNDARIES, or None."""
    part = part_of(header)
    if part:
        return part
    if header == "mpi.h":
        return "MPI"
    if STANDARD.match(header):
        return None
    if any(re.match(pattern, header) for pattern in BOUNDARIES):
        return None
    return "LIGGGHTS"  # its headers have plain names


def violations(root, path):
    own = part_of(path)
    for number, line in enumerate((root / path).read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        header = match.group(2)
        place = f"{path}:{number}: {line.strip()}"
        for pattern, files in BOUNDARIES.items():
            if re.match(pattern, header) and path not in files:
                yield f"{place}: only {', '.join(files)} may include this library"
        target = target_of(header)
        if target and target != own and target not in ALLOWED[own] and header not in ALLOWED[own]:
            yield f"{place}: {own} must not depend on {target}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    files = sorted(str(path.relative_to(root)) for part in ("coupling", "cfd", "liggghts_plugins")
                   for path in (root / part).rglob("*")
                   if path.suffix in (".hpp", ".cpp", ".h"))
    assert len(files) > 10, f"no sources below {root}"
    found = [text for path in files for text in violations(root, path)]
    print("\n".join(found))
    print(f"{len(files)} files, {len(found)} violations of the dependency rule")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
