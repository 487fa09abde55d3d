// Values at points by trilinear interpolation, second order in the spacing: of each velocity
// component between the faces that carry it, of pressure and void fraction between cell centres.
// Over the last half cell before a side of the grid the pressure goes on linearly, the void
// fraction with its last value, the velocity as the side's condition says.
//
// The faces inside bodies hold the wall's velocity, so that the velocity near a body is
// interpolated towards it. Pressure and void fraction have no meaning in cells without gas: where
// one of the eight cells is such, the value of the point's own cell is taken (first order). A point
// in a cell without gas gives NaN.
#include <array>
#include <cmath>
#include <limits>

#include "cfd/probe.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int values_per_point = 5;  // velocity, pressure, void fraction

// The two neighbours along one direction, as local indices, and the weight of the upper one.
struct Pair {
  int lower, upper;
  double weight;
};

// `position` in cells from the lower side of the grid, of values at integers + `offset`.
Pair pair_of(double position, double offset, int first, int last, int block_lower) {
  if (first == last) return {first - block_lower, first - block_lower, 0.0};
  int lower = static_cast<int>(std::floor(position - offset));
  lower = std::min(std::max(lower, first), last - 1);
  return {lower - block_lower, lower + 1 - block_lower, position - offset - lower};
}

template <class Visit>
void for_each_corner(const std::array<Pair, 3>& pairs, Visit&& visit) {
  for (int corner = 0; corner < 8; ++corner) {
    Index3 at{};
    double weight = 1.0;
    for (int d = 0; d < 3; ++d) {
      const bool upper = (corner >> d & 1) != 0;
      at[d] = upper ? pairs[d].upper : pairs[d].lower;
      weight *= upper ? pairs[d].weight : 1.0 - pairs[d].weight;
    }
    if (weight != 0.0) visit(at, weight);
  }
}

double interpolated(const Field& field, const std::array<Pair, 3>& pairs) {
  double sum = 0.0;
  for_each_corner(
      pairs, [&](const Index3& at, double weight) { sum += weight * field(at[0], at[1], at[2]); });
  return sum;
}

bool all_open(const Field& wall_fraction, const std::array<Pair, 3>& pairs) {
  bool open = true;
  for_each_corner(pairs, [&](const Index3& at, double) {
    open = open && wall_fraction(at[0], at[1], at[2]) < 1.0;
  });
  return open;
}

// A sample's position in cells, and who computes it.
struct Sample {
  Vec3 x = Vec3::Zero();  // m
  Vec3 cells = Vec3::Zero();
  Index3 cell{};  // the one that holds it, global
  bool mine = false;
};

Sample sample_at(const Vec3& x, const Decomposition& blocks) {
  const Grid& grid = blocks.grid();
  Sample sample;
  sample.x = x;
  sample.cells = (x - grid.lower).cwiseQuotient(grid.spacing());
  for (int d = 0; d < 3; ++d) {
    const int cell = static_cast<int>(std::floor(sample.cells[d]));
    sample.cell[d] = std::min(std::max(cell, 0), grid.cells[d] - 1);
  }
  sample.mine = blocks.owner(sample.cell) == blocks.rank();
  return sample;
}

void measure(double* values, const Sample& sample, const GasSolver& solver) {
  const Decomposition& blocks = solver.decomposition();
  const Index3& n = blocks.grid().cells;
  const Index3& lower = blocks.block().lower;
  const Field& wall = solver.walls().wall_fraction;
  const Index3 own{sample.cell[0] - lower[0], sample.cell[1] - lower[1], sample.cell[2] - lower[2]};
  if (wall(own[0], own[1], own[2]) == 1.0) {
    std::fill_n(values, values_per_point, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  // Beyond the sides of the grid velocity and void fraction have ghosts, the pressure has none.
  enum Kind { component_x, component_y, component_z, with_ghosts, without_ghosts };
  const auto pairs = [&](int kind) {
    std::array<Pair, 3> result{};
    for (int d = 0; d < 3; ++d) {
      if (d == kind) {
        result[d] = pair_of(sample.cells[d], 0.0, 0, n[d], lower[d]);
      } else {
        const int ghost = kind != without_ghosts || blocks.periodic()[d] ? 1 : 0;
        result[d] = pair_of(sample.cells[d], 0.5, -ghost, n[d] - 1 + ghost, lower[d]);
      }
    }
    return result;
  };
  for (int d = 0; d < 3; ++d) values[d] = interpolated(solver.velocity()[d], pairs(d));
  const bool open = all_open(wall, pairs(without_ghosts));
  const auto cell_value = [&](const Field& field, Kind kind) {
    return open ? interpolated(field, pairs(kind)) : field(own[0], own[1], own[2]);
  };
  values[3] = cell_value(solver.pressure(), without_ghosts);
  values[4] = cell_value(solver.void_fraction(), with_ghosts);
}

// The values of each sample from the rank that has it, on rank 0: adding zeros changes no bit.
void gather(std::vector<double>& values, const Decomposition& blocks) {
  const int count = static_cast<int>(values.size());
  if (blocks.rank() == 0) {
    MPI_Reduce(MPI_IN_PLACE, values.data(), count, MPI_DOUBLE, MPI_SUM, 0, blocks.communicator());
  } else {
    MPI_Reduce(values.data(), nullptr, count, MPI_DOUBLE, MPI_SUM, 0, blocks.communicator());
  }
}

const std::vector<std::string> value_columns{"velocity_x_m_s", "velocity_y_m_s", "velocity_z_m_s",
                                             "pressure_Pa", "void_fraction"};

class Points final : public Probe {
 public:
  // With more than one point, rows tell where they are: distance from the first, position.
  Points(const std::vector<Vec3>& points, const Decomposition& blocks) {
    for (const Vec3& x : points) samples_.push_back(sample_at(x, blocks));
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    if (samples_.size() > 1) names = {"distance_m", "x_m", "y_m", "z_m"};
    names.insert(names.end(), value_columns.begin(), value_columns.end());
    return names;
  }

  std::vector<double> sample(const GasSolver& solver) const override {
    std::vector<double> values(samples_.size() * values_per_point, 0.0);
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      if (samples_[n].mine) measure(&values[n * values_per_point], samples_[n], solver);
    }
    gather(values, solver.decomposition());
    if (samples_.size() == 1) return values;
    std::vector<double> rows;
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      const Vec3& x = samples_[n].x;
      rows.insert(rows.end(), {(x - samples_[0].x).norm(), x[0], x[1], x[2]});
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(n * values_per_point);
      rows.insert(rows.end(), from, from + values_per_point);
    }
    return rows;
  }

 private:
  std::vector<Sample> samples_;
};

}  // namespace

std::unique_ptr<Probe> make_point_probe(const PointProbe& place, const Decomposition& blocks) {
  return std::make_unique<Points>(std::vector{place.point}, blocks);
}

std::unique_ptr<Probe> make_line_probe(const LineProbe& place, const Decomposition& blocks) {
  std::vector<Vec3> points;
  for (int n = 0; n < place.samples; ++n) {
    const double share = double(n) / (place.samples - 1);
    points.push_back((1.0 - share) * place.from + share * place.to);
  }
  return std::make_unique<Points>(points, blocks);
}

}  // namespace gasgrain::cfd
