// SDF file, version 3: what BrickSamples holds, one attribute or dataset per member; arrays of the
// grid have the slowest index (z) first. Format: docs/geometry.md.
#include "coupling/files/sdf_file.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "coupling/files/hdf5_file.hpp"
#include "coupling/files/mapped_file.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/sampling.hpp"

namespace gasgrain {

namespace {

constexpr const char* format_name = "gasgrain signed distance";
constexpr std::int64_t format_version = 3;

const char* name_of(Interpolation interpolation) {
  return interpolation == Interpolation::linear ? "linear" : "quadratic";
}

void write_field(Hdf5File& file, const BrickSamples& data) {
  file.write_attribute("format", std::string(format_name));
  file.write_attribute<std::int64_t>("version", {format_version});
  file.write_attribute<std::int64_t>("brick_points", {SampledDistance::brick_points});
  file.write_attribute<double>("lower", {data.lower[0], data.lower[1], data.lower[2]});
  file.write_attribute<double>("spacing", {data.spacing});
  file.write_attribute<double>("band", {data.band});
  file.write_attribute<double>("quantum", {data.quantum});
  file.write_attribute<std::int64_t>("cut", {data.cut ? 1 : 0});
  file.write_attribute("interpolation", std::string(name_of(data.interpolation)));
  file.write_attribute<std::int64_t>("bricks", {data.bricks[0], data.bricks[1], data.bricks[2]});
  const auto size = [](auto n) { return static_cast<std::uint64_t>(n); };
  const Index3 n = data.blocks();
  const ArrayBlock blocks = ArrayBlock::whole({size(n[2]), size(n[1]), size(n[0])});
  file.write("/blocks/table", blocks, data.table.data());
  file.write("/blocks/far_value", blocks, data.block_value.data());
  constexpr std::uint64_t b = SampledDistance::block_bricks, p = SampledDistance::brick_points;
  const ArrayBlock bricks =
      ArrayBlock::whole({data.brick.size() / SampledDistance::bricks_per_block, b, b, b});
  file.write("/bricks/entry", bricks, data.brick.data());
  const ArrayBlock samples = ArrayBlock::whole({data.stored_bricks(), p, p, p});
  if (data.quantum > 0)
    file.write("/samples", samples, data.compact_samples.data());
  else
    file.write("/samples", samples, data.samples.data());
}

void check_header(const Hdf5File& file, const std::string& path) {
  if (!file.has_attribute("format") || file.text_attribute("format") != format_name) {
    throw UserError("'" + path + "' is no SDF file of gasgrain; write one with gasgrain-sdf");
  }
  const std::int64_t version = file.attribute<std::int64_t>("version").at(0);
  if (version != format_version) {
    throw UserError("SDF file '" + path + "' has version " + std::to_string(version) +
                    ", but this program reads version " + std::to_string(format_version) +
                    "; write it again with this program's gasgrain-sdf");
  }
  if (file.attribute<std::int64_t>("brick_points").at(0) != SampledDistance::brick_points)
    throw UserError("SDF file '" + path + "' has bricks of another size than " +
                    std::to_string(SampledDistance::brick_points) +
                    " samples; write it again with gasgrain-sdf");
}

Interpolation interpolation_of(const Hdf5File& file, const std::string& path) {
  const std::string name = file.text_attribute("interpolation");
  for (const Interpolation known : {Interpolation::linear, Interpolation::quadratic})
    if (name == name_of(known)) return known;
  throw UserError("SDF file '" + path + "': unknown interpolation '" + name +
                  "', known are linear and quadratic; write it again with gasgrain-sdf");
}

// One number of an attribute that must hold `count` of them.
template <class T>
std::vector<T> attribute(const Hdf5File& file, const std::string& path, const std::string& name,
                         std::size_t count) {
  std::vector<T> values = file.attribute<T>(name);
  if (values.size() != count) {
    throw UserError("SDF file '" + path + "': attribute '" + name + "' holds " +
                    std::to_string(values.size()) + " numbers instead of " + std::to_string(count) +
                    "; the file is damaged, write it again with gasgrain-sdf");
  }
  return values;
}

// One copy for all processes of a machine where possible.
template <class T>
SharedArray<T> read_samples(const Hdf5File& file, const std::string& path) {
  const std::string name = "/samples";
  const auto place = file.place_in_file<T>(name);
  if (!place) return file.read<T>(name);
  std::uint64_t count = 1;
  for (const std::uint64_t n : file.size(name)) count *= n;
  return mapped_array<T>(path, *place, count);
}

}  // namespace

void write_sdf(const std::string& path, const SampledDistance& field) {
  const std::string part = path + ".part";
  Hdf5File file = Hdf5File::create(part);
  write_field(file, field.data());
  file.close();
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw UserError("cannot write '" + path + "': " + error.message());
}

SampledDistance read_sdf(const std::string& path) {
  const Hdf5File file = Hdf5File::open(path);
  check_header(file, path);
  BrickSamples data;
  const std::vector<double> lower = attribute<double>(file, path, "lower", 3);
  data.lower = Vec3(lower[0], lower[1], lower[2]);
  data.spacing = attribute<double>(file, path, "spacing", 1)[0];
  data.band = attribute<double>(file, path, "band", 1)[0];
  data.cut = attribute<std::int64_t>(file, path, "cut", 1)[0] != 0;
  data.quantum = attribute<double>(file, path, "quantum", 1)[0];
  data.interpolation = interpolation_of(file, path);
  const std::vector<std::int64_t> bricks = attribute<std::int64_t>(file, path, "bricks", 3);
  for (int d = 0; d < 3; ++d) {
    if (bricks[d] < 1 || bricks[d] > std::numeric_limits<int>::max() / 8)
      throw UserError("SDF file '" + path +
                      "': attribute 'bricks' is not valid; the file is damaged, " +
                      "write it again with gasgrain-sdf");
    data.bricks[d] = static_cast<int>(bricks[d]);
  }
  data.table = file.read<std::int32_t>("/blocks/table");
  data.block_value = file.read<float>("/blocks/far_value");
  data.brick = file.read<std::int32_t>("/bricks/entry");
  if (data.quantum > 0)
    data.compact_samples = read_samples<std::int16_t>(file, path);
  else
    data.samples = read_samples<float>(file, path);
  try {
    return SampledDistance(std::move(data));
  } catch (const UserError& error) {
    throw UserError("SDF file '" + path + "': " + error.what());
  }
}

Shape load_sdf_shape(const std::string& path) {
  auto field = std::make_shared<const SampledDistance>(read_sdf(path));
  check_closed(*field, "SDF file '" + path + "'");
  return field;
}

}  // namespace gasgrain
