// The check that neighbouring samples are consistent.
//
// Neighbouring samples of a true distance differ by one spacing at most (coefficients of the
// quadratic interpolation at kinks by somewhat more), whereas a field with a hole changes its sign
// by a jump. Jumps without change of sign beyond the band are harmless: there a shape made of
// another sampled field returns bounds.
#include <cmath>
#include <limits>
#include <sstream>

#include "coupling/shared/error.hpp"
#include "coupling/shared/sampling.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain {

namespace {

constexpr int points = SampledDistance::brick_points;
constexpr double lipschitz_tolerance = 1e-3;  // share of a spacing: files may hold rounded values
constexpr double coefficient_excess = 0.75;   // second differences of kinks in three directions

Index3 next_in(Index3 index, int d) {
  ++index[d];
  return index;
}

class ClosedCheck {
 public:
  ClosedCheck(const SampledDistance& field, const std::string& name)
      : field_(field), data_(field.data()), name_(name) {
    const double excess = data_.interpolation == Interpolation::linear ? 0.0 : coefficient_excess;
    allowed_ = (1.0 + excess + lipschitz_tolerance) * data_.spacing + 2 * data_.quantum;
  }

  void run() {
    const Index3& n = data_.bricks;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) check_brick({i, j, k});
  }

  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

 private:
  using Brick = SampledDistance::Brick;

  [[noreturn]] void fail(const Vec3& place, double one, double other) const {
    std::ostringstream message;
    message << name_ << ": body not closed: its signed distance jumps from " << one << " to "
            << other << " m within one spacing (" << data_.spacing << " m) at " << text(place)
            << "; the surface must enclose the solid without gaps, with distances < 0 inside";
    throw UserError(message.str());
  }

  void check_brick(const Index3& at) {
    const Brick own = field_.brick(at);
    if (own.slot < 0)
      note(own.far_value);
    else
      check_inside(at, own);
    for (int d = 0; d < 3; ++d) {
      if (at[d] + 1 == data_.bricks[d]) continue;
      const Brick next = field_.brick(next_in(at, d));
      if (own.slot < 0 && next.slot < 0) {
        if (own.far_value * next.far_value < 0)
          fail(field_.position(at, {0, 0, 0}), own.far_value, next.far_value);
      } else {
        check_faces(at, own, next, d);
      }
    }
  }

  void check_inside(const Index3& at, const Brick& own) {
    for (int k = 0; k < points; ++k) {
      for (int j = 0; j < points; ++j) {
        for (int i = 0; i < points; ++i) {
          const Index3 point{i, j, k};
          const double here = field_.stored(own.slot, point);
          note(here);
          for (int d = 0; d < 3; ++d)
            if (point[d] + 1 < points)
              compare(at, point, here, field_.stored(own.slot, next_in(point, d)));
        }
      }
    }
  }

  // The last layer of one brick against the first of the next.
  void check_faces(const Index3& at, const Brick& own, const Brick& next, int d) {
    for (int a = 0; a < points; ++a) {
      for (int b = 0; b < points; ++b) {
        Index3 last, first;
        last[d] = points - 1;
        first[d] = 0;
        last[(d + 1) % 3] = first[(d + 1) % 3] = a;
        last[(d + 2) % 3] = first[(d + 2) % 3] = b;
        const double here = own.slot < 0 ? own.far_value : field_.stored(own.slot, last);
        const double there = next.slot < 0 ? next.far_value : field_.stored(next.slot, first);
        if (own.slot >= 0 && next.slot >= 0)
          compare(at, last, here, there);
        else if (here * there < 0)
          fail(field_.position(at, last), here, there);
      }
    }
  }

  void compare(const Index3& brick, const Index3& point, double here, double there) const {
    const bool matters = here * there < 0 || std::min(std::abs(here), std::abs(there)) < data_.band;
    if (matters && std::abs(here - there) > allowed_)
      fail(field_.position(brick, point), here, there);
  }

  void note(double phi) {
    smallest_ = std::min(smallest_, phi);
    largest_ = std::max(largest_, phi);
  }

  const SampledDistance& field_;
  const BrickSamples& data_;
  const std::string& name_;
  double allowed_ = 0.0;  // m
  double smallest_ = std::numeric_limits<double>::infinity();
  double largest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

void check_closed(const SampledDistance& field, const std::string& name) {
  ClosedCheck check(field, name);
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
