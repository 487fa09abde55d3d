// A named solid body: its shape, what it acts on and how it moves.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/motion.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

struct Body {
  std::string name;
  Shape shape;  // as it is before any motion
  bool acts_on_gas = true;
  bool acts_on_grains = true;
  Vec3 surface_velocity = Vec3::Zero();  // m/s; a wall that slides in its own plane (conveyor)
  Motion motion;
  Vec3 torque_point = Vec3::Zero();  // m, at rest: torques on the body are about it; it moves along
};

// The body's shape where it is at `time` [s]; the shape itself when it never sweeps.
Shape shape_at(const Body& body, double time);

// Where the body's torque point is at `time` [s], m.
Vec3 torque_point_at(const Body& body, double time);

// Velocity of the body's surface at x [m], m/s: of the motion plus `surface_velocity`, which turns
// with the body.
Vec3 surface_velocity_at(const Body& body, const Vec3& x, double time);

// Loads the SDF file named by `file = "x.h5"` of a body; supplied by coupling/files, so that this
// leaf library stays free of HDF5.
using ShapeFileLoader = Shape (*)(const std::string& path);

// Reads all [[body]] tables of a case file (keys: docs/case_file.md). Throws UserError: no or
// duplicate name, no or several shapes, non-positive sizes, unknown keys.
std::vector<Body> read_bodies(const ConfigTable& case_file, ShapeFileLoader load_file);

// The one shape that a table gives by one of the keys plane, box, cylinder, sphere, union,
// intersection, difference, complement and file. The caller marks its own keys as known before and
// rejects unknown ones afterwards. Throws UserError when there is none or more than one.
Shape read_shape(const ConfigTable& table, ShapeFileLoader load_file);

// The body of that name; throws UserError that lists the names there are.
const Body& find_body(const std::vector<Body>& bodies, const std::string& name);

}  // namespace gasgrain
