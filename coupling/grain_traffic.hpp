// Grains that come or go while the gas runs: inserted ones and those that leave the box.
#pragma once

#include <mpi.h>

#include "cfd/state_archive.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

// One grain that appears or leaves, and when.
struct GrainPassage {
  double mass;    // kg
  Vec3 position;  // m
  Vec3 velocity;  // m/s
  double energy;  // J, kinetic with rotation
  double time;    // s since the last take()
};

// Sums since the last take(); appeared minus left.
struct TrafficSums {
  long appeared = 0, left = 0;
  double mass = 0.0;                // kg
  double mass_time = 0.0;           // kg s: sum of mass times the time of passage
  Vec3 momentum = Vec3::Zero();     // kg m/s
  Vec3 mass_moment = Vec3::Zero();  // kg m: mass times place
  double energy = 0.0;              // J
  // Impulse of the gas that the grains that left would have received after that, N s.
  Vec3 undelivered = Vec3::Zero();
};

class GrainTraffic {
 public:
  void appeared(const GrainPassage& grain);
  // `held` is the gas force on the grain, N; `mid_step`: between the halves of a step's kick.
  enum class Moment { mid_step, between_steps };
  void left(const GrainPassage& grain, const Vec3& held, Moment moment);
  // In every DEM step after passages, s.
  void force_applied(double dem_step);
  // New forces are held from now on.
  void exchanged() { held_.setZero(); }

  // Sums over all ranks; starts anew. Collective.
  TrafficSums take(MPI_Comm communicator);

  void visit_state(cfd::StateArchive& archive);

 private:
  TrafficSums sums_;             // of this rank
  Vec3 held_ = Vec3::Zero();     // N, of grains that left since the last exchange
  Vec3 applied_ = Vec3::Zero();  // N, what the integrator would have of it
};

}  // namespace gasgrain::coupling
