// Reads the [[body]] tables of a case file; the keys are documented in docs/geometry.md.
#include "coupling/shared/body.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"
#include "coupling/shared/stl_shape.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain {

namespace {

Vec3 direction(const ConfigTable& table, const std::string& key) {
  const Vec3 given = table.vector(key);
  if (given.norm() == 0.0) table.fail(key, "must not be zero: it gives a direction");
  return given.normalized();
}

Shape read_plane(const ConfigTable& table) {
  return make_shape(Plane{.point = table.vector("point"), .normal = direction(table, "normal")});
}

Shape read_box(const ConfigTable& table) {
  const Vec3 lower = table.vector("lower"), upper = table.vector("upper");
  if (!((upper - lower).minCoeff() > 0)) {
    table.fail("upper", "is " + text(upper) + ", but must exceed `lower` = " + text(lower) +
                            " in every component");
  }
  Box box{.center = 0.5 * (lower + upper), .half_size = 0.5 * (upper - lower)};
  if (table.has("rotation_angle") || table.has("rotation_axis")) {
    const double degrees = table.number("rotation_angle", {.lower = -360, .upper = 360});
    box.axes = rotation_about(direction(table, "rotation_axis"), degrees * std::numbers::pi / 180);
  }
  return make_shape(box);
}

Shape read_cylinder(const ConfigTable& table) {
  Cylinder cylinder{.center = Vec3::Zero(),
                    .axis = Vec3::UnitZ(),
                    .radius = table.number("radius", Range::positive()),
                    .half_length = std::numeric_limits<double>::infinity()};
  if (table.has("start") || table.has("end")) {
    const Vec3 start = table.vector("start"), end = table.vector("end");
    if (start == end) table.fail("end", "must differ from `start`");
    cylinder.center = 0.5 * (start + end);
    cylinder.axis = (end - start).normalized();
    cylinder.half_length = 0.5 * (end - start).norm();
  } else {
    cylinder.center = table.vector("point");
    cylinder.axis = direction(table, "axis");
    cylinder.half_length = table.number_or("half_length", cylinder.half_length, Range::positive());
  }
  return make_shape(cylinder);
}

Shape read_cone(const ConfigTable& table) {
  const Vec3 start = table.vector("start"), end = table.vector("end");
  if (start == end) table.fail("end", "must differ from `start`");
  const Cone cone{.start = start,
                  .axis = (end - start).normalized(),
                  .length = (end - start).norm(),
                  .start_radius = table.number("start_radius", Range::non_negative()),
                  .end_radius = table.number("end_radius", Range::non_negative())};
  if (cone.start_radius + cone.end_radius == 0.0)
    table.fail("end_radius", "and `start_radius` must not both be zero");
  return make_shape(cone);
}

Shape read_torus(const ConfigTable& table) {
  const double radius = table.number("radius", Range::positive());
  return make_shape(Torus{
      .center = table.vector("center"),
      .axis = direction(table, "axis"),
      .radius = radius,
      .tube_radius = table.number(
          "tube_radius", {.lower = 0, .upper = radius, .lower_open = true, .upper_open = true})});
}

Shape read_sphere(const ConfigTable& table) {
  return make_shape(Sphere{.center = table.vector("center"),
                           .radius = table.number("radius", Range::positive())});
}

std::vector<Shape> read_parts(const ConfigTable& table, const std::string& key, std::size_t fewest,
                              ShapeFileLoader load_file) {
  const std::vector<ConfigTable> list = table.tables(key);
  if (list.size() < fewest) {
    table.fail(key, "needs at least " + std::to_string(fewest) + " shapes, such as " + key +
                        " = [{sphere = {...}}, {box = {...}}]");
  }
  std::vector<Shape> parts;
  for (const ConfigTable& item : list) {
    parts.push_back(read_shape(item, load_file));
    item.reject_unknown_keys();
  }
  return parts;
}

Shape read_difference(const ConfigTable& table, ShapeFileLoader load_file) {
  std::vector<Shape> parts = read_parts(table, "difference", 2, load_file);
  Shape base = parts.front();
  parts.erase(parts.begin());
  return make_difference(std::move(base), make_union(std::move(parts)));
}

Shape read_complement(const ConfigTable& table, ShapeFileLoader load_file) {
  const ConfigTable inner = table.table("complement");
  Shape shape = read_shape(inner, load_file);
  inner.reject_unknown_keys();
  return make_complement(std::move(shape));
}

Shape read_file(const ConfigTable& table, ShapeFileLoader load_file) {
  const std::string path = table.resolve_path(table.text("file"));
  if (!std::filesystem::is_regular_file(path)) {
    table.fail("file", "names '" + path + "', which is not there; write it with gasgrain-sdf, or " +
                           "correct the path (relative to the case file)");
  }
  GASGRAIN_ASSERT(load_file != nullptr);
  try {
    return load_file(path);
  } catch (const UserError& error) {
    table.fail("file", error.what());
  }
}

template <class Reader>
Shape read_primitive(const ConfigTable& table, const std::string& key, const Reader& reader) {
  const ConfigTable parameters = table.table(key);
  Shape shape = reader(parameters);
  parameters.reject_unknown_keys();
  return shape;
}

constexpr const char* shape_keys =
    "plane, box, cylinder, cone, sphere, torus, stl, union, intersection, difference, "
    "complement or file";

// The one shape key of a table; the caller rejects unknown keys afterwards.
std::string shape_key(const ConfigTable& table) {
  std::string found;
  for (const char* key : {"plane", "box", "cylinder", "cone", "sphere", "torus", "stl", "union",
                          "intersection", "difference", "complement", "file"}) {
    if (!table.has(key)) continue;
    if (!found.empty()) {
      table.fail(key, "is a second shape beside '" + found +
                          "'; give one, or combine them: union = [{" + found + " = ...}, {" + key +
                          " = ...}]");
    }
    found = key;
  }
  if (found.empty()) {
    table.reject_unknown_keys();
    table.fail("<shape>", std::string("is missing; give one of ") + shape_keys);
  }
  return found;
}

}  // namespace

