// Fractions come from plane cuts (open_fraction.cpp), distances from the bodies themselves. What is
// left open afterwards is cleaned of gas that cannot move: a void there could not follow a change
// of the grains' volume, so the continuity equation would have no solution.
#include "cfd/wall_geometry.hpp"

#include <algorithm>
#include <sstream>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "cfd/open_fraction.hpp"
#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double sliver = 1e-9;  // open shares below count as closed, solid ones as open

class GeometryBuilder {
 public:
  GeometryBuilder(const Decomposition& decomposition, const SideConditions& sides,
                  const std::vector<Body>& bodies, double time)
      : decomposition_(decomposition),
        sides_(sides),
        all_bodies_(bodies),
        size_(decomposition.block().size),
        half_cell_(0.5 * decomposition.grid().spacing()),
        time_(time) {
    for (const Body& body : bodies) {
      if (!body.acts_on_gas) continue;
      bodies_.push_back(&body);
      shapes_.push_back(shape_at(body, time));
    }
    walls_.has_bodies = !bodies_.empty();
  }

  void check() const {
    check_bodies_reach_into_grid();
    check_bodies_are_resolved();
  }

  WallGeometry build() {
    allocate();
    sample_cells();
    for (int d = 0; d < 3; ++d) sample_faces(d);
    set_wall_velocities(walls_, decomposition_, all_bodies_, time_);
    close_faces_of_solid_cells();
    solidify_unresolved_cells();
    close_faces_of_solid_cells();
    share_faces();
    fill_all_ghosts();
    choose_hosts();
    return std::move(walls_);
  }

  WallGeometry build_spanned() {
    walls_.spans_bodies = walls_.has_bodies;
    allocate();
    sample_cells();
    for (int d = 0; d < 3; ++d) sample_faces(d);
    set_wall_velocities(walls_, decomposition_, all_bodies_, time_);
    close_faces_of_solid_cells();
    if (walls_.spans_bodies) {
      for (int d = 0; d < 3; ++d) span_bodies(d);
    }
    share_faces();
    fill_all_ghosts();
    return std::move(walls_);
  }

 private:
  void allocate();
  void check_bodies_reach_into_grid() const;
  void check_bodies_are_resolved() const;
  void sample_cells();
  void sample_faces(int d);
  void close_faces_of_solid_cells();
  void solidify_unresolved_cells();
  void span_bodies(int d);
  void share_faces();
  void fill_all_ghosts();
  void choose_hosts();

  Vec3 cell_centre(int i, int j, int k) const {
    const Index3& lower = decomposition_.block().lower;
    const Vec3 steps(2 * (i + lower[0]) + 1, 2 * (j + lower[1]) + 1, 2 * (k + lower[2]) + 1);
    return decomposition_.grid().lower + steps.cwiseProduct(half_cell_);
  }
  // Side of the grid that the face at local index n of direction d is on, or -1.
  int side_of_face(int d, int n) const {
    if (n == 0 && decomposition_.at_boundary(d, 0)) return 0;
    return n == size_[d] && decomposition_.at_boundary(d, 1) ? 1 : -1;
  }
  // Condition of the face of direction d at local indices on a side of the grid.
  BoundaryType type_of_face(int d, int side, int i, int j, int k) const {
    const Index3& lower = decomposition_.block().lower;
    return sides_.at(d, side, {i + lower[0], j + lower[1], k + lower[2]}).type;
  }
  bool is_open(int d, int side, int i, int j, int k) const {
    if (side < 0) return true;
    const BoundaryType type = type_of_face(d, side, i, j, k);
    return type == BoundaryType::inlet || type == BoundaryType::outlet;
  }
  bool flux_is_prescribed(int d, int side, int i, int j, int k) const {
    return side >= 0 && type_of_face(d, side, i, j, k) != BoundaryType::outlet;
  }
  // Index in the list of all bodies.
  std::ptrdiff_t nearest_body(const Vec3& x) const {
    const auto nearest = std::min_element(
        shapes_.begin(), shapes_.end(),
        [&](const Shape& a, const Shape& b) { return a->distance(x) < b->distance(x); });
    return bodies_[nearest - shapes_.begin()] - all_bodies_.data();
  }

