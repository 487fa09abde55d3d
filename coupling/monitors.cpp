// The flux through a plane is what a counter of crossings has as its mean: a grain that goes from
// one side to the other adds its mass once, over the exchanges in which it is within a diameter of
// the plane. With W the integral of the hat function of half width d, a path from z0 to z1 adds
// m (W(z1) - W(z0)); paths that join add up to the mass exactly.
// Mixing: Danckwerts (1952), Appl. Sci. Res. A 3, 279.
#include "coupling/monitors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "coupling/bubbles.hpp"

namespace gasgrain::coupling {

namespace {

// Integral of the hat function of half width 1 from -infinity to x.
double hat_integral(double x) {
  const double y = std::clamp(x, -1.0, 1.0);
  return y < 0 ? 0.5 * (1 + y) * (1 + y) : 1.0 - 0.5 * (1 - y) * (1 - y);
}

}  // namespace

double mass_through(const FluxPlane& plane, const GrainRecord& grain, double interval) {
  const int d = plane.direction;
  const double width = grain_diameter(grain);
  const double now = (grain.position[d] - plane.position) / width;
  const double before = now - grain.velocity[d] * interval / width;
  return grain.mass * (hat_integral(now) - hat_integral(before));
}

double mixing_index(GasCoupling& coupling, std::span<const double> labels) {
  const std::vector<GrainRecord>& grains = coupling.transfer().received();
  Deposition& deposition = coupling.deposition();
  const cfd::Decomposition& decomposition = coupling.gas().decomposition();
  std::vector<std::array<double, 2>> volumes(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n)
    volumes[n] = {grains[n].volume, labels[n] * grains[n].volume};
  cfd::Field all(decomposition.block().size), labelled(decomposition.block().size);
  deposition.deposit<2>({&all, &labelled}, volumes);
  double sums[3] = {};  // of V, c V and c^2 V
  cfd::for_each_cell(all.size(), [&](int i, int j, int k) {
    if (all(i, j, k) <= 0) return;
    const double volume = deposition.open_fraction()(i, j, k) * all(i, j, k);
    const double share = labelled(i, j, k) / all(i, j, k);
    sums[0] += volume;
    sums[1] += share * volume;
    sums[2] += share * share * volume;
  });
  cfd::sum_over_ranks(decomposition, sums);
  const double share = sums[1] / sums[0];
  const double apart = share * (1.0 - share);
  if (!(apart > 0)) return std::numeric_limits<double>::quiet_NaN();
  return 1.0 - (sums[2] / sums[0] - share * share) / apart;
}

std::vector<std::string> Monitors::names() const {
  std::vector<std::string> result{"bed_height_void_0.7", "bed_height_void_0.9",
                                  "bed_height_solid_99", "bed_height_twice_centre"};
  if (options_.bubble_void_fraction > 0)
    result.insert(result.end(), {"bubble_count", "bubble_fraction"});
  if (wants_labels()) result.emplace_back("mixing_index");
  for (const FluxPlane& plane : options_.planes) {
    result.push_back("flux_up_" + plane.name);
    result.push_back("flux_down_" + plane.name);
  }
  return result;
}

void Monitors::note_exchange(const GasCoupling& coupling, double interval) {
  duration_ += interval;
  for (std::size_t p = 0; p < fluxes_.size(); ++p) {
    for (const GrainRecord& grain : coupling.transfer().received()) {
      const double mass = mass_through(options_.planes[p], grain, interval);
      (mass > 0 ? fluxes_[p].up : fluxes_[p].down) += std::abs(mass);
    }
  }
}

std::vector<double> Monitors::take(GasCoupling& coupling, const BedMonitor& bed,
                                   std::span<const double> labels) {
  const BedLayers& layers = bed.layers();
  std::vector<double> values{level_of_void_fraction(layers, 0.7),
                             level_of_void_fraction(layers, 0.9),
                             level_of_solid_share(layers, 0.99), 2.0 * centre_of_solid(layers)};
  if (options_.bubble_void_fraction > 0) {
    const double surface = bed.height();
    const Bubbles bubbles = find_bubbles(
        coupling.gas(), {coupling.deposition().open_fraction(), coupling.void_fraction()},
        bed.vertical(), {options_.bubble_void_fraction, surface});
    const double volume = open_volume_below(layers, surface);
    values.push_back(bubbles.count);
    values.push_back(volume > 0 ? bubbles.volume / volume : 0.0);
  }
  if (wants_labels())
    values.push_back(mixing_index(coupling, coupling.transfer().send_along(labels)));
  std::vector<double> masses;
  for (const Flux& flux : fluxes_) masses.insert(masses.end(), {flux.up, flux.down});
  cfd::sum_over_ranks(coupling.gas().decomposition(), masses);
  for (const double mass : masses) values.push_back(duration_ > 0 ? mass / duration_ : 0.0);
  fluxes_.assign(fluxes_.size(), {});
  duration_ = 0.0;
  return values;
}

void Monitors::visit_state(cfd::StateArchive& archive) {
  archive.number("monitored_duration", duration_);
  for (std::size_t p = 0; p < fluxes_.size(); ++p) {
    const std::string name = "flux_" + std::to_string(p);
    archive.partial_sums(name + "_up", {&fluxes_[p].up, 1});
    archive.partial_sums(name + "_down", {&fluxes_[p].down, 1});
  }
}

}  // namespace gasgrain::coupling
