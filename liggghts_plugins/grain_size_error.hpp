// What larger grains change, whatever their contact law: fits to the time-error benchmark.
//
// Source: rows of tests/bench/coarse_graining/results (docs/coarse_graining_errors.md), means over
// seven contact laws and three seeds. A slot 16 originals wide: rate ~ 1 / (1 + 6 d/W) within 1.5 %
// of the rate for d = 1 to 4 d0. A column that slumps to a layer 20 originals high: runout
// 1 + 0.9 (d - d0) / h within 1.5 %.
#pragma once

namespace gasgrain::plugins {

// Relative to the originals.
struct GrainSizeError {
  double slot_rate;  // of the discharge through a slot as wide as the gap
  double layer;      // of the runout of a heap that ends as high as the gap
  bool measured;     // 4 to 20 grains across the gap, as in the benchmark
};

// `gap` and `original` (diameter d0) in m, both > 0; ratio l >= 1.
GrainSizeError grain_size_error(double gap, double original, double ratio);

}  // namespace gasgrain::plugins
