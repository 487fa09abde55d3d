// Sampling by bricks, and the check that neighbouring samples are consistent.
//
// phi is 1-Lipschitz: |phi(x) - phi(y)| <= |x - y|. So a brick whose centre has |phi| > band + half
// its diagonal lies outside of the band everywhere and |phi| minus half the diagonal bounds all of
// it; and neighbouring samples of a true distance differ by one spacing at most, whereas a field
// with a hole changes its sign by a jump. Jumps without change of sign beyond the band are
// harmless: there a shape made of another sampled field returns bounds.
#include "coupling/shared/sampling.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr int cells = SampledDistance::brick_cells;
constexpr int points = SampledDistance::brick_points;
constexpr double lipschitz_tolerance = 1e-3;  // share of a spacing: files may hold rounded values
constexpr double most_bricks = 1e8;           // about 1.2 GB of index

template <class Function>
void for_each_point(const Function& function) {
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) function(std::array<int, 3>{i, j, k});
    }
  }
}

std::size_t offset(const std::array<int, 3>& point) {
  return (static_cast<std::size_t>(point[2]) * points + point[1]) * points + point[0];
}

std::size_t brick_index(const BrickSamples& data, const std::array<int, 3>& brick) {
  return (static_cast<std::size_t>(brick[2]) * data.bricks[1] + brick[1]) * data.bricks[0] +
         brick[0];
}

Vec3 position(const BrickSamples& data, const std::array<int, 3>& brick,
              const std::array<int, 3>& point) {
  Vec3 steps;
  for (int d = 0; d < 3; ++d) steps[d] = brick[d] * cells + point[d];
  return data.lower + data.spacing * steps;
}

template <class Function>
void for_each_brick(const BrickSamples& data, const Function& function) {
  for (int k = 0; k < data.bricks[2]; ++k) {
    for (int j = 0; j < data.bricks[1]; ++j) {
      for (int i = 0; i < data.bricks[0]; ++i) function(std::array<int, 3>{i, j, k});
    }
  }
}

// Bound of |phi| in a whole brick with its sign, or 0 when the brick touches the band.
double far_value(const SignedDistance& shape, const BrickSamples& data,
                 const std::array<int, 3>& brick) {
  const double half_diagonal = 0.5 * std::sqrt(3.0) * cells * data.spacing;
  const Vec3 center = position(data, brick, {0, 0, 0}) + Vec3::Constant(0.5 * cells * data.spacing);
  const double phi = shape.distance(center);
  const double bound = std::abs(phi) - half_diagonal;
  return bound >= data.band ? std::copysign(bound, phi) : 0.0;
}

void store_brick(const SignedDistance& shape, const std::array<int, 3>& brick, BrickSamples& data) {
  data.slot[brick_index(data, brick)] =
      static_cast<std::int32_t>(data.samples.size() / SampledDistance::samples_per_brick);
  for_each_point([&](const std::array<int, 3>& point) {
    data.samples.push_back(shape.distance(position(data, brick, point)));
  });
}

std::string text(const Vec3& x) {
  std::ostringstream out;
  out << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return out.str();
}

void check_box(const SignedDistance& shape, const SamplingBox& box) {
  const Vec3 size = box.upper - box.lower;
  if (!(size.minCoeff() > 0)) {
    throw UserError("sampling box from " + text(box.lower) + " to " + text(box.upper) +
                    " is empty; every upper coordinate must exceed the lower one");
  }
  std::ostringstream message;
  const double bricks = (size / (cells * box.spacing)).array().ceil().prod();
  if (bricks > most_bricks) {
    message << "sampling box of " << text(size) << " m needs " << bricks
            << " bricks at a spacing of " << box.spacing << " m, more than " << most_bricks
            << "; choose a larger spacing";
    throw UserError(message.str());
  }
  if (box.band > shape.resolved_range()) {
    message << "the band is " << box.band << " m, but the file that the body is made of resolves "
            << shape.resolved_range() << " m only; give a narrower band";
    throw UserError(message.str());
  }
}

class ClosedCheck {
 public:
  ClosedCheck(const BrickSamples& data, const std::string& name) : data_(data), name_(name) {}

  void run() {
    for_each_brick(data_, [&](const std::array<int, 3>& brick) {
      check_inside(brick);
      for (int d = 0; d < 3; ++d) {
        std::array<int, 3> next = brick;
        if (++next[d] < data_.bricks[d]) check_shared_face(brick, next, d);
      }
    });
  }

  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

