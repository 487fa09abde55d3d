"""Environment of the programs that tests and benchmarks start."""

import os


def mpi_environment(**more):
    """Open MPI: allow root (containers), leave the cores to the scheduler, and give ranks a minute
    instead of a second to end after SIGTERM."""
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_hwloc_base_binding_policy": "none",
            "OMPI_MCA_odls_base_sigkill_timeout": "60", "OMP_NUM_THREADS": "1", **more}


def patient_environment():
    """For more ranks than cores, or a busy machine: who waits does not spin."""
    return mpi_environment(OMPI_MCA_mpi_yield_when_idle="1")
