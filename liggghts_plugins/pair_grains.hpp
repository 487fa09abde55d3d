// Two grains of LIGGGHTS's atom arrays as the pair style's loops need them: masses, coefficients
// and surface forces of their contact. For the file that implements pair_gran_cgm.hpp.
#pragma once

#include <atom.h>
#include <pair_gran.h>

#include "liggghts_plugins/contact_coefficients.hpp"
#include "liggghts_plugins/surface_forces.hpp"

namespace gasgrain::plugins {

// The atom arrays of LIGGGHTS; per-atom vectors are contiguous.
struct Grains {
  explicit Grains(LAMMPS_NS::Atom& atom)
      : x(atom.x[0]),
        v(atom.v[0]),
        omega(atom.omega[0]),
        radius(atom.radius),
        mass(atom.rmass),
        type(atom.type),
        mask(atom.mask),
        f(atom.f[0]),
        torque(atom.torque[0]),
        local_count(atom.nlocal) {}

  const double *x, *v, *omega;  // m, m/s, rad/s; three per atom
  const double *radius, *mass;  // m, kg
  const int *type, *mask;
  double *f, *torque;  // N, N m; three per atom
  int local_count;
};

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

inline ConstColumn column(const double* array, int i) {
  return ConstColumn(array + 3 * i);
}
inline Column column(double* array, int i) {
  return Column(array + 3 * i);
}

// Masses of the pair as LIGGGHTS sees them: a grain of a rigid body has the body's mass.
struct PairMasses {
  double i, j;  // kg
  bool i_frozen, j_frozen;
};

inline PairMasses pair_masses(const LAMMPS_NS::PairGran& pair, const Grains& g, int i, int j) {
  PairMasses m{g.mass[i], g.mass[j], (g.mask[i] & pair.freeze_group_bit()) != 0,
               (g.mask[j] & pair.freeze_group_bit()) != 0};
  if (pair.fr_pair()) {
    if (pair.mr_pair()[i] > 0.0) m.i = pair.mr_pair()[i];
    if (pair.mr_pair()[j] > 0.0) m.j = pair.mr_pair()[j];
  }
  return m;
}

inline ContactCoefficients coefficients(const GrainContact& contact, const PairMasses& m) {
  if (m.j_frozen) return contact.first_against_fixed(m.i);
  if (m.i_frozen) return contact.second_against_fixed(m.j);
  return contact.between(m.i, m.j);
}

// Surface forces of a pair, with the frozen one of it as a wall.
struct PairSurface {
  SurfaceForces forces;
  RollingPair rolling;
};

inline PairSurface pair_surface(const GrainContact& contact, const PairMasses& m, const Grains& g,
                                int i, int j) {
  const GrainSize a{m.i, g.radius[i]}, b{m.j, g.radius[j]};
  PairSurface pair;
  pair.rolling.relative_spin = column(g.omega, i) - column(g.omega, j);
  if (m.j_frozen || m.i_frozen) {
    const GrainSize& free = m.j_frozen ? a : b;
    pair.forces = m.j_frozen ? contact.surface_of_first_against_fixed(a)
                             : contact.surface_of_second_against_fixed(b);
    pair.rolling.effective_radius = free.radius;
    pair.rolling.inertia = sphere_inertia(free.mass, free.radius);
    return pair;
  }
  const double inertia_a = sphere_inertia(a.mass, a.radius);
  const double inertia_b = sphere_inertia(b.mass, b.radius);
  pair.forces = contact.surface_between(a, b);
  pair.rolling.effective_radius = a.radius * b.radius / (a.radius + b.radius);
  pair.rolling.inertia = inertia_a * inertia_b / (inertia_a + inertia_b);
  return pair;
}

}  // namespace gasgrain::plugins