 private:
  // Sample `point` of a brick, or the value of a brick that is not stored.
  double value(const std::array<int, 3>& brick, const std::array<int, 3>& point) const {
    const std::size_t b = brick_index(data_, brick);
    if (data_.slot[b] < 0) return data_.far_value[b];
    return data_
        .samples[static_cast<std::size_t>(data_.slot[b]) * SampledDistance::samples_per_brick +
                 offset(point)];
  }
  bool stored(const std::array<int, 3>& brick) const {
    return data_.slot[brick_index(data_, brick)] >= 0;
  }

  [[noreturn]] void fail(const Vec3& place, double one, double other) const {
    std::ostringstream message;
    message << name_ << ": body not closed: its signed distance jumps from " << one << " to "
            << other << " m within one spacing (" << data_.spacing << " m) at " << text(place)
            << "; the surface must enclose the solid without gaps, with distances < 0 inside";
    throw UserError(message.str());
  }

  void check_inside(const std::array<int, 3>& brick) {
    const double allowed = (1.0 + lipschitz_tolerance) * data_.spacing;
    if (!stored(brick)) {
      note(value(brick, {}));
      return;
    }
    for_each_point([&](const std::array<int, 3>& point) {
      const double here = value(brick, point);
      note(here);
      for (int d = 0; d < 3; ++d) {
        std::array<int, 3> next = point;
        if (++next[d] == points) continue;
        const double there = value(brick, next);
        const bool matters =
            here * there < 0 || std::min(std::abs(here), std::abs(there)) < data_.band;
        if (matters && std::abs(here - there) > allowed) {
          fail(position(data_, brick, point), here, there);
        }
      }
    });
  }

  // The last layer of `brick` is the first of `next`: equal where both are stored, else of one
  // sign.
  void check_shared_face(const std::array<int, 3>& brick, const std::array<int, 3>& next, int d) {
    for_each_point([&](std::array<int, 3> point) {
      if (point[d] != 0) return;
      const double there = value(next, point);
      point[d] = cells;
      const double here = value(brick, point);
      const bool same = stored(brick) && stored(next)
                            ? std::abs(here - there) <= lipschitz_tolerance * data_.spacing
                            : here * there > 0;
      if (!same) fail(position(data_, brick, point), here, there);
    });
  }

  void note(double phi) {
    smallest_ = std::min(smallest_, phi);
    largest_ = std::max(largest_, phi);
  }

  const BrickSamples& data_;
  const std::string& name_;
  double smallest_ = std::numeric_limits<double>::infinity();
  double largest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

SampledDistance sample_shape(const SignedDistance& shape, const SamplingBox& box) {
  GASGRAIN_ASSERT(box.spacing > 0 && box.band > 0);
  check_box(shape, box);
  BrickSamples data;
  data.lower = box.lower;
  data.spacing = box.spacing;
  data.band = box.band;
  data.cut = box.cut;
  const Vec3 bricks =
      ((box.upper - box.lower) / (cells * box.spacing) - Vec3::Constant(1e-9)).array().ceil();
  for (int d = 0; d < 3; ++d) data.bricks[d] = std::max(1, static_cast<int>(bricks[d]));
  data.slot.assign(static_cast<std::size_t>(data.bricks[0]) * data.bricks[1] * data.bricks[2], -1);
  data.far_value.assign(data.slot.size(), 0.0);
  for_each_brick(data, [&](const std::array<int, 3>& brick) {
    const double bound = far_value(shape, data, brick);
    if (bound == 0.0) {
      store_brick(shape, brick, data);
    } else {
      data.far_value[brick_index(data, brick)] = bound;
    }
  });
  return SampledDistance(std::move(data));
}

void check_closed(const SampledDistance& field, const std::string& name) {
  ClosedCheck check(field.data(), name);
  check.run();
  if (check.smallest() >= 0) {
    throw UserError(name +
                    ": body not closed: no sample lies inside the solid; the surface is "
                    "open, or the solid is thinner than the spacing or outside of the box");
  }
  if (check.largest() <= 0) {
    throw UserError(name +
                    ": no sample lies outside the solid; is the sign of the distance right "
                    "(> 0 outside), and does the box reach beyond the body?");
  }
  if (field.ends_at_box() && !field.data().cut) {
    throw UserError(name + ": body not closed within its sampled box from " + text(field.lower()) +
                    " to " + text(field.upper()) +
                    "; enlarge the box, or say that the body goes "
                    "on beyond it (cut = true, gasgrain-sdf --allow-cut)");
  }
}

}  // namespace gasgrain
