// A region without an outlet determines its pressure up to a constant, and only when it neither
// gains nor loses gas. The sum of its right-hand side is then round-off of the terms' sum; that is
// checked, the rest removed, and the mean of its pressure set to the reference pressure.
#include <cmath>
#include <limits>
#include <sstream>

#include "cfd/halo_exchange.hpp"
#include "cfd/projection.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double largest_imbalance = 1e-12;  // of a sealed region, relative to its terms
constexpr double largest_swept_imbalance = 0.1;
constexpr double round_off_margin = 8.0;  // in units of the evaluation's own round-off

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
  closed_cells_.clear();
  auto region = regions_.region_of_cell.begin();
  for_each_cell(domain_.size(), [&](int i, int j, int k) {
    if (*region++ == GasRegions::none) closed_cells_.push_back(outlet.index(i, j, k));
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
  clear_round_off();
  return largest;
}

// Gas that flows along itself, in a periodic channel, has no divergence but round-off of its terms,
// and no pressure that would solve it.
void Projection::clear_round_off() {
  Field& rhs = system_.right_hand_side;
  const double left =
      sum_over_ranks(domain_.decomposition,
                     sum_cells(rhs, [b = rhs.data()](std::ptrdiff_t n) { return std::abs(b[n]); }));
  double terms = 0.0;
  for (const double norm : region_norms_) terms += norm;
  if (left <= round_off_margin * std::numeric_limits<double>::epsilon() * terms) rhs.fill(0.0);
}

void Projection::set_pressure_means(Field& pressure, double reference) {
  if (!regions_.any_singular()) return;
  means_of_singular_regions(region_means_, domain_.decomposition, regions_, pressure);
  for (std::size_t r = 0; r < region_means_.size(); ++r) {
    if (!regions_.regions[r].has_outlet) region_means_[r] -= reference;
  }
  subtract_per_region(pressure, regions_, region_means_);
  fill_ghosts(domain_.decomposition, pressure);
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

}  // namespace gasgrain::cfd
