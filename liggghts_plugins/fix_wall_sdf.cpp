#include "liggghts_plugins/fix_wall_sdf.h"

#include <atom.h>
#include <modify.h>
#include <mpi.h>
#include <neighbor.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "coupling/files/sdf_file.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

// Below this length of grad(phi) there is no wall normal (points equally far from several
// surfaces).
constexpr double smallest_gradient = 1e-3;

TangentialModel tangential_model(const std::string& name, const std::string& where) {
  if (name == "history") return TangentialModel::history;
  if (name == "no_history") return TangentialModel::no_history;
  if (name == "off") return TangentialModel::off;
  throw UserError(where + ": tangential is 'history', 'no_history' or 'off', not '" + name + "'");
}

}  // namespace

FixWallSdf::FixWallSdf(LAMMPS_NS::LAMMPS* liggghts, int argument_count, char** arguments)
    : Fix(liggghts, argument_count, arguments),
      GrainWall(*liggghts),
      where_(std::string("fix ") + id + " wall/sdf") {
  if (!atom->sphere_flag || !atom->rmass)
    throw UserError(where_ + ": needs spheres with their own mass (atom_style sphere)");
  const int used = read_body(argument_count, arguments);
  read_options(argument_count - used, arguments + used);

  vector_flag = 1;
  size_vector = static_cast<int>(totals_.size());
  global_freq = 1;
  extvector = 1;
  restart_peratom = 1;
  create_attribute = 1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
}

FixWallSdf::~FixWallSdf() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

// Reads `body FILE` or `case FILE body NAME`; returns the number of arguments used so far.
int FixWallSdf::read_body(int argument_count, char** arguments) {
  const auto is = [&](int i, const char* word) {
    return i + 1 < argument_count && std::strcmp(arguments[i], word) == 0;
  };
  if (is(3, "body")) {
    body_.name = arguments[4];
    body_.shape = load_sdf_shape(arguments[4]);
    return 5;
  }
  if (is(3, "case") && is(5, "body")) {
    const ConfigTable case_file = ConfigTable::parse_file(arguments[4]);
    body_ = find_body(read_bodies(case_file, load_sdf_shape), arguments[6]);
    if (!body_.acts_on_grains)
      throw UserError(where_ + ": body '" + body_.name + "' of " + arguments[4] +
                      " does not act on grains");
    return 7;
  }
  throw UserError(where_ + ": expects `body FILE.h5 type T` or `case CASE.toml body NAME type T`");
}

void FixWallSdf::read_options(int argument_count, char** arguments) {
  for (int i = 0; i < argument_count; i += 2) {
    const std::string keyword = arguments[i];
    if (i + 1 >= argument_count) throw UserError(where_ + ": no value after '" + keyword + "'");
    char* value = arguments[i + 1];
    if (keyword == "type") {
      const double type = script_number(value, where_.c_str(), "type");
      if (!(type >= 1 && type <= atom->ntypes && type == std::floor(type)))
        throw UserError(where_ + ": type = " + value + " is not an atom type in 1.." +
                        std::to_string(atom->ntypes) + " (create_box)");
      wall_type_ = static_cast<int>(type);
    } else if (keyword == "tangential") {
      settings_.tangential = tangential_model(value, where_);
    } else if (keyword == "stiffness_exponent") {
      own_exponent_ = true;
      read_contact_settings(settings_, {2, arguments + i}, where_.c_str());
    } else {
      throw UserError(where_ + ": unknown keyword '" + keyword +
                      "' (known: type, tangential, stiffness_exponent)");
    }
  }
  if (wall_type_ == 0)
    throw UserError(where_ +
                    ": missing `type T`, the atom type whose contact properties the wall has");
}

int FixWallSdf::setmask() {
  return LAMMPS_NS::FixConst::PRE_NEIGHBOR | LAMMPS_NS::FixConst::POST_FORCE;
}

void FixWallSdf::init() {
  if (modify->n_fixes_style("rigid") > 0 || modify->n_fixes_style("multisphere") > 0)
    throw UserError(where_ + ": rigid bodies and multispheres are not supported");
  const ContactSettings* pair = pair_settings(*lmp);
  if (!own_exponent_ && pair) settings_.stiffness_exponent = pair->stiffness_exponent;
  contacts_ = GrainContactTable(*lmp, settings_, where_.c_str());
  refuse_unresolved_grains();
}

// A grain reaches as far as its radius; further out a sampled field only knows a bound. Grains that
// are still to be inserted count with the radius of their template.
void FixWallSdf::refuse_unresolved_grains() const {
  double radius = 0.0, smallest_radius = 0.0;
  modify->max_min_rad(radius, smallest_radius);  // over all ranks
  if (radius <= body_.shape->resolved_range()) return;
  std::ostringstream message;
  message << where_ << ": body '" << body_.name << "' is sampled with a band of "
          << body_.shape->resolved_range() << " m, but grains have a radius of " << radius
          << " m; sample it with a band of at least the largest grain radius";
  throw UserError(message.str());
}

