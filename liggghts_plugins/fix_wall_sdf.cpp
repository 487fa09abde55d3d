#include "liggghts_plugins/fix_wall_sdf.h"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <error.h>
#include <modify.h>
#include <mpi.h>
#include <neighbor.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <utility>

#include "coupling/files/sdf_file.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

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
  auto [body, used] = read_body(argument_count, arguments);
  const int wall_type = read_options(argument_count - used, arguments + used);
  take_motion(body, used == 7 ? arguments[4] : nullptr);
  wall_ = SdfWall(body, wall_type);

  vector_flag = 1;
  size_vector = static_cast<int>(totals_.size());
  global_freq = 1;
  extvector = 1;
  restart_peratom = 1;
  create_attribute = 1;
  // else LIGGGHTS calls set_arrays() for all atoms in the first set-up, after pre_neighbor(), and the
  // springs' places would be forgotten
  just_created = 0;
  // a wall that sweeps asks for new lists before it comes to grains that are no candidates
  force_reneighbor = body.motion.sweeps() || motion_.by_variable.exists() ? 1 : 0;
  restart_global = motion_.by_variable.exists() ? 1 : 0;
  next_reneighbor = -1;
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
}

FixWallSdf::~FixWallSdf() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

// Reads `body FILE` or `case FILE body NAME`; returns the number of arguments used so far, too.
std::pair<Body, int> FixWallSdf::read_body(int argument_count, char** arguments) const {
  const auto is = [&](int i, const char* word) {
    return i + 1 < argument_count && std::strcmp(arguments[i], word) == 0;
  };
  if (is(3, "body")) {
    Body body;
    body.name = arguments[4];
    body.shape = load_sdf_shape(arguments[4]);
    return {body, 5};
  }
  if (is(3, "case") && is(5, "body")) {
    const ConfigTable case_file = ConfigTable::parse_file(arguments[4]);
    const Body body = find_body(read_bodies(case_file, load_sdf_shape), arguments[6]);
    if (!body.acts_on_grains)
      throw UserError(where_ + ": body '" + body.name + "' of " + arguments[4] +
                      " does not act on grains");
    return {body, 7};
  }
  throw UserError(where_ + ": expects `body FILE.h5 type T` or `case CASE.toml body NAME type T`");
}

// Returns the wall's atom type.
int FixWallSdf::read_options(int argument_count, char** arguments) {
  int wall_type = 0;
  int words = 2;
  for (int i = 0; i < argument_count; i += words) {
    const std::string keyword = arguments[i];
    words = read_motion_keyword(motion_, {argument_count - i, arguments + i}, where_);
    if (words > 0) continue;
    words = 2;
    if (i + 1 >= argument_count) throw UserError(where_ + ": no value after '" + keyword + "'");
    char* value = arguments[i + 1];
    if (keyword == "type") {
      const double type = script_number(value, where_.c_str(), "type");
      if (!(type >= 1 && type <= atom->ntypes && type == std::floor(type)))
        throw UserError(where_ + ": type = " + value + " is not an atom type in 1.." +
                        std::to_string(atom->ntypes) + " (create_box)");
      wall_type = static_cast<int>(type);
    } else if (keyword == "tangential") {
      settings_.tangential = tangential_model(value, where_);
    } else if (keyword == "stiffness_exponent") {
      own_exponent_ = true;
      read_contact_settings(settings_, {2, arguments + i}, where_.c_str());
    } else {
      throw UserError(where_ + ": unknown keyword '" + keyword +
                      "' (known: type, tangential, stiffness_exponent, translate, oscillate, "
                      "rotate, start, stop, displacement, velocity)");
    }
  }
  if (wall_type == 0)
    throw UserError(where_ +
                    ": missing `type T`, the atom type whose contact properties the wall has");
  return wall_type;
}

// Motion stated by keywords, of a body that has none of its own and is no wall for the gas.
void FixWallSdf::take_motion(Body& body, const char* case_file) const {
  check_motion(motion_, where_);
  if (!motion_.exists()) return;
  if (!body.motion.is_at_rest())
    throw UserError(where_ + ": body '" + body.name + "' has a `motion` in " + case_file +
                    "; state it there or by keywords, not both");
  if (case_file && body.acts_on_gas)
    throw UserError(where_ + ": body '" + body.name + "' of " + case_file +
                    " acts on the gas, which would not see a motion stated by keywords; state it "
                    "as `motion` in the case file, or give the body acts_on = [\"grains\"]");
  body.motion = motion_.rigid;
  if (motion_.rigid.rate != 0.0) body.torque_point = motion_.rigid.centre;
}

int FixWallSdf::setmask() {
  return LAMMPS_NS::FixConst::PRE_NEIGHBOR | LAMMPS_NS::FixConst::POST_FORCE;
}