Shape read_shape(const ConfigTable& table, ShapeFileLoader load_file) {
  const std::string key = shape_key(table);
  if (key == "plane") return read_primitive(table, key, read_plane);
  if (key == "box") return read_primitive(table, key, read_box);
  if (key == "cylinder") return read_primitive(table, key, read_cylinder);
  if (key == "sphere") return read_primitive(table, key, read_sphere);
  if (key == "cone") return read_primitive(table, key, read_cone);
  if (key == "torus") return read_primitive(table, key, read_torus);
  if (key == "stl") return read_primitive(table, key, read_stl_shape);
  if (key == "union") return make_union(read_parts(table, key, 1, load_file));
  if (key == "intersection") return make_intersection(read_parts(table, key, 1, load_file));
  if (key == "difference") return read_difference(table, load_file);
  if (key == "complement") return read_complement(table, load_file);
  return read_file(table, load_file);
}

namespace {

void read_acts_on(const ConfigTable& table, Body& body) {
  if (!table.has("acts_on")) return;
  body.acts_on_gas = body.acts_on_grains = false;
  for (const std::string& name : table.texts("acts_on")) {
    if (name == "gas") {
      body.acts_on_gas = true;
    } else if (name == "grains") {
      body.acts_on_grains = true;
    } else {
      table.fail("acts_on", "holds '" + name + "', but may hold \"gas\" and \"grains\" only");
    }
  }
  if (!body.acts_on_gas && !body.acts_on_grains) {
    table.fail("acts_on", "is empty; a body acts on \"gas\", \"grains\" or both");
  }
}

Interpolation read_interpolation(const ConfigTable& table) {
  const std::string name = table.choice_or("interpolation", "quadratic", {"linear", "quadratic"});
  return name == "linear" ? Interpolation::linear : Interpolation::quadratic;
}

// Replaces the shape by its samples when the table gives a `spacing`.
void sample_if_asked(const ConfigTable& table, Body& body) {
  if (!table.has("spacing")) {
    for (const char* key : {"lower", "upper", "band", "cut", "interpolation"}) {
      if (table.has(key)) table.fail(key, "belongs to a sampled body; give `spacing` as well");
    }
    return;
  }
  const double spacing = table.number("spacing", Range::positive());
  SamplingBox box{.lower = table.vector("lower"),
                  .upper = table.vector("upper"),
                  .spacing = spacing,
                  .band = table.number_or("band", default_band(spacing), Range::positive()),
                  .cut = table.flag_or("cut", false),
                  .interpolation = read_interpolation(table)};
  try {
    auto field = std::make_shared<const SampledDistance>(sample_shape(*body.shape, box));
    check_closed(*field, "body '" + body.name + "'");
    body.shape = std::move(field);
  } catch (const UserError& error) {
    table.fail("spacing", error.what());
  }
}

Body read_body(const ConfigTable& table, ShapeFileLoader load_file) {
  Body body;
  body.name = table.text("name");
  if (body.name.empty()) table.fail("name", "is empty; every body needs a name");
  table.has("acts_on");  // known before a missing shape suggests the nearest key
  table.has("surface_velocity");
  table.has("motion");
  table.has("torque_point");
  for (const char* key : {"spacing", "lower", "upper", "band", "cut", "interpolation"})
    table.has(key);
  body.shape = read_shape(table, load_file);
  read_acts_on(table, body);
  body.surface_velocity = table.vector_or("surface_velocity", Vec3::Zero());
  if (table.has("motion")) body.motion = read_motion(table.table("motion"));
  body.torque_point = table.vector_or("torque_point", body.motion.centre);
  sample_if_asked(table, body);
  table.reject_unknown_keys();
  return body;
}

}  // namespace

Shape shape_at(const Body& body, double time) {
  return body.motion.sweeps() ? move_shape(body.shape, body.motion.pose(time)) : body.shape;
}

Vec3 torque_point_at(const Body& body, double time) {
  return body.motion.pose(time).to_world(body.torque_point);
}

Vec3 surface_velocity_at(const Body& body, const Vec3& x, double time) {
  if (body.motion.is_at_rest()) return body.surface_velocity;
  if (body.surface_velocity.isZero(0)) return body.motion.velocity_at(x, time);
  return body.motion.velocity_at(x, time) + body.motion.pose(time).rotation * body.surface_velocity;
}

std::vector<Body> read_bodies(const ConfigTable& case_file, ShapeFileLoader load_file) {
  std::vector<Body> bodies;
  std::set<std::string> names;
  for (const ConfigTable& table : case_file.tables("body")) {
    bodies.push_back(read_body(table, load_file));
    if (!names.insert(bodies.back().name).second) {
      table.fail("name", "'" + bodies.back().name + "' is taken; every body needs its own name");
    }
  }
  return bodies;
}

const Body& find_body(const std::vector<Body>& bodies, const std::string& name) {
  std::string list;
  std::vector<std::string> names;
  for (const Body& body : bodies) {
    if (body.name == name) return body;
    list += (list.empty() ? "" : ", ") + body.name;
    names.push_back(body.name);
  }
  const std::string near = nearest_name(name, names.data(), names.data() + names.size());
  throw UserError("there is no body '" + name + "'; the case file has " +
                  (list.empty() ? "none" : list) +
                  (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

}  // namespace gasgrain
