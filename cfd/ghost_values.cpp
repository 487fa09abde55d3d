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

// Velocity along the side, of the wall or the inlet stream before division by the void fraction.
Vec3 velocity_of_side(const Boundary& side) {
  return side.type == BoundaryType::inlet ? side.superficial_velocity : side.wall_velocity;
}

void fill_tangential(const GasDomain& domain, const FaceMedium& medium, Side s, int component,
                     Field& u) {
  const Boundary& side = domain.boundaries[s.direction][s.side];
  const double value = velocity_of_side(side)[component];
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

void fill_normal(const GasDomain& domain, Side s, Field& u) {
  const int plane = domain.side_plane(s.direction, s.side);
  if (!stored(domain, s.direction, plane)) return;
  const bool outlet = domain.is_outlet(s.direction, s.side);
  const auto layers = mirrored_faces(domain, s);
  for_each_outside(domain, s, u, layers, [&](auto n, auto source) {
    const double on_side = u[(n + source) / 2];
    u[n] = outlet ? on_side : 2.0 * on_side - u[source];
  });
}

void set_prescribed_flux(const GasDomain& domain, const FaceMedium& medium, Side s, Field& u) {
  if (!domain.decomposition.at_boundary(s.direction, s.side)) return;
  const Boundary& side = domain.boundaries[s.direction][s.side];
  if (side.type == BoundaryType::outlet) return;
  const Field& open = domain.walls.open_area[s.direction];
  const double flux = side.type == BoundaryType::inlet ? side.superficial_velocity[s.direction] : 0;
  const int plane = domain.side_plane(s.direction, s.side);
  for_each_in(plane_of(domain, s.direction, plane), [&](int i, int j, int k) {
    const std::ptrdiff_t n = u.index(i, j, k);
    u[n] = open[n] > 0.0 ? flux / face_void_fraction(medium, s.direction, n) : 0.0;
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
