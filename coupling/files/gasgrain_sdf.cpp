// gasgrain-sdf: samples a body of a case file or STL files into an SDF file, or inspects such a
// file.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "coupling/files/sdf_file.hpp"
#include "coupling/files/slice_picture.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/config_table.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/feature_size.hpp"
#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/motion.hpp"
#include "coupling/shared/primitives.hpp"
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
  bool allow_cut = false, compact = false;
  std::string interpolation = "quadratic", picture, slice_axis = "y";
  std::optional<double> slice_position;  // m; the middle
  int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
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
                  .cut = options.allow_cut,
                  .interpolation = options.interpolation == "linear" ? Interpolation::linear
                                                                     : Interpolation::quadratic,
                  .storage = options.compact ? SampleStorage::compact : SampleStorage::plain};
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
  const Index3& bricks = data.bricks;
  const double all = static_cast<double>(bricks[0]) * bricks[1] * bricks[2];
  std::printf("spacing        %g m, band %g m, %s interpolation\n", data.spacing, data.band,
              data.interpolation == Interpolation::linear ? "linear" : "quadratic");
  std::printf("box            (%g, %g, %g) to (%g, %g, %g) m%s\n", lower[0], lower[1], lower[2],
              upper[0], upper[1], upper[2], data.cut ? ", body goes on beyond it" : "");
  std::printf("bricks         %zu of %.0f stored (%.2g %%), %d x %d x %d of 4^3 samples\n",
              data.stored_bricks(), all, 100.0 * data.stored_bricks() / all, bricks[0], bricks[1],
              bricks[2]);
  std::printf("memory         %.2f MB, %zu bytes per sample; a dense grid %.4g MB\n",
              field.memory() / 1e6, data.quantum > 0 ? sizeof(std::int16_t) : sizeof(float),
              all * SampledDistance::samples_per_brick * sizeof(float) / 1e6);
}

// The part of a shape within a box.
class PartInBox final : public SignedDistance, public DistanceFromKnown {
 public:
  PartInBox(const SignedDistance& shape, const Eigen::AlignedBox3d& box)
      : shape_(shape),
        box_(make_shape(Box{.center = box.center(), .half_size = 0.5 * box.sizes()})) {}
  double distance(const Vec3& x) const override {
    return std::max(shape_.distance(x), box_->distance(x));
  }
  double distance_near(const Vec3& x, const KnownDistance& known) const override {
    const bool is_of_shape = known.distance > box_->distance(known.place);
    return std::max(is_of_shape ? gasgrain::distance_near(shape_, x, known) : shape_.distance(x),
                    box_->distance(x));
  }
  DistanceSample sample(const Vec3& x) const override {
    const DistanceSample own = shape_.sample(x), box = box_->sample(x);
    return own.distance > box.distance ? own : box;
  }

 private:
  const SignedDistance& shape_;
  Shape box_;
};

// How often cells at the surface may be halved, at most `wanted`, so that the volume of large
// bodies does not take longer than their samples: a brick has about 16 such cells.
int halvings_of_cells(const SampledDistance& field, int wanted) {
  constexpr double most_looks = 4e6;
  double looks = 16.0 * static_cast<double>(field.data().stored_bricks());
  int halvings = 0;
  while (halvings < wanted && (looks *= 8) <= most_looks) ++halvings;
  return halvings;
}

// Volume of the solid in the box of the field; cells of the field are halved `halvings` times.
double volume_in_box(const SignedDistance& shape, const SampledDistance& field, int halvings,
                     int threads) {
  constexpr int cubes = 3;  // halvings from the largest cube to a cell
  const Eigen::AlignedBox3d box(field.lower(), field.upper());
  const double edge = field.data().spacing * (1 << cubes);
  VolumeGrid grid{box.min(), edge, {}, cubes + halvings};
  for (int d = 0; d < 3; ++d)
    grid.cells[d] = static_cast<int>(std::ceil(box.sizes()[d] / edge - 1e-9));
  return solid_volume(PartInBox(shape, box), grid, threads);
}

