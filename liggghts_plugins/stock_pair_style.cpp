#include "liggghts_plugins/stock_pair_style.hpp"

#include <map>
#include <utility>

namespace gasgrain::plugins {

namespace {

std::map<const LAMMPS_NS::LAMMPS*, StockPairStyle*>& pair_styles() {
  static std::map<const LAMMPS_NS::LAMMPS*, StockPairStyle*> styles;
  return styles;
}

}  // namespace

StockPairStyle::StockPairStyle(const LAMMPS_NS::LAMMPS& liggghts, LAMMPS_NS::PairGran* parent,
                               std::unique_ptr<Interface> stock)
    : liggghts_(liggghts), parent_(parent), stock_(std::move(stock)) {
  pair_styles()[&liggghts] = this;
}

StockPairStyle::~StockPairStyle() {
  if (stock_pair_style(liggghts_) == this) pair_styles().erase(&liggghts_);
}

void StockPairStyle::settings(int argument_count, char** arguments,
                              LIGGGHTS::IContactHistorySetup* history) {
  options_.assign(arguments, arguments + argument_count);
  options_are_known_ = true;
  stock_->settings(argument_count, arguments, history);
}

StockPairStyle* stock_pair_style(const LAMMPS_NS::LAMMPS& lmp) {
  const auto found = pair_styles().find(&lmp);
  return found == pair_styles().end() ? nullptr : found->second;
}

}  // namespace gasgrain::plugins
