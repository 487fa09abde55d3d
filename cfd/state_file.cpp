#include "cfd/state_file.hpp"

#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

std::uint64_t unsigned_of(int n) {
  return static_cast<std::uint64_t>(n);
}

}  // namespace

void StateFile::number(const std::string& name, double& value) {
  const std::string set = group_ + "/" + name;
  if (restores()) {
    file_.read(set, ArrayBlock::whole({1}), &value);
  } else {
    const std::uint64_t mine = decomposition_.rank() == 0 ? 1 : 0;
    file_.write(set, {.global = {1}, .start = {0}, .count = {mine}}, &value);
  }
}

void StateFile::list(const std::string& name, std::vector<double>& values) {
  const std::string set = group_ + "/" + name;
  if (restores()) {
    values = file_.read<double>(set);
  } else {
    const std::uint64_t mine = decomposition_.rank() == 0 ? values.size() : 0;
    file_.write(set, {.global = {values.size()}, .start = {0}, .count = {mine}}, values.data());
  }
}

void StateFile::partial_sums(const std::string& name, std::span<double> parts) {
  const std::string set = group_ + "/" + name;
  const std::uint64_t rank = unsigned_of(decomposition_.rank());
  if (!restores()) {
    file_.write(set,
                {.global = {unsigned_of(decomposition_.size()), parts.size()},
                 .start = {rank, 0},
                 .count = {1, parts.size()}},
                parts.data());
    return;
  }
  const std::vector<double> all = file_.read<double>(set);
  const bool same_ranks = all.size() == parts.size() * unsigned_of(decomposition_.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (same_ranks) {
      parts[p] = all[rank * parts.size() + p];
    } else {
      parts[p] = 0.0;
      for (std::size_t n = p; rank == 0 && n < all.size(); n += parts.size()) parts[p] += all[n];
    }
  }
}

void StateFile::block(const std::string& name, const Index3& global, const Index3& size,
                      Field& field) {
  const Index3& lower = decomposition_.block().lower;
  ArrayBlock part;
  for (int d = 2; d >= 0; --d) {
    part.global.push_back(unsigned_of(global[d]));
    part.start.push_back(unsigned_of(lower[d]));
    part.count.push_back(unsigned_of(size[d]));
  }
  values_.resize(std::size_t(size[0]) * size[1] * size[2]);
  std::size_t n = 0;
  if (restores()) {
    file_.read(group_ + "/" + name, part, values_.data());
    for_each_cell(size, [&](int i, int j, int k) { field(i, j, k) = values_[n++]; });
  } else {
    for_each_cell(size, [&](int i, int j, int k) { values_[n++] = field(i, j, k); });
    file_.write(group_ + "/" + name, part, values_.data());
  }
}

void StateFile::cells(const std::string& name, Field& field) {
  block(name, decomposition_.grid().cells, decomposition_.block().size, field);
}

void StateFile::faces(const std::string& name, VectorField& field) {
  for (int d = 0; d < 3; ++d) {
    Index3 global = decomposition_.grid().cells;
    global[d] += decomposition_.periodic()[d] ? 0 : 1;
    block(name + "_" + "xyz"[d], global, owned_faces(decomposition_, d), field[d]);
  }
}

}  // namespace gasgrain::cfd
