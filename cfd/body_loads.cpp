// What a body receives is what the gas next to it loses, term by term of the momentum budget:
//
//   friction = - momentum added by the immersed boundary / dt + sum over faces (V0 - V) slope
//   pressure = sum over cells of p (the change of their control volumes' difference by the body)
//
// V is a face's control volume and V0 the one it would have without bodies. The second friction
// term is the flux of momentum through the surface: convection and stress cancel between faces of
// equal volume, so that their sum over V0 is the sides' alone, and what V lacks against V0 has gone
// into the body. The pressure term is the summation by parts of V grad p (momentum_budget.cpp) with
// that of the undisturbed volumes, which the sides carry, taken off; it differs from zero only in
// cells next to a body. Without the stress term the force of a viscous flow would be short by what
// the faces inside the body draw from those outside.
//
// Torques: friction acts where its face is, for which the angular momentum of the gas outside
// balances; pressure acts at the point of the surface nearest to the cell's centre.
#include "cfd/body_loads.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double round_off = 1e-12;  // of a cell's volume

int nearest_body(const std::vector<Body>& bodies, const std::vector<Shape>& shapes, const Vec3& x) {
  int nearest = -1;
  double smallest = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].acts_on_gas) continue;
    const double distance = shapes[b]->distance(x);
    if (nearest >= 0 && distance >= smallest) continue;
    nearest = static_cast<int>(b);
    smallest = distance;
  }
  return nearest;
}

// Share that cell `i` of `count` gives to the face `face` of its two, without bodies.
double undisturbed_share(int i, int count, int face, bool outlet_below, bool outlet_above) {
  const double lower = i > 0 || outlet_below ? 1.0 : 0.0;
  const double upper = i + 1 < count || outlet_above ? 1.0 : 0.0;
  if (lower + upper == 0.0) return 0.0;
  return (face == i ? lower : upper) / (lower + upper);
}

}  // namespace

BodyLoads::BodyLoads(const GasDomain& domain) : domain_(domain), loads_(domain.bodies.size()) {
  find_walls();
}

// Control volume that the face would have without bodies, m^3.
double BodyLoads::undisturbed_volume(int d, const Index3& local) const {
  const int count = domain_.decomposition.grid().cells[d];
  const bool periodic = domain_.is_periodic(d);
  const bool below = periodic || domain_.is_outlet(d, 0, local),
             above = periodic || domain_.is_outlet(d, 1, local);
  const int face = local[d] + domain_.decomposition.block().lower[d];
  double shares = 0.0;
  for (int cell = face - 1; cell <= face; ++cell) {
    if (periodic) {
      shares += 0.5;
    } else if (cell >= 0 && cell < count) {
      shares += undisturbed_share(cell, count, face, below, above);
    }
  }
  return shares * domain_.cell_volume();
}

void BodyLoads::find_walls() {
  cells_.clear();
  for (std::vector<Face>& faces : faces_) faces.clear();
  if (!domain_.walls.has_bodies) return;
  const double tolerance = round_off * domain_.cell_volume();
  std::vector<Shape> shapes;
  std::vector<Vec3> reference;
  for (const Body& body : domain_.bodies) {
    shapes.push_back(shape_at(body, domain_.walls_time));
    reference.push_back(torque_point_at(body, domain_.walls_time));
  }
  const auto missing = [&](int d, const Index3& local) {
    return undisturbed_volume(d, local) - domain_.control_volume[d](local[0], local[1], local[2]);
  };
  for (int d = 0; d < 3; ++d) {
    if (!domain_.solved[d]) continue;
    for_each_face(domain_.decomposition, d, [&](int i, int j, int k) {
      const double volume = missing(d, {i, j, k});
      if (std::abs(volume) <= tolerance) return;
      const Vec3 centre = domain_.face_centre(d, i, j, k);
      const int body = nearest_body(domain_.bodies, shapes, centre);
      faces_[d].push_back(
          {domain_.open_share.index(i, j, k), body, volume, centre - reference[body]});
    });
  }
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    Vec3 below, above;
    for (int d = 0; d < 3; ++d) {
      Index3 next{i, j, k};
      ++next[d];
      below[d] = missing(d, {i, j, k});
      above[d] = missing(d, next);
    }
    const double largest = std::max(below.cwiseAbs().maxCoeff(), above.cwiseAbs().maxCoeff());
    if (domain_.open_share(i, j, k) == 1.0 && largest <= tolerance) return;
    const Vec3 centre = domain_.cell_centre(i, j, k);
    const int body = nearest_body(domain_.bodies, shapes, centre);
    const DistanceSample sample = shapes[body]->sample(centre);
    const Vec3 wall = centre - sample.distance * sample.gradient;
    cells_.push_back({{i, j, k}, body, wall - reference[body], below, above});
  });
}

