// Ghosts with edges travel direction after direction, each layer with the ghosts of the directions
// before it; the transpose goes backwards. Both messages of a direction are under way at once.
#include "coupling/cell_array.hpp"

#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr int first_tag = 51;

// Adjacent layers of cells across a direction.
struct Layers {
  cfd::Index3 begin, end;
};

enum class Reach { faces_only, with_edges };

// Cells with index [begin, end) in direction d; with edges they cover the ghosts of the directions
// before d.
Layers layers(const cfd::Index3& size, int d, int begin, int end, int edge) {
  Layers result{{0, 0, 0}, size};
  for (int e = 0; e < d; ++e) {
    result.begin[e] = -edge;
    result.end[e] = size[e] + edge;
  }
  result.begin[d] = begin;
  result.end[d] = end;
  return result;
}

std::size_t cells_in(const Layers& layers) {
  std::size_t count = 1;
  for (int d = 0; d < 3; ++d) count *= layers.end[d] - layers.begin[d];
  return count;
}

// The layers of a block that messages move: owned ones, and ghosts, at both sides of direction d.
struct MovedLayers {
  std::array<Layers, 2> owned, ghosts;

  MovedLayers(const cfd::Index3& size, int d, int moved, Reach reach) {
    const int edge = reach == Reach::with_edges ? moved : 0;
    owned = {layers(size, d, 0, moved, edge), layers(size, d, size[d] - moved, size[d], edge)};
    ghosts = {layers(size, d, -moved, 0, edge), layers(size, d, size[d], size[d] + moved, edge)};
  }
};

template <class Visit>
void for_each_in(const Layers& layers, const cfd::Index3& size, const GhostLayers& ghosts,
                 Visit&& visit) {
  const CellStrides stride(size, ghosts);
  const int h = ghosts.stored;
  for (int k = layers.begin[2]; k < layers.end[2]; ++k)
    for (int j = layers.begin[1]; j < layers.end[1]; ++j)
      for (int i = layers.begin[0]; i < layers.end[0]; ++i) {
        visit((i + h) + (j + h) * stride.y + (k + h) * stride.z);
      }
}

// Messages with the neighbours on both sides of some directions.
template <int components>
class Messages {
 public:
  Messages(const cfd::Decomposition& decomposition, const GhostLayers& ghosts)
      : decomposition_(decomposition), size_(decomposition.block().size), ghosts_(ghosts) {}

  // Sends the layers to the neighbour on that side of direction d and expects as many from it.
  void post(int d, int side, const Layers& layers, const CellArray<components>& cells) {
    if (decomposition_.at_boundary(d, side)) return;
    GASGRAIN_ASSERT(size_[d] >= ghosts_.moved);
    auto& sent = sent_[2 * d + side];
    auto& received = received_[2 * d + side];
    sent.clear();
    for_each_in(layers, size_, ghosts_, [&](std::ptrdiff_t n) { sent.push_back(cells[n]); });
    received.resize(cells_in(layers));
    const int count = static_cast<int>(received.size()) * stored_components<components>;
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

  // visit(index, value) for each cell of the layers with what came from that side.
  template <class Visit>
  void take(int d, int side, const Layers& layers, Visit&& visit) const {
    if (decomposition_.at_boundary(d, side)) return;
    auto next = received_[2 * d + side].begin();
    for_each_in(layers, size_, ghosts_, [&](std::ptrdiff_t n) { visit(n, *next++); });
  }

 private:
  const cfd::Decomposition& decomposition_;
  cfd::Index3 size_;
  GhostLayers ghosts_;
  std::array<CellArray<components>, 6> sent_, received_;  // per direction and side
  std::array<MPI_Request, 12> requests_;
  int pending_ = 0;
};

// Copies between owned layers and the neighbours' ghosts in directions [begin, end), all at once.
template <int components>
void copy(const cfd::Decomposition& decomposition, CellArray<components>& cells, int begin, int end,
          Reach reach, const GhostLayers& ghosts) {
  const cfd::Index3& size = decomposition.block().size;
  Messages<components> messages(decomposition, ghosts);
  for (int d = begin; d < end; ++d) {
    const MovedLayers moved(size, d, ghosts.moved, reach);
    for (int side : {0, 1}) messages.post(d, side, moved.owned[side], cells);
  }
  messages.wait();
  const auto set = [&](std::ptrdiff_t n, const auto& value) { cells[n] = value; };
  for (int d = begin; d < end; ++d) {
    const MovedLayers moved(size, d, ghosts.moved, reach);
    for (int side : {0, 1}) messages.take(d, side, moved.ghosts[side], set);
  }
}

}  // namespace

std::size_t cell_array_size(const cfd::Decomposition& decomposition, const GhostLayers& ghosts) {
  const cfd::Index3& size = decomposition.block().size;
  return static_cast<std::size_t>(CellStrides(size, ghosts).z) * (size[2] + 2 * ghosts.stored + 1);
}

template <int components>
void fill_face_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells) {
  copy<components>(decomposition, cells, 0, 3, Reach::faces_only, {});
}

template <int components>
void fill_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells,
                 const GhostLayers& ghosts) {
  for (int d = 0; d < 3; ++d)
    copy<components>(decomposition, cells, d, d + 1, Reach::with_edges, ghosts);
}

template <int components>
void add_ghosts_to_owners(const cfd::Decomposition& decomposition, CellArray<components>& cells,
                          const GhostLayers& ghosts) {
  const cfd::Index3& size = decomposition.block().size;
  const auto add = [&](std::ptrdiff_t n, const auto& value) {
    for (int m = 0; m < components; ++m) cells[n][m] += value[m];
  };
  for (int d = 2; d >= 0; --d) {
    const MovedLayers moved(size, d, ghosts.moved, Reach::with_edges);
    Messages<components> messages(decomposition, ghosts);
    for (int side : {0, 1}) messages.post(d, side, moved.ghosts[side], cells);
    messages.wait();
    for (const Layers& layers : moved.ghosts) {
      for_each_in(layers, size, ghosts, [&](std::ptrdiff_t n) { cells[n].fill(0.0); });
    }
    for (int side : {0, 1}) messages.take(d, side, moved.owned[side], add);
  }
}

#define GASGRAIN_INSTANTIATE(n)                                                               \
  template void fill_face_ghosts<n>(const cfd::Decomposition&, CellArray<n>&);                \
  template void fill_ghosts<n>(const cfd::Decomposition&, CellArray<n>&, const GhostLayers&); \
  template void add_ghosts_to_owners<n>(const cfd::Decomposition&, CellArray<n>&,             \
                                        const GhostLayers&);
GASGRAIN_FOR_COMPONENTS(GASGRAIN_INSTANTIATE)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
