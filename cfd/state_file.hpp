// A component's state in a group of an HDF5 file: numbers, and fields of the whole grid, so that
// any number of ranks can read them. Datasets have the order z, y, x; faces of direction d stand in
// <name>_x, _y, _z.
#pragma once

#include <string>
#include <vector>

#include "cfd/grid.hpp"
#include "cfd/state_archive.hpp"
#include "coupling/files/hdf5_file.hpp"

namespace gasgrain::cfd {

enum class StateDirection { save, restore };

class StateFile final : public StateArchive {
 public:
  // The file stays open and the decomposition alive while the archive is used. Reading throws
  // UserError when a dataset is missing or has another size.
  StateFile(Hdf5File& file, const std::string& group, const Decomposition& decomposition,
            StateDirection direction)
      : file_(file), group_(group), decomposition_(decomposition), direction_(direction) {}

  bool restores() const override { return direction_ == StateDirection::restore; }
  void number(const std::string& name, double& value) override;
  void list(const std::string& name, std::vector<double>& values) override;
  void partial_sums(const std::string& name, std::span<double> parts) override;
  void cells(const std::string& name, Field& field) override;
  void faces(const std::string& name, VectorField& field) override;

 private:
  void block(const std::string& name, const Index3& global, const Index3& size, Field& field);

  Hdf5File& file_;
  std::string group_;
  const Decomposition& decomposition_;
  StateDirection direction_;
  std::vector<double> values_;  // of one block
};

}  // namespace gasgrain::cfd
