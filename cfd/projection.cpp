// The pressure equation, integrated over the cells,
//
//   sum over faces of a c A/h (p - p_neighbour) = -(1 - alpha) V (eps_new - eps_old)/dt
//                                                 + swept - sum of a eps u* A outwards,
//   c = eps dt / (rho (1 + K)),     K = dt B / (eps rho),
//
// swept: what moving bodies leave to the cell (moving_walls.cpp),
// with a half cell between the last cell and an outlet. Drag is part of c as well as of u*: with
// drag in u* alone the pressure drop of a bed would be short by 1/(1 + K).
//
// A region without an outlet determines its pressure up to a constant, and only when it neither
// gains nor loses gas. The sum of its right-hand side is then round-off of the terms' sum; that is
// checked, the rest removed, and the mean of its pressure set to zero.
#include "cfd/projection.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "cfd/halo_exchange.hpp"
#include "cfd/solve_failure.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double largest_imbalance = 1e-12;  // of a sealed region, relative to its terms
constexpr double largest_swept_imbalance = 0.1;
constexpr double round_off_margin = 8.0;  // in units of the evaluation's own round-off

// 1 / (rho (1 + K)) * dt = dt / (rho + dt B / eps), the velocity that a unit gradient removes.
double mobility(const FaceMedium& medium, double density, double dt, int d, std::ptrdiff_t n) {
  if (!medium.has_grains) return dt / density;
  return dt / (density + dt * medium.momentum_exchange[d][n] / medium.void_fraction[d][n]);
}

std::string place(const GasDomain& domain, const Index3& cell) {
  const Grid& grid = domain.decomposition.grid();
  std::ostringstream out;
  out << "(";
  for (int d = 0; d < 3; ++d) {
    out << grid.lower[d] + (cell[d] + 0.5) * domain.spacing[d] << (d < 2 ? ", " : ") m");
  }
  return out.str();
}

}  // namespace

Projection::Projection(const GasDomain& domain, const Numerics& numerics)
    : domain_(domain),
      tolerance_(numerics.pressure_tolerance),
      max_iterations_(numerics.pressure_iterations),
      solver_(make_pressure_solver(domain.decomposition, numerics.pressure_solver,
                                   numerics.pressure_fallback)),
      term_norm_(domain.size()),
      outlet_term_(domain.size()) {
  system_.diagonal = system_.right_hand_side = Field(domain.size());
  for (int d = 0; d < 3; ++d) gradient_[d] = system_.transmissibility[d] = Field(domain.size());
  find_regions();
  system_.regions = &regions_;
}

void Projection::find_regions() {
  Field outlet(domain_.size());
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      for_each_outlet_face(domain_, d, side, [&](auto cell, auto face, const SideCondition&) {
        outlet[cell] += domain_.walls.takes_part[d][face];
      });
    }
  }
  regions_ = find_gas_regions(domain_.decomposition, domain_.walls.takes_part, outlet);
}

void Projection::set_coefficients(const FaceMedium& medium, double dt) {
  system_.diagonal.fill(0.0);
  outlet_term_.fill(0.0);
  for (int d = 0; d < 3; ++d) {
    Field& t = system_.transmissibility[d];
    const Field& part = domain_.walls.takes_part[d];
    const Field& open = domain_.walls.open_area[d];
    const double scale = domain_.face_area(d) / domain_.spacing[d];
    const bool joins_itself = domain_.decomposition.grid().cells[d] == 1;
    for_each_in(inner_faces(domain_, d), [&](int i, int j, int k) {
      const std::ptrdiff_t n = t.index(i, j, k);
      t[n] = 0.0;
      if (part[n] == 0.0 || joins_itself) return;
      t[n] = scale * open[n] * face_void_fraction(medium, d, n) *
             mobility(medium, domain_.gas.density, dt, d, n);
    });
    for (int side = 0; side < 2; ++side) {
      for_each_outlet_face(
          domain_, d, side, [&](auto cell, auto face, const SideCondition& condition) {
            if (part[face] == 0.0) return;
            const double coefficient = 2.0 * scale * open[face] *
                                       face_void_fraction(medium, d, face) *
                                       mobility(medium, domain_.gas.density, dt, d, face);
            system_.diagonal[cell] += coefficient;
            outlet_term_[cell] += coefficient * condition.pressure;
          });
    }
  }
  fill_ghosts(domain_.decomposition, system_.transmissibility);
}

