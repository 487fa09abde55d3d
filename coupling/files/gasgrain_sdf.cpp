// gasgrain-sdf: samples a body of a case file into an SDF file, or inspects such a file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "coupling/files/sdf_file.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/config_table.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/sampling.hpp"
#include "coupling/shared/solid_volume.hpp"

namespace {

using namespace gasgrain;

struct Options {
  std::string case_file, body, output, inspect;
  double spacing = 0.0, margin = -1.0, band = 0.0;  // negative, zero: default
  std::vector<double> lower, upper;                 // empty: the case file's grid
  bool allow_cut = false;
};

// The box to sample: as given, or the gas grid of the case file, in both cases with the margin.
SamplingBox sampling_box(const Options& options, const ConfigTable& case_file) {
  SamplingBox box{.lower = Vec3::Zero(),
                  .upper = Vec3::Zero(),
                  .spacing = options.spacing,
                  .band = options.band > 0 ? options.band : default_band(options.spacing),
                  .cut = options.allow_cut};
  if (options.lower.empty()) {
    const ConfigTable grid = case_file.table_or_empty("grid");
    if (!grid.has("lower") || !grid.has("upper")) {
      throw UserError(case_file.file() +
                      ": has no grid.lower and grid.upper to take the sampling "
                      "box from; give --lower and --upper");
    }
    box.lower = grid.vector("lower");
    box.upper = grid.vector("upper");
  } else {
    box.lower = Vec3(options.lower[0], options.lower[1], options.lower[2]);
    box.upper = Vec3(options.upper[0], options.upper[1], options.upper[2]);
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
  const ConfigTable case_file = ConfigTable::parse_file(options.case_file);
  const std::vector<Body> bodies = read_bodies(case_file, load_sdf_shape);
  const Body& body = find_body(bodies, options.body);
  const SampledDistance field = sample_shape(*body.shape, sampling_box(options, case_file));
  check_closed(field, "body '" + body.name + "'");
  write_sdf(options.output, field);

  std::printf("body           %s, written to %s\n", body.name.c_str(), options.output.c_str());
  print_field(field);
  // cells halved once for the field, twice for the shape it was made of
  const double volume = solid_volume(field, volume_grid(field, 4));
  const double finer = solid_volume(*body.shape, volume_grid(field, 5));
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

void declare(CLI::App& app, Options& options) {
  CLI::Option* file = app.add_option("case", options.case_file, "Case file with the body (TOML)");
  CLI::Option* view =
      app.add_option("--inspect", options.inspect, "Describe and check an SDF file");
  CLI::Option* body = app.add_option("--body", options.body, "Name of the body to sample");
  CLI::Option* spacing = app.add_option("--spacing", options.spacing, "Distance of samples, m")
                             ->check(CLI::PositiveNumber);
  CLI::Option* output = app.add_option("-o,--output", options.output, "SDF file to write");
  for (CLI::Option* option : {body, spacing, output}) option->needs(file)->excludes(view);
  file->excludes(view)->needs(body)->needs(spacing)->needs(output);
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
  if (!options.case_file.empty()) return write_field(options);
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
