#include "liggghts_plugins/scene_errors.hpp"

#include <algorithm>
#include <cmath>

namespace gasgrain::plugins {

namespace {

constexpr SceneError rows[] = {
#include "liggghts_plugins/scene_errors.inc"
};

}  // namespace

std::span<const SceneError> scene_errors() {
  return rows;
}

double nearest_measured_exponent(double n) {
  return std::clamp(std::round(n), 1.0, 3.0);
}

}  // namespace gasgrain::plugins
