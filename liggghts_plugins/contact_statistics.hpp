// Largest overlap of the contacts of `model cgm` and fix wall/sdf since somebody last asked.
// One per process: gasgrain runs one LIGGGHTS instance.
#pragma once

namespace gasgrain::plugins {

struct LargestOverlap {
  double length = 0.0;    // m
  double relative = 0.0;  // overlap / mean grain diameter of the pair (wall: of the grain)
};

class ContactStatistics {
 public:
  void note(const LargestOverlap& seen) {
    if (seen.length > largest_.length) largest_.length = seen.length;
    if (seen.relative > largest_.relative) largest_.relative = seen.relative;
  }
  // The largest values of this rank since the last call; starts anew.
  LargestOverlap take();

 private:
  LargestOverlap largest_;
};

ContactStatistics& contact_statistics();

}  // namespace gasgrain::plugins
