"""Environment of the programs that tests and benchmarks start."""

import os


def mpi_environment(**more):
    """Open MPI: allow root (containers), leave the cores to the scheduler."""
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_hwloc_base_binding_policy": "none", "OMP_NUM_THREADS": "1", **more}


def patient_environment():
    """For more ranks than cores, or a busy machine: who waits does not spin."""
    return mpi_environment(OMPI_MCA_mpi_yield_when_idle="1")
