// Run time of a ratio l' and exponent n', from what was measured at the script's l and n:
//
//   grains(l') = grains (l/l')^3,  contact time Tc(l', n') = Tc (l'^((3-n')/2)) / l^((3-n)/2),
//   time = T (c grains(l') / step(l', n') + g)
//
// T is the simulated time, c the wall time of a grain-step without gas, g that of the gas per
// simulated time, step = Tc over the script's own Tc/step (at least 8). Gas steps are taken not to
// depend on l: they do where the grains' speed limits them. Grains fall freely when c is measured;
// a settled bed costs up to three times as much (docs/engine.md).
#include "liggghts_plugins/estimate_report.hpp"

#include <atom.h>
#include <domain.h>
#include <force.h>
#include <lammps.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/shared/text.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/grain_size_error.hpp"
#include "liggghts_plugins/pair_gran_cgm.hpp"
#include "liggghts_plugins/scene_errors.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::LAMMPS;

constexpr double steps_per_contact = 8;       // the least that is accurate, docs/script_commands.md
constexpr double largest_measured_ratio = 4;  // of tests/bench/coarse_graining
constexpr int ratios_shown = 10;

// The stiffest contact among grains of one type: it limits the step.
struct Stiffest {
  double contact_time = std::numeric_limits<double>::max();  // of the grains, s
  double overlap_per_speed = 0;                              // of a head-on impact, s
  double ratio = 1;                                          // l
  double diameter = 0;                                       // of the grain, m
  bool known() const { return diameter > 0; }
};

struct TypeSize {
  double mass = std::numeric_limits<double>::max();
  double radius = std::numeric_limits<double>::max();
};