void FixWallSdf::setup(int vflag) {
  post_force(vflag);
}

// Grains move less than the skin until the lists are built again, and the distance changes by no
// more than they move, so all others cost nothing.
void FixWallSdf::pre_neighbor() {
  candidates_.clear();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double reach = atom->radius[i] + neighbor->skin;
    if (body_.shape->distance(ConstColumn(atom->x[i])) < reach)
      candidates_.push_back(i);
    else
      displacement_[i].setZero();
  }
}

void FixWallSdf::post_force(int) {
  load_ = {};
  totals_valid_ = false;
  const TangentialStep step{update->setupflag ? History::keep : History::advance, update->dt};
  with_tangential_model(settings_.tangential,
                        [&]<TangentialModel model>() { apply_contacts<model>(step); });
  if (update->setupflag)
    impulse_.start(load_.force);
  else
    impulse_.add_step(load_.force, update->dt);
  contact_statistics().note(load_.largest);
}

void FixWallSdf::record_step(const Load& load) {
  load_ = load;
  totals_valid_ = false;
  impulse_.add_step(load_.force, update->dt);
  contact_statistics().note(load_.largest);
}

template <TangentialModel tangential>
void FixWallSdf::apply_contacts(const TangentialStep& step) {
  for (const int i : candidates_) {
    const DistanceSample wall = body_.shape->sample(ConstColumn(atom->x[i]));
    const bool touches = wall.distance < atom->radius[i] &&
                         wall.gradient.squaredNorm() > smallest_gradient * smallest_gradient;
    if (touches)
      apply_contact<tangential>(i, wall, step);
    else
      displacement_[i].setZero();
  }
}

template <TangentialModel tangential>
void FixWallSdf::apply_contact(int i, const DistanceSample& wall, const TangentialStep& step) {
  const double radius = atom->radius[i];
  const double overlap = radius - wall.distance;
  const double gradient = wall.gradient.norm();
  const Vec3 n = wall.gradient / gradient;
  const double lever = radius - 0.5 * overlap;
  const ContactState state{.n = n,
                           .overlap = gradient * overlap,
                           .relative_velocity = ConstColumn(atom->v[i]) - body_.surface_velocity,
                           .lever_spin = lever * ConstColumn(atom->omega[i])};
  const ContactCoefficients c =
      contacts_(atom->type[i], wall_type_).first_against_fixed(atom->rmass[i]);
  const ContactForce f = contact_force<tangential>(c, state, displacement_[i], step);
  Column(atom->f[i]) += f.force;
  Column(atom->torque[i]) += lever * f.moment;

  load_.add(f.force, ConstColumn(atom->x[i]) - lever * n,
            {.length = overlap, .relative = overlap / (2.0 * radius)});
}

void FixWallSdf::Load::add(const Vec3& force_on_grain, const Vec3& point,
                           const LargestOverlap& overlap) {
  force -= force_on_grain;
  torque -= point.cross(force_on_grain);
  contacts += 1;
  largest.length = std::max(largest.length, overlap.length);
  largest.relative = std::max(largest.relative, overlap.relative);
}

double FixWallSdf::compute_vector(int index) {
  if (!totals_valid_) {
    std::array<double, 7> sums{};
    Column(sums.data()) = load_.force;
    Column(sums.data() + 3) = load_.torque;
    sums[6] = load_.contacts;
    MPI_Allreduce(sums.data(), totals_.data(), 7, MPI_DOUBLE, MPI_SUM, world);
    MPI_Allreduce(&load_.largest.length, &totals_[7], 1, MPI_DOUBLE, MPI_MAX, world);
    totals_valid_ = true;
  }
  return totals_.at(index);
}

void FixWallSdf::grow_arrays(int count) {
  displacement_.resize(count, Vec3::Zero());
}

void FixWallSdf::copy_arrays(int from, int to, int) {
  displacement_[to] = displacement_[from];
}

void FixWallSdf::set_arrays(int i) {
  displacement_[i].setZero();
}

int FixWallSdf::pack_exchange(int i, double* buffer) {
  Column{buffer} = displacement_[i];
  return 3;
}

int FixWallSdf::unpack_exchange(int i, double* buffer) {
  displacement_[i] = Column(buffer);
  return 3;
}

int FixWallSdf::pack_restart(int i, double* buffer) {
  buffer[0] = size_restart(i);
  Column(buffer + 1) = displacement_[i];
  return size_restart(i);
}

// LIGGGHTS keeps the restart values of all fixes of an atom one after the other, each set beginning
// with its length; this fix's is the nth.
void FixWallSdf::unpack_restart(int i, int nth) {
  const double* values = atom->extra[i];
  for (int k = 0; k < nth; ++k) values += static_cast<int>(values[0]);
  displacement_[i] = ConstColumn(values + 1);
}

double FixWallSdf::memory_usage() {
  return static_cast<double>(displacement_.capacity() * sizeof(Vec3) +
                             candidates_.capacity() * sizeof(int));
}

}  // namespace gasgrain::plugins
