// SIGTERM, SIGINT and SIGUSR1 as a request to stop at the next good moment instead of an end at
// once. SIGUSR1 is the one that Open MPI's mpirun hands on to the ranks. A second signal ends the
// process as usual.
#pragma once

namespace gasgrain {

class StopSignal {
 public:
  // Takes over the signals of the process until it is destroyed. One at a time.
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // Whether this process got one of them; other ranks may know nothing of it.
  bool raised() const;
};

}  // namespace gasgrain