void print_features(const SignedDistance& shape, const SampledDistance& field) {
  const double spacing = field.data().spacing, length = 20 * spacing;
  const FeatureSize size = feature_size(shape, field, length);
  const auto line = [&](const char* what, double value) {
    std::printf("%-14s %s%.3g m = %.3g spacings\n", what, value < length ? "" : "at least ", value,
                value / spacing);
  };
  line("thinnest wall", size.thinnest_wall);
  line("narrowest gap", size.narrowest_gap);
  if (size.thin_share > 0)
    std::printf(
        "  warning      %.2g %% of the surface has a wall or gap below two spacings: choose "
        "a smaller spacing\n",
        100 * size.thin_share);
}

void draw(const Options& options, const SampledDistance& field) {
  if (options.picture.empty()) return;
  Slice slice{options.slice_axis[0] - 'x', 0.0};
  slice.position =
      options.slice_position.value_or(0.5 * (field.lower() + field.upper())[slice.axis]);
  write_slice_picture(options.picture, field, slice);
  std::printf("picture        %s, %s = %g m\n", options.picture.c_str(), options.slice_axis.c_str(),
              slice.position);
}

// Says every tenth on the error output.
std::function<void(double)> progress_report() {
  return [said = 0](double share) mutable {
    const int tenth = static_cast<int>(10 * share);
    if (tenth <= said) return;
    said = tenth;
    std::fprintf(stderr, "sampling %d %%\n", 10 * tenth);
  };
}

int write_field(const Options& options) {
  const Subject subject =
      options.case_file.empty() ? read_stl_files(options) : read_case_body(options);
  std::fputs(subject.shape->remarks().c_str(), stdout);
  const auto field = std::make_shared<const SampledDistance>(
      sample_shape(*subject.shape, sampling_box(options, subject),
                   {.threads = options.threads, .progress = progress_report()}));
  check_closed(*field, subject.name);
  write_sdf(options.output, *field);

  std::printf("written        %s, from %s\n", options.output.c_str(), subject.name.c_str());
  print_field(*field);
  std::fputs("measuring the solid volume\n", stderr);
  const int halvings = halvings_of_cells(*field, 2);
  const double volume = volume_in_box(*field, *field, std::min(halvings, 1), options.threads);
  const double finer =
      volume_in_box(*subject.shape, *field, std::max(halvings, 1), options.threads);
  std::printf("solid volume   %.8g m^3 in the box, %+.2e of a finer estimate (%.8g m^3)\n", volume,
              (volume - finer) / finer, finer);
  std::fputs("measuring walls and gaps\n", stderr);
  print_features(*subject.shape, *field);
  draw(options, *field);
  return 0;
}

int inspect(const Options& options) {
  const auto field = std::make_shared<const SampledDistance>(read_sdf(options.inspect));
  std::printf("file           %s\n", options.inspect.c_str());
  print_field(*field);
  std::printf("solid volume   %.8g m^3 in the box\n",
              volume_in_box(*field, *field, halvings_of_cells(*field, 1), options.threads));
  print_features(*field, *field);
  draw(options, *field);
  check_closed(*field, options.inspect);
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
  app.add_option("--interpolation", options.interpolation,
                 "quadratic (smooth force) or linear (faster)")
      ->check(CLI::IsMember({"quadratic", "linear"}));
  app.add_flag("--compact", options.compact, "2 bytes per sample instead of 4");
  app.add_option("--threads", options.threads, "Threads (all cores)")->check(CLI::PositiveNumber);
  app.add_option("--picture", options.picture, "Slice through the field (PNG)");
  app.add_option("--slice-axis", options.slice_axis, "Normal of the slice (y)")
      ->check(CLI::IsMember({"x", "y", "z"}));
  app.add_option("--slice-position", options.slice_position, "Along that axis, m (the middle)");
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
