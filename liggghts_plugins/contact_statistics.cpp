#include "liggghts_plugins/contact_statistics.hpp"

#include <utility>

namespace gasgrain::plugins {

LargestOverlap ContactStatistics::take() {
  return std::exchange(largest_, LargestOverlap{});
}

ContactStatistics& contact_statistics() {
  static ContactStatistics statistics;
  return statistics;
}

}  // namespace gasgrain::plugins
