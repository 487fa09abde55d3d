// A face belongs to a patch when its centre does: a face half of which is wall and half inlet has
// no flow of its own to resolve, and whole faces keep the flux and the area of an inlet what they
// are stated to be. The area that a patch so gets is reported.
#include "cfd/side_conditions.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double round_off = 1e-9;  // of a cell: a face centre on the surface of a region is in it

}  // namespace

std::string title(const SidePart& part) {
  const std::string side = names_of_sides[part.direction][part.side];
  return part.name.empty() ? "boundary." + side : "boundary.patch '" + part.name + "' on " + side;
}

SideConditions::SideConditions(const Grid& grid, const Boundaries& boundaries,
                               const std::vector<BoundaryPatch>& patches)
    : grid_(grid) {
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      maps_[d][side].first = static_cast<std::uint16_t>(parts_.size());
      parts_.push_back({"", d, side, 0, boundaries[d][side]});
    }
  }
  for (const BoundaryPatch& patch : patches) place_patch(patch);
  count_faces();
  for (std::size_t n = 0; n < parts_.size(); ++n) set_profile(static_cast<std::uint16_t>(n));
  conditions_.resize(parts_.size());
  largest_speeds_ = find_largest_speeds();
  set_time(0.0);
}

std::size_t SideConditions::face_index(int direction, const Index3& cell) const {
  std::size_t index = 0;
  for (int d = 2; d >= 0; --d) {
    if (d == direction) continue;
    const int cells = grid_.cells[d];
    const bool joined = conditions_.empty() ? false : is_periodic(d);
    const int n = joined ? ((cell[d] % cells) + cells) % cells : std::clamp(cell[d], 0, cells - 1);
    index = index * cells + n;
  }
  return index;
}

Rectangle SideConditions::face_rectangle(int direction, const Index3& cell) const {
  const Vec3 h = grid_.spacing(), steps(cell[0], cell[1], cell[2]);
  Rectangle face{grid_.lower + steps.cwiseProduct(h), {}};
  face.upper = face.lower + h;
  face.lower[direction] = face.upper[direction] = 0.0;
  return face;
}

// visit(a cell next to the face) for every face of a side.
template <class Visit>
void SideConditions::for_each_face(int direction, Visit&& visit) const {
  Index3 end = grid_.cells;
  end[direction] = 1;
  for (int k = 0; k < end[2]; ++k) {
    for (int j = 0; j < end[1]; ++j) {
      for (int i = 0; i < end[0]; ++i) visit(Index3{i, j, k});
    }
  }
}

void SideConditions::place_patch(const BoundaryPatch& patch) {
  const int d = patch.direction;
  Map& map = maps_[d][patch.side];
  const auto number = static_cast<std::uint16_t>(parts_.size());
  parts_.push_back({patch.name, d, patch.side, 0, patch.condition});
  if (map.part.empty()) {
    map.part.assign(grid_.cells[(d + 1) % 3] * std::size_t(grid_.cells[(d + 2) % 3]), map.first);
  }
  const double slack = round_off * grid_.spacing().minCoeff();
  for_each_face(d, [&](const Index3& cell) {
    const Rectangle face = face_rectangle(d, cell);
    Vec3 centre = 0.5 * (face.lower + face.upper);
    centre[d] = patch.side == 0 ? grid_.lower[d] : grid_.upper[d];
    if (patch.region->distance(centre) > slack) return;
    std::uint16_t& part = map.part[face_index(d, cell)];
    if (part != map.first) {
      std::ostringstream message;
      message << title(parts_[number]) << " and " << title(parts_[part])
              << " both hold the face at (" << centre.transpose()
              << ") m; move or shrink one of them";
      throw UserError(message.str());
    }
    part = number;
  });
}

void SideConditions::count_faces() {
  for (int d = 0; d < 3; ++d) {
    for (const Map& map : maps_[d]) {
      for (const std::uint16_t part : map.part) ++parts_[part].faces;
      if (!map.part.empty()) continue;
      parts_[map.first].faces = long(grid_.cells[(d + 1) % 3]) * grid_.cells[(d + 2) % 3];
    }
  }
  for (const SidePart& part : parts_) {
    if (part.name.empty() || part.faces > 0) continue;
    std::ostringstream message;
    message << title(part) << " holds the centre of no face of the side, whose cells are "
            << grid_.spacing().transpose() << " m; its shape must reach through the side at "
            << "xyz"[part.direction] << " = "
            << (part.side == 0 ? grid_.lower : grid_.upper)[part.direction]
            << " m; make it larger or refine the grid";
    throw UserError(message.str());
  }
}

