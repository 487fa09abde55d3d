// The stock normal models hooke, hooke/stiffness and hertz of LIGGGHTS 3.8.0 as a law of the
// engine, from the very properties that LIGGGHTS made of a script's `fix property/global`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "liggghts_plugins/engine/pair_law.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

class StockPairStyle;

struct StockLawResult {
  std::unique_ptr<PairLaw> law;        // nullptr when there are obstacles
  std::vector<std::string> obstacles;  // models or options that the engine does not compute
};

// After LAMMPS::init(), which makes the properties.
StockLawResult make_stock_law(LAMMPS_NS::LAMMPS& lmp, StockPairStyle& style);

}  // namespace gasgrain::plugins