  // visit(i, j, k) for all indices below `count` but those in bricks that are further than two
  // cells away from all bodies: |phi| never exceeds the distance.
  template <class Visit>
  void for_each_near_bodies(const Index3& count, Visit&& visit) const {
    if (!solid_) return;
    constexpr int brick = 8;
    const double reach = (brick + 6) * half_cell_.norm();
    const auto below = [&](int d, int first) { return std::min(first + brick, count[d]); };
    for (int c = 0; c < count[2]; c += brick) {
      for (int b = 0; b < count[1]; b += brick) {
        for (int a = 0; a < count[0]; a += brick) {
          const Vec3 middle = cell_centre(a, b, c) + (brick - 1) * half_cell_;
          if (solid_->distance(middle) > reach) continue;
          for (int k = c; k < below(2, c); ++k)
            for (int j = b; j < below(1, b); ++j)
              for (int i = a; i < below(0, a); ++i) visit(i, j, k);
        }
      }
    }
  }

  const Decomposition& decomposition_;
  const SideConditions& sides_;
  const std::vector<Body>& all_bodies_;
  Index3 size_;
  Vec3 half_cell_;
  double time_;                      // s
  std::vector<const Body*> bodies_;  // those that act on the gas
  std::vector<Shape> shapes_;
  Shape solid_;  // union of them
  WallGeometry walls_;
};

void GeometryBuilder::allocate() {
  const Grid& grid = decomposition_.grid();
  walls_.wall_fraction = Field(size_, 1.0);
  for (int d = 0; d < 3; ++d) {
    walls_.open_area[d] = walls_.takes_part[d] = Field(size_);
    walls_.distance[d] = Field(size_, (grid.upper - grid.lower).norm());
    walls_.wall_velocity[d] = Field(size_);
    walls_.nearest_body[d] = Field(size_, -1.0);
    for (Field& component : walls_.normal[d]) component = Field(size_);
    walls_.lower_share[d] = walls_.upper_share[d] = walls_.host[d] = Field(size_);
  }
  if (walls_.has_bodies) solid_ = make_union(shapes_);
}

void GeometryBuilder::check_bodies_reach_into_grid() const {
  for (const Body* body : bodies_) {
    if (body->motion.sweeps()) continue;
    bool inside = false;
    for_each_cell(size_, [&](int i, int j, int k) {
      inside = inside || open_fraction(*body->shape, cell_centre(i, j, k), half_cell_) < 1 - sliver;
    });
    if (max_over_ranks(decomposition_, inside ? 1.0 : 0.0) == 0.0) {
      throw UserError("body '" + body->name +
                      "' acts on the gas but no part of it is inside the gas grid; move it, extend "
                      "grid.lower and grid.upper, or give it acts_on = [\"grains\"]");
    }
  }
}

// Fractions and the immersed boundary look at distances up to about two cells.
void GeometryBuilder::check_bodies_are_resolved() const {
  const double needed = 4.0 * half_cell_.maxCoeff();
  for (const Body* body : bodies_) {
    const double band = body->shape->resolved_range();
    if (band >= needed) continue;
    std::ostringstream message;
    message << "body '" << body->name << "' is sampled with a band of " << band
            << " m, but the gas needs at least two of its cells, " << needed
            << " m; sample it again with a wider band (gasgrain-sdf --band)";
    throw UserError(message.str());
  }
}

void GeometryBuilder::sample_cells() {
  for_each_cell(size_, [&](int i, int j, int k) { walls_.wall_fraction(i, j, k) = 0.0; });
  for_each_near_bodies(size_, [&](int i, int j, int k) {
    const double open = open_fraction(*solid_, cell_centre(i, j, k), half_cell_);
    walls_.wall_fraction(i, j, k) = open < sliver ? 1.0 : open > 1 - sliver ? 0.0 : 1.0 - open;
  });
  fill_ghosts(decomposition_, walls_.wall_fraction);
}

