// Reads STL files, binary and ASCII, whatever their first word says.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/triangle_mesh.hpp"

namespace gasgrain {

// All triangles of all solids of the file, in the file's unit. Normals in the file are ignored: the
// order of the corners counts. Throws UserError that names file and place: missing, empty, cut
// short, a triangle count that does not fit the size of the file, a coordinate that is no finite
// number, a facet that is no triangle.
std::vector<LooseTriangle> read_stl(const std::string& path);

// The same of the bytes of a file called `name`.
std::vector<LooseTriangle> parse_stl(const std::string& bytes, const std::string& name);

}  // namespace gasgrain
