// Direction after direction, each with the ghosts of the directions before it, so that edges and
// corners need no messages of their own. Where a block may be thinner than the ghost layers the
// layers travel one after the other, each relayed from the ghosts the neighbour already has.
//
// A field does not say whether it sits on cells or faces. Both copy `halo` layers from below and
// halo + 1 from above; on cell fields the last one is unused storage.
#include "cfd/halo_exchange.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace gasgrain::cfd {

namespace {

// Index range [begin, end) in every direction.
struct Slab {
  Index3 begin, end;
};

// All stored indices, cut to [from, to) in `direction`.
Slab slab(const Index3& size, int direction, int from, int to) {
  Slab s{{-halo, -halo, -halo}, {size[0] + halo + 1, size[1] + halo + 1, size[2] + halo + 1}};
  s.begin[direction] = from;
  s.end[direction] = to;
  return s;
}

// visit(row, length) for every row of the slab along x: `row` is the storage index of its first
// value.
template <class Visit>
void for_each_row(const Field& field, const Slab& s, Visit&& visit) {
  for (int k = s.begin[2]; k < s.end[2]; ++k) {
    for (int j = s.begin[1]; j < s.end[1]; ++j) {
      visit(field.index(s.begin[0], j, k), s.end[0] - s.begin[0]);
    }
  }
}

std::size_t count(const Slab& s) {
  return static_cast<std::size_t>(s.end[0] - s.begin[0]) * (s.end[1] - s.begin[1]) *
         (s.end[2] - s.begin[2]);
}

// Buffers grow to what the largest message needs and stay: no allocation from step to step.
struct Buffers {
  std::vector<double> out, in;
};

Buffers& buffers() {
  static thread_local Buffers both;
  return both;
}

void pack(std::vector<double>& values, std::span<Field* const> fields, const Slab& s) {
  values.resize(fields.size() * count(s));
  double* next = values.data();
  for (Field* field : fields) {
    for_each_row(*field, s, [&](std::ptrdiff_t row, int length) {
      next = std::copy_n(field->data() + row, length, next);
    });
  }
}

void unpack(std::span<Field* const> fields, const Slab& s, const std::vector<double>& values) {
  const double* next = values.data();
  for (Field* field : fields) {
    for_each_row(*field, s, [&](std::ptrdiff_t row, int length) {
      std::copy_n(next, length, field->data() + row);
      next += length;
    });
  }
}

void unpack_add(Field& field, const Slab& s, const std::vector<double>& values) {
  const double* next = values.data();
  for_each_row(field, s, [&](std::ptrdiff_t row, int length) {
    for (int i = 0; i < length; ++i) field[row + i] += next[i];
    next += length;
  });
}

bool has_neighbours(const Decomposition& decomposition, int direction) {
  return !decomposition.at_boundary(direction, 0) || !decomposition.at_boundary(direction, 1);
}

// Sends `out` to the neighbour on `to_side`, receives the message of the same kind from the other
// side. Blocks of one row of ranks have the same cross-section, so both messages are equally long.
// Returns what arrived; empty when there is nobody to receive from.
const std::vector<double>& shift(const Decomposition& decomposition, int direction, int to_side,
                                 Buffers& both) {
  const int to = decomposition.neighbour(direction, to_side);
  const int from = decomposition.neighbour(direction, 1 - to_side);
  if (to == decomposition.rank() && from == to) return both.out;
  both.in.resize(from == MPI_PROC_NULL ? 0 : both.out.size());
  const int tag = 2 * direction + to_side;
  MPI_Sendrecv(both.out.data(), static_cast<int>(both.out.size()), MPI_DOUBLE, to, tag,
               both.in.data(), static_cast<int>(both.in.size()), MPI_DOUBLE, from, tag,
               decomposition.communicator(), MPI_STATUS_IGNORE);
  return both.in;
}

// Copies layers [from, to) counted away from the block face into the ghosts of the neighbours.
void copy_layers(const Decomposition& decomposition, std::span<Field* const> fields, int direction,
                 int side, int from, int to) {
  const Index3& size = decomposition.block().size;
  const int n = size[direction];
  // side 0: my lowest layers become the upper ghosts of the neighbour below
  const Slab source =
      side == 0 ? slab(size, direction, from, to) : slab(size, direction, n - to, n - from);
  const Slab ghosts =
      side == 0 ? slab(size, direction, n + from, n + to) : slab(size, direction, -to, -from);
  Buffers& both = buffers();
  pack(both.out, fields, source);
  const std::vector<double>& received = shift(decomposition, direction, side, both);
  if (!received.empty()) unpack(fields, ghosts, received);
}

// Layers that can travel in one message: no block of the row is thinner.
int layers_at_once(const Decomposition& decomposition, int direction, int layers) {
  const int thinnest = decomposition.grid().cells[direction] / decomposition.ranks()[direction];
  return thinnest >= layers ? layers : 1;
}

// Transpose of copy_layers for one layer or more of a cell field.
void add_layers(const Decomposition& decomposition, Field& field, int direction, int side, int from,
                int to) {
  const Index3& size = decomposition.block().size;
  const int n = size[direction];
  const Slab ghosts =
      side == 0 ? slab(size, direction, n + from, n + to) : slab(size, direction, -to, -from);
  const Slab owner =
      side == 0 ? slab(size, direction, from, to) : slab(size, direction, n - to, n - from);
  Field* const one[] = {&field};
  Buffers& both = buffers();
  pack(both.out, one, ghosts);
  const std::vector<double>& received = shift(decomposition, direction, 1 - side, both);
  if (!decomposition.at_boundary(direction, 1 - side)) {
    for_each_row(field, ghosts, [&](std::ptrdiff_t row, int length) {
      std::fill_n(field.data() + row, length, 0.0);
    });
  }
  if (!received.empty()) unpack_add(field, owner, received);
}

}  // namespace

