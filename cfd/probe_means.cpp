// Means over the gas in planes and boxes. A cell counts with its open volume 1 - alpha, velocities
// are those of its centre.
//
// In a plane between two layers of cell centres (two planes of faces, for the flux) the values of
// both are interpolated linearly, beyond the last layer they are continued: second order. The flux
// is that of the solver's own face velocities and so the same in every plane of a steady flow
// without sources.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cfd/gas_domain.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "cfd/probe.hpp"

namespace gasgrain::cfd {

namespace {

constexpr std::size_t sums_count = 6;  // open volume, and over it velocity, pressure, void fraction

void add_cell(double* sums, const GasSolver& solver, int i, int j, int k, double volume) {
  const VectorField& u = solver.velocity();
  const std::ptrdiff_t n = u[0].index(i, j, k);
  const double open = volume * (1.0 - solver.walls().wall_fraction[n]);
  sums[0] += open;
  for (int d = 0; d < 3; ++d) sums[1 + d] += open * 0.5 * (u[d][n] + u[d][n + u[d].stride(d)]);
  sums[4] += open * solver.pressure()[n];
  sums[5] += open * solver.void_fraction()[n];
}

double mean(const double* sums, std::size_t of) {
  return sums[0] > 0.0 ? sums[of] / sums[0] : std::numeric_limits<double>::quiet_NaN();
}

const std::vector<std::string> mean_columns{"velocity_x_m_s", "velocity_y_m_s", "velocity_z_m_s",
                                            "pressure_Pa", "void_fraction"};

// Two neighbouring indices and the weight of the upper one.
struct Between {
  int lower, upper;
  double weight;
};

Between between(double position, int last) {
  if (last == 0) return {0, 0, 0.0};
  const int lower = std::clamp(static_cast<int>(std::floor(position)), 0, last - 1);
  return {lower, lower + 1, position - lower};
}

class Plane final : public Probe {
 public:
  Plane(const PlaneProbe& place, const Decomposition& blocks) : d_(place.direction) {
    const Grid& grid = blocks.grid();
    const double cells = (place.position - grid.lower[d_]) / grid.spacing()[d_];
    layers_ = between(cells - 0.5, grid.cells[d_] - 1);
    faces_ = between(cells, grid.cells[d_]);
    thickness_ = grid.spacing()[d_];
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> names{"flux_m3_s", "open_area_m2"};
    names.insert(names.end(), mean_columns.begin(), mean_columns.end());
    return names;
  }

  std::vector<double> sample(const GasSolver& solver) const override {
    std::vector<double> sums(2 * sums_count + 2, 0.0);
    add_layer(&sums[0], solver, layers_.lower);
    add_layer(&sums[sums_count], solver, layers_.upper);
    sums[2 * sums_count] = solver.plane_flux(d_, faces_.lower);
    sums[2 * sums_count + 1] = solver.plane_flux(d_, faces_.upper);
    sum_over_ranks(solver.decomposition(), sums);
    const auto mixed = [](const Between& b, double lower, double upper) {
      return (1.0 - b.weight) * lower + b.weight * upper;
    };
    std::vector<double> row{mixed(faces_, sums[2 * sums_count], sums[2 * sums_count + 1]),
                            mixed(layers_, sums[0] / thickness_, sums[sums_count] / thickness_)};
    for (std::size_t n = 1; n < sums_count; ++n) {
      row.push_back(mixed(layers_, mean(&sums[0], n), mean(&sums[sums_count], n)));
    }
    return row;
  }

 private:
  void add_layer(double* sums, const GasSolver& solver, int layer) const {
    const Block& block = solver.decomposition().block();
    const double volume = solver.decomposition().grid().cell_volume();
    IndexBox box{{0, 0, 0}, block.size};
    const int local = layer - block.lower[d_];
    if (local < 0 || local >= block.size[d_]) return;
    box.begin[d_] = local;
    box.end[d_] = local + 1;
    for_each_in(box, [&](int i, int j, int k) { add_cell(sums, solver, i, j, k, volume); });
  }

  int d_;
  double thickness_;  // m, of a layer
  Between layers_{}, faces_{};
};

class Box final : public Probe {
 public:
  Box(const BoxProbe& place, const Decomposition& blocks) {
    const Grid& grid = blocks.grid();
    const Block& block = blocks.block();
    const Vec3 h = grid.spacing();
    for (int d = 0; d < 3; ++d) {
      for (int n = 0; n < block.size[d]; ++n) {
        const double lower = grid.lower[d] + (n + block.lower[d]) * h[d];
        const double length =
            std::min(place.upper[d], lower + h[d]) - std::max(place.lower[d], lower);
        length_[d].push_back(std::max(length, 0.0));
      }
    }
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> names{"open_volume_m3"};
    names.insert(names.end(), mean_columns.begin(), mean_columns.end());
    return names;
  }

  std::vector<double> sample(const GasSolver& solver) const override {
    std::vector<double> sums(sums_count, 0.0);
    for_each_cell(solver.decomposition().block().size, [&](int i, int j, int k) {
      const double volume = length_[0][i] * length_[1][j] * length_[2][k];
      if (volume > 0.0) add_cell(sums.data(), solver, i, j, k, volume);
    });
    sum_over_ranks(solver.decomposition(), sums);
    std::vector<double> row{sums[0]};
    for (std::size_t n = 1; n < sums_count; ++n) row.push_back(mean(sums.data(), n));
    return row;
  }

 private:
  std::array<std::vector<double>, 3> length_;  // of the box in each layer of this block's cells, m
};

class OfBody final : public Probe {
 public:
  explicit OfBody(std::size_t index) : index_(index) {}

  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    for (const char* what :
         {"pressure_force", "friction_force", "pressure_torque", "friction_torque"}) {
      const std::string unit = std::string(what).ends_with("force") ? "_N" : "_N_m";
      for (const char d : {'x', 'y', 'z'}) names.push_back(std::string(what) + "_" + d + unit);
    }
    return names;
  }

  std::vector<double> sample(const GasSolver& solver) const override {
    const BodyLoad& load = solver.body_loads()[index_];
    std::vector<double> row;
    for (const Vec3& v :
         {load.pressure, load.friction, load.pressure_torque, load.friction_torque}) {
      row.insert(row.end(), {v[0], v[1], v[2]});
    }
    return row;
  }

 private:
  std::size_t index_;
};

}  // namespace

std::unique_ptr<Probe> make_plane_probe(const PlaneProbe& place, const Decomposition& blocks) {
  return std::make_unique<Plane>(place, blocks);
}

std::unique_ptr<Probe> make_box_probe(const BoxProbe& place, const Decomposition& blocks) {
  return std::make_unique<Box>(place, blocks);
}

std::unique_ptr<Probe> make_body_probe(const BodyProbe& place) {
  return std::make_unique<OfBody>(place.index);
}

}  // namespace gasgrain::cfd
