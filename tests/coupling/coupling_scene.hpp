// Cases and grains for tests that drive GasCoupling without a DEM code.
#pragma once

#include <mpi.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "coupling/gas_coupling.hpp"

namespace gasgrain::coupling {

// A case file's text, read as fix couple/gas reads a file.
struct CoupledCase {
  cfd::GasCase gas;
  CouplingOptions options;

  explicit CoupledCase(const std::string& text) {
    const ConfigTable file = ConfigTable::parse(text, "test.toml");
    gas = cfd::read_gas_case(file);
    options = read_coupling_options(file.table_or_empty("coupling"), gas);
    file.reject_unknown_keys();
  }
};

struct GrainKind {
  double original_diameter = 1e-4;  // m
  double ratio = 10;                // l
  double density = 2500;            // kg/m^3

  double diameter() const { return ratio * original_diameter; }
  double volume() const { return M_PI / 6 * std::pow(diameter(), 3); }
  double mass() const { return density * volume(); }
  GrainRecord record(const Vec3& position, const Vec3& velocity) const {
    return {.position = position,
            .velocity = velocity,
            .volume = volume(),
            .mass = mass(),
            .original_diameter = original_diameter};
  }
};

// Every rank holds every `ranks`-th of all grains, wherever they are.
class DealtGrains {
 public:
  DealtGrains(std::vector<GrainRecord> all, MPI_Comm communicator) : all_(std::move(all)) {
    MPI_Comm_rank(communicator, &rank_);
    MPI_Comm_size(communicator, &ranks_);
    forces.resize(mine().size(), Vec3::Zero());
  }

  std::vector<GrainRecord> mine() const {
    std::vector<GrainRecord> result;
    for (std::size_t n = rank_; n < all_.size(); n += ranks_) result.push_back(all_[n]);
    return result;
  }
  std::vector<GrainRecord>& all() { return all_; }
  // Force on the grain of that number in all(), if this rank holds it.
  const Vec3* force(std::size_t n) const {
    return static_cast<int>(n % ranks_) == rank_ ? &forces[n / ranks_] : nullptr;
  }

  std::vector<Vec3> forces;  // of mine()

 private:
  std::vector<GrainRecord> all_;
  int rank_ = 0, ranks_ = 1;
};

// Grains on a jittered lattice of the given spacing in the box [lower, upper].
inline std::vector<GrainRecord> lattice(const GrainKind& kind, const Vec3& lower, const Vec3& upper,
                                        double spacing, double largest_speed) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  const auto vector = [&] {
    const double x = noise(random), y = noise(random), z = noise(random);
    return Vec3(x, y, z);
  };
  std::vector<GrainRecord> grains;
  for (double z = lower[2] + spacing / 2; z < upper[2]; z += spacing)
    for (double y = lower[1] + spacing / 2; y < upper[1]; y += spacing)
      for (double x = lower[0] + spacing / 2; x < upper[0]; x += spacing) {
        grains.push_back(
            kind.record(Vec3(x, y, z) + 0.05 * spacing * vector(), largest_speed * vector()));
      }
  return grains;
}

}  // namespace gasgrain::coupling
