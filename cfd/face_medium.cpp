#include "cfd/face_medium.hpp"

#include "cfd/gas_solver.hpp"
#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

bool any_grains(const GasDomain& domain, const GrainPhase& grains) {
  bool any = false;
  for_each_cell(domain.size(), [&](int i, int j, int k) {
    any = any || grains.void_fraction(i, j, k) != 1.0 || grains.momentum_exchange(i, j, k) != 0.0;
  });
  return max_over_ranks(domain.decomposition, any ? 1.0 : 0.0) > 0.0;
}

// Weights of the cell below and above a face; zero sum where the face does not take part.
struct Weights {
  double below, above;
};

Weights weights_of(const GasDomain& domain, int d, std::ptrdiff_t n) {
  const std::ptrdiff_t below = n - domain.open_share.stride(d);
  return {domain.walls.upper_share[d][below] * domain.joint_share[d][below],
          domain.walls.lower_share[d][n] * domain.joint_share[d][n]};
}

// The cells' values with those of lenders joined to their hosts', weighted by open volume. Without
// lenders it is `cells` itself; otherwise `joined` holds the result.
const Field& join_lenders(Field& joined, const GasDomain& domain, int d, const Field& cells) {
  if (domain.lenders[d].empty()) return cells;
  joined = cells;
  const Field &own = domain.open_share, &joint = domain.joint_share[d];
  for (const Lender& lender : domain.lenders[d]) {  // a host of several is set to the same again
    joined[lender.host] = cells[lender.host] * own[lender.host] / joint[lender.host];
  }
  for (const Lender& lender : domain.lenders[d]) {
    joined[lender.host] += cells[lender.cell] * own[lender.cell] / joint[lender.host];
  }
  return joined;
}

void update_void_fraction(FaceMedium& medium, const GasDomain& domain, int d) {
  Field joined;
  const Field& cells = join_lenders(joined, domain, d, medium.cell_void_fraction);
  const Index3& size = domain.size();
  IndexBox box{{-halo, -halo, -halo}, {size[0] + halo, size[1] + halo, size[2] + halo}};
  box.begin[d] += 1;  // the lowest ghost face has only one cell
  for_each_row(box, cells, [&](std::ptrdiff_t first, int length) {
    for (std::ptrdiff_t n = first; n < first + length; ++n) {
      const double below = cells[n - cells.stride(d)], above = cells[n];
      const Weights w = weights_of(domain, d, n);
      const double sum = w.below + w.above;
      medium.void_fraction[d][n] =
          sum > 0.0 ? (w.below * below + w.above * above) / sum : 0.5 * (below + above);
    }
  });
}

void update_drag(FaceMedium& medium, const GasDomain& domain, const GrainPhase& grains, int d) {
  Field joined_b, joined_bv;
  const Field& b = join_lenders(joined_b, domain, d, grains.momentum_exchange);
  const Field& bv = join_lenders(joined_bv, domain, d, grains.exchange_momentum[d]);
  for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
    const std::ptrdiff_t n = b.index(i, j, k), below = n - b.stride(d);
    const Weights w = weights_of(domain, d, n);
    const double sum = w.below + w.above;
    const double scale = sum > 0.0 ? 1.0 / sum : 0.0;
    medium.momentum_exchange[d][n] = scale * (w.below * b[below] + w.above * b[n]);
    medium.exchange_momentum[d][n] = scale * (w.below * bv[below] + w.above * bv[n]);
  });
}

constexpr double round_off = 1e-12;

void check_void_fraction(const GasDomain& domain, const Field& void_fraction) {
  for_each_cell(domain.size(), [&](int i, int j, int k) {
    const double eps = void_fraction(i, j, k);
    GASGRAIN_ASSERT((eps > 0.0 && eps <= 1.0 + round_off) ||
                    domain.walls.wall_fraction(i, j, k) == 1.0);
  });
}

}  // namespace

FaceMedium make_face_medium(const GasDomain& domain) {
  FaceMedium medium;
  medium.cell_void_fraction = Field(domain.size(), 1.0);
  medium.edges = make_edge_void_fraction(domain);
  for (int d = 0; d < 3; ++d) {
    medium.void_fraction[d] = Field(domain.size(), 1.0);
    medium.momentum_exchange[d] = Field(domain.size());
    medium.exchange_momentum[d] = Field(domain.size());
  }
  return medium;
}

void update(FaceMedium& medium, const GasDomain& domain, GrainPhase& grains) {
  medium.has_grains = any_grains(domain, grains);
  if (!medium.has_grains) {
    medium.cell_void_fraction.fill(1.0);
    return;
  }
  medium.cell_void_fraction = grains.void_fraction;
  check_void_fraction(domain, grains.void_fraction);
  for_each_cell(domain.size(), [&](int i, int j, int k) {
    if (domain.walls.wall_fraction(i, j, k) == 1.0) medium.cell_void_fraction(i, j, k) = 1.0;
  });
  fill_scalar_ghosts(domain, medium.cell_void_fraction);
  update(medium.edges, domain, medium.cell_void_fraction);
  fill_ghosts(domain.decomposition, grains.momentum_exchange);
  fill_ghosts(domain.decomposition, grains.exchange_momentum);
  for (int d = 0; d < 3; ++d) {
    update_void_fraction(medium, domain, d);
    update_drag(medium, domain, grains, d);
  }
  if (domain.any_lenders) fill_ghosts(domain.decomposition, medium.void_fraction);
}

}  // namespace gasgrain::cfd
