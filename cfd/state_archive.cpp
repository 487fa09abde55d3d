#include "cfd/state_archive.hpp"

#include <algorithm>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

void StateCopy::Archive::number(const std::string& name, double& value) {
  partial_sums(name, {&value, 1});
}

void StateCopy::Archive::list(const std::string& name, std::vector<double>& values) {
  std::size_t size = values.size();
  number_of(name, size);
  values.resize(size);
  partial_sums(name, values);
}

void StateCopy::Archive::partial_sums(const std::string&, std::span<double> parts) {
  if (restores()) {
    GASGRAIN_ASSERT(at_ + parts.size() <= values_.size());
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(at_), parts.size(), parts.begin());
    at_ += parts.size();
  } else {
    values_.insert(values_.end(), parts.begin(), parts.end());
  }
}

// With ghosts: one block of memory, and more is not needed.
void StateCopy::Archive::cells(const std::string& name, Field& field) {
  partial_sums(name, {field.data(), field.count()});
}

void StateCopy::Archive::faces(const std::string& name, VectorField& field) {
  for (Field& component : field) cells(name, component);
}

}  // namespace gasgrain::cfd
