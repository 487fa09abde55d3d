// XML elements of an XDMF 3 index that refers to HDF5 files, as ParaView reads it.
//
// XDMF counts dimensions from the slowest, so everything that belongs to the directions of a grid
// is written in the order z, y, x. See https://www.xdmf.org/index.php/XDMF_Model_and_Format.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::xdmf {

struct ElementType {
  const char* name;
  int bytes;
};
inline constexpr ElementType real{"Float", 8};
inline constexpr ElementType integer{"Int", 8};

enum class Center { cell, grain };

// Data at `location`, "file.h5:/dataset", of that size.
std::string hdf_item(const std::string& location, const std::vector<std::uint64_t>& size,
                     ElementType type = real);
// A named array of 1 or 3 components whose data is `item`.
std::string attribute(const std::string& name, int components, Center center,
                      const std::string& item);
std::string grid_mesh(const std::array<int, 3>& cells, const Vec3& lower, const Vec3& spacing);
// Grains as cells of one vertex each: datasets /vertex and /position of the file.
std::string grain_mesh(const std::string& file, std::uint64_t grains);
// The whole element of one frame around its mesh and attributes.
std::string frame(double time, const std::string& content);

}  // namespace gasgrain::xdmf
