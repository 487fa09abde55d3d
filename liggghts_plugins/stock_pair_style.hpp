// A stock `pair_style gran` whose options are remembered: stock models keep them to themselves, and
// the fused engine has to know them. Every call goes on to stock's own implementation.
#pragma once

#include <granular_pair_style.h>

#include <memory>
#include <string>
#include <vector>

namespace gasgrain::plugins {

class StockPairStyle : public LIGGGHTS::PairStyles::IGranularPairStyle {
 public:
  using Interface = LIGGGHTS::PairStyles::IGranularPairStyle;

  StockPairStyle(const LAMMPS_NS::LAMMPS& liggghts, LAMMPS_NS::PairGran* parent,
                 std::unique_ptr<Interface> stock);
  ~StockPairStyle() override;

  void settings(int argument_count, char** arguments,
                LIGGGHTS::IContactHistorySetup* history) override;
  void init_granular() override { stock_->init_granular(); }
  void write_restart_settings(FILE* file) override { stock_->write_restart_settings(file); }
  void read_restart_settings(FILE* file, int64_t variant) override {
    stock_->read_restart_settings(file, variant);
  }
  void compute_force(LAMMPS_NS::PairGran* pair, int eflag, int vflag, int addflag) override {
    stock_->compute_force(pair, eflag, vflag, addflag);
  }
  int get_history_offset(const std::string name) override {
    return stock_->get_history_offset(name);
  }
  double stressStrainExponent() override { return stock_->stressStrainExponent(); }
  int64_t hashcode() override { return stock_->hashcode(); }
  bool contact_match(const std::string kind, const std::string model) override {
    return stock_->contact_match(kind, model);
  }

  const LAMMPS_NS::PairGran* parent() const { return parent_; }
  // False: read from a restart file, which does not hold them.
  bool options_are_known() const { return options_are_known_; }
  // Words after the models, as in the script.
  const std::vector<std::string>& options() const { return options_; }

 private:
  const LAMMPS_NS::LAMMPS& liggghts_;
  LAMMPS_NS::PairGran* parent_;
  std::unique_ptr<Interface> stock_;
  bool options_are_known_ = false;
  std::vector<std::string> options_;
};

// The pair style of this LIGGGHTS instance if it is a stock one that is observed, or nullptr.
StockPairStyle* stock_pair_style(const LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
