// Numbers that do not change any more, in memory of their own or in memory that others own, such as
// the pages of a file, of which a machine keeps one copy for all its processes. Copies share them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace gasgrain {

template <class T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(std::vector<T> values) {
    const auto own = std::make_shared<const std::vector<T>>(std::move(values));
    values_ = *own;
    owner_ = own;
  }
  // `owner` keeps the values alive.
  SharedArray(std::shared_ptr<const void> owner, std::span<const T> values)
      : owner_(std::move(owner)), values_(values) {}

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  const T* data() const { return values_.data(); }
  const T& operator[](std::size_t n) const { return values_[n]; }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  std::vector<T> copy() const { return {begin(), end()}; }

 private:
  std::shared_ptr<const void> owner_;
  std::span<const T> values_;
};

}  // namespace gasgrain
