#include "cfd/multigrid_level.hpp"

#include <algorithm>

namespace gasgrain::cfd {

namespace {

struct FaceLoop {
  std::array<int, 3> lower{0, 0, 0};
  std::array<int, 3> upper;
};

void pack(const MultigridLevel& level, const FaceLoop& loop, const std::vector<float>& from,
          std::vector<float>& buffer) {
  std::size_t n = 0;
  for (int k = loop.lower[2]; k < loop.upper[2]; ++k)
    for (int j = loop.lower[1]; j < loop.upper[1]; ++j)
      for (int i = loop.lower[0]; i < loop.upper[0]; ++i) buffer[n++] = from[level.at(i, j, k)];
}

void unpack(const MultigridLevel& level, const FaceLoop& loop, const std::vector<float>& buffer,
            std::vector<float>& to) {
  std::size_t n = 0;
  for (int k = loop.lower[2]; k < loop.upper[2]; ++k)
    for (int j = loop.lower[1]; j < loop.upper[1]; ++j)
      for (int i = loop.lower[0]; i < loop.upper[0]; ++i) to[level.at(i, j, k)] = buffer[n++];
}

}  // namespace

void MultigridLevel::allocate(const Index3& n) {
  size = n;
  stride = {1, n[0] + 2, std::ptrdiff_t(n[0] + 2) * (n[1] + 2)};
  const std::size_t count = stride[2] * (n[2] + 2);
  for (auto* v : {&face[0], &face[1], &face[2], &outlet, &inverse_diagonal, &x, &b}) {
    v->assign(count, 0.0F);
  }
  const std::size_t largest_face =
      std::max({std::size_t(n[0]) * n[1], std::size_t(n[1]) * n[2], std::size_t(n[0]) * n[2]});
  send.resize(largest_face);
  receive.resize(largest_face);
}

void MultigridLevel::fill_ghosts(const Decomposition& blocks) {
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {  // send towards `side`, receive from the other one
      const int to = blocks.neighbour(d, side);
      const int from = blocks.neighbour(d, 1 - side);
      if (to == MPI_PROC_NULL && from == MPI_PROC_NULL) continue;
      FaceLoop out{.lower = {0, 0, 0}, .upper = size};
      out.lower[d] = side == 0 ? 0 : size[d] - 1;
      out.upper[d] = out.lower[d] + 1;
      FaceLoop in{.lower = {0, 0, 0}, .upper = size};
      in.lower[d] = side == 0 ? size[d] : -1;
      in.upper[d] = in.lower[d] + 1;
      const int count = static_cast<int>(cells() / size[d]);
      pack(*this, out, x, send);
      MPI_Sendrecv(send.data(), count, MPI_FLOAT, to, 2 * d + side, receive.data(), count,
                   MPI_FLOAT, from, 2 * d + side, blocks.communicator(), MPI_STATUS_IGNORE);
      if (from != MPI_PROC_NULL) unpack(*this, in, receive, x);
    }
  }
}

void MultigridLevel::set_inverse_diagonal() {
  const float* x_face = face[0].data();
  const float* y_face = face[1].data();
  const float* z_face = face[2].data();
  const float* extra = outlet.data();
  float* inverse = inverse_diagonal.data();
  const std::ptrdiff_t sy = stride[1], sz = stride[2];
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j) {
      const std::ptrdiff_t row = at(0, j, k);
#pragma omp simd
      for (std::ptrdiff_t c = row; c < row + size[0]; ++c) {
        const float sum = extra[c] + x_face[c] + x_face[c + 1] + y_face[c] + y_face[c + sy] +
                          z_face[c] + z_face[c + sz];
        inverse[c] = (sum > 0 ? 1.0F : 0.0F) / (sum > 0 ? sum : 1.0F);
      }
    }
}

void MultigridLevel::smooth(int colour) {
  const float* __restrict tx = face[0].data();
  const float* __restrict ty = face[1].data();
  const float* __restrict tz = face[2].data();
  const float* __restrict inverse = inverse_diagonal.data();
  const float* __restrict right = b.data();
  float* p = x.data();
  const std::ptrdiff_t sy = stride[1];
  const std::ptrdiff_t sz = stride[2];
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j) {
      const std::ptrdiff_t row = at(0, j, k);
      const std::ptrdiff_t end = row + size[0];
#pragma GCC ivdep
      for (std::ptrdiff_t c = row + ((colour + parity + j + k) & 1); c < end; c += 2) {
        p[c] =
            inverse[c] * (right[c] + tx[c] * p[c - 1] + tx[c + 1] * p[c + 1] + ty[c] * p[c - sy] +
                          ty[c + sy] * p[c + sy] + tz[c] * p[c - sz] + tz[c + sz] * p[c + sz]);
      }
    }
}

void MultigridLevel::smooth_from_zero(int colour) {
  std::fill(x.begin(), x.end(), 0.0F);
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j) {
      const std::ptrdiff_t row = at(0, j, k);
      for (int i = (colour + parity + j + k) & 1; i < size[0]; i += 2) {
        x[row + i] = inverse_diagonal[row + i] * b[row + i];
      }
    }
}

void MultigridLevel::coarsen_coefficients(MultigridLevel& coarse) const {
  const MultigridLevel& fine = *this;
  const auto& joined = fine.coarsening;
  const bool any = joined[0] * joined[1] * joined[2] > 1;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3;
    const int f = (d + 2) % 3;
    std::array<int, 3> c{};
    for (c[f] = 0; c[f] < coarse.size[f]; ++c[f])
      for (c[e] = 0; c[e] < coarse.size[e]; ++c[e])
        for (c[d] = 0; c[d] <= coarse.size[d]; ++c[d]) {
          std::array<int, 3> n{};
          n[d] = std::min(c[d] * joined[d], fine.size[d]);
          double sum = 0;
          for (n[f] = c[f] * joined[f]; n[f] < std::min((c[f] + 1) * joined[f], fine.size[f]);
               ++n[f])
            for (n[e] = c[e] * joined[e]; n[e] < std::min((c[e] + 1) * joined[e], fine.size[e]);
                 ++n[e])
              sum += fine.face[d][fine.at(n[0], n[1], n[2])];
          const double fine_distance = fine.width[d][n[d]] + fine.width[d][n[d] + 1];
          const double coarse_distance = coarse.width[d][c[d]] + coarse.width[d][c[d] + 1];
          coarse.face[d][coarse.at(c[0], c[1], c[2])] =
              static_cast<float>(sum * fine_distance / coarse_distance);
        }
  }
  // Pressure outlets: the distance to the outlet doubles with the cell.
  std::fill(coarse.outlet.begin(), coarse.outlet.end(), 0.0F);
  for (int k = 0; k < fine.size[2]; ++k)
    for (int j = 0; j < fine.size[1]; ++j)
      for (int i = 0; i < fine.size[0]; ++i) {
        coarse.outlet[coarse.at(i / joined[0], j / joined[1], k / joined[2])] +=
            (any ? 0.5F : 1.0F) * fine.outlet[fine.at(i, j, k)];
      }
}

}  // namespace gasgrain::cfd
