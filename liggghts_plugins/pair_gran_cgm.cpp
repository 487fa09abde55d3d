#include "liggghts_plugins/pair_gran_cgm.hpp"

#include <atom.h>
#include <comm.h>
#include <fix_contact_property_atom.h>
#include <force.h>
#include <modify.h>
#include <mpi.h>
#include <neigh_list.h>
#include <pair_gran.h>
#include <update.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/contact_model_cgm.hpp"
#include "liggghts_plugins/contact_report.hpp"
#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/pair_grains.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::PairGran;
using LIGGGHTS::ContactModels::CONTACT_NORMAL_MODEL;
using LIGGGHTS::ContactModels::CONTACT_TANGENTIAL_MODEL;

constexpr const char* where = "pair_style gran model cgm";
constexpr int contact_bits = CONTACT_NORMAL_MODEL | CONTACT_TANGENTIAL_MODEL;

std::map<const LAMMPS_NS::LAMMPS*, PairGranCgm*>& pair_styles() {
  static std::map<const LAMMPS_NS::LAMMPS*, PairGranCgm*> styles;
  return styles;
}

}  // namespace

PairGranCgm::PairGranCgm(LAMMPS_NS::LAMMPS* liggghts, PairGran* parent, int64_t variant)
    : Pointers(liggghts), parent_(parent), variant_(variant) {
  settings_.tangential = tangential_model_of(variant);
  if (settings_.tangential == TangentialModel::history) {
    history_offset_ = parent->add_history_value("shearx", "1");
    parent->add_history_value("sheary", "1");
    parent->add_history_value("shearz", "1");
  }
  set_pair_settings(*lmp, &settings_);
  pair_styles()[lmp] = this;
}

PairGranCgm::~PairGranCgm() {
  if (pair_settings(*lmp) == &settings_) set_pair_settings(*lmp, nullptr);
  if (pair_gran_cgm(*lmp) == this) pair_styles().erase(lmp);
}

int touching_flags() {
  return contact_bits;
}

PairGranCgm* pair_gran_cgm(const LAMMPS_NS::LAMMPS& lmp) {
  const auto found = pair_styles().find(&lmp);
  return found == pair_styles().end() ? nullptr : found->second;
}

void PairGranCgm::settings(int argument_count, char** arguments, LIGGGHTS::IContactHistorySetup*) {
  read_contact_settings(settings_, {argument_count, arguments}, where);
}

void PairGranCgm::init_granular() {
  if (!atom->sphere_flag || !atom->rmass || atom->superquadric_flag || atom->shapetype_flag)
    throw UserError(std::string(where) + ": needs spheres with their own mass (atom_style sphere)");
  if (parent_->storeSumDelta())
    throw UserError(std::string(where) +
                    ": multi-contact models are not supported; remove the one of the script");
  if (modify->n_fixes_style("insert/stream/predefined") > 0)
    throw UserError(std::string(where) +
                    ": fix insert/stream/predefined, which inserts contact histories of stock "
                    "models, is not supported; use fix insert/stream or insert/pack");
  contacts_ = GrainContactTable(*lmp, settings_, where);
}

void PairGranCgm::write_restart_settings(FILE* file) {
  fwrite(&variant_, sizeof(variant_), 1, file);
  fwrite(&settings_.stiffness_exponent.value, sizeof(double), 1, file);
}

void PairGranCgm::read_restart_settings(FILE* file, int64_t) {
  int complete = 1;
  if (comm->me == 0) {
    int64_t stored = -1;
    complete = fread(&stored, sizeof(stored), 1, file) == 1 && stored == variant_ &&
               fread(&settings_.stiffness_exponent.value, sizeof(double), 1, file) == 1;
  }
  MPI_Bcast(&complete, 1, MPI_INT, 0, world);
  if (!complete)
    throw UserError(std::string(where) +
                    ": the restart file holds another pair style or tangential model; state in the "
                    "script the ones of the run that wrote it");
  MPI_Bcast(&settings_.stiffness_exponent.value, 1, MPI_DOUBLE, 0, world);
}

int PairGranCgm::get_history_offset(const std::string) {
  return -1;
}

bool PairGranCgm::contact_match(const std::string kind, const std::string model) {
  return variant_contains(variant_, kind, model);
}

void PairGranCgm::compute_force(PairGran* pair, int eflag, int vflag, int addflag) {
  if (eflag || vflag)
    pair->ev_setup(eflag, vflag);
  else
    pair->evflag = pair->vflag_fdotr = 0;

  const bool store_forces =
      pair->storeContactForces() && update->ntimestep % pair->storeContactForcesEvery() == 0;
  const bool list_contacts = pair->cpl() && addflag;
  const bool report = pair->evflag || store_forces || pair->storeContactForcesStress() ||
                      list_contacts || pair->store_sum_normal_force();
  if (report)
    loop_of_tangential_model(*pair,
                             ContactReport(*pair, *atom, *force, store_forces, list_contacts));
  else
    loop_of_tangential_model(*pair, NoReport());

  if (list_contacts) pair->cpl_pair_finalize();
  if (pair->storeContactForces()) pair->fix_contact_forces()->do_forward_comm();
  if (pair->storeContactForcesStress()) pair->fix_contact_forces_stress()->do_forward_comm();
}

