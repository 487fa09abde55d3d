// The boundary condition of every face on the sides of the grid, at one time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::cfd {

struct SideCondition {
  BoundaryType type = BoundaryType::no_slip;
  Vec3 velocity = Vec3::Zero();  // m/s now: an inlet's mean superficial velocity, or the wall's
  double pressure = 0.0;         // Pa now, outlet
  Backflow backflow = Backflow::still;
};

// One condition of a side: its own (name "") or that of a patch.
struct SidePart {
  std::string name;
  int direction = 0, side = 0;
  long faces = 0;
  Boundary stated;
};

// "boundary.z_lower" or "boundary.patch 'jet' on z_lower".
std::string title(const SidePart& part);

class SideConditions {
 public:
  // Every rank holds the whole sides. Throws UserError when a patch holds the centre of no face,
  // two patches hold the same one, or a profile does not cover its inlet.
  SideConditions(const Grid& grid, const Boundaries& boundaries,
                 const std::vector<BoundaryPatch>& patches = {});

  // Velocities and pressures from now on are those of `time`, s. Throws UserError when a time table
  // has ended before. They are those of time 0 at first.
  void set_time(double time);

  bool is_periodic(int direction) const { return at(direction, 0, {}).type == periodic; }
  // Some face of the side has this type.
  bool has(int direction, int side, BoundaryType type) const;
  // All faces of the side have the same condition and velocity.
  bool is_uniform(int direction, int side) const;

  // Condition of the face next to a cell given by global indices. Cells beyond the edges of the
  // side have that of the nearest face, or of the one that periodic directions make it.
  const SideCondition& at(int direction, int side, const Index3& cell) const;
  // Index into parts() of the condition there.
  std::size_t part(int direction, int side, const Index3& cell) const;
  // Its velocity: of an inlet with the profile.
  Vec3 velocity(int direction, int side, const Index3& cell) const;

  // Largest velocity of each component that any inlet or wall has at any time, m/s.
  const Vec3& largest_speeds() const { return largest_speeds_; }

  const std::vector<SidePart>& parts() const { return parts_; }

 private:
  static constexpr BoundaryType periodic = BoundaryType::periodic;

  struct Map {
    std::vector<std::uint16_t> part;  // of each face, index into parts_; empty: all the first
    std::vector<double> share;        // velocity over the mean of its part; empty: 1
    std::uint16_t first = 0;          // the side's own condition
  };

  std::size_t face_index(int direction, const Index3& cell) const;
  Rectangle face_rectangle(int direction, const Index3& cell) const;
  template <class Visit>
  void for_each_face(int direction, Visit&& visit) const;
  void place_patch(const BoundaryPatch& patch);
  void count_faces();
  void set_profile(std::uint16_t part);
  Vec3 find_largest_speeds() const;

  Grid grid_;
  std::array<std::array<Map, 2>, 3> maps_;
  std::vector<SidePart> parts_;
  std::vector<SideCondition> conditions_;  // of parts_, now
  Vec3 largest_speeds_ = Vec3::Zero();
};

}  // namespace gasgrain::cfd
