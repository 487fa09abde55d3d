// SDF file, version 1: attributes format, version, lower, spacing, band, cut, brick_cells; datasets
// /bricks/slot and /bricks/far_value (z, y, x) and /samples (stored brick, z, y, x).
#include "coupling/files/sdf_file.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "coupling/files/hdf5_file.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/sampling.hpp"

namespace gasgrain {

namespace {

constexpr const char* format_name = "gasgrain signed distance";
constexpr std::int64_t format_version = 1;

void write_field(Hdf5File& file, const BrickSamples& data) {
  file.write_attribute("format", std::string(format_name));
  file.write_attribute<std::int64_t>("version", {format_version});
  file.write_attribute<std::int64_t>("brick_cells", {SampledDistance::brick_cells});
  file.write_attribute<double>("lower", {data.lower[0], data.lower[1], data.lower[2]});
  file.write_attribute<double>("spacing", {data.spacing});
  file.write_attribute<double>("band", {data.band});
  file.write_attribute<std::int64_t>("cut", {data.cut ? 1 : 0});
  const auto size = [](int n) { return static_cast<std::uint64_t>(n); };
  const ArrayBlock bricks =
      ArrayBlock::whole({size(data.bricks[2]), size(data.bricks[1]), size(data.bricks[0])});
  file.write("/bricks/slot", bricks, data.slot.data());
  file.write("/bricks/far_value", bricks, data.far_value.data());
  constexpr std::uint64_t n = SampledDistance::brick_points;
  const std::uint64_t stored = data.samples.size() / SampledDistance::samples_per_brick;
  file.write("/samples", ArrayBlock::whole({stored, n, n, n}), data.samples.data());
}

void check_header(const Hdf5File& file, const std::string& path) {
  if (!file.has_attribute("format") || file.text_attribute("format") != format_name) {
    throw UserError("'" + path + "' is no SDF file of gasgrain; write one with gasgrain-sdf");
  }
  const std::int64_t version = file.attribute<std::int64_t>("version").at(0);
  const std::int64_t cells = file.attribute<std::int64_t>("brick_cells").at(0);
  if (version != format_version || cells != SampledDistance::brick_cells) {
    throw UserError("SDF file '" + path + "' has version " + std::to_string(version) +
                    " with bricks of " + std::to_string(cells) + " cells, but this program reads " +
                    "version 1 with 8; write it again with this program's gasgrain-sdf");
  }
}

// One number of an attribute that must hold `count` of them.
template <class T>
std::vector<T> attribute(const Hdf5File& file, const std::string& path, const std::string& name,
                         std::size_t count) {
  std::vector<T> values = file.attribute<T>(name);
  if (values.size() != count) {
    throw UserError("SDF file '" + path + "': attribute '" + name + "' has the wrong size");
  }
  return values;
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
  const std::vector<std::uint64_t> bricks = file.size("/bricks/slot");
  if (bricks.size() != 3) {
    throw UserError("SDF file '" + path + "': /bricks/slot must have three dimensions");
  }
  for (int d = 0; d < 3; ++d) data.bricks[d] = static_cast<int>(bricks[2 - d]);
  data.slot = file.read<std::int32_t>("/bricks/slot");
  data.far_value = file.read<double>("/bricks/far_value");
  data.samples = file.read<double>("/samples");
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