template <class Report>
void PairGranCgm::loop_of_tangential_model(PairGran& pair, Report report) {
  if (pair.list->inum == 0) return;
  with_tangential_model(settings_.tangential,
                        [&]<TangentialModel model>() { loop<model>(pair, report); });
}

double PairGranCgm::spring_energy() const {
  const Grains g(*atom);
  const LAMMPS_NS::NeighList& list = *parent_->list;
  double energy = 0.0;
  for (int ii = 0; ii < list.inum; ++ii) {
    const int i = list.ilist[ii];
    for (int jj = 0; jj < list.numneigh[i]; ++jj) {
      const int j = list.firstneigh[i][jj] & NEIGHMASK;
      const double overlap = g.radius[i] + g.radius[j] - (column(g.x, i) - column(g.x, j)).norm();
      if (overlap <= 0) continue;
      const GrainContact& contact = contacts_(g.type[i], g.type[j]);
      const PairMasses masses = pair_masses(*parent_, g, i, j);
      const ContactCoefficients c = coefficients(contact, masses);
      const double share = force->newton_pair || j < g.local_count ? 1.0 : 0.5;
      energy += share * 0.5 * c.spring_constant * overlap * overlap;
      if (contact.has_surface_forces())
        energy -= share * pair_surface(contact, masses, g, i, j).forces.adhesion * overlap;
    }
  }
  return energy;
}

template <TangentialModel tangential, class Report>
void PairGranCgm::loop(PairGran& pair, Report report) {
  constexpr bool with_history = tangential == TangentialModel::history;
  const Grains g(*atom);
  const LAMMPS_NS::NeighList& list = *pair.list;
  const int history_length = pair.dnum();
  const bool apply = pair.computeflag();
  const bool both_sides = force->newton_pair;
  const TangentialStep step{apply && pair.shearupdate() ? History::advance : History::keep,
                            update->dt};
  LargestOverlap largest;

  for (int ii = 0; ii < list.inum; ++ii) {
    const int i = list.ilist[ii];
    const Vec3 x_i = column(g.x, i), v_i = column(g.v, i), omega_i = column(g.omega, i);
    const double r_i = g.radius[i];
    const int* neighbours = list.firstneigh[i];
    int* touching = with_history ? pair.listgranhistory->firstneigh[i] : nullptr;
    double* histories = with_history ? pair.listgranhistory->firstdouble[i] : nullptr;
    Vec3 f_i = Vec3::Zero(), torque_i = Vec3::Zero();

    for (int jj = 0; jj < list.numneigh[i]; ++jj) {
      const int j = neighbours[jj] & NEIGHMASK;
      const Vec3 delta = x_i - column(g.x, j);
      const double rsq = delta.squaredNorm();
      const double r_sum = r_i + g.radius[j];
      double* history = with_history ? histories + history_length * jj : nullptr;
      if (rsq >= r_sum * r_sum) {
        if (with_history && touching[jj]) {
          touching[jj] &= ~contact_bits;
          Column(history + history_offset_).setZero();
        }
        continue;
      }
      const double r = std::sqrt(rsq);
      const double overlap = r_sum - r;
      if (overlap > largest.length) largest.length = overlap;
      if (overlap > largest.relative * r_sum) largest.relative = overlap / r_sum;

      const double lever_i = r_i - 0.5 * overlap;
      const double lever_j = g.radius[j] - 0.5 * overlap;
      const ContactState state{.n = delta / r,
                               .overlap = overlap,
                               .relative_velocity = v_i - column(g.v, j),
                               .lever_spin = lever_i * omega_i + lever_j * column(g.omega, j)};
      const GrainContact& contact = contacts_(g.type[i], g.type[j]);
      const PairMasses masses = pair_masses(pair, g, i, j);
      const ContactCoefficients c = coefficients(contact, masses);

      Vec3 displacement = Vec3::Zero();
      if (with_history) {
        touching[jj] |= contact_bits;
        displacement = Column(history + history_offset_);
      }
      ContactForce f = contact_force<tangential>(c, state, displacement, step);
      Vec3 rolling = Vec3::Zero();  // torque on i
      if (contact.has_surface_forces()) {
        const PairSurface surface = pair_surface(contact, masses, g, i, j);
        rolling = add_surface_forces(surface.forces, state.n, surface.rolling, step.duration, f);
      }
      if (with_history && step.history == History::advance)
        Column(history + history_offset_) = displacement;

      if (apply) {
        f_i += f.force;
        torque_i += lever_i * f.moment + rolling;
        if (both_sides || j < g.local_count) {
          const double relax_j = pair.relax(j);
          column(g.f, j) -= relax_j * f.force;
          column(g.torque, j) += relax_j * (lever_j * f.moment - rolling);
        }
      }
      report({i, j, delta.data(), state.n.data(), f.force, lever_i * f.moment + rolling,
              lever_j * f.moment - rolling, rsq, history});
    }
    const double relax_i = pair.relax(i);
    column(g.f, i) += relax_i * f_i;
    column(g.torque, i) += relax_i * torque_i;
  }
  if (apply) contact_statistics().note(largest);
}

}  // namespace gasgrain::plugins