void GeometryBuilder::sample_faces(int d) {
  Vec3 half_face = half_cell_;
  half_face[d] = 0.0;
  for_each_face(decomposition_, d, [&](int i, int j, int k) {
    const int side = side_of_face(d, Index3{i, j, k}[d]);
    walls_.open_area[d](i, j, k) = is_open(d, side, i, j, k) ? 1.0 : 0.0;
  });
  for_each_near_bodies(owned_faces(decomposition_, d), [&](int i, int j, int k) {
    const std::ptrdiff_t n = walls_.open_area[d].index(i, j, k);
    double& open = walls_.open_area[d][n];
    const Vec3 centre = cell_centre(i, j, k) - half_cell_[d] * Vec3::Unit(d);
    if (open > 0.0) open = open_fraction(*solid_, centre, half_face);
    const DistanceSample sample = solid_->sample(centre);
    walls_.distance[d][n] = sample.distance;
    for (int e = 0; e < 3; ++e) walls_.normal[d][e][n] = sample.gradient[e];
    walls_.nearest_body[d][n] = static_cast<double>(nearest_body(centre));
    open = open < sliver ? 0.0 : open > 1 - sliver ? 1.0 : open;
  });
}

// The faces between gas and solid cells are closed; what is left takes part unless its centre is
// inside a body or its flux is prescribed.
void GeometryBuilder::close_faces_of_solid_cells() {
  for (int d = 0; d < 3; ++d) {
    Field& open = walls_.open_area[d];
    for_each_face(decomposition_, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = open.index(i, j, k);
      const int side = side_of_face(d, Index3{i, j, k}[d]);
      const bool solid_above = side != 1 && walls_.wall_fraction[n] == 1.0;
      const bool solid_below = side != 0 && walls_.wall_fraction[n - open.stride(d)] == 1.0;
      if (solid_above || solid_below) open[n] = 0.0;
      const bool free = open[n] > 0.0 && walls_.distance[d][n] >= 0.0;
      walls_.takes_part[d][n] = free && !flux_is_prescribed(d, side, i, j, k) ? 1.0 : 0.0;
    });
  }
  fill_ghosts(decomposition_, walls_.takes_part);
}

void GeometryBuilder::solidify_unresolved_cells() {
  Field no_outlet(size_), whole(size_);
  const GasRegions found = find_gas_regions(decomposition_, walls_.takes_part, no_outlet);
  for_each_cell(size_, [&](int i, int j, int k) {
    whole(i, j, k) = walls_.wall_fraction(i, j, k) == 0.0 ? 1.0 : 0.0;
  });
  const std::vector<double> whole_cells = sum_per_region(decomposition_, found, whole);
  std::size_t n = 0;
  for_each_cell(size_, [&](int i, int j, int k) {
    const int region = found.region_of_cell[n++];
    // a whole cell that nothing joins may still be a sealed box of one cell
    const bool resolved =
        region == GasRegions::none ? whole(i, j, k) > 0.0 : whole_cells[region] > 0.0;
    if (!resolved) walls_.wall_fraction(i, j, k) = 1.0;
  });
  fill_ghosts(decomposition_, walls_.wall_fraction);
  double open = 0.0;
  for_each_cell(size_, [&](int i, int j, int k) { open += 1.0 - walls_.wall_fraction(i, j, k); });
  if (sum_over_ranks(decomposition_, open) == 0.0) {
    throw UserError(
        "the bodies fill the whole gas grid; distance must be positive in the gas, so a vessel is "
        "complement = {...} of its interior");
  }
}

void GeometryBuilder::span_bodies(int d) {
  Field& solid = walls_.solid_share[d];
  solid = Field(size_);
  for_each_near_bodies(owned_faces(decomposition_, d), [&](int i, int j, int k) {
    const Vec3 centre = cell_centre(i, j, k) - half_cell_[d] * Vec3::Unit(d);
    const double open = open_fraction(*solid_, centre, half_cell_);
    solid(i, j, k) = open < sliver ? 1.0 : open > 1 - sliver ? 0.0 : 1.0 - open;
  });
  fill_ghosts(decomposition_, solid);
  for_each_face(decomposition_, d, [&](int i, int j, int k) {
    if (side_of_face(d, Index3{i, j, k}[d]) >= 0) return;
    walls_.open_area[d](i, j, k) = walls_.takes_part[d](i, j, k) = 1.0;
  });
  fill_ghosts(decomposition_, walls_.takes_part[d]);
}

