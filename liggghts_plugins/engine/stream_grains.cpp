#include "liggghts_plugins/engine/stream_grains.hpp"

#include <atom.h>
#include <fix.h>
#include <fix_property_atom.h>
#include <lammps.h>
#include <modify.h>

#include <algorithm>
#include <cmath>

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

// Values that fix insert/stream keeps of each atom: place, step of insertion (0: not inserted by
// it), step of release, velocity until then, velocity and spin afterwards.
constexpr int inserted_at = 3, released_at = 4, velocity_at = 5, velocity_then_at = 8,
              spin_then_at = 11, value_count = 14;
constexpr const char* values_name = "release_fix_insert_stream";

}  // namespace

void StreamGrains::load(LAMMPS_NS::LAMMPS& lmp, const LAMMPS_NS::Fix* stream, long step) {
  grains_.clear();
  square_speed_ = 0.0;
  if (!stream) return;
  const auto& fix = static_cast<const LAMMPS_NS::FixPropertyAtom&>(*lmp.modify->find_fix_property(
      values_name, "property/atom", "vector", value_count, 0, stream->style));
  const LAMMPS_NS::Atom& atom = *lmp.atom;
  for (int i = 0; i < atom.nlocal; ++i) {
    const double* values = fix.array_atom[i];
    const Grain grain{.index = i,
                      .inserted = std::lround(values[inserted_at]),
                      .released = std::lround(values[released_at]),
                      .start = ConstColumn(values),
                      .velocity = ConstColumn(values + velocity_at),
                      .velocity_then = ConstColumn(values + velocity_then_at),
                      .spin_then = ConstColumn(values + spin_then_at)};
    if ((atom.mask[i] & stream->groupbit) == 0 || grain.inserted == 0 || grain.released < step)
      continue;
    grains_.push_back(grain);
    square_speed_ =
        std::max({square_speed_, grain.velocity.squaredNorm(), grain.velocity_then.squaredNorm()});
  }
}

void StreamGrains::hold(GrainLoop& loop, long step) {
  std::erase_if(grains_, [&](const Grain& grain) { return grain.released < step; });
  for (const Grain& grain : grains_) loop.fix_grain(grain.index);
}

void StreamGrains::place(GrainLoop& loop, long step, double dt) {
  for (const Grain& grain : grains_) {
    const bool released = grain.released < step;
    const long end = released ? grain.released : step;
    Column position(loop.grain(grain.index).position);
    position = grain.start + (static_cast<double>(end - grain.inserted) * dt) * grain.velocity;
    Column(loop.grain(grain.index).velocity) = released ? grain.velocity_then : grain.velocity;
    Column(loop.spin(grain.index).velocity) = released ? grain.spin_then : Vec3(Vec3::Zero());
    if (!released) continue;
    position += dt * grain.velocity_then;
    loop.free_grain(grain.index);
  }
  std::erase_if(grains_, [&](const Grain& grain) { return grain.released < step; });
  if (grains_.empty()) square_speed_ = 0.0;
}

}  // namespace gasgrain::plugins