void BodyLoads::clear() {
  loads_.assign(loads_.size(), {});
  stress_impulse_ = Vec3::Zero();
  std::vector<Vec3>& reference = reference_;
  reference.clear();
  for (const Body& body : domain_.bodies) {
    reference.push_back(torque_point_at(body, domain_.walls_time));
  }
}

void BodyLoads::add_stress(const VectorField& slope, double weight) {
  for (int d = 0; d < 3; ++d) {
    for (const Face& face : faces_[d]) {
      const Vec3 received = face.missing * weight * slope[d][face.face] * Vec3::Unit(d);
      loads_[face.body].friction += received;
      loads_[face.body].friction_torque += face.arm.cross(received);
      stress_impulse_ += received;
    }
  }
}

// Force of a side of the grid, as in side_force(), minus that without bodies, N.
double BodyLoads::side_term(int d, int side, const Index3& local, const Field& pressure,
                            const VectorField& gradient) const {
  const SideCondition& condition = domain_.condition(d, side, local);
  const std::ptrdiff_t cell = pressure.index(local[0], local[1], local[2]);
  const double undisturbed = domain_.face_area(d), inwards = side == 0 ? 1.0 : -1.0;
  const std::ptrdiff_t step = side == 0 ? pressure.stride(d) : -pressure.stride(d);
  const std::ptrdiff_t face = side == 0 ? cell : cell + pressure.stride(d);
  const std::ptrdiff_t next_face = face + step;
  const BoundaryType type = condition.type;
  const bool flows = type == BoundaryType::inlet || type == BoundaryType::outlet;
  const double area =
      undisturbed * (flows ? domain_.walls.open_area[d][face] : domain_.open_share[cell]);
  if (type == BoundaryType::outlet) {
    return (area - undisturbed) * condition.pressure;
  }
  const double with = pressure[cell] - inwards * 0.5 * domain_.spacing[d] * gradient[d][next_face];
  if (domain_.decomposition.grid().cells[d] == 1) return area * with - undisturbed * pressure[cell];
  const double without = pressure[cell] - 0.5 * (pressure[cell + step] - pressure[cell]);
  return area * with - undisturbed * without;
}

// Force of the gas's pressure on the body next to the cell, N.
Vec3 BodyLoads::pressure_on(const Cell& cell, const Field& pressure,
                            const VectorField& gradient) const {
  Vec3 force = Vec3::Zero();
  const Index3& local = cell.local;
  const std::ptrdiff_t n = pressure.index(local[0], local[1], local[2]);
  const Index3& first = domain_.decomposition.block().lower;
  for (int d = 0; d < 3; ++d) {
    if (!domain_.solved[d]) continue;
    const double lower = -cell.missing_below[d], upper = -cell.missing_above[d];
    force[d] += pressure[n] * (lower - upper) / domain_.spacing[d];
    if (domain_.is_periodic(d)) continue;
    for (int side = 0; side < 2; ++side) {
      const int last = side == 0 ? 0 : domain_.decomposition.grid().cells[d] - 1;
      if (local[d] + first[d] != last) continue;
      const double outwards = side == 0 ? -1.0 : 1.0;
      if (domain_.is_outlet(d, side, local)) {
        const double outside = domain_.condition(d, side, local).pressure;
        force[d] += outwards * (side == 0 ? lower : upper) / domain_.spacing[d] *
                    (2.0 * outside - pressure[n]);
      }
      force[d] -= outwards * side_term(d, side, local, pressure, gradient);
    }
  }
  return force;
}

void BodyLoads::add_pressure(const Field& pressure, const VectorField& gradient,
                             const Vec3& uniform_gradient, double dt) {
  for (int d = 0; d < 3; ++d) {
    if (uniform_gradient[d] == 0.0) continue;
    for (const Face& face : faces_[d]) {
      const Vec3 received = -dt * face.missing * uniform_gradient[d] * Vec3::Unit(d);
      loads_[face.body].pressure += received;
      loads_[face.body].pressure_torque += face.arm.cross(received);
    }
  }
  for (const Cell& cell : cells_) {
    const Vec3 received = dt * pressure_on(cell, pressure, gradient);
    loads_[cell.body].pressure += received;
    loads_[cell.body].pressure_torque += cell.arm.cross(received);
  }
}

void BodyLoads::finish(double dt) {
  std::vector<double>& values = sums_;
  values.clear();
  for (BodyLoad& load : loads_) {
    for (Vec3* part :
         {&load.pressure, &load.friction, &load.pressure_torque, &load.friction_torque})
      values.insert(values.end(), part->data(), part->data() + 3);
  }
  sum_over_ranks(domain_.decomposition, values);
  auto next = values.begin();
  for (BodyLoad& load : loads_) {
    for (Vec3* part :
         {&load.pressure, &load.friction, &load.pressure_torque, &load.friction_torque})
      for (int d = 0; d < 3; ++d) (*part)[d] = *next++ / dt;
  }
}

}  // namespace gasgrain::cfd
