// The SDF file (HDF5): a sampled signed distance field on disk. Format: docs/geometry.md.
#pragma once

#include <string>

#include "coupling/shared/sampled_distance.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Writes the field, one process alone; the file appears under its name only when it is complete.
// Throws UserError when it cannot be written.
void write_sdf(const std::string& path, const SampledDistance& field);

// Reads what write_sdf wrote, bit for bit; every process may call it for itself. Throws UserError
// when the file is missing, is not an SDF file or is of another version.
SampledDistance read_sdf(const std::string& path);

// read_sdf as a shape, checked to describe a closed solid: the ShapeFileLoader of read_bodies.
Shape load_sdf_shape(const std::string& path);

}  // namespace gasgrain
