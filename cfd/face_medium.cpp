#include "cfd/face_medium.hpp"

#include "cfd/felt_gradient.hpp"
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

// While `visit` runs the hosts among the cells have the value joined with that of their lenders,
// weighted by open volume. `values` is work space.
template <class Visit>
void with_lenders_joined(std::vector<double>& values, Field& cells, const GasDomain& domain, int d,
                         const Visit& visit) {
  const std::vector<Lender>& lenders = domain.lenders[d];
  const Field &own = domain.open_share, &joint = domain.joint_share[d];
  values.clear();
  for (const Lender& lender : lenders) {
    values.push_back(cells[lender.cell]);
    values.push_back(cells[lender.host]);
  }
  for (std::size_t n = 0; n < lenders.size(); ++n) {  // a host of several is set to the same again
    const std::ptrdiff_t host = lenders[n].host;
    cells[host] = values[2 * n + 1] * own[host] / joint[host];
  }
  for (std::size_t n = 0; n < lenders.size(); ++n) {
    cells[lenders[n].host] += values[2 * n] * own[lenders[n].cell] / joint[lenders[n].host];
  }
  visit();
  for (std::size_t n = 0; n < lenders.size(); ++n) cells[lenders[n].host] = values[2 * n + 1];
}

// All faces but the lowest ghosts, which have only one cell.
IndexBox faces_between_cells(const GasDomain& domain, int d) {
  const Index3& size = domain.size();
  IndexBox box{{-halo, -halo, -halo}, {size[0] + halo, size[1] + halo, size[2] + halo}};
  box.begin[d] += 1;
  return box;
}

void set_weights(FaceMedium& medium, const GasDomain& domain, int d) {
  Field &below = medium.weight_below[d], &above = medium.weight_above[d];
  below = above = Field(domain.size());
  const Field &lower = domain.walls.lower_share[d], &upper = domain.walls.upper_share[d];
  const Field& share = domain.joint_share[d];
  for_box(faces_between_cells(domain, d), share, [&, s = share.stride(d)](std::ptrdiff_t n) {
    const double of_lower = upper[n - s] * share[n - s], of_upper = lower[n] * share[n];
    const double sum = of_lower + of_upper;
    if (sum > 0.0) {
      below[n] = of_lower / sum;
      above[n] = of_upper / sum;
    }
  });
}

// Void fraction of the faces of direction d from that of the cells.
void set_faces(Field& faces, const FaceMedium& medium, const Field& cells, int d,
               const IndexBox& part) {
  const std::ptrdiff_t s = cells.stride(d);
  const double *below = medium.weight_below[d].data(), *above = medium.weight_above[d].data();
  const double* eps = cells.data();
  double* face_eps = faces.data();
  for_box(part, cells, [=](std::ptrdiff_t n) {
    const double mean = below[n] * eps[n - s] + above[n] * eps[n];
    face_eps[n] = below[n] + above[n] > 0.0 ? mean : 0.5 * (eps[n - s] + eps[n]);
  });
}

// Void fraction and drag of the faces of direction d from those of the cells.
void update_faces(FaceMedium& medium, const GasDomain& domain, const GrainPhase& grains, int d) {
  const Field& like = medium.cell_void_fraction;
  const std::ptrdiff_t s = like.stride(d);
  const double *below = medium.weight_below[d].data(), *above = medium.weight_above[d].data();
  const double* b = grains.momentum_exchange.data();
  const double* bv = grains.exchange_momentum[d].data();
  double* face_b = medium.momentum_exchange[d].data();
  double* face_bv = medium.exchange_momentum[d].data();
  for_each_part(faces_between_cells(domain, d), [&](const IndexBox& part) {
    set_faces(medium.void_fraction[d], medium, like, d, part);
    for_box(intersection(part, all_faces(domain, d)), like, [=](std::ptrdiff_t n) {
      face_b[n] = below[n] * b[n - s] + above[n] * b[n];
      face_bv[n] = below[n] * bv[n - s] + above[n] * bv[n];
    });
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
  find_walls(medium, domain);
  medium.has_scaling = domain.walls.spans_bodies;
  for (int d = 0; d < 3; ++d) {
    medium.void_fraction[d] = Field(domain.size(), 1.0);
    medium.momentum_exchange[d] = Field(domain.size());
    medium.exchange_momentum[d] = Field(domain.size());
    if (!medium.has_scaling) continue;
    Field& scaling = medium.density_scaling[d] = Field(domain.size());
    for (std::size_t n = 0; n < scaling.count(); ++n) {
      scaling[n] = 1.0 + (domain.density_scaling - 1.0) * domain.walls.solid_share[d][n];
    }
  }
  return medium;
}

void find_walls(FaceMedium& medium, const GasDomain& domain) {
  medium.edges = make_edge_void_fraction(domain);
  for (int d = 0; d < 3; ++d) set_weights(medium, domain, d);
}

void update(FaceMedium& medium, const GasDomain& domain, GrainPhase& grains) {
  const bool had_grains = medium.has_grains;
  medium.has_grains = any_grains(domain, grains);
  medium.lag = medium.has_grains ? lag_of(grains.density_ratio) : 0.0;
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
    with_lenders_joined(medium.lent[0], medium.cell_void_fraction, domain, d, [&] {
      with_lenders_joined(medium.lent[1], grains.momentum_exchange, domain, d, [&] {
        with_lenders_joined(medium.lent[2], grains.exchange_momentum[d], domain, d,
                            [&] { update_faces(medium, domain, grains, d); });
      });
    });
  }
  if (domain.any_lenders) fill_ghosts(domain.decomposition, medium.void_fraction);
  if (domain.walls.has_bodies) fill_ghosts(domain.decomposition, medium.momentum_exchange);
}

void divide_interval(FaceMedium& medium, const GasDomain& domain, const Field& end) {
  Field cells(domain.size());
  set_cell_void_fraction(cells, domain, end);
  fill_scalar_ghosts(domain, cells);
  for (int d = 0; d < 3; ++d) {
    Field& faces = medium.coming_void_fraction[d];
    if (faces.count() == 0) faces = Field(domain.size(), 1.0);
    with_lenders_joined(medium.lent[0], cells, domain, d, [&] {
      set_faces(faces, medium, cells, d, faces_between_cells(domain, d));
    });
  }
  if (domain.any_lenders) fill_ghosts(domain.decomposition, medium.coming_void_fraction);
  medium.is_divided = true;
}

}  // namespace gasgrain::cfd
