#include "coupling/layer_exchange.hpp"

namespace gasgrain::coupling {

namespace {

constexpr int first_tag = 51;

// visit(index) for the cells of one layer of direction d, in a fixed order.
template <class Visit>
void for_each_in_layer(const cfd::Field& field, int d, int layer, Visit&& visit) {
  const int e = d == 0 ? 1 : 0, f = d == 2 ? 1 : 2;
  for (int b = 0; b < field.size()[f]; ++b) {
    for (int a = 0; a < field.size()[e]; ++a) {
      cfd::Index3 cell;
      cell[d] = layer;
      cell[e] = a;
      cell[f] = b;
      visit(field.index(cell[0], cell[1], cell[2]));
    }
  }
}

}  // namespace

void LayerExchange::fill(std::span<cfd::Field* const> fields) {
  const cfd::Index3& size = decomposition_.block().size;
  std::array<MPI_Request, 12> requests;
  int pending = 0;
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      if (decomposition_.at_boundary(d, side)) continue;
      const std::size_t count = fields.size() * size[(d + 1) % 3] * size[(d + 2) % 3];
      std::vector<double>& received = received_[2 * d + side];
      received.resize(count);
      // what comes from below was sent upwards
      MPI_Irecv(received.data(), static_cast<int>(count), MPI_DOUBLE,
                decomposition_.neighbour(d, side), first_tag + 2 * d + (1 - side),
                decomposition_.communicator(), &requests[pending++]);
    }
  }
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      if (decomposition_.at_boundary(d, side)) continue;
      std::vector<double>& sent = sent_[2 * d + side];
      sent.clear();
      for (const cfd::Field* field : fields) {
        for_each_in_layer(*field, d, side == 0 ? 0 : size[d] - 1,
                          [&](std::ptrdiff_t n) { sent.push_back((*field)[n]); });
      }
      MPI_Isend(sent.data(), static_cast<int>(sent.size()), MPI_DOUBLE,
                decomposition_.neighbour(d, side), first_tag + 2 * d + side,
                decomposition_.communicator(), &requests[pending++]);
    }
  }
  MPI_Waitall(pending, requests.data(), MPI_STATUSES_IGNORE);
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      if (decomposition_.at_boundary(d, side)) continue;
      auto next = received_[2 * d + side].begin();
      for (cfd::Field* field : fields) {
        for_each_in_layer(*field, d, side == 0 ? -1 : size[d],
                          [&](std::ptrdiff_t n) { (*field)[n] = *next++; });
      }
    }
  }
}

}  // namespace gasgrain::coupling
