// Errors of model cgm against the originals (l = 1) in the five scenes of the time-error benchmark.
//
// Source: rows of tests/bench/coarse_graining/results (docs/coarse_graining_errors.md). Valid for
// scenes as narrow, in originals, as the text in brackets says; wider ones err less.
#pragma once

#include <span>

namespace gasgrain::plugins {

struct SceneError {
  const char* scene;
  double exponent;          // n of the contact law
  double at_2, at_3, at_4;  // root mean square over the scene's quantities, share
  double scatter;           // of runs of the originals among each other, share
};

std::span<const SceneError> scene_errors();

// The exponent (1, 2 or 3) of the rows nearest to n.
double nearest_measured_exponent(double n);

}  // namespace gasgrain::plugins
