#include "liggghts_plugins/wall_gran_cgm.hpp"

#include <atom.h>
#include <fix_wall_gran.h>
#include <update.h>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/contact_model_cgm.hpp"
#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::FixWallGran;
using LIGGGHTS::ContactModels::SurfacesIntersectData;
using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

constexpr const char* where = "fix wall/gran model cgm";

}  // namespace

WallGranCgm::WallGranCgm(LAMMPS_NS::LAMMPS* liggghts, FixWallGran* parent, int64_t variant)
    : Pointers(liggghts), GrainWall(*liggghts), parent_(parent), variant_(variant) {
  settings_.tangential = tangential_model_of(variant);
  if (settings_.tangential == TangentialModel::history) {
    history_offset_ = parent->add_history_value("shearx", "1");
    parent->add_history_value("sheary", "1");
    parent->add_history_value("shearz", "1");
  }
}

void WallGranCgm::settings(int argument_count, char** arguments, LIGGGHTS::IContactHistorySetup*) {
  own_exponent_ = argument_count > 0;
  read_contact_settings(settings_, {argument_count, arguments}, where);
}

void WallGranCgm::init_granular() {
  if (!atom->sphere_flag || !atom->rmass || atom->superquadric_flag || atom->shapetype_flag)
    throw UserError(std::string(where) + ": needs spheres with their own mass (atom_style sphere)");
  const ContactSettings* pair = pair_settings(*lmp);
  if (!own_exponent_ && pair) settings_.stiffness_exponent = pair->stiffness_exponent;
  contacts_ = GrainContactTable(*lmp, settings_, where);
}

bool WallGranCgm::contact_match(const std::string kind, const std::string model) {
  return variant_contains(variant_, kind, model);
}

WallGranCgm::Forces WallGranCgm::forces(const FixWallGran& wall,
                                        const SurfacesIntersectData& contact, const Vec3& n,
                                        const double* wall_velocity) {
  const int i = contact.i;
  const double overlap = contact.deltan;
  const double lever = contact.radi - 0.5 * overlap;
  const ContactState state{
      .n = n,
      .overlap = overlap,
      .relative_velocity = ConstColumn(atom->v[i]) - ConstColumn(wall_velocity),
      .lever_spin = lever * ConstColumn(atom->omega[i])};
  const GrainContact& law = contacts_(atom->type[i], wall.atom_type_wall());
  const ContactCoefficients c = law.first_against_fixed(contact.mi);

  Vec3 displacement = Vec3::Zero();
  Column history(contact.contact_history ? contact.contact_history + history_offset_ : nullptr);
  if (history_offset_ >= 0) displacement = history;
  const bool advance = wall.computeflag() && wall.shearupdate();
  const TangentialStep step{advance ? History::advance : History::keep, update->dt};
  ContactForce f = with_tangential_model(settings_.tangential, [&]<TangentialModel model>() {
    return contact_force<model>(c, state, displacement, step);
  });
  if (history_offset_ >= 0 && advance) history = displacement;
  Vec3 rolling = Vec3::Zero();
  if (law.has_surface_forces()) {
    const GrainSize size{contact.mi, contact.radi};
    const RollingPair pair{.relative_spin = ConstColumn(atom->omega[i]),
                           .effective_radius = size.radius,
                           .inertia = sphere_inertia(size.mass, size.radius)};
    rolling = add_surface_forces(law.surface_of_first_against_fixed(size), n, pair, update->dt, f);
  }
  return {.force = f.force, .torque = lever * f.moment + rolling};
}

void WallGranCgm::compute_force(FixWallGran* wall, SurfacesIntersectData& contact, bool touching,
                                double* wall_velocity, LAMMPS_NS::FixMeshSurface* mesh_fix,
                                int mesh_index, LAMMPS_NS::TriMesh* mesh, int triangle) {
  const int i = contact.i;
  contact.has_force_update = touching;
  if (!touching) {
    if (history_offset_ >= 0) Column(contact.contact_history + history_offset_).setZero();
    return;
  }
  const Vec3 delta = ConstColumn(contact.delta);  // from the contact point to the centre
  contact.r = contact.radi - contact.deltan;
  contact.rsq = contact.r * contact.r;
  const Vec3 n = delta / contact.r;
  const bool rigid = wall->fix_rigid() && wall->body(i) >= 0;
  contact.mi = rigid ? wall->masstotal(wall->body(i)) : atom->rmass[i];

  const Forces on_grain = forces(*wall, contact, n, wall_velocity);
  if (wall->computeflag()) {
    Column(atom->f[i]) += on_grain.force;
    Column(atom->torque[i]) += on_grain.torque;
    if (wall->store_sum_normal_force()) *wall->get_sum_normal_force_ptr(i) += on_grain.force.dot(n);
    if (wall->store_force()) Column(wall->fix_wallforce()->array_atom[i]) += on_grain.force;
    contact_statistics().note(
        {.length = contact.deltan, .relative = contact.deltan / (2.0 * contact.radi)});
    enter_present_step();
    step_force_ -= on_grain.force;
    surface_moves_ = surface_moves_ || !ConstColumn(wall_velocity).isZero(0.0);
  }

  const int triangle_id = mesh ? mesh->id(triangle) : 0;
  LIGGGHTS::ContactModels::ForceData data;
  Column(data.delta_F) = on_grain.force;
  Column(data.delta_torque) = on_grain.torque;
  if (wall->store_force_contact() && update->ntimestep % wall->store_force_contact_every() == 0)
    wall->add_contactforce_wall(i, data, triangle_id);
  if (wall->store_force_contact_stress())
    wall->add_contactforce_stress_wall(i, data, contact.delta, wall_velocity, triangle_id);
  if (wall->compute_wall_gran_local() && wall->addflag()) {
    Vec3 contact_point = Vec3(ConstColumn(atom->x[i])) - delta;
    Vec3 outward = -n;
    wall->compute_wall_gran_local()->add_wall_1(mesh_index, triangle_id, i, contact_point.data(),
                                                wall_velocity);
    wall->compute_wall_gran_local()->add_wall_2(
        i, data.delta_F[0], data.delta_F[1], data.delta_F[2], data.delta_torque[0],
        data.delta_torque[1], data.delta_torque[2], contact.contact_history, contact.rsq,
        outward.data());
  }
  if (wall->heattransfer_flag()) wall->addHeatFlux(mesh, i, contact.radi, contact.deltan, 1.0);
  if (mesh_fix && wall->computeflag()) {
    Vec3 total = on_grain.force, to_contact = -delta;
    mesh_fix->add_particle_contribution(i, total.data(), to_contact.data(), triangle,
                                        wall_velocity);
  }
}

void WallGranCgm::close_step() {
  if (step_closed_) return;
  if (setup_step_)
    impulse_.start(step_force_);
  else
    impulse_.add_step(step_force_, update->dt);
  step_force_.setZero();
  step_closed_ = true;
}

// LIGGGHTS calls contact by contact: a step is complete when the next one begins. Steps without any
// contact count with zero force.
void WallGranCgm::enter_present_step() {
  const bool setup = update->setupflag != 0;
  if (update->ntimestep == step_ && setup == setup_step_) return;
  close_step();
  if (update->ntimestep > step_ + 1) impulse_.add_step(Vec3::Zero(), update->dt);
  step_ = update->ntimestep;
  setup_step_ = setup;
  step_closed_ = false;
}

Vec3 WallGranCgm::take_impulse() {
  enter_present_step();
  close_step();
  return impulse_.take();
}

std::string WallGranCgm::wall_name() const {
  return parent_->id;
}

}  // namespace gasgrain::plugins
