// Forward communication of ghosts between the engine's records: position, velocity and spin in one
// message per swap of LIGGGHTS's own communication pattern, which stays in charge of borders.
#pragma once

#include <mpi.h>

#include <vector>

#include "liggghts_plugins/engine/grain_loop.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

class GhostExchange {
 public:
  // Takes the pattern that Comm::borders() has made.
  void load(LAMMPS_NS::LAMMPS& lmp);
  void update_ghosts(GrainLoop& loop);

 private:
  struct Swap {
    std::vector<int> sent;  // indices of records, ghosts of earlier swaps included
    int first_received, received_count;
    int send_rank, receive_rank;
    Vec3 shift;  // through a periodic boundary, m
  };

  MPI_Comm world_ = MPI_COMM_NULL;
  int rank_ = 0;
  std::vector<Swap> swaps_;
  std::vector<double> send_buffer_, receive_buffer_;
};

}  // namespace gasgrain::plugins