void Projection::set_right_hand_side(const FaceMedium& medium, const Field& old_void_fraction,
                                     const VectorField& velocity, double dt) {
  Field& rhs = system_.right_hand_side;
  std::size_t m = 0;
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = rhs.index(i, j, k);
    rhs[n] = term_norm_[n] = 0.0;
    if (regions_.region_of_cell[m++] == GasRegions::none) return;
    const double growth = (medium.cell_void_fraction[n] - old_void_fraction[n]) / dt;
    rhs[n] = -domain_.open_share[n] * domain_.cell_volume() * growth;
    term_norm_[n] = std::abs(rhs[n]);
    if (domain_.has_motion) {
      rhs[n] += swept_[n];
      term_norm_[n] += std::abs(swept_[n]);
    }
    for (int d = 0; d < 3; ++d) {
      const Field& open = domain_.walls.open_area[d];
      const auto flux = [&](std::ptrdiff_t face) {
        return open[face] * face_void_fraction(medium, d, face) * velocity[d][face] *
               domain_.face_area(d);
      };
      const double in = flux(n), out = flux(n + open.stride(d));
      rhs[n] += in - out;
      term_norm_[n] += std::abs(in) + std::abs(out);
    }
  });
}

void Projection::add_outlets() {
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    system_.right_hand_side(i, j, k) += outlet_term_(i, j, k);
  });
}

double Projection::remove_means(double dt) {
  if (!regions_.any_singular()) return 0.0;
  const Decomposition& blocks = domain_.decomposition;
  std::vector<double>&sums = region_sums_, &norms = region_norms_, &open = region_volumes_;
  sum_per_region(sums, blocks, regions_, system_.right_hand_side);
  sum_per_region(norms, blocks, regions_, term_norm_);
  // the change of the void fractions is a difference of numbers close to one
  sum_per_region(open, blocks, regions_, domain_.open_share);
  const double void_round_off =
      round_off_margin * std::numeric_limits<double>::epsilon() * domain_.cell_volume() / dt;
  std::vector<double>& mean = region_means_;
  mean.assign(sums.size(), 0.0);
  double largest = 0.0;
  for (std::size_t r = 0; r < sums.size(); ++r) {
    if (regions_.regions[r].has_outlet || norms[r] == 0.0) continue;
    const double imbalance = std::abs(sums[r]) / norms[r];
    if (imbalance > largest_imbalance && std::abs(sums[r]) > open[r] * void_round_off) {
      std::ostringstream message;
      message << "the gas around " << place(domain_, regions_.regions[r].first_cell)
              << " has no outlet but would have to " << (sums[r] > 0 ? "lose " : "gain ")
              << std::abs(sums[r]) << " m^3/s (" << imbalance << " of what moves in it, allowed is "
              << largest_imbalance
              << "); give it an outlet, or check its inlets, the bodies that seal it and those "
                 "that move "
                 "into it";
      throw UserError(message.str());
    }
    largest = std::max(largest, imbalance);
    mean[r] = sums[r] / regions_.regions[r].cells;
  }
  subtract_per_region(system_.right_hand_side, regions_, mean);
  return largest;
}

void Projection::remove_pressure_means(Field& pressure) {
  if (!regions_.any_singular()) return;
  means_of_singular_regions(region_means_, domain_.decomposition, regions_, pressure);
  subtract_per_region(pressure, regions_, region_means_);
  fill_ghosts(domain_.decomposition, pressure);
}

void Projection::check(const PressureReport& report) const {
  if (report.converged) return;
  std::ostringstream message;
  message << "the pressure equation is not solved: residual " << report.residual << " after "
          << report.iterations << " iterations, numerics.pressure_tolerance is " << tolerance_
          << (report.fallbacks > 0 ? ", the fallback's included" : "")
          << "; raise numerics.pressure_iterations (now " << max_iterations_
          << "), take a smaller step or allow a larger residual";
  throw SolveFailure(message.str());
}