void FixWallSdf::init() {
  if (modify->n_fixes_style("rigid") > 0 || modify->n_fixes_style("multisphere") > 0)
    throw UserError(where_ + ": rigid bodies and multispheres are not supported");
  const ContactSettings* pair = pair_settings(*lmp);
  if (!own_exponent_ && pair) settings_.stiffness_exponent = pair->stiffness_exponent;
  motion_.by_variable.check(*lmp, where_);
  wall_.set_contacts(GrainContactTable(*lmp, settings_, where_.c_str()));
  refuse_unresolved_grains();
}

// A grain reaches as far as its radius; further out a sampled field only knows a bound. Grains that
// are still to be inserted count with the radius of their template.
void FixWallSdf::refuse_unresolved_grains() const {
  double radius = 0.0, smallest_radius = 0.0;
  modify->max_min_rad(radius, smallest_radius);  // over all ranks
  if (radius <= wall_.body().shape->resolved_range()) return;
  std::ostringstream message;
  message << where_ << ": body '" << wall_.body().name << "' is sampled with a band of "
          << wall_.body().shape->resolved_range() << " m, but grains have a radius of " << radius
          << " m; sample it with a band of at least the largest grain radius";
  throw UserError(message.str());
}

void FixWallSdf::setup(int vflag) {
  post_force(vflag);
}

void FixWallSdf::place_wall() {
  wall_.set_time(update->get_cur_time(), update->dt);
  if (motion_.by_variable.exists()) carry_wall();
}

// Asks for new lists when half of the way that they allow for is used up.
void FixWallSdf::carry_wall() {
  VariableMotion& motion = motion_.by_variable;
  if (motion.advance(*lmp)) swept_ += motion.last_way();
  wall_.carry({motion.displacement(), motion.velocity(), motion.last_way() / update->dt});
  if (way_ == 0.0) return;  // there are no grains
  if (swept_ > way_) {
    std::ostringstream message;
    message << where_ << ": the variables move the wall by " << motion.last_way() << " m in step "
            << update->ntimestep << ", more than half of the largest grain radius (" << way_
            << " m): it could pass grains; choose a smaller step or a slower motion";
    throw UserError(message.str());
  }
  if (swept_ > 0.5 * way_) next_reneighbor = update->ntimestep + 1;
}

double FixWallSdf::fastest_sweep() const {
  return wall_.fastest_sweep(ConstColumn(domain->boxlo), ConstColumn(domain->boxhi));
}

double FixWallSdf::step_duration() const {
  return update->dt;
}

int FixWallSdf::tag(int i) const {
  return atom->tag[i];
}

int FixWallSdf::type(int i) const {
  return atom->type[i];
}

// Grains move less than the skin until the lists are built again, and the distance changes by no
// more than they move, so all others cost nothing. A wall that sweeps may come nearer by a grain
// radius more before it asks for new lists.
void FixWallSdf::pre_neighbor() {
  double smallest_radius = 0.0;
  way_ = 0.0;
  if (wall_.sweeps() || motion_.by_variable.exists()) modify->max_min_rad(way_, smallest_radius);
  swept_ = 0.0;
  place_wall();
  swept_ = 0.0;
  const double speed = fastest_sweep();
  if (speed > 0 && !motion_.by_variable.exists())
    next_reneighbor =
        update->ntimestep + std::max(1, static_cast<int>(way_ / (speed * update->dt)));
  candidates_.clear();
  std::vector<Vec3> springs;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double reach = atom->radius[i] + neighbor->skin + way_;
    if ((atom->mask[i] & groupbit) && wall_.distance(ConstColumn(atom->x[i])) < reach) {
      candidates_.push_back(i);
      springs.push_back(spring_of(i));
      place_[i] = static_cast<int>(springs.size()) - 1;
    } else {
      place_[i] = -1;
      wall_.forget(atom->tag[i]);
    }
  }
  springs_ = std::move(springs);
  local_walls_.assign(wall_.has_local_walls() ? candidates_.size() : 1, LocalWalls());
}

void FixWallSdf::post_force(int) {
  load_ = {};
  totals_valid_ = false;
  place_wall();
  const TangentialStep step{update->setupflag ? History::keep : History::advance, update->dt};
  with_tangential_model(settings_.tangential,
                        [&]<TangentialModel model>() { apply_contacts<model>(step); });
  if (update->setupflag)
    impulse_.start(load_.force);
  else
    impulse_.add_step(load_.force, update->dt);
  note_load();
}

void FixWallSdf::record_step(const WallLoad& load) {
  load_ = load;
  totals_valid_ = false;
  impulse_.add_step(load_.force, update->dt);
  note_load();
}

void FixWallSdf::note_load() {
  contact_statistics().note(load_.largest);
  unsure_contacts_ += load_.unsure_contacts;
}

