// The contact law of a pair style in the form the fused engine computes.
//
//   F_n = k delta - eta v_n,   at least `least_normal_force`
//   linear:  k, eta, k_t, eta_t are those of the coefficients
//   hertz:   k and k_t times sqrt(delta), eta and eta_t times delta^(1/4)
//
// delta is the overlap in m, v_n the normal velocity. The tangential part is that of
// contact_law.hpp with the k_t, eta_t and F_n of the moment.
#pragma once

#include <memory>
#include <string>

#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/engine/records.hpp"

namespace gasgrain::plugins {

enum class NormalModel { linear, hertz };

struct PairModel {
  NormalModel normal = NormalModel::linear;
  TangentialModel tangential = TangentialModel::history;
  double least_normal_force = 0.0;  // N; minus infinity where contacts may pull
};

// What the coefficients of a pair may depend on.
struct PairMember {
  int type;
  double mass;    // kg
  double radius;  // m
  bool frozen;    // fix freeze: acts like a wall
  bool operator==(const PairMember&) const = default;
};

class PairLaw {
 public:
  virtual ~PairLaw() = default;
  virtual PairModel model() const = 0;
  // Place of the tangential spring among LIGGGHTS's history values of a pair; -1: none.
  virtual int history_offset() const = 0;
  virtual std::string name() const = 0;  // as in a script
  // For hertz in N/m^(3/2) and kg/s/m^(1/4).
  virtual PairCoefficients between(const PairMember& first, const PairMember& second) const = 0;
};

class PairGranCgm;

std::unique_ptr<PairLaw> make_cgm_law(const PairGranCgm& pair);

}  // namespace gasgrain::plugins