void Projection::set_gradient(const Field& pressure) {
  for (int d = 0; d < 3; ++d) {
    Field& gradient = gradient_[d];
    const Field& part = domain_.walls.takes_part[d];
    const double scale = 1.0 / domain_.spacing[d];
    for_each_in(inner_faces(domain_, d), [&](int i, int j, int k) {
      const std::ptrdiff_t n = pressure.index(i, j, k);
      gradient[n] = part[n] * scale * (pressure[n] - pressure[n - pressure.stride(d)]);
    });
    for (int side = 0; side < 2; ++side) {
      const double outwards = side == 0 ? -1.0 : 1.0;
      for_each_outlet_face(domain_, d, side,
                           [&](auto cell, auto face, const SideCondition& condition) {
                             const double rise = outwards * (condition.pressure - pressure[cell]);
                             gradient[face] = part[face] * 2.0 * scale * rise;
                           });
    }
  }
  fill_ghosts(domain_.decomposition, gradient_);
}

// A region without outlet gets what the bodies leave to it minus what they take in equal measure
// back from the cells they sweep, when it is no more than an error of their discrete shape.
double Projection::balance_swept_volume() {
  if (!domain_.has_motion) return 0.0;
  swept_ = domain_.swept;
  Field moved(domain_.size());
  if (!regions_.any_singular()) return 0.0;
  for_each_cell(domain_.size(),
                [&](int i, int j, int k) { moved(i, j, k) = std::abs(swept_(i, j, k)); });
  std::vector<double> net, sum;
  sum_per_region(net, domain_.decomposition, regions_, swept_);
  sum_per_region(sum, domain_.decomposition, regions_, moved);
  std::vector<double> share(net.size(), 0.0);
  double largest = 0.0;
  for (std::size_t r = 0; r < net.size(); ++r) {
    if (regions_.regions[r].has_outlet || sum[r] == 0.0) continue;
    const double imbalance = std::abs(net[r]) / sum[r];
    if (imbalance > largest_swept_imbalance) continue;  // remove_means() will complain
    share[r] = net[r] / sum[r];
    largest = std::max(largest, imbalance);
  }
  std::size_t m = 0;
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    const int region = regions_.region_of_cell[m++];
    if (region != GasRegions::none) swept_(i, j, k) -= share[region] * moved(i, j, k);
  });
  return largest;
}

Projection::Report Projection::solve(const FaceMedium& medium, const Field& old_void_fraction,
                                     const VectorField& velocity, double dt, Field& pressure) {
  Report report;
  set_coefficients(medium, dt);
  report.swept_imbalance = balance_swept_volume();
  set_right_hand_side(medium, old_void_fraction, velocity, dt);
  report.removed_mean = remove_means(dt);
  add_outlets();
  report.solve = solver_->solve(system_, tolerance_, max_iterations_, pressure);
  check(report.solve);
  remove_pressure_means(pressure);
  set_gradient(pressure);
  return report;
}

void Projection::correct(VectorField& velocity, const FaceMedium& medium, double dt) const {
  for (int d = 0; d < 3; ++d) {
    if (!domain_.solved[d]) continue;
    for_each_face(domain_.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = velocity[d].index(i, j, k);
      velocity[d][n] -= mobility(medium, domain_.gas.density, dt, d, n) * gradient_[d][n];
    });
  }
}

double Projection::divergence(const FaceMedium& medium, const Field& old_void_fraction,
                              const VectorField& velocity, double dt) const {
  double largest = 0.0;
  std::size_t m = 0;
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    if (regions_.region_of_cell[m++] == GasRegions::none) return;
    const std::ptrdiff_t n = old_void_fraction.index(i, j, k);
    const double open = domain_.open_share[n], eps = medium.cell_void_fraction[n];
    double change = open * (eps - old_void_fraction[n]);
    if (domain_.has_motion) change -= dt * swept_[n] / domain_.cell_volume();
    for (int d = 0; d < 3; ++d) {
      const Field& area = domain_.walls.open_area[d];
      const auto flux = [&](std::ptrdiff_t face) {
        return area[face] * face_void_fraction(medium, d, face) * velocity[d][face];
      };
      change += dt / domain_.spacing[d] * (flux(n + area.stride(d)) - flux(n));
    }
    largest = std::max(largest, std::abs(change) / (open * eps));
  });
  return max_over_ranks(domain_.decomposition, largest);
}

}  // namespace gasgrain::cfd
