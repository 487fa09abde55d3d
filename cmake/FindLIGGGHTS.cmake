# Finds an unmodified LIGGGHTS-PUBLIC 3.8.0 library and its headers. Honours LIGGGHTS_ROOT.
# Defines the imported target LIGGGHTS::LIGGGHTS.
#
# The installed headers include style lists that LIGGGHTS generates while it builds itself and that
# Debian does not ship (style_surface_model.h ...). They only matter when the library itself is
# compiled, so empty ones are put on the include path behind the real ones.
find_path(LIGGGHTS_INCLUDE_DIR pair_gran.h PATH_SUFFIXES include/liggghts liggghts include src)
find_library(LIGGGHTS_LIBRARY NAMES liggghts PATH_SUFFIXES lib src)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LIGGGHTS REQUIRED_VARS LIGGGHTS_LIBRARY LIGGGHTS_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "Debian: apt install libliggghts-dev, elsewhere: set LIGGGHTS_ROOT")
if(LIGGGHTS_FOUND AND NOT TARGET LIGGGHTS::LIGGGHTS)
  set(_generated ${CMAKE_BINARY_DIR}/liggghts_generated_headers)
  foreach(kind surface normal tangential rolling cohesion)
    file(CONFIGURE OUTPUT ${_generated}/style_${kind}_model.h
      CONTENT "// empty: see cmake/FindLIGGGHTS.cmake\n")
  endforeach()
  add_library(LIGGGHTS::LIGGGHTS UNKNOWN IMPORTED)
  set_target_properties(LIGGGHTS::LIGGGHTS PROPERTIES IMPORTED_LOCATION ${LIGGGHTS_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${LIGGGHTS_INCLUDE_DIR};${_generated}")
  target_link_libraries(LIGGGHTS::LIGGGHTS INTERFACE MPI::MPI_CXX)
endif()
mark_as_advanced(LIGGGHTS_INCLUDE_DIR LIGGGHTS_LIBRARY)
