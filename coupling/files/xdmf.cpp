#include "coupling/files/xdmf.hpp"

#include <cstdio>

namespace gasgrain::xdmf {

namespace {

// Shortest text that reads back as the same number.
std::string exact(double value) {
  std::array<char, 32> text{};
  for (int digits = 15; digits <= 17; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    if (std::stod(text.data()) == value) break;
  }
  return text.data();
}

std::string joined(const std::vector<std::uint64_t>& values) {
  std::string text;
  for (const std::uint64_t value : values) {
    if (!text.empty()) text += ' ';
    text += std::to_string(value);
  }
  return text;
}

std::string reversed(const Vec3& v) {
  return exact(v[2]) + " " + exact(v[1]) + " " + exact(v[0]);
}

std::string three_numbers(const Vec3& v) {
  return "<DataItem Format=\"XML\" Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\">" +
         reversed(v) + "</DataItem>";
}

}  // namespace

std::string hdf_item(const std::string& location, const std::vector<std::uint64_t>& size,
                     ElementType type) {
  return "<DataItem Format=\"HDF\" Dimensions=\"" + joined(size) + "\" NumberType=\"" + type.name +
         "\" Precision=\"" + std::to_string(type.bytes) + "\">" + location + "</DataItem>";
}

std::string attribute(const std::string& name, int components, Center center,
                      const std::string& item) {
  return "        <Attribute Name=\"" + name + "\" AttributeType=\"" +
         (components == 3 ? "Vector" : "Scalar") + "\" Center=\"" +
         (center == Center::cell ? "Cell" : "Node") + "\">" + item + "</Attribute>\n";
}

std::string grid_mesh(const std::array<int, 3>& cells, const Vec3& lower, const Vec3& spacing) {
  std::vector<std::uint64_t> nodes;
  for (int d = 2; d >= 0; --d) nodes.push_back(static_cast<std::uint64_t>(cells[d]) + 1);
  return "        <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"" + joined(nodes) +
         "\"/>\n        <Geometry GeometryType=\"ORIGIN_DXDYDZ\">" + three_numbers(lower) +
         three_numbers(spacing) + "</Geometry>\n";
}

std::string grain_mesh(const std::string& file, std::uint64_t grains) {
  return "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" +
         std::to_string(grains) + "\" NodesPerElement=\"1\">" +
         hdf_item(file + ":/vertex", {grains}, integer) +
         "</Topology>\n        <Geometry GeometryType=\"XYZ\">" +
         hdf_item(file + ":/position", {grains, 3}) + "</Geometry>\n";
}

std::string frame(double time, const std::string& content) {
  return "      <Grid Name=\"frame\" GridType=\"Uniform\">\n        <Time Value=\"" + exact(time) +
         "\"/>\n" + content + "      </Grid>\n";
}

}  // namespace gasgrain::xdmf
