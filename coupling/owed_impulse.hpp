// What becomes of the impulse that grains received beyond what the gas gave, because an exchange
// interval changed its length.
#pragma once

#include "cfd/field.hpp"
#include "cfd/state_archive.hpp"
#include "cfd/wall_geometry.hpp"

namespace gasgrain::coupling {

class OwedImpulse {
 public:
  // Splits `force`, N/m^3 of open volume in owned cells, of either sign: `force` keeps what the gas
  // has to give, felt() is what the grains have to. `lag` >= 0: cfd::lag_of().
  void split(cfd::VectorField& force, const cfd::Field& void_fraction,
             const cfd::WallGeometry& walls, double lag);

  // H, N/m^3: a grain of volume V gives V H. Empty when there is nothing to give.
  const cfd::VectorField& felt() const { return felt_; }
  bool is_empty() const { return felt_[0].count() == 0; }
  void forget() { felt_ = {}; }

  // Collective; cells of `size`.
  void visit_state(cfd::StateArchive& archive, const cfd::Index3& size);

 private:
  cfd::VectorField felt_;
};

}  // namespace gasgrain::coupling