void fill_ghosts(const Decomposition& decomposition, std::span<Field* const> fields) {
  for (int d = 0; d < 3; ++d) {
    if (!has_neighbours(decomposition, d)) continue;
    for (int side = 0; side < 2; ++side) {
      const int layers = side == 0 ? halo + 1 : halo;
      const int stride = layers_at_once(decomposition, d, layers);
      for (int layer = 0; layer < layers; layer += stride) {
        copy_layers(decomposition, fields, d, side, layer, layer + stride);
      }
    }
  }
}

void fill_ghosts(const Decomposition& decomposition, Field& field) {
  Field* const fields[] = {&field};
  fill_ghosts(decomposition, fields);
}

void fill_ghosts(const Decomposition& decomposition, VectorField& field) {
  Field* const fields[] = {&field[0], &field[1], &field[2]};
  fill_ghosts(decomposition, fields);
}

void add_ghosts_to_owners(const Decomposition& decomposition, Field& field) {
  for (int d = 2; d >= 0; --d) {
    if (!has_neighbours(decomposition, d)) continue;
    for (int side = 1; side >= 0; --side) {
      const int stride = layers_at_once(decomposition, d, halo);
      for (int layer = halo - stride; layer >= 0; layer -= stride) {
        add_layers(decomposition, field, d, side, layer, layer + stride);
      }
    }
  }
}

void sum_over_ranks(const Decomposition& decomposition, std::span<double> values) {
  if (decomposition.size() == 1) return;
  static thread_local std::vector<double> all;
  all.resize(values.size() * decomposition.size());
  const int count = static_cast<int>(values.size());
  MPI_Allgather(values.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE,
                decomposition.communicator());
  std::fill(values.begin(), values.end(), 0.0);
  for (std::size_t n = 0; n < all.size(); ++n) values[n % values.size()] += all[n];
}

double sum_over_ranks(const Decomposition& decomposition, double value) {
  sum_over_ranks(decomposition, {&value, 1});
  return value;
}

double max_over_ranks(const Decomposition& decomposition, double value) {
  double largest = value;
  if (decomposition.size() == 1) return largest;
  MPI_Allreduce(&value, &largest, 1, MPI_DOUBLE, MPI_MAX, decomposition.communicator());
  return largest;
}

}  // namespace gasgrain::cfd
