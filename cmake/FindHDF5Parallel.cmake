# Finds the MPI build of HDF5's C library through CMake's own FindHDF5. Honours HDF5_ROOT.
# Defines the imported target HDF5::parallel.
set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 QUIET COMPONENTS C)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HDF5Parallel REQUIRED_VARS HDF5_C_LIBRARIES HDF5_IS_PARALLEL
  REASON_FAILURE_MESSAGE "Debian: apt install libhdf5-openmpi-dev, elsewhere: set HDF5_ROOT to an MPI build")
if(HDF5Parallel_FOUND AND NOT TARGET HDF5::parallel)
  add_library(HDF5::parallel INTERFACE IMPORTED)
  set_target_properties(HDF5::parallel PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${HDF5_C_INCLUDE_DIRS}")
  target_link_libraries(HDF5::parallel INTERFACE ${HDF5_C_LIBRARIES} MPI::MPI_CXX)
endif()
