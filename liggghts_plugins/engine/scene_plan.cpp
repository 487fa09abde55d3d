#include "liggghts_plugins/engine/scene_plan.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <fix.h>
#include <fix_gravity.h>
#include <fix_nve_sphere.h>
#include <fix_wall_gran.h>
#include <force.h>
#include <lammps.h>
#include <modify.h>
#include <neigh_list.h>
#include <neighbor.h>
#include <pair_gran.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "liggghts_plugins/engine/mesh_fix.hpp"
#include "liggghts_plugins/engine/mesh_wall_loads.hpp"
#include "liggghts_plugins/engine/primitive_wall_loads.hpp"
#include "liggghts_plugins/engine/stock_pair_law.hpp"
#include "liggghts_plugins/fix_wall_sdf.h"
#include "liggghts_plugins/pair_gran_cgm.hpp"
#include "liggghts_plugins/private_member.hpp"
#include "liggghts_plugins/stock_pair_style.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::FixGravity;
using LAMMPS_NS::FixNVESphere;

struct GravityVariables {
  using Member = int FixGravity::*;
  friend Member private_member(GravityVariables);
};
struct SphereExtra {
  using Member = int FixNVESphere::*;
  friend Member private_member(SphereExtra);
};
struct SphereAddedMass {
  using Member = bool FixNVESphere::*;
  friend Member private_member(SphereAddedMass);
};
template struct GrantAccess<GravityVariables, &FixGravity::varflag>;
template struct GrantAccess<SphereExtra, &FixNVESphere::extra>;
template struct GrantAccess<SphereAddedMass, &FixNVESphere::useAM_>;

namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;
namespace hook = LAMMPS_NS::FixConst;

constexpr int group_all = 0;

// Hooks that the engine calls as LIGGGHTS does, with the atom arrays ready.
constexpr int reneighbouring_hooks = hook::PRE_EXCHANGE | hook::PRE_NEIGHBOR;
// Hooks that do not concern a time step: minimization, respa, energy of thermo output.
constexpr int harmless_hooks = hook::THERMO_ENERGY | hook::MIN_PRE_EXCHANGE |
                               hook::MIN_PRE_NEIGHBOR | hook::MIN_PRE_FORCE | hook::MIN_POST_FORCE |
                               hook::MIN_ENERGY | hook::POST_RUN | hook::INITIAL_INTEGRATE_RESPA |
                               hook::POST_INTEGRATE_RESPA | hook::PRE_FORCE_RESPA |
                               hook::POST_FORCE_RESPA | hook::FINAL_INTEGRATE_RESPA;
// Styles known to do at reneighbouring nothing but move, insert or delete atoms and their values.
constexpr std::array reneighbouring_styles = {"contacthistory", "property/atom", "insert/pack",
                                              "insert/rate/region"};

class Planner {
 public:
  explicit Planner(LAMMPS& lmp) : lmp_(lmp) {}

  ScenePlan plan() {
    look_at_pair();
    look_at_box();
    for (int n = 0; n < lmp_.modify->nfix; ++n) look_at_fix(*lmp_.modify->fix[n]);
    if (integrators_ != 1) oppose("not exactly one fix nve/sphere");
    oppose_if(frozen_grains_move(), "fix freeze of grains that are integrated");
    return plan_;
  }

 private:
  void oppose(const std::string& what) { plan_.obstacles.push_back(what); }
  void oppose_if(bool condition, const char* what) {
    if (condition) oppose(what);
  }

  // The law of the pair style, if it is one that the engine knows.
  void find_law() {
    const LAMMPS_NS::Pair* pair = lmp_.force->pair;
    PairGranCgm* cgm = pair_gran_cgm(lmp_);
    StockPairStyle* stock = stock_pair_style(lmp_);
    if (cgm && static_cast<const LAMMPS_NS::Pair*>(cgm->parent()) == pair) {
      plan_.pair = make_cgm_law(*cgm);
      oppose_if(cgm->contacts().has_surface_forces(), "adhesion or rolling friction");
    } else if (stock && static_cast<const LAMMPS_NS::Pair*>(stock->parent()) == pair) {
      StockLawResult result = make_stock_law(lmp_, *stock);
      for (const std::string& obstacle : result.obstacles) oppose(obstacle);
      plan_.known_pair_style = true;
      plan_.pair = std::move(result.law);
    } else {
      oppose("pair style other than gran model cgm, hooke, hooke/stiffness or hertz");
    }
    if (plan_.pair) plan_.known_pair_style = true;
  }

