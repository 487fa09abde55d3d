// Grains' data go to the gas ranks that own their cells, and forces come back.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

// What the gas needs to know of a grain.
struct GrainRecord {
  Vec3 position;             // m
  Vec3 velocity;             // m/s
  double volume;             // of the grain, l^3 V0, m^3
  double mass;               // kg
  double original_diameter;  // d0, m
  // N s: what it received from the gas in all beyond what the gas gave so far.
  Vec3 carried = Vec3::Zero();
};

// Diameter of the grain (not of the original particle), m.
double grain_diameter(const GrainRecord& grain);

// One exchange: send(), then any number of computations on received(), then return_to_senders().
class GrainTransfer {
 public:
  // Keeps a reference to `decomposition`.
  explicit GrainTransfer(const cfd::Decomposition& decomposition) : decomposition_(decomposition) {}

  // Sends each of this rank's grains to the rank that owns the cell of its centre; positions are
  // wrapped in periodic directions. Grains outside the grid stay. Collective.
  void send(std::span<const GrainRecord> local);

  // One more number per grain of the last send(), in the order of received(). Collective.
  std::vector<double> send_along(std::span<const double> local) const;

  // The grains in this rank's block, by sending rank and, within a rank, in the sender's order.
  const std::vector<GrainRecord>& received() const { return received_; }
  // How many of this rank's own grains were outside the grid.
  long outside() const { return outside_; }

  // Gives `results` (one per received grain) back to the sender; `local` has one entry per grain
  // passed to send(), which stays as it is for grains outside the grid. Collective.
  void return_to_senders(std::span<Vec3> local, std::span<const Vec3> results) const;
  void return_to_senders(std::span<double> local, std::span<const double> results) const;

 private:
  template <class T>
  void send_back(std::span<T> local, std::span<const T> results) const;

  // A message partner and its grains' range in the send order or in received().
  struct Partner {
    int rank;
    std::size_t begin, end;
  };

  const cfd::Decomposition& decomposition_;
  std::vector<std::size_t> send_order_;  // local grains in the grid, sorted by destination
  std::vector<Partner> destinations_, sources_;
  std::vector<GrainRecord> received_;
  long outside_ = 0;
};

}  // namespace gasgrain::coupling
