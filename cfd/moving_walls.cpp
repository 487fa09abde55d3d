// Volume swept by moving bodies, from the velocity of their surface and not from the change of the
// cells' open volumes: open areas change smoothly in time and the flux telescopes over the cells,
// so that a rigid motion of gas and body together satisfies the continuity equation to round-off
// (geometric conservation) and a sealed vessel neither gains nor loses gas, whatever the error of
// the discrete volume of the body. A rotation u = w x r is discretely free of divergence because
// its component d does not change along d.
//
// Source of the idea: Seo & Mittal, J. Comput. Phys. 230 (2011) 7347 (cut cells in the continuity
// equation of an immersed boundary against pressure oscillations).
#include "cfd/moving_walls.hpp"

#include <algorithm>

#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double fullest = 0.9;  // share of a cell's gas that carried grains may fill

struct MovingBody {
  const Body* body;
  Shape shape;
};

std::vector<MovingBody> moving_bodies(const GasDomain& domain) {
  std::vector<MovingBody> moving;
  for (const Body& body : domain.bodies) {
    if (body.acts_on_gas && !body.motion.is_at_rest()) {
      moving.push_back({&body, shape_at(body, domain.walls_time)});
    }
  }
  return moving;
}

// Component d of the velocity of the nearest of these bodies at x, m/s.
double body_velocity(const std::vector<MovingBody>& moving, const Vec3& x, int d, double time) {
  const MovingBody* nearest = &moving.front();
  if (moving.size() > 1) {
    double smallest = nearest->shape->distance(x);
    for (const MovingBody& candidate : moving) {
      const double distance = candidate.shape->distance(x);
      if (distance >= smallest) continue;
      smallest = distance;
      nearest = &candidate;
    }
  }
  return nearest->body->motion.velocity_at(x, time)[d];
}

}  // namespace

void set_swept_volume(Field& swept, const GasDomain& domain) {
  const std::vector<MovingBody> moving = moving_bodies(domain);
  swept.fill(0.0);
  const Index3& size = domain.size();
  for (int d = 0; d < 3; ++d) {
    const Field &open = domain.walls.open_area[d], &at_rest = domain.resting_open_area[d];
    Index3 faces = size;
    ++faces[d];
    for_each_cell(faces, [&](int i, int j, int k) {
      const std::ptrdiff_t n = open.index(i, j, k);
      const double covered = at_rest[n] - open[n];
      if (covered == 0.0) return;
      const Vec3 centre = domain.face_centre(d, i, j, k);
      const double flux =
          -covered * domain.face_area(d) * body_velocity(moving, centre, d, domain.walls_time);
      const Index3 index{i, j, k};
      if (index[d] < size[d]) swept[n] -= flux;
      if (index[d] > 0) swept[n - open.stride(d)] += flux;
    });
  }
}

double carry_grains(Field& void_fraction, const GasDomain& domain, const Field& old_open_share) {
  const Index3& size = domain.size();
  Field solid(size), excess(size), capacity(size);
  for_each_cell(size, [&](int i, int j, int k) {
    const std::ptrdiff_t n = solid.index(i, j, k);
    solid[n] = old_open_share[n] * (1.0 - void_fraction[n]);
    const double room = fullest * domain.open_share[n];
    const double kept =
        std::max(room, std::min(solid[n], domain.open_share[n] * (1.0 - void_fraction[n])));
    excess[n] = std::max(0.0, solid[n] - kept);
    capacity[n] = std::max(0.0, room - solid[n]);
  });
  fill_ghosts(domain.decomposition, capacity);
  Field per_capacity(size);  // what a cell gives away over the room around it
  double lost = 0.0;
  for_each_cell(size, [&](int i, int j, int k) {
    const std::ptrdiff_t n = solid.index(i, j, k);
    if (excess[n] == 0.0) return;
    double room = 0.0;
    for (int d = 0; d < 3; ++d) {
      room += capacity[n - solid.stride(d)] + capacity[n + solid.stride(d)];
    }
    if (room > 0.0) per_capacity[n] = excess[n] / room;
    if (room == 0.0 && domain.open_share[n] == 0.0) lost += excess[n];
    if (room > 0.0 || domain.open_share[n] == 0.0) solid[n] -= excess[n];
  });
  fill_ghosts(domain.decomposition, per_capacity);
  for_each_cell(size, [&](int i, int j, int k) {
    const std::ptrdiff_t n = solid.index(i, j, k);
    for (int d = 0; d < 3; ++d) {
      solid[n] +=
          capacity[n] * (per_capacity[n - solid.stride(d)] + per_capacity[n + solid.stride(d)]);
    }
    const double open = domain.open_share[n];
    void_fraction[n] = open > 0.0 ? 1.0 - solid[n] / open : 1.0;
  });
  return lost * domain.cell_volume();
}

void fill_fresh_cells(Field& pressure, const GasDomain& domain, const Field& old_open_share) {
  Field filled = pressure;
  for_each_cell(domain.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = pressure.index(i, j, k);
    if (domain.open_share[n] == 0.0 || old_open_share[n] > 0.0) return;
    double sum = 0.0, count = 0.0;
    for (int d = 0; d < 3; ++d) {
      for (const std::ptrdiff_t m : {n - pressure.stride(d), n + pressure.stride(d)}) {
        if (old_open_share[m] == 0.0) continue;
        sum += pressure[m];
        count += 1.0;
      }
    }
    filled[n] = count > 0.0 ? sum / count : 0.0;
  });
  pressure = std::move(filled);
  fill_ghosts(domain.decomposition, pressure);
}

}  // namespace gasgrain::cfd
