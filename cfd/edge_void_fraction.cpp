// Inside the grid the four cells around an edge are weighted by their open volumes. An edge on a
// side of the grid has cells on one side only, half a cell away: their mean would be wrong by
// h/2 d(eps)/dn, and with it the friction of the side; the pressure of the manufactured solution of
// tests/verification would lose its order (1.8 instead of 2). So eps is extrapolated,
//
//   eps_side = eps_0 + (eps_0 - eps_1)/2 + O(h^2),
//
// in a form that needs no limiter to stay in (0, 1]: 2 a^2/(a + b) = a + (a - b)/2 + O((a - b)^2)
// is positive, and is applied to eps where it falls towards the side, to 1 - eps where it rises.
#include "cfd/edge_void_fraction.hpp"

namespace gasgrain::cfd {

namespace {

double extrapolated_decrease(double first, double second) {
  return 2.0 * first * first / (first + second);
}

// visit(outside, inside, behind): storage indices of a cell outside a side of the grid, of the one
// inside and of the next one inwards. Cells outside of two sides at once are left out.
template <class Visit>
void for_each_cell_outside(const GasDomain& domain, const Field& like, Visit visit) {
  const Decomposition& blocks = domain.decomposition;
  const Index3& size = domain.size();
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      if (!blocks.at_boundary(d, side)) continue;
      IndexBox box{{-1, -1, -1}, {size[0] + 1, size[1] + 1, size[2] + 1}};
      for (int e = 0; e < 3; ++e) {
        if (blocks.at_boundary(e, 0)) box.begin[e] = 0;
        if (blocks.at_boundary(e, 1)) box.end[e] = size[e];
      }
      box.begin[d] = domain.side_layer(d, side);
      box.end[d] = box.begin[d] + 1;
      const std::ptrdiff_t outwards = (side == 0 ? -1 : 1) * like.stride(d);
      for_each_in(box, [&](int i, int j, int k) {
        const std::ptrdiff_t inside = like.index(i, j, k);
        visit(inside + outwards, inside, inside - outwards);
      });
    }
  }
}

// 1 / sum of the shares around the edges along d, 0 where it is 0.
Field edge_weights(const GasDomain& domain, const Field& share, int d) {
  Field weights(domain.size());
  const std::ptrdiff_t a = share.stride((d + 1) % 3), b = share.stride((d + 2) % 3);
  const Index3& size = domain.size();
  for_each_in({{-1, -1, -1}, {size[0] + halo, size[1] + halo, size[2] + halo}},
              [&](int i, int j, int k) {
                const std::ptrdiff_t n = share.index(i, j, k);
                const double sum = share[n] + share[n - a] + share[n - b] + share[n - a - b];
                weights[n] = sum > 0.0 ? 1.0 / sum : 0.0;
              });
  return weights;
}

}  // namespace

double void_fraction_on_side(double first, double second) {
  if (first < second) return extrapolated_decrease(first, second);
  if (first > second) return 1.0 - extrapolated_decrease(1.0 - first, 1.0 - second);
  return first;
}

EdgeVoidFraction make_edge_void_fraction(const GasDomain& domain) {
  EdgeVoidFraction edges;
  edges.share = domain.open_share;
  for_each_cell_outside(domain, edges.share, [&](auto outside, auto inside, auto) {
    edges.share[outside] = edges.share[inside];
  });
  edges.gas = edges.share;
  for (int d = 0; d < 3; ++d) edges.per_share[d] = edge_weights(domain, edges.share, d);
  return edges;
}

void update(EdgeVoidFraction& edges, const GasDomain& domain, const Field& cells) {
  const double* share = edges.share.data();
  const double* eps = cells.data();
  double* gas = edges.gas.data();
  const std::size_t count = cells.count();
#pragma omp simd
  for (std::size_t n = 0; n < count; ++n) gas[n] = share[n] * eps[n];
  for_each_cell_outside(domain, cells, [&](auto outside, auto inside, auto behind) {
    if (edges.share[inside] == 0.0 || edges.share[behind] == 0.0) return;
    const double on_side = void_fraction_on_side(cells[inside], cells[behind]);
    edges.gas[outside] = edges.share[outside] * (2.0 * on_side - cells[inside]);
  });
}

}  // namespace gasgrain::cfd