std::vector<TypeSize> smallest_of_types(LAMMPS& lmp) {
  const LAMMPS_NS::Atom& atom = *lmp.atom;
  std::vector<TypeSize> sizes(atom.ntypes + 1);
  for (int i = 0; i < atom.nlocal; ++i) {
    TypeSize& size = sizes[atom.type[i]];
    size.mass = std::min(size.mass, atom.rmass[i]);
    size.radius = std::min(size.radius, atom.radius[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, sizes.data(), 2 * static_cast<int>(sizes.size()), MPI_DOUBLE, MPI_MIN,
                lmp.world);
  return sizes;
}

Stiffest stiffest_contact(LAMMPS& lmp) {
  Stiffest found;
  const PairGranCgm* pair = pair_gran_cgm(lmp);
  if (!pair) return found;
  const std::vector<TypeSize> sizes = smallest_of_types(lmp);
  for (int type = 1; type <= lmp.atom->ntypes; ++type) {
    const TypeSize& size = sizes[type];
    if (size.radius == TypeSize().radius) continue;
    const ContactCoefficients c = pair->contacts()(type, type).between(size.mass, size.mass);
    const double rate = c.damping_coefficient / size.mass;  // eta / (2 m_eff), m_eff = m/2
    const double squared = 2.0 * c.spring_constant / size.mass;
    const double time = std::numbers::pi / std::sqrt(squared - rate * rate);
    if (time >= found.contact_time) continue;
    found = {.contact_time = time,
             .overlap_per_speed = 1.0 / std::sqrt(squared),
             .ratio = lmp.force->cg(type),
             .diameter = 2.0 * size.radius};
  }
  return found;
}

// The measured parts of the formula at the head of the file.
struct Costs {
  double simulated = 0;   // T, s
  double grain_step = 0;  // c, s
  double gas = 0;         // of all gas in the script, s of wall time
  double steps = 0;
  double shortest_step = std::numeric_limits<double>::max();  // s
  double longest_step = 0;                                    // s
};

Costs costs_of(const std::vector<MeasuredRun>& runs) {
  Costs costs;
  for (const MeasuredRun& run : runs) {
    costs.simulated += run.steps * run.step;
    costs.steps += run.steps;
    costs.shortest_step = std::min(costs.shortest_step, run.step);
    costs.longest_step = std::max(costs.longest_step, run.step);
    if (!run.with_gas && run.grains > 0) costs.grain_step = run.seconds_per_step / run.grains;
  }
  for (const MeasuredRun& run : runs)
    if (run.with_gas)
      costs.gas += run.steps * std::max(0.0, run.seconds_per_step - costs.grain_step * run.grains);
  return costs;
}

std::string run_time(double seconds) {
  return seconds < 60 ? text("%.3g s", seconds) : duration(seconds);
}

std::string measured_text(const std::vector<MeasuredRun>& runs) {
  std::string lines = "Runs of the script:\n";
  for (const MeasuredRun& run : runs)
    lines += text("  %10.0f steps of %.4g s, %.0f grains%s: %.3g us per step here, %s\n", run.steps,
                  run.step, run.grains, run.with_gas ? " and gas" : "", 1e6 * run.seconds_per_step,
                  run_time(run.steps * run.seconds_per_step).c_str());
  return lines;
}

std::string contact_text(const Stiffest& contact, const Costs& costs) {
  const double steps = contact.contact_time / costs.longest_step;
  std::string lines =
      text("Contact of two grains of %.4g m (l = %g):\n", contact.diameter, contact.ratio);
  lines += text("  contact time       %.4g s; largest step %.4g s, the script's %.4g s is 1/%.3g\n",
                contact.contact_time, contact.contact_time / steps_per_contact, costs.longest_step,
                steps);
  const double share = contact.overlap_per_speed / contact.diameter;
  lines += text("  overlap            %.3g %% of the diameter at 1 m/s; 1 %% at %.3g m/s\n",
                100 * share, 0.01 / share);
  if (steps < steps_per_contact)
    lines += "  WARNING: the step is too long: grains gain energy in contacts\n";
  if (share > 0.1) lines += "  WARNING: soft spring: impacts of 1 m/s overlap by more than 10 %\n";
  return lines;
}

std::string box_text(const LAMMPS& lmp, const Stiffest& contact) {
  const double* sides = lmp.domain->prd;
  const double side = std::min({sides[0], sides[1], sides[2]});
  const double grains = side / contact.diameter;
  std::string lines = text("Shortest side of the box: %.4g m, %.3g grains\n", side, grains);
  if (grains < 8)
    lines += "  WARNING: fewer than 8 grains across: walls order the grains and arches form\n";
  return lines;
}

std::string ratios_text(LAMMPS& lmp, const Stiffest& contact, const Costs& costs,
                        double megabytes) {
  const ContactSettings* settings = pair_settings(lmp);
  const double n = settings->stiffness_exponent.value;
  const double at_original = contact.contact_time / std::pow(contact.ratio, 0.5 * (3.0 - n));
  const double share = std::max(steps_per_contact, contact.contact_time / costs.longest_step);
  const auto grains_now = static_cast<double>(lmp.atom->natoms);
  std::string lines =
      "Other ratios, at the same contact time over step:\n"
      "    l      grains   diameter/m   memory/MB   n = 3: step/s        time   n = 1: step/s"
      "        time\n";
  for (int l = 1; l <= ratios_shown; ++l) {
    const double grains = grains_now * std::pow(contact.ratio / l, 3);
    std::string line = text("%5d%12.0f%13.4g%12.4g", l, grains,
                            contact.diameter / contact.ratio * l, megabytes * grains / grains_now);
    for (const double exponent : {3.0, 1.0}) {
      const double step = at_original * std::pow(l, 0.5 * (3.0 - exponent)) / share;
      const double time = costs.simulated / step * grains * costs.grain_step + costs.gas;
      line += text("%16.4g%12s", step, run_time(time).c_str());
    }
    lines += line + (l > largest_measured_ratio ? "  *\n" : "\n");
  }
  return lines +
         "  * errors of these l were not measured; those up to 4 are in docs/choosing.md\n"
         "  Grains fall freely in this measurement: a settled bed costs up to three times as "
         "much.\n";
}

std::string gas_cell_text(const Stiffest& contact, const GasCells& gas) {
  const double original = contact.diameter / contact.ratio;
  std::string line =
      text("Gas cells of %.4g m over the grain diameter, for l = 1 to 10:", gas.size);
  for (int l = 1; l <= ratios_shown; ++l) line += text(" %.3g", gas.size / (original * l));
  return line + "\n  about 1.25 is the rule of docs/choosing.md; smaller cells cost time\n";
}

std::string gap_text(const Stiffest& contact, double gap) {
  const double original = contact.diameter / contact.ratio;
  std::string lines = text(
      "What grain size changes at a gap of %.4g m, against l = 1 (docs/choosing.md):\n"
      "    l   grains across   rate through a slot /%%   spread of a layer /%%\n",
      gap);
  for (int l = 1; l <= ratios_shown; ++l) {
    const GrainSizeError error = grain_size_error(gap, original, l);
    lines += text("%5d%16.3g%26.0f%23.0f%s\n", l, gap / (original * l), 100 * error.slot_rate,
                  100 * error.layer, error.measured ? "" : "  *");
  }
  return lines + "  * outside of what was measured\n";
}

std::string errors_text(LAMMPS& lmp) {
  const double n = nearest_measured_exponent(pair_settings(lmp)->stiffness_exponent.value);
  std::string lines = text(
      "Measured errors of n = %g against l = 1, root mean square of all quantities /%%:\n"
      "  %-50s%8s%8s%8s%20s\n",
      n, "scene (sizes in originals)", "l = 2", "l = 3", "l = 4", "scatter of l = 1");
  for (const SceneError& row : scene_errors())
    if (row.exponent == n)
      lines += text("  %-50s%8.0f%8.0f%8.0f%20.1f\n", row.scene, 100 * row.at_2, 100 * row.at_3,
                    100 * row.at_4, 100 * row.scatter);
  return lines + "  what errs, and which l to take: docs/choosing.md\n";
}

}  // namespace

std::string estimate_report(LAMMPS& lmp, const std::vector<MeasuredRun>& runs, double bytes,
                            const EstimateContext& context) {
  const Costs costs = costs_of(runs);
  std::string report = measured_text(runs);
  const Stiffest contact = stiffest_contact(lmp);
  if (!contact.known())
    return report + "Contact times are known for grains of pair_style gran model cgm only.\n";
  report += contact_text(contact, costs) + box_text(lmp, contact);
  if (context.gas) report += gas_cell_text(contact, *context.gas);
  if (context.gap > 0) report += gap_text(contact, context.gap);
  report += errors_text(lmp);
  if (costs.grain_step == 0.0)
    return report + "No run without gas: the cost of other ratios l cannot be told apart.\n";
  return report + ratios_text(lmp, contact, costs, bytes / 1e6);
}

}  // namespace gasgrain::plugins
