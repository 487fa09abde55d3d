// One contact with sampled walls against the exact shape or the analytic solution: rebound,
// sliding down a plane, rolling in a pipe. Lengths in radii of the grain unless stated.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "tests/verification/grain_flight.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double half_size = 8.0;  // of the sampled box

struct Rebound {
  double speed;     // m/s
  double duration;  // s
  double distance;  // m, of the wall before
};

// A damped head-on impact at an overlap of about a hundredth of the radius; `from`: a place half
// a percent of the radius away from the wall, `towards`: unit vector.
Rebound rebound(const Shape& wall, const Vec3& from, const Vec3& towards) {
  GrainFlight grain(wall, {.restitution = 0.9});
  grain.position = from;
  grain.velocity = 0.01 * towards;
  constexpr double step = std::numbers::pi / 1000;  // of the contact time, pi sqrt(m/k)
  const double distance = 1.0 + grain.gap();
  double begin = 0.0, gap_before = grain.gap();
  for (int n = 0;; ++n) {
    grain.step(step);
    const double gap = grain.gap();
    // when the gap is zero, between the last two steps
    const double zero = step * (n + gap_before / (gap_before - gap));
    if (gap_before > 0 && gap <= 0) begin = zero;
    if (gap_before < 0 && gap >= 0) return {grain.velocity.norm(), zero - begin, distance};
    gap_before = gap;
  }
}

struct Wall {
  std::string name;
  Shape shape;
  std::function<Vec3(double)> normal_at;  // into the gas, at the place of impact n = 0, 1, ...
  std::function<Vec3(double)> foot_at;    // on the surface
};

constexpr int impacts = 20;

// Largest errors over impacts all over the wall, relative to the exact shape, but for the distance.
Rebound largest_errors(const Wall& wall, double spacing, Interpolation interpolation) {
  const Shape field = sampled(wall.shape, half_size, spacing, interpolation);
  Rebound errors{};
  for (int n = 0; n < impacts; ++n) {
    const Vec3 normal = wall.normal_at(n), from = wall.foot_at(n) + 1.005 * normal;
    const Rebound exact = rebound(wall.shape, from, -normal);
    const Rebound found = rebound(field, from, -normal);
    errors.speed = std::max(errors.speed, std::abs(found.speed / exact.speed - 1));
    errors.duration = std::max(errors.duration, std::abs(found.duration / exact.duration - 1));
    errors.distance = std::max(errors.distance, std::abs(found.distance - exact.distance));
  }
  return errors;
}

// Scattered over (0, 1), in two sequences.
double first_scattered(double n) {
  return std::fmod(0.5 + 0.7548776662466927 * n, 1.0);
}
double second_scattered(double n) {
  return std::fmod(0.5 + 0.5698402909980532 * n, 1.0);
}

Wall plane() {
  const Vec3 normal = Vec3(1, 2, 4).normalized(), along = Vec3(2, -1, 0).normalized();
  const Vec3 across = normal.cross(along), point(0.13, -0.21, 0.37);
  return {"plane", make_shape(Plane{point, normal}), [=](double) { return normal; },
          [=](double n) {
            return Vec3(point + (4 * first_scattered(n) - 2) * along +
                        (4 * second_scattered(n) - 2) * across);
          }};
}

Vec3 scattered_direction(double n) {
  const double z = 2 * first_scattered(n) - 1, turn = 2 * std::numbers::pi * second_scattered(n);
  const double side = std::sqrt(1 - z * z);
  return {side * std::cos(turn), side * std::sin(turn), z};
}

// Grains hit it from outside.
Wall sphere() {
  const Vec3 center(0.13, -0.21, 0.37);
  constexpr double radius = 4.0;
  return {"sphere", make_shape(Sphere{center, radius}), scattered_direction,
          [=](double n) { return Vec3(center + radius * scattered_direction(n)); }};
}

// Grains hit it from inside.
Wall pipe() {
  const Vec3 center(0.13, -0.21, 0.37), axis = Vec3(3, 1, 2).normalized();
  const Vec3 along = Vec3(2, -6, 0).normalized(), across = axis.cross(along);
  constexpr double radius = 4.0;
  const auto normal = [=](double n) {
    const double turn = 2 * std::numbers::pi * first_scattered(n);
    return Vec3(-std::cos(turn) * along - std::sin(turn) * across);
  };
  return {"cylinder", make_complement(make_shape(Cylinder{center, axis, radius, infinity})), normal,
          [=](double n) {
            return Vec3(center + (2 * second_scattered(n) - 1) * axis - radius * normal(n));
          }};
}

