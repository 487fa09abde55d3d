#include "coupling/grain_values.hpp"

#include <algorithm>
#include <array>

namespace gasgrain::coupling {

void GrainValues::resize(int count) {
  held_.resize(count, Vec3::Zero());
  if (labelled_) labels_.resize(count, 0.0);
  if (!drag_follows_) return;
  coefficients_.resize(count, 0.0);
  given_.resize(count, Vec3::Zero());
  positions_.resize(count, Vec3::Zero());
}

// visit(value) for all that moves with atom i.
template <class Self, class Visit>
void GrainValues::visit(Self& self, int i, Visit&& visit) {
  for (int d = 0; d < 3; ++d) visit(self.held_[i][d]);
  if (self.labelled_) visit(self.labels_[i]);
  if (!self.drag_follows_) return;
  visit(self.coefficients_[i]);
  for (int d = 0; d < 3; ++d) visit(self.given_[i][d]);
  for (int d = 0; d < 3; ++d) visit(self.positions_[i][d]);
}

void GrainValues::pack(int i, double* buffer) const {
  visit(*this, i, [&](double value) { *buffer++ = value; });
}

void GrainValues::unpack(int i, const double* buffer) {
  visit(*this, i, [&](double& value) { value = *buffer++; });
}

void GrainValues::copy(int from, int to) {
  std::array<double, 11> values;  // force, label, drag
  pack(from, values.data());
  unpack(to, values.data());
}

void GrainValues::clear(int i) {
  visit(*this, i, [](double& value) { value = 0.0; });
}

void GrainValues::release() {
  std::fill(held_.begin(), held_.end(), Vec3::Zero());
}

void GrainValues::hold(int i, const Exchanged& exchanged) {
  held_[i] = exchanged.force;
  if (!drag_follows_) return;
  coefficients_[i] = exchanged.coefficient;
  given_[i] = exchanged.interval * exchanged.force;
  positions_[i] = exchanged.position;
  held_[i] += exchanged.coefficient * exchanged.velocity;
}

plugins::HeldForces GrainValues::forces() const {
  return {held_.data(), drag_follows_ ? coefficients_.data() : nullptr};
}

// Nothing is carried after the first exchange, when the gas had given nothing.
Vec3 GrainValues::received_beyond(int i, const Vec3& path, double elapsed, double given) const {
  if (given <= 0) return Vec3::Zero();
  if (!drag_follows_) return (elapsed - given) * held_[i];
  if (coefficients_[i] <= 0) return Vec3::Zero();
  return elapsed * held_[i] - coefficients_[i] * path - given_[i];
}

}  // namespace gasgrain::coupling