  void look_at_pair() {
    find_law();
    if (!plan_.pair) return;
    LAMMPS_NS::Force& force = *lmp_.force;
    auto* gran = static_cast<LAMMPS_NS::PairGran*>(force.pair);
    oppose_if(force.newton_pair, "newton on");
    oppose_if(force.kspace || force.bond, "kspace or bond style");
    plan_.frozen_group = gran->freeze_group_bit();
    oppose_if(gran->fr_pair() != nullptr, "rigid bodies");
    oppose_if(lmp_.modify->n_fixes_style("relax") > 0, "fix relax");
    oppose_if(gran->cpl() != nullptr, "compute pair/gran/local");
    oppose_if(gran->storeContactForces() || gran->storeContactForcesStress() ||
                  gran->storeSumDelta() || gran->store_sum_normal_force(),
              "stored contact forces");
    const int values = plan_.pair->model().tangential == TangentialModel::history ? 3 : 0;
    oppose_if(gran->dnum() != values, "contact history of other styles");
  }

  void look_at_box() {
    const LAMMPS_NS::Domain& domain = *lmp_.domain;
    const LAMMPS_NS::Atom& atom = *lmp_.atom;
    oppose_if(domain.triclinic != 0, "triclinic box");
    oppose_if(domain.dimension != 3, "dimension 2");
    oppose_if(!atom.sphere_flag || !atom.rmass || atom.molecular != 0, "atom style");
    oppose_if(atom.radvary_flag != 0, "radii that change");
    oppose_if(atom.firstgroup >= 0 || lmp_.neighbor->includegroup != 0, "atom_modify first");
    oppose_if(lmp_.neighbor->build_once != 0, "neigh_modify once");
    oppose_if(!lmp_.comm->ghost_velocity, "communicate without velocities");
  }

  void look_at_fix(Fix& fix) {
    const int hooks = lmp_.modify->fmask[index_of(fix)] & ~harmless_hooks;
    if (fix.box_change_size || fix.box_change_shape || fix.box_change_domain)
      oppose(std::string("box that fix ") + fix.id + " " + fix.style + " changes");
    if (fix.force_reneighbor) plan_.reneighbouring.push_back(&fix);
    if (fuses(fix) || fuses_mesh(fix)) return;
    const bool known = std::any_of(reneighbouring_styles.begin(), reneighbouring_styles.end(),
                                   [&](const char* style) { return is_style(fix, style); });
    const int understood = hook::END_OF_STEP | (known ? reneighbouring_hooks : 0);
    const bool every_step = (hooks & hook::END_OF_STEP) != 0 && fix.nevery <= 1;
    if ((hooks & ~understood) != 0 || every_step)
      oppose(std::string("fix ") + fix.id + " " + fix.style);
  }

