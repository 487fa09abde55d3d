// gasgrain-sdf: samples a body of a case file or STL files into an SDF file, or inspects such a
// file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "coupling/files/sdf_file.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/config_table.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/motion.hpp"
#include "coupling/shared/sampling.hpp"
#include "coupling/shared/solid_volume.hpp"
#include "coupling/shared/stl_shape.hpp"

namespace {

using namespace gasgrain;

struct Options {
  std::string case_file, body, output, inspect;
  StlSource stl;
  std::vector<double> rotation, translation;  // axis and degrees; m
  bool complement = false;
  double spacing = 0.0, margin = -1.0, band = 0.0;  // negative, zero: default
  std::vector<double> lower, upper;                 // empty: the case file's grid
  bool allow_cut = false;
};

// What is to be sampled, and where it is unless the user says so.
struct Subject {
  std::string name;
  Shape shape;
  std::optional<Eigen::AlignedBox3d> box;  // m
};

Vec3 to_vector(const std::vector<double>& values) {
  return Vec3(values[0], values[1], values[2]);
}

Subject read_case_body(const Options& options) {
  const ConfigTable case_file = ConfigTable::parse_file(options.case_file);
  const std::vector<Body> bodies = read_bodies(case_file, load_sdf_shape);
  const Body& body = find_body(bodies, options.body);
  Subject subject{"body '" + body.name + "'", body.shape, {}};
  const ConfigTable grid = case_file.table_or_empty("grid");
  if (grid.has("lower") && grid.has("upper"))
    subject.box.emplace(grid.vector("lower"), grid.vector("upper"));
  return subject;
}

Subject read_stl_files(const Options& options) {
  StlSource source = options.stl;
  if (!options.translation.empty()) source.translation = to_vector(options.translation);
  if (!options.rotation.empty()) {
    const Vec3 axis = to_vector(options.rotation);
    if (axis.norm() == 0.0) throw UserError("--rotate: the axis must not be zero");
    source.rotation =
        rotation_about(axis.normalized(), options.rotation[3] * std::numbers::pi / 180);
  }
  const PlacedShape placed = make_stl_shape(source);
  Subject subject{"STL '" + source.files.front() + "'", placed.shape,
                  Eigen::AlignedBox3d(placed.lower, placed.upper)};
  if (options.complement) subject.shape = make_complement(subject.shape);
  return subject;
}

// The box to sample: as given, or that of the subject, in both cases with the margin.
SamplingBox sampling_box(const Options& options, const Subject& subject) {
  SamplingBox box{.lower = Vec3::Zero(),
                  .upper = Vec3::Zero(),
                  .spacing = options.spacing,
                  .band = options.band > 0 ? options.band : default_band(options.spacing),
                  .cut = options.allow_cut};
  if (!options.lower.empty()) {
    box.lower = to_vector(options.lower);
    box.upper = to_vector(options.upper);
  } else if (subject.box) {
    box.lower = subject.box->min();
    box.upper = subject.box->max();
  } else {
    throw UserError(options.case_file + ": has no grid.lower and grid.upper to take the sampling " +
                    "box from; give --lower and --upper");
  }
  const double margin = options.margin >= 0 ? options.margin : box.band;
  box.lower -= Vec3::Constant(margin);
  box.upper += Vec3::Constant(margin);
  return box;
}

void print_field(const SampledDistance& field) {
  const BrickSamples& data = field.data();
  const Vec3 lower = field.lower(), upper = field.upper();
  const std::size_t bricks = data.slot.size();
  std::printf("spacing        %g m, band %g m\n", data.spacing, data.band);
  std::printf("box            (%g, %g, %g) to (%g, %g, %g) m%s\n", lower[0], lower[1], lower[2],
              upper[0], upper[1], upper[2], data.cut ? ", body goes on beyond it" : "");
  std::printf("bricks         %zu of %zu stored (%.1f %%), %d x %d x %d of 8^3 cells\n",
              field.stored_bricks(), bricks, 100.0 * field.stored_bricks() / bricks, data.bricks[0],
              data.bricks[1], data.bricks[2]);
  std::printf("memory         %.2f MB\n", field.memory() / 1e6);
}

VolumeGrid volume_grid(const SampledDistance& field, int halvings) {
  VolumeGrid grid{field.lower(), SampledDistance::brick_cells * field.data().spacing,
                  field.data().bricks, halvings};
  return grid;
}

int write_field(const Options& options) {
  const Subject subject =
      options.case_file.empty() ? read_stl_files(options) : read_case_body(options);
  std::fputs(subject.shape->remarks().c_str(), stdout);
  const SampledDistance field = sample_shape(*subject.shape, sampling_box(options, subject));
  check_closed(field, subject.name);
  write_sdf(options.output, field);

  std::printf("written        %s, from %s\n", options.output.c_str(), subject.name.c_str());
  print_field(field);
  // cells halved once for the field, twice for the shape it was made of
  const double volume = solid_volume(field, volume_grid(field, 4));
  const double finer = solid_volume(*subject.shape, volume_grid(field, 5));
  std::printf("solid volume   %.8g m^3 in the box, %+.2e of a finer estimate (%.8g m^3)\n", volume,
              (volume - finer) / finer, finer);
  return 0;
}

int inspect(const Options& options) {
  const SampledDistance field = read_sdf(options.inspect);
  std::printf("file           %s\n", options.inspect.c_str());
  print_field(field);
  const std::vector<double>& samples = field.data().samples;
  if (!samples.empty()) {
    const auto [smallest, largest] = std::minmax_element(samples.begin(), samples.end());
    std::printf("samples        from %g to %g m\n", *smallest, *largest);
  }
  std::printf("solid volume   %.8g m^3 in the box\n", solid_volume(field, volume_grid(field, 4)));
  check_closed(field, options.inspect);
  std::printf("closed         yes\n");
  return 0;
}

void declare_sources(CLI::App& app, Options& options) {
  CLI::Option* file = app.add_option("case", options.case_file, "Case file with the body (TOML)");
  CLI::Option* view =
      app.add_option("--inspect", options.inspect, "Describe and check an SDF file");
  CLI::Option* stl =
      app.add_option("--stl", options.stl.files, "STL files; their union is sampled");
  CLI::Option* body = app.add_option("--body", options.body, "Name of the body to sample");
  CLI::Option* spacing = app.add_option("--spacing", options.spacing, "Distance of samples, m")
                             ->check(CLI::PositiveNumber);
  CLI::Option* output = app.add_option("-o,--output", options.output, "SDF file to write");
  body->needs(file);
  for (CLI::Option* option : {body, spacing, output, file, stl}) option->excludes(view);
  file->excludes(stl)->needs(body)->needs(spacing)->needs(output);
  stl->needs(spacing)->needs(output);
  const auto of_stl = [&](CLI::Option* option) { option->needs(stl); };
  of_stl(app.add_option("--scale", options.stl.scale, "Metres per unit of the STL files (1)")
             ->check(CLI::PositiveNumber));
  of_stl(
      app.add_option("--rotate", options.rotation, "Axis and degrees, after scaling")->expected(4));
  of_stl(app.add_option("--translate", options.translation, "m, after rotation")->expected(3));
  of_stl(app.add_option("--sheet", options.stl.sheet_thickness,
                        "Thickness of a wall along the surface, m; without it what the surface "
                        "encloses is solid")
             ->check(CLI::PositiveNumber));
  of_stl(app.add_flag("--complement", options.complement,
                      "What the surface encloses is empty, everything else solid"));
}

void declare(CLI::App& app, Options& options) {
  declare_sources(app, options);
  app.add_option("--band", options.band,
                 "Distance up to which samples are kept, m (8 spacings; at least the largest grain "
                 "radius and the gas cell)")
      ->check(CLI::PositiveNumber);
  app.add_option("--margin", options.margin, "Added to the box on every side, m (the band)")
      ->check(CLI::NonNegativeNumber);
  CLI::Option* lower =
      app.add_option("--lower", options.lower, "Corner of the box, m (the grid of the case file)")
          ->expected(3);
  CLI::Option* upper =
      app.add_option("--upper", options.upper, "Opposite corner of the box, m")->expected(3);
  lower->needs(upper);
  upper->needs(lower);
  app.add_flag("--allow-cut", options.allow_cut, "The body may go on beyond the box");
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app{"Samples the signed distance of a body; docs/geometry.md describes bodies and files",
               "gasgrain-sdf"};
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  if (!options.inspect.empty()) return inspect(options);
  if (!options.case_file.empty() || !options.stl.files.empty()) return write_field(options);
  std::fputs(app.help().c_str(), stdout);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gasgrain-sdf: error: %s\n", error.what());
    return 1;
  }
}
