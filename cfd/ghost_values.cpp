// Outside layers are addressed by their distance from the side of the grid, not from the block, so
// that a block whose ghosts reach over a thin neighbour to beyond the side fills them as well: the
// result does not depend on the decomposition.
#include "cfd/ghost_values.hpp"

#include "cfd/face_medium.hpp"
#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

namespace {

struct Side {
  int direction, side;
};

// All stored indices in the plane `index` of a direction.
IndexBox stored_plane(const GasDomain& domain, int direction, int index) {
  const Index3& size = domain.size();
  IndexBox box{{-halo, -halo, -halo}, {size[0] + halo + 1, size[1] + halo + 1, size[2] + halo + 1}};
  box.begin[direction] = index;
  box.end[direction] = index + 1;
  return box;
}

bool stored(const GasDomain& domain, int direction, int index) {
  return index >= -halo && index <= domain.size()[direction] + halo;
}

// set(ghost, source) with storage indices for the outside layers of a side. `layer(l)` gives the
// local index of outside layer l and of its source inside.
template <class LayerIndex, class Set>
void for_each_outside(const GasDomain& domain, Side s, const Field& field, LayerIndex layer,
                      Set set) {
  const std::ptrdiff_t stride = field.stride(s.direction);
  for (int l = 1; l <= halo; ++l) {
    const auto [ghost, source] = layer(l);
    if (!stored(domain, s.direction, ghost) || !stored(domain, s.direction, source)) continue;
    for_each_row(stored_plane(domain, s.direction, ghost), field,
                 [&, step = (source - ghost) * stride](std::ptrdiff_t first, int length) {
                   for (std::ptrdiff_t n = first; n < first + length; ++n) set(n, n + step);
                 });
  }
}

// The same with set(i, j, k, ghost, source), for what depends on the place.
template <class LayerIndex, class Set>
void for_each_place_outside(const GasDomain& domain, Side s, const Field& field, LayerIndex layer,
                            Set set) {
  const std::ptrdiff_t stride = field.stride(s.direction);
  for (int l = 1; l <= halo; ++l) {
    const auto [ghost, source] = layer(l);
    if (!stored(domain, s.direction, ghost) || !stored(domain, s.direction, source)) continue;
    for_each_in(stored_plane(domain, s.direction, ghost),
                [&, step = (source - ghost) * stride](int i, int j, int k) {
                  const std::ptrdiff_t n = field.index(i, j, k);
                  set(i, j, k, n, n + step);
                });
  }
}

struct Layers {
  int ghost, source;
};

// Cell layers: outside layer l is the mirror image of inside layer l.
auto mirrored_cells(const GasDomain& domain, Side s) {
  const int plane = domain.side_plane(s.direction, s.side);
  return [plane, s](int l) {
    return s.side == 0 ? Layers{plane - l, plane + l - 1} : Layers{plane + l - 1, plane - l};
  };
}

auto mirrored_faces(const GasDomain& domain, Side s) {
  const int plane = domain.side_plane(s.direction, s.side);
  return [plane, s](int l) {
    return s.side == 0 ? Layers{plane - l, plane + l} : Layers{plane + l, plane - l};
  };
}

// The value outside that makes the one on the side right for one condition: `given` is that of the
// wall or the inlet stream, before division by the void fraction.
double mirrored(BoundaryType type, double given, double inside, double void_fraction) {
  if (type == BoundaryType::slip || type == BoundaryType::outlet) return inside;
  const double stream = type == BoundaryType::inlet ? given / void_fraction : given;
  return 2.0 * stream - inside;
}

// A tangential velocity sits between two faces of the side; with different conditions the value
// outside is the mean of what each asks for.
void fill_tangential_by_faces(const GasDomain& domain, const FaceMedium& medium, Side s,
                              int component, Field& u) {
  const SideConditions& sides = domain.sides;
  for_each_place_outside(
      domain, s, u, mirrored_cells(domain, s), [&](int i, int j, int k, auto n, auto source) {
        const double eps = face_void_fraction(medium, component, source);
        Index3 cell = domain.global_cell(i, j, k);
        double sum = 0.0;
        for (int beside = 0; beside < 2; ++beside, --cell[component]) {
          const SideCondition& condition = sides.at(s.direction, s.side, cell);
          const double given = sides.velocity(s.direction, s.side, cell)[component];
          sum += mirrored(condition.type, given, u[source], eps);
        }
        u[n] = 0.5 * sum;
      });
}

void fill_tangential(const GasDomain& domain, const FaceMedium& medium, Side s, int component,
                     Field& u) {
  if (!domain.sides.is_uniform(s.direction, s.side)) {
    fill_tangential_by_faces(domain, medium, s, component, u);
    return;
  }
  const SideCondition& side = domain.sides.at(s.direction, s.side, {});
  const double value = side.velocity[component];
  const auto layers = mirrored_cells(domain, s);
  if (side.type == BoundaryType::slip || side.type == BoundaryType::outlet) {
    for_each_outside(domain, s, u, layers, [&](auto n, auto source) { u[n] = u[source]; });
  } else if (side.type == BoundaryType::inlet && medium.has_grains && value != 0.0) {
    const Field& eps = medium.void_fraction[component];
    for_each_outside(domain, s, u, layers,
                     [&](auto n, auto source) { u[n] = 2.0 * value / eps[source] - u[source]; });
  } else {
    for_each_outside(domain, s, u, layers,
                     [&](auto n, auto source) { u[n] = 2.0 * value - u[source]; });
  }
}

void fill_normal_by_faces(const GasDomain& domain, Side s, Field& u) {
  for_each_place_outside(
      domain, s, u, mirrored_faces(domain, s), [&](int i, int j, int k, auto n, auto source) {
        const double on_side = u[(n + source) / 2];
        const bool outlet =
            domain.sides.at(s.direction, s.side, domain.global_cell(i, j, k)).type ==
            BoundaryType::outlet;
        u[n] = outlet ? on_side : 2.0 * on_side - u[source];
      });
}

void fill_normal(const GasDomain& domain, Side s, Field& u) {
  const int plane = domain.side_plane(s.direction, s.side);
  if (!stored(domain, s.direction, plane)) return;
  if (!domain.sides.is_uniform(s.direction, s.side)) {
    fill_normal_by_faces(domain, s, u);
    return;
  }
  const bool outlet = domain.sides.at(s.direction, s.side, {}).type == BoundaryType::outlet;
  const auto layers = mirrored_faces(domain, s);
  for_each_outside(domain, s, u, layers, [&](auto n, auto source) {
    const double on_side = u[(n + source) / 2];
    u[n] = outlet ? on_side : 2.0 * on_side - u[source];
  });
}

void set_prescribed_flux(const GasDomain& domain, const FaceMedium& medium, Side s, Field& u) {
  if (!domain.decomposition.at_boundary(s.direction, s.side)) return;
  const SideConditions& sides = domain.sides;
  const Field& open = domain.walls.open_area[s.direction];
  const int plane = domain.side_plane(s.direction, s.side);
  for_each_in(plane_of(domain, s.direction, plane), [&](int i, int j, int k) {
    const std::ptrdiff_t n = u.index(i, j, k);
    const Index3 cell = domain.global_cell(i, j, k);
    const BoundaryType type = sides.at(s.direction, s.side, cell).type;
    if (type == BoundaryType::outlet) return;
    u[n] = 0.0;
    if (type != BoundaryType::inlet || open[n] == 0.0) return;
    const double flux = sides.velocity(s.direction, s.side, cell)[s.direction];
    u[n] = flux / face_void_fraction(medium, s.direction, n);
  });
}

template <class Visit>
void for_each_side(const GasDomain& domain, Visit&& visit) {
  for (int d = 0; d < 3; ++d) {
    if (domain.is_periodic(d)) continue;
    for (int side = 0; side < 2; ++side) visit(Side{d, side});
  }
}

}  // namespace

void fill_scalar_ghosts(const GasDomain& domain, Field& field) {
  fill_ghosts(domain.decomposition, field);
  for_each_side(domain, [&](Side s) {
    const int inside = domain.side_layer(s.direction, s.side);
    const int out = s.side == 0 ? -1 : 1;
    for_each_outside(
        domain, s, field,
        [=](int l) {
          return Layers{inside + out * l, inside};
        },
        [&](auto n, auto source) { field[n] = field[source]; });
  });
}

void fill_velocity_ghosts(const GasDomain& domain, const FaceMedium& medium,
                          VectorField& velocity) {
  for_each_side(domain,
                [&](Side s) { set_prescribed_flux(domain, medium, s, velocity[s.direction]); });
  fill_ghosts(domain.decomposition, velocity);
  for_each_side(domain, [&](Side s) {
    for (int component = 0; component < 3; ++component) {
      if (component == s.direction) {
        fill_normal(domain, s, velocity[component]);
      } else {
        fill_tangential(domain, medium, s, component, velocity[component]);
      }
    }
  });
}

}  // namespace gasgrain::cfd
