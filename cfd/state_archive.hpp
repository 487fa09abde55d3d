// Where a component's memory from one step to the next is saved and restored from.
//
// A component visits its state once, in a function that serves both directions:
//
//   void Controller::visit_state(StateArchive& archive) {
//     archive.number("integral", integral_);
//     if (archive.restores()) rebuild_what_follows_from_it();
//   }
//
// All calls are collective, with the same names in the same order on every rank. What is restored
// on the same blocks of the grid has the same bits.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cfd/field.hpp"

namespace gasgrain::cfd {

class StateArchive {
 public:
  virtual ~StateArchive() = default;
  virtual bool restores() const = 0;

  // The same on every rank.
  virtual void number(const std::string& name, double& value) = 0;
  // The same list on every rank, of any length.
  virtual void list(const std::string& name, std::vector<double>& values) = 0;
  // This rank's parts of sums over all ranks. Restored on another number of ranks, rank 0 gets the
  // sums and the others zero.
  virtual void partial_sums(const std::string& name, std::span<double> parts) = 0;
  // Owned cells; owned faces of all directions (loops.hpp). Ghosts are left to the component.
  virtual void cells(const std::string& name, Field& field) = 0;
  virtual void faces(const std::string& name, VectorField& field) = 0;

  // The same for a value that is no double; it must convert without loss.
  template <class T>
  void number_of(const std::string& name, T& value) {
    double converted = static_cast<double>(value);
    number(name, converted);
    if (restores()) value = static_cast<T>(converted);
  }
};

// A copy in memory. The second save takes no memory but that of the first.
class StateCopy {
 public:
  // visit(archive) is called with an archive that saves, or one that restores.
  template <class Visit>
  void save(Visit&& visit) {
    values_.clear();
    Archive archive(values_, Archive::Direction::save);
    visit(archive);
  }
  // Precondition: saved before, with a visit of the same values.
  template <class Visit>
  void restore(Visit&& visit) {
    Archive archive(values_, Archive::Direction::restore);
    visit(archive);
  }
  bool empty() const { return values_.empty(); }

 private:
  class Archive final : public StateArchive {
   public:
    enum class Direction { save, restore };
    Archive(std::vector<double>& values, Direction direction)
        : values_(values), direction_(direction) {}
    bool restores() const override { return direction_ == Direction::restore; }
    void number(const std::string& name, double& value) override;
    void list(const std::string& name, std::vector<double>& values) override;
    void partial_sums(const std::string& name, std::span<double> parts) override;
    void cells(const std::string& name, Field& field) override;
    void faces(const std::string& name, VectorField& field) override;

   private:
    std::vector<double>& values_;
    Direction direction_;
    std::size_t at_ = 0;
  };

  std::vector<double> values_;
};

}  // namespace gasgrain::cfd