void FixWallSdf::post_run() {
  double sum = 0.0;
  MPI_Allreduce(&unsure_contacts_, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  unsure_contacts_ = 0.0;
  if (sum == 0.0 || comm->me != 0) return;
  std::ostringstream message;
  message << where_ << ": " << sum << " times (steps and grains) the place of body '"
          << wall_.body().name
          << "' nearest to a grain was not found, and the nearest one seen was taken; sample the "
             "body more finely where hollows are as narrow as the grains";
  error->warning(FLERR, message.str().c_str());
}

template <TangentialModel tangential>
void FixWallSdf::apply_contacts(const TangentialStep& step) {
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const int i = candidates_[c];
    const GrainAtWall grain{.tag = atom->tag[i],
                            .type = atom->type[i],
                            .radius = atom->radius[i],
                            .mass = atom->rmass[i],
                            .position = ConstColumn(atom->x[i]),
                            .velocity = ConstColumn(atom->v[i]),
                            .spin = ConstColumn(atom->omega[i])};
    const WallTouch touch =
        wall_.touch<tangential>(grain, local_walls(c), springs_[c], step, load_);
    if (!touch.touches) continue;
    Column(atom->f[i]) += touch.force;
    Column(atom->torque[i]) += touch.torque;
  }
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
  place_.reserve(count);  // as many as LIGGGHTS has room for, and no more
  place_.resize(count, -1);
}

void FixWallSdf::copy_arrays(int from, int to, int) {
  place_[to] = place_[from];
}

void FixWallSdf::set_arrays(int i) {
  place_[i] = -1;
}

// The spring of a single contact, the number of springs of several contacts, and each of those.
std::vector<double> FixWallSdf::packed_springs(int i) const {
  const Vec3 own = spring_of(i);
  std::vector<double> values{own[0], own[1], own[2], 0.0};
  if (const std::vector<EdgeSpring>* springs = wall_.edge_springs(atom->tag[i])) {
    values[3] = static_cast<double>(springs->size());
    for (const EdgeSpring& spring : *springs)
      for (const Vec3& v : {spring.normal, spring.displacement})
        values.insert(values.end(), v.begin(), v.end());
  }
  return values;
}

void FixWallSdf::unpack_springs(int i, const double* values) {
  place_[i] = static_cast<int>(springs_.size());
  springs_.push_back(ConstColumn(values));
  std::vector<EdgeSpring> springs(static_cast<std::size_t>(values[3]));
  for (std::size_t n = 0; n < springs.size(); ++n)
    springs[n] = {ConstColumn(values + 4 + 6 * n), ConstColumn(values + 7 + 6 * n)};
  wall_.set_edge_springs(atom->tag[i], std::move(springs));
}

int FixWallSdf::pack_exchange(int i, double* buffer) {
  const std::vector<double> values = packed_springs(i);
  std::copy(values.begin(), values.end(), buffer);
  wall_.forget(atom->tag[i]);
  return static_cast<int>(values.size());
}

int FixWallSdf::unpack_exchange(int i, double* buffer) {
  unpack_springs(i, buffer);
  return 4 + 6 * static_cast<int>(buffer[3]);
}

int FixWallSdf::size_restart(int i) {
  return 1 + static_cast<int>(packed_springs(i).size());
}

int FixWallSdf::maxsize_restart() {
  return 1 + 4 + 6 * NearSurfaces::most;
}

int FixWallSdf::pack_restart(int i, double* buffer) {
  const std::vector<double> values = packed_springs(i);
  buffer[0] = 1.0 + static_cast<double>(values.size());
  std::copy(values.begin(), values.end(), buffer + 1);
  return 1 + static_cast<int>(values.size());
}

// LIGGGHTS keeps the restart values of all fixes of an atom one after the other, each set beginning
// with its length; this fix's is the nth.
void FixWallSdf::unpack_restart(int i, int nth) {
  const double* values = atom->extra[i];
  for (int k = 0; k < nth; ++k) values += static_cast<int>(values[0]);
  unpack_springs(i, values + 1);
}

void FixWallSdf::write_restart(FILE* file) {
  if (comm->me != 0) return;
  const std::vector<double> state = motion_.by_variable.state();
  const int size = static_cast<int>(state.size() * sizeof(double));
  std::fwrite(&size, sizeof size, 1, file);
  std::fwrite(state.data(), sizeof(double), state.size(), file);
}

void FixWallSdf::restart(char* buffer) {
  std::vector<double> state = motion_.by_variable.state();
  std::memcpy(state.data(), buffer, state.size() * sizeof(double));
  motion_.by_variable.set_state(state.data());
}

double FixWallSdf::memory_usage() {
  return static_cast<double>(springs_.capacity() * sizeof(Vec3) +
                             local_walls_.capacity() * sizeof(LocalWalls) +
                             (candidates_.capacity() + place_.capacity()) * sizeof(int));
}

}  // namespace gasgrain::plugins
