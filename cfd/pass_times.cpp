#include "cfd/pass_times.hpp"

#include <mpi.h>

#include <ctime>

namespace gasgrain::cfd {

namespace {

PassTime now() {
  return {MPI_Wtime(), static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

}  // namespace

PassClock::PassClock() : last_(now()) {}

void PassClock::finish(PassTimes& times, Pass pass) {
  const PassTime time = now();
  PassTime& sum = times[static_cast<std::size_t>(pass)];
  sum.wall += time.wall - last_.wall;
  sum.cpu += time.cpu - last_.cpu;
  last_ = time;
}

}  // namespace gasgrain::cfd
