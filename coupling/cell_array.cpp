// Ghosts with edges travel direction after direction, each layer with the ghosts of the directions
// before it; the transpose goes backwards. Both messages of a direction are under way at once.
#include "coupling/cell_array.hpp"

namespace gasgrain::coupling {

namespace {

constexpr int first_tag = 51;

// One layer of cells across direction d.
struct Layer {
  cfd::Index3 begin, end;
};

enum class Reach { faces_only, with_edges };

// The layer `index` of direction d; with edges it covers the ghosts of the directions before d.
Layer layer(const cfd::Index3& size, int d, int index, Reach reach) {
  Layer result{{0, 0, 0}, size};
  for (int e = 0; e < d && reach == Reach::with_edges; ++e) {
    result.begin[e] = -1;
    result.end[e] = size[e] + 1;
  }
  result.begin[d] = index;
  result.end[d] = index + 1;
  return result;
}

std::size_t cells_in(const Layer& layer) {
  std::size_t count = 1;
  for (int d = 0; d < 3; ++d) count *= layer.end[d] - layer.begin[d];
  return count;
}

template <class Visit>
void for_each_in(const Layer& layer, const cfd::Index3& size, Visit&& visit) {
  const std::ptrdiff_t sy = size[0] + 2 * cfd::halo + 1;
  const std::ptrdiff_t sz = sy * (size[1] + 2 * cfd::halo + 1);
  for (int k = layer.begin[2]; k < layer.end[2]; ++k)
    for (int j = layer.begin[1]; j < layer.end[1]; ++j)
      for (int i = layer.begin[0]; i < layer.end[0]; ++i) {
        visit((i + cfd::halo) + (j + cfd::halo) * sy + (k + cfd::halo) * sz);
      }
}

// Messages with the neighbours on both sides of some directions.
template <int components>
class Messages {
 public:
  explicit Messages(const cfd::Decomposition& decomposition)
      : decomposition_(decomposition), size_(decomposition.block().size) {}

  // Sends the layer to the neighbour on that side of direction d and expects one as large from it.
  void post(int d, int side, const Layer& layer, const CellArray<components>& cells) {
    if (decomposition_.at_boundary(d, side)) return;
    auto& sent = sent_[2 * d + side];
    auto& received = received_[2 * d + side];
    sent.clear();
    for_each_in(layer, size_, [&](std::ptrdiff_t n) { sent.push_back(cells[n]); });
    received.resize(cells_in(layer));
    const int count = static_cast<int>(received.size()) * components;
    const int neighbour = decomposition_.neighbour(d, side);
    // what comes from below was sent upwards
    MPI_Irecv(received.data(), count, MPI_DOUBLE, neighbour, first_tag + 2 * d + (1 - side),
              decomposition_.communicator(), &requests_[pending_++]);
    MPI_Isend(sent.data(), count, MPI_DOUBLE, neighbour, first_tag + 2 * d + side,
              decomposition_.communicator(), &requests_[pending_++]);
  }

  void wait() {
    MPI_Waitall(pending_, requests_.data(), MPI_STATUSES_IGNORE);
    pending_ = 0;
  }

  // visit(index, value) for each cell of the layer with what came from that side.
  template <class Visit>
  void take(int d, int side, const Layer& layer, Visit&& visit) const {
    if (decomposition_.at_boundary(d, side)) return;
    auto next = received_[2 * d + side].begin();
    for_each_in(layer, size_, [&](std::ptrdiff_t n) { visit(n, *next++); });
  }

 private:
  const cfd::Decomposition& decomposition_;
  cfd::Index3 size_;
  std::array<CellArray<components>, 6> sent_, received_;  // per direction and side
  std::array<MPI_Request, 12> requests_;
  int pending_ = 0;
};

// Copies between owned layers and the neighbours' ghosts in directions [begin, end), all at once.
template <int components>
void copy(const cfd::Decomposition& decomposition, CellArray<components>& cells, int begin, int end,
          Reach reach) {
  const cfd::Index3& size = decomposition.block().size;
  Messages<components> messages(decomposition);
  for (int d = begin; d < end; ++d) {
    messages.post(d, 0, layer(size, d, 0, reach), cells);
    messages.post(d, 1, layer(size, d, size[d] - 1, reach), cells);
  }
  messages.wait();
  const auto set = [&](std::ptrdiff_t n, const auto& value) { cells[n] = value; };
  for (int d = begin; d < end; ++d) {
    messages.take(d, 0, layer(size, d, -1, reach), set);
    messages.take(d, 1, layer(size, d, size[d], reach), set);
  }
}

}  // namespace

template <int components>
void fill_face_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells) {
  copy<components>(decomposition, cells, 0, 3, Reach::faces_only);
}

template <int components>
void fill_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells) {
  for (int d = 0; d < 3; ++d) copy<components>(decomposition, cells, d, d + 1, Reach::with_edges);
}

template <int components>
void add_ghosts_to_owners(const cfd::Decomposition& decomposition, CellArray<components>& cells) {
  const cfd::Index3& size = decomposition.block().size;
  const auto add = [&](std::ptrdiff_t n, const auto& value) {
    for (int m = 0; m < components; ++m) cells[n][m] += value[m];
  };
  for (int d = 2; d >= 0; --d) {
    const Layer below = layer(size, d, -1, Reach::with_edges);
    const Layer above = layer(size, d, size[d], Reach::with_edges);
    Messages<components> messages(decomposition);
    messages.post(d, 0, below, cells);
    messages.post(d, 1, above, cells);
    messages.wait();
    for (const Layer& ghosts : {below, above}) {
      for_each_in(ghosts, size, [&](std::ptrdiff_t n) { cells[n].fill(0.0); });
    }
    messages.take(d, 0, layer(size, d, 0, Reach::with_edges), add);
    messages.take(d, 1, layer(size, d, size[d] - 1, Reach::with_edges), add);
  }
}

#define GASGRAIN_INSTANTIATE(n)                                                \
  template void fill_face_ghosts<n>(const cfd::Decomposition&, CellArray<n>&); \
  template void fill_ghosts<n>(const cfd::Decomposition&, CellArray<n>&);      \
  template void add_ghosts_to_owners<n>(const cfd::Decomposition&, CellArray<n>&);
GASGRAIN_INSTANTIATE(1)
GASGRAIN_INSTANTIATE(2)
GASGRAIN_INSTANTIATE(4)
GASGRAIN_INSTANTIATE(6)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