void GeometryBuilder::share_faces() {
  for (int d = 0; d < 3; ++d) {
    const Field& part = walls_.takes_part[d];
    for_each_cell(size_, [&](int i, int j, int k) {
      const std::ptrdiff_t n = part.index(i, j, k);
      const double lower = part[n], upper = part[n + part.stride(d)];
      if (lower + upper == 0.0 || walls_.wall_fraction[n] == 1.0) return;
      walls_.lower_share[d][n] = lower / (lower + upper);
      walls_.upper_share[d][n] = upper / (lower + upper);
    });
  }
}

void GeometryBuilder::fill_all_ghosts() {
  for (VectorField* field : {&walls_.open_area, &walls_.takes_part, &walls_.distance,
                             &walls_.lower_share, &walls_.upper_share}) {
    fill_ghosts(decomposition_, *field);
  }
  for (VectorField& normal : walls_.normal) fill_ghosts(decomposition_, normal);
}

// The neighbour behind the largest opening that has a face that takes part.
void GeometryBuilder::choose_hosts() {
  const auto shares = [&](int d, std::ptrdiff_t n) {
    return walls_.lower_share[d][n] + walls_.upper_share[d][n];
  };
  for (int d = 0; d < 3; ++d) {
    for_each_cell(size_, [&](int i, int j, int k) {
      const std::ptrdiff_t n = walls_.wall_fraction.index(i, j, k);
      if (walls_.wall_fraction[n] == 1.0 || shares(d, n) > 0.0) return;
      double largest = 0.0;
      for (int code = 1; code <= 6; ++code) {
        const int e = (code - 1) / 2, side = (code - 1) % 2;
        const std::ptrdiff_t neighbour = n + host_offset(walls_.wall_fraction, code);
        const std::ptrdiff_t face = side == 0 ? n : neighbour;
        const double opening = walls_.open_area[e][face] * (1.0 - walls_.wall_fraction[neighbour]);
        if (shares(d, neighbour) == 0.0 || opening <= largest) continue;
        largest = opening;
        walls_.host[d](i, j, k) = code;
      }
    });
  }
  fill_ghosts(decomposition_, walls_.host);
}

}  // namespace

WallGeometry make_wall_geometry(const Decomposition& decomposition, const SideConditions& sides,
                                const std::vector<Body>& bodies, double time) {
  GeometryBuilder builder(decomposition, sides, bodies, time);
  builder.check();
  return builder.build();
}

WallGeometry make_spanned_wall_geometry(const Decomposition& decomposition,
                                        const SideConditions& sides,
                                        const std::vector<Body>& bodies) {
  GeometryBuilder builder(decomposition, sides, bodies, 0.0);
  builder.check();
  return builder.build_spanned();
}

WallGeometry move_wall_geometry(const Decomposition& decomposition, const SideConditions& sides,
                                const std::vector<Body>& bodies, double time) {
  return GeometryBuilder(decomposition, sides, bodies, time).build();
}

// Inside a body as it turns, outside as the surface next to the face does.
void set_wall_velocities(WallGeometry& walls, const Decomposition& decomposition,
                         const std::vector<Body>& bodies, double time) {
  if (!walls.has_bodies) return;
  const Grid& grid = decomposition.grid();
  const Vec3 h = grid.spacing();
  const Index3& first = decomposition.block().lower;
  for (int d = 0; d < 3; ++d) {
    for_each_face(decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = walls.distance[d].index(i, j, k);
      if (walls.nearest_body[d][n] < 0.0) return;
      Vec3 steps(i + first[0] + 0.5, j + first[1] + 0.5, k + first[2] + 0.5);
      steps[d] -= 0.5;
      Vec3 place = grid.lower + steps.cwiseProduct(h);
      const double distance = std::max(walls.distance[d][n], 0.0);
      for (int e = 0; e < 3; ++e) place[e] -= distance * walls.normal[d][e][n];
      const Body& body = bodies[static_cast<std::size_t>(walls.nearest_body[d][n])];
      walls.wall_velocity[d][n] = surface_velocity_at(body, place, time)[d];
    });
  }
  fill_ghosts(decomposition, walls.wall_velocity);
}

}  // namespace gasgrain::cfd
