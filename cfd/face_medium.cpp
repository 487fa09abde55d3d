#include "cfd/face_medium.hpp"

#include "cfd/gas_solver.hpp"
#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

bool any_grains(const GasDomain& domain, const GrainPhase& grains) {
  const double* eps = grains.void_fraction.data();
  const double* b = grains.momentum_exchange.data();
  const double signs = sum_cells(grains.void_fraction, [=](std::ptrdiff_t n) {
    return eps[n] != 1.0 || b[n] != 0.0 ? 1.0 : 0.0;
  });
  return max_over_ranks(domain.decomposition, signs) > 0.0;
}

// Weights of the cell below and above a face; zero sum where the face does not take part.
class Weights {
 public:
  Weights(const GasDomain& domain, int d)
      : stride_(domain.open_share.stride(d)),
        upper_share_(domain.walls.upper_share[d].data()),
        lower_share_(domain.walls.lower_share[d].data()),
        share_(domain.joint_share[d].data()) {}

  double below(std::ptrdiff_t n) const { return upper_share_[n - stride_] * share_[n - stride_]; }
  double above(std::ptrdiff_t n) const { return lower_share_[n] * share_[n]; }
  std::ptrdiff_t stride() const { return stride_; }

 private:
  std::ptrdiff_t stride_;
  const double* upper_share_;
  const double* lower_share_;
  const double* share_;
};

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
  const Field& cells = join_lenders(medium.joined[0], domain, d, medium.cell_void_fraction);
  const Index3& size = domain.size();
  IndexBox box{{-halo, -halo, -halo}, {size[0] + halo, size[1] + halo, size[2] + halo}};
  box.begin[d] += 1;  // the lowest ghost face has only one cell
  const Weights w(domain, d);
  const double* cell = cells.data();
  double* face = medium.void_fraction[d].data();
  for_box(box, cells, [=](std::ptrdiff_t n) {
    const double below = cell[n - w.stride()], above = cell[n];
    const double sum = w.below(n) + w.above(n);
    const double mean = (w.below(n) * below + w.above(n) * above) / (sum > 0.0 ? sum : 1.0);
    face[n] = sum > 0.0 ? mean : 0.5 * (below + above);
  });
}

void update_drag(FaceMedium& medium, const GasDomain& domain, const GrainPhase& grains, int d) {
  const double* b = join_lenders(medium.joined[0], domain, d, grains.momentum_exchange).data();
  const double* bv = join_lenders(medium.joined[1], domain, d, grains.exchange_momentum[d]).data();
  const Weights w(domain, d);
  double* face_b = medium.momentum_exchange[d].data();
  double* face_bv = medium.exchange_momentum[d].data();
  for_box(all_faces(domain, d), grains.momentum_exchange, [=](std::ptrdiff_t n) {
    const double below = w.below(n), above = w.above(n), sum = below + above;
    const double scale = (sum > 0.0 ? 1.0 : 0.0) / (sum > 0.0 ? sum : 1.0);
    face_b[n] = scale * (below * b[n - w.stride()] + above * b[n]);
    face_bv[n] = scale * (below * bv[n - w.stride()] + above * bv[n]);
  });
}

constexpr double round_off = 1e-12;

// Takes over the cells' void fractions; solid cells have none of their own.
void set_cell_void_fraction(Field& cells, const GasDomain& domain, const Field& given) {
  const double* eps = given.data();
  const double* wall = domain.walls.wall_fraction.data();
  double* result = cells.data();
  const double wrong = sum_cells(given, [=](std::ptrdiff_t n) {
    const bool solid = wall[n] == 1.0;
    result[n] = solid ? 1.0 : eps[n];
    return solid || (eps[n] > 0.0 && eps[n] <= 1.0 + round_off) ? 0.0 : 1.0;
  });
  GASGRAIN_ASSERT(wrong == 0.0);
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
  const bool had_grains = medium.has_grains;
  medium.has_grains = any_grains(domain, grains);
  if (!medium.has_grains) {
    if (had_grains) medium.cell_void_fraction.fill(1.0);
    return;
  }
  set_cell_void_fraction(medium.cell_void_fraction, domain, grains.void_fraction);
  fill_scalar_ghosts(domain, medium.cell_void_fraction);
  update(medium.edges, domain, medium.cell_void_fraction);
  Field* const drag[] = {&grains.momentum_exchange, &grains.exchange_momentum[0],
                         &grains.exchange_momentum[1], &grains.exchange_momentum[2]};
  fill_ghosts(domain.decomposition, drag);
  for (int d = 0; d < 3; ++d) {
    update_void_fraction(medium, domain, d);
    update_drag(medium, domain, grains, d);
  }
  if (domain.any_lenders) fill_ghosts(domain.decomposition, medium.void_fraction);
  if (domain.walls.has_bodies) fill_ghosts(domain.decomposition, medium.momentum_exchange);
}

}  // namespace gasgrain::cfd
