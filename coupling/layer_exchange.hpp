// One layer of ghosts across block faces, many fields in one message.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::coupling {

// Fills the first ghost layer behind each block face with the neighbour's cells, without edges and
// corners: what a seven-point stencil reads. All directions travel at once and all fields in one
// message per neighbour, so it costs far less than cfd::fill_ghosts field by field.
class LayerExchange {
 public:
  // Keeps a reference to `decomposition`.
  explicit LayerExchange(const cfd::Decomposition& decomposition) : decomposition_(decomposition) {}

  // Collective over neighbours.
  void fill(std::span<cfd::Field* const> fields);

 private:
  const cfd::Decomposition& decomposition_;
  std::array<std::vector<double>, 6> sent_, received_;  // per direction and side
};

}  // namespace gasgrain::coupling