TEST(WallContact, rebound_is_that_of_the_exact_shape) {
  Report report("wall_rebound", "rebound from sampled walls against the exact shape; e = 0.9");
  for (const Wall& wall : {plane(), sphere(), pipe()}) {
    for (const Interpolation interpolation : {Interpolation::quadratic, Interpolation::linear}) {
      const std::string kind =
          wall.name + "; " + (interpolation == Interpolation::linear ? "linear" : "quadratic");
      const Rebound coarse = largest_errors(wall, 0.5, interpolation),
                    middle = largest_errors(wall, 0.25, interpolation),
                    fine = largest_errors(wall, 0.125, interpolation);
      report.note("rebound speed; " + kind, "r/2", coarse.speed);
      report.check("rebound speed; " + kind, "r/4", middle.speed);
      report.note("rebound speed; " + kind, "r/8", fine.speed);
      report.note("contact time; " + kind, "r/2", coarse.duration);
      report.check("contact time; " + kind, "r/4", middle.duration);
      report.note("contact time; " + kind, "r/8", fine.duration);
      if (wall.name == "plane") continue;  // exact but for the rounding of samples
      report.note("distance; " + kind, "r/2", coarse.distance);
      report.note("distance; " + kind, "r/4", middle.distance);
      report.note("distance; " + kind, "r/8", fine.distance);
      report.check("order of the distance; " + kind, "r/2; r/4; r/8",
                   0.5 * observed_order(coarse.distance, fine.distance));
    }
  }
}

// A ball set down on a slope with mu < 2/7 tan(angle) slides: a = g (sin - mu cos), and turns with
// 5/2 mu g cos/r. The overlap takes a little from the lever arm.
TEST(WallContact, sliding_down_a_plane_is_that_of_the_analytic_solution) {
  Report report("wall_sliding", "grain sliding down an inclined sampled plane");
  const Vec3 normal = Vec3(0, std::sin(0.5), std::cos(0.5)), down(0, std::cos(0.5), -std::sin(0.5));
  constexpr double mu = 0.1, g = 1e-4, time = 400.0, overlap = g * 0.8775825618903728;
  const Shape plane = make_shape(Plane{Vec3(0.13, -0.2, 0.3), normal});
  for (const Interpolation interpolation : {Interpolation::quadratic, Interpolation::linear}) {
    GrainFlight grain(sampled(plane, 20.0, 0.25, interpolation),
                      {.restitution = 0.5, .friction = mu});
    grain.gravity = Vec3(0, 0, -g);
    const Vec3 start = Vec3(0.13, -0.2, 0.3) - 5 * down + (1 - overlap) * normal;
    grain.position = start;
    constexpr double step = std::numbers::pi / 40;
    const int steps = static_cast<int>(std::round(time / step));
    for (int n = 0; n < steps; ++n) grain.step(step);
    const double t = steps * step;
    const double acceleration = g * (std::sin(0.5) - mu * std::cos(0.5));
    const double spin_up = 2.5 * mu * g * std::cos(0.5);
    const std::string kind = interpolation == Interpolation::linear ? "linear" : "quadratic";
    report.check("way over exact; " + kind, "r/4",
                 (grain.position - start).dot(down) / (0.5 * acceleration * t * t));
    report.check("spin over exact; " + kind, "r/4",
                 grain.spin.dot(normal.cross(down)) / (spin_up * t));
  }
}

// Complete elliptic integral by the arithmetic-geometric mean: period of a pendulum of amplitude a
// over that of small swings.
double pendulum_stretch(double amplitude) {
  double a = 1.0, b = std::cos(0.5 * amplitude);
  for (int n = 0; n < 10; ++n) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1.0 / a;
}

// A ball that rolls to and fro in a horizontal pipe is a pendulum: length R - r, inertia 7/5.
TEST(WallContact, rolling_in_a_pipe_has_the_period_of_the_analytic_solution) {
  Report report("wall_rolling", "grain rolling in a horizontal sampled pipe; swings of 45 degrees");
  constexpr double radius = 4.0, amplitude = std::numbers::pi / 4, g = 1e-5;
  const Shape pipe = make_complement(
      make_shape(Cylinder{Vec3(0.13, -0.21, 0.07), Vec3(0, 1, 0), radius, infinity}));
  const double exact =
      2 * std::numbers::pi * std::sqrt(1.4 * (radius - 1) / g) * pendulum_stretch(amplitude);
  const auto period = [&](const Shape& wall) {
    GrainFlight grain(wall, {.restitution = 0.5, .friction = 1.0});
    grain.gravity = Vec3(0, 0, -g);
    const Vec3 out(std::sin(amplitude), 0, -std::cos(amplitude));
    grain.position = Vec3(0.13, -0.21, 0.07) + (radius - 1 + g * std::cos(amplitude)) * out;
    constexpr double step = std::numbers::pi / 20;
    double first = 0.0, before = grain.position[0] - 0.13;
    int crossings = 0;
    for (int n = 0;; ++n) {  // the lowest place is passed twice per period
      grain.step(step);
      const double x = grain.position[0] - 0.13;
      if ((x > 0) != (before > 0)) {
        const double time = step * (n + before / (before - x));
        if (crossings == 0) first = time;
        if (++crossings == 5) return (time - first) / 2;
      }
      before = x;
    }
  };
  report.check("period over exact; exact distance", "", period(pipe) / exact);
  report.check("period over exact; quadratic", "r/4",
               period(sampled(pipe, half_size, 0.25, Interpolation::quadratic)) / exact);
  report.check("period over exact; linear", "r/4",
               period(sampled(pipe, half_size, 0.25, Interpolation::linear)) / exact);
}

}  // namespace
}  // namespace gasgrain::verification