// Shares of the faces of an inlet, scaled so that their mean is one, and the mean velocity of an
// inlet whose table gives it.
void SideConditions::set_profile(std::uint16_t number) {
  SidePart& part = parts_[number];
  const InletProfile& profile = part.stated.profile;
  if (profile.kind == ProfileKind::uniform || part.faces == 0) return;
  const int d = part.direction;
  Map& map = maps_[d][part.side];
  const auto for_each_own = [&](const auto& visit) {
    for_each_face(d, [&](const Index3& cell) {
      if (map.part.empty() || map.part[face_index(d, cell)] == number) visit(cell);
    });
  };
  Rectangle extent{Vec3::Constant(std::numeric_limits<double>::infinity()), {}};
  extent.upper = -extent.lower;
  for_each_own([&](const Index3& cell) {
    const Rectangle face = face_rectangle(d, cell);
    extent.lower = extent.lower.cwiseMin(face.lower);
    extent.upper = extent.upper.cwiseMax(face.upper);
  });
  check_coverage(profile, extent, title(part));
  map.share.resize(grid_.cells[(d + 1) % 3] * std::size_t(grid_.cells[(d + 2) % 3]), 1.0);
  double sum = 0.0;
  for_each_own([&](const Index3& cell) {
    const double value = mean_over_face(profile, d, extent, face_rectangle(d, cell));
    map.share[face_index(d, cell)] = value;
    sum += value;
  });
  const double mean = sum / static_cast<double>(part.faces);
  if (!(mean > 0.0)) throw UserError(title(part) + ": profile_file gives no inflow at all");
  for_each_own([&](const Index3& cell) { map.share[face_index(d, cell)] /= mean; });
  if (part.stated.velocity_is_of_profile) {
    part.stated.superficial_velocity = (part.side == 0 ? mean : -mean) * Vec3::Unit(d);
  }
}

void SideConditions::set_time(double time) {
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    const Boundary& stated = parts_[n].stated;
    if (!stated.factor.covers(time)) {
      std::ostringstream message;
      message << title(parts_[n]) << ": time_table ends at " << stated.factor.times.back()
              << " s but the run has reached " << time << " s; add rows or give a period";
      throw UserError(message.str());
    }
    const double factor = stated.factor.at(time);
    const bool inlet = stated.type == BoundaryType::inlet;
    conditions_[n] = {stated.type,
                      factor * (inlet ? stated.superficial_velocity : stated.wall_velocity),
                      factor * stated.pressure, stated.backflow};
  }
}

bool SideConditions::has(int direction, int side, BoundaryType type) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const SidePart& part) {
    return part.direction == direction && part.side == side && part.faces > 0 &&
           part.stated.type == type;
  });
}

bool SideConditions::is_uniform(int direction, int side) const {
  return maps_[direction][side].part.empty() && maps_[direction][side].share.empty();
}

std::size_t SideConditions::part(int direction, int side, const Index3& cell) const {
  const Map& map = maps_[direction][side];
  return map.part.empty() ? map.first : map.part[face_index(direction, cell)];
}

const SideCondition& SideConditions::at(int direction, int side, const Index3& cell) const {
  return conditions_[part(direction, side, cell)];
}

Vec3 SideConditions::velocity(int direction, int side, const Index3& cell) const {
  const Map& map = maps_[direction][side];
  const Vec3& mean = at(direction, side, cell).velocity;
  return map.share.empty() ? mean : Vec3(map.share[face_index(direction, cell)] * mean);
}

Vec3 SideConditions::find_largest_speeds() const {
  Vec3 largest = Vec3::Zero();
  for (std::size_t n = 0; n < parts_.size(); ++n) {
    const SidePart& part = parts_[n];
    const bool inlet = part.stated.type == BoundaryType::inlet;
    double share = part.stated.factor.largest_magnitude();
    const Map& map = maps_[part.direction][part.side];
    if (inlet && !map.share.empty()) {
      share *= *std::max_element(map.share.begin(), map.share.end());
    }
    const Vec3& mean = inlet ? part.stated.superficial_velocity : part.stated.wall_velocity;
    largest = largest.cwiseMax(share * mean.cwiseAbs());
  }
  return largest;
}

}  // namespace gasgrain::cfd
