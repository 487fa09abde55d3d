# gasgrain_library(NAME sources...) and gasgrain_executable(NAME sources...): our targets, all with
# the same language level, warnings and floating-point rules.
#
# -fno-math-errno and -fno-trapping-math let the compiler vectorize sqrt and loops with conditions;
# -ffp-contract=fast allows fused multiply-add. None reorders sums, so the same build gives the same
# bits in every run.

function(_gasgrain_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
    -fno-math-errno -fno-trapping-math -ffp-contract=fast)
  # GCC 12 reports its own AVX-512 intrinsics (GCC bug 105593); Open MPI's C++ bindings are unused.
  target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
  target_compile_definitions(${target} PUBLIC OMPI_SKIP_MPICXX)
  if(GASGRAIN_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(GASGRAIN_NATIVE)
    target_compile_options(${target} PUBLIC -march=native)
  endif()
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()

function(gasgrain_library name)
  add_library(${name} STATIC ${ARGN})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  _gasgrain_options(${name})
endfunction()

function(gasgrain_executable name)
  add_executable(${name} ${ARGN})
  _gasgrain_options(${name})
endfunction()
