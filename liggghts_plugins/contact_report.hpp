// Passes single contacts of `pair_style gran model cgm` on to the computes and fixes of LIGGGHTS
// that ask for them: virial, compute pair/gran/local, stored contact forces, sum of normal forces.
#pragma once

#include <atom.h>
#include <fix_contact_property_atom.h>
#include <force.h>
#include <pair_gran.h>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::plugins {

// What one contact did, for those who list contact forces.
struct PairContact {
  int i, j;
  const double* delta;  // x_i - x_j, m
  const double* n;
  Vec3 force;     // on i, N; -force on j
  Vec3 torque_i;  // N m
  Vec3 torque_j;  // N m
  double squared_distance;
  double* history;  // all history values of the pair, or nullptr
};

// Passes contacts on to the computes and fixes of LIGGGHTS that ask for single contacts.
class ContactReport {
 public:
  ContactReport(LAMMPS_NS::PairGran& pair, LAMMPS_NS::Atom& atom, LAMMPS_NS::Force& force,
                bool store_forces, bool list_contacts)
      : pair_(pair),
        atom_(atom),
        newton_pair_(force.newton_pair),
        store_forces_(store_forces),
        list_contacts_(list_contacts) {}

  void operator()(const PairContact& c) const {
    const bool both = newton_pair_ || c.j < atom_.nlocal;
    if (pair_.computeflag() && pair_.store_sum_normal_force()) {
      const double f_n = c.force.dot(Eigen::Map<const Vec3>(c.n));
      *pair_.get_sum_normal_force_ptr(c.i) += f_n;
      if (both) *pair_.get_sum_normal_force_ptr(c.j) += f_n;
    }
    if (list_contacts_) list(c);
    if (pair_.evflag)
      pair_.ev_tally_xyz(c.i, c.j, atom_.nlocal, newton_pair_, 0.0, 0.0, c.force[0], c.force[1],
                         c.force[2], c.delta[0], c.delta[1], c.delta[2]);
    if (store_forces_) {
      store(pair_.fix_contact_forces(), c.i, c.j, c.force, c.torque_i);
      store(pair_.fix_contact_forces(), c.j, c.i, -c.force, c.torque_j);
    }
    if (pair_.storeContactForcesStress()) {
      store(pair_.fix_contact_forces_stress(), c.i, c.j, c.force, Vec3(c.j, 0, 0));
      store(pair_.fix_contact_forces_stress(), c.j, c.i, -c.force, Vec3(c.i, 0, 0));
    }
  }

 private:
  void list(const PairContact& c) const {
    LIGGGHTS::ContactModels::SurfacesIntersectData surfaces;
    surfaces.i = c.i;
    surfaces.j = c.j;
    surfaces.rsq = c.squared_distance;
    surfaces.contact_history = c.history;
    LIGGGHTS::ContactModels::ForceData forces;
    Eigen::Map<Vec3>(forces.delta_F) = c.force;
    Eigen::Map<Vec3>(forces.delta_torque) = c.torque_i;
    pair_.cpl_add_pair(surfaces, forces);
  }

  // The stress list takes the first four values (force and partner index), the force list all six.
  void store(LAMMPS_NS::FixContactPropertyAtom* fix, int i, int j, const Vec3& force,
             const Vec3& more) const {
    if (fix->has_partner(i, atom_.tag[j]) != -1) return;
    double values[6] = {force[0], force[1], force[2], more[0], more[1], more[2]};
    fix->add_partner(i, atom_.tag[j], values);
  }

  LAMMPS_NS::PairGran& pair_;
  LAMMPS_NS::Atom& atom_;
  int newton_pair_;
  bool store_forces_;
  bool list_contacts_;
};

struct NoReport {
  void operator()(const PairContact&) const {}
};

}  // namespace gasgrain::plugins