  // Takes over what this fix does in every step, if it is one of ours or understood.
  bool fuses(Fix& fix) {
    const std::string name = std::string("fix ") + fix.id + " " + fix.style;
    if (auto* wall = dynamic_cast<FixWallSdf*>(&fix)) {
      if (wall->looks_at_grains()) oppose(name + " moved by variables of more than the time");
      plan_.walls.push_back(wall);
      return true;
    }
    if (auto* held = dynamic_cast<HeldForceFix*>(&fix)) {
      if (plan_.held_force) oppose("second " + name);
      plan_.held_force = held;
      plan_.held_force_fix = &fix;
      return true;
    }
    if (auto* wall = dynamic_cast<LAMMPS_NS::FixWallGran*>(&fix);
        wall && is_style(fix, "wall/gran") && computes_loads_only(*wall)) {
      if (!wall->is_mesh_wall())
        plan_.primitive_walls.push_back(wall);
      else if (meshes_compute_loads_only(*wall))
        plan_.mesh_wall = wall;
      else
        return false;
      return true;
    }
    if (is_style(fix, "gravity")) {
      auto& gravity = static_cast<FixGravity&>(fix);
      if (gravity.*private_member(GravityVariables()) != 0) oppose(name + " with variables");
      if (fix.igroup != group_all) oppose(name + " of a group");
      Vec3 acceleration;
      gravity.get_gravity(acceleration.data());
      plan_.after_contacts.push_back(&fix);
      plan_.acceleration += acceleration;
      return true;
    }
    if (is_style(fix, "freeze")) {
      plan_.after_contacts.push_back(&fix);
      return true;
    }
    if (is_style(fix, "insert/stream")) {
      plan_.streams.push_back(&fix);
      return true;
    }
    if (is_style(fix, "nve/sphere")) {
      const auto& sphere = static_cast<const FixNVESphere&>(fix);
      ++integrators_;
      plan_.moving_group = fix.groupbit;
      if (sphere.*private_member(SphereExtra()) != 0 || sphere.*private_member(SphereAddedMass()))
        oppose(name + " with options");
      return true;
    }
    return false;
  }

  bool fuses_mesh(Fix& fix) {
    const MeshFixRole role = mesh_fix_role(fix);
    if (role == MeshFixRole::none) return false;
    if (role == MeshFixRole::variable)
      oppose(std::string("fix ") + fix.id + " " + fix.style + " with variables");
    plan_.mesh_fixes.push_back(&fix);
    if (role == MeshFixRole::live) plan_.live_mesh_fixes.push_back(&fix);
    return true;
  }

  // On any rank.
  bool frozen_grains_move() const {
    if (plan_.frozen_group == 0) return false;
    const int both = plan_.frozen_group | plan_.moving_group;
    int found = 0;
    for (int i = 0; i < lmp_.atom->nlocal; ++i)
      if ((lmp_.atom->mask[i] & both) == both) found = 1;
    MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, lmp_.world);
    return found != 0;
  }

  static bool is_style(const Fix& fix, const char* style) {
    return std::strcmp(fix.style, style) == 0;
  }
  int index_of(const Fix& fix) const {
    return static_cast<int>(
        std::find(lmp_.modify->fix, lmp_.modify->fix + lmp_.modify->nfix, &fix) - lmp_.modify->fix);
  }

  LAMMPS& lmp_;
  ScenePlan plan_;
  int integrators_ = 0;
};

const char* tangential_name(TangentialModel model) {
  switch (model) {
    case TangentialModel::off:
      return "off";
    case TangentialModel::no_history:
      return "no_history";
    case TangentialModel::history:
      break;
  }
  return "history";
}

}  // namespace

std::string ScenePlan::text() const {
  if (!fused()) {
    std::string reasons;
    for (const std::string& obstacle : obstacles)
      reasons += (reasons.empty() ? "" : ", ") + obstacle;
    return "Engine: stock time integration, because of " + reasons;
  }
  std::string text = std::string("Engine: fused") +
                     (precision == Precision::mixed ? ", mixed precision" : "") + ": " +
                     pair->name() + " tangential " + tangential_name(pair->model().tangential);
  for (const LAMMPS_NS::Fix* fix : after_contacts) text += std::string(", ") + fix->style;
  if (!walls.empty()) text += ", wall/sdf x " + std::to_string(walls.size());
  if (!primitive_walls.empty())
    text += ", wall/gran primitive x " + std::to_string(primitive_walls.size());
  if (mesh_wall) text += ", wall/gran mesh x " + std::to_string(mesh_wall->n_meshes());
  for (const LAMMPS_NS::Fix* fix : live_mesh_fixes) text += std::string(", ") + fix->style;
  if (!streams.empty()) text += ", insert/stream x " + std::to_string(streams.size());
  if (held_force) text += ", " + std::string(held_force_fix->style);
  return text + ", nve/sphere";
}

ScenePlan plan_scene(LAMMPS& lmp, Precision precision) {
  ScenePlan plan = Planner(lmp).plan();
  plan.precision = precision;
  return plan;
}

}  // namespace gasgrain::plugins
