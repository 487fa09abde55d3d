#include "tests/verification/settled_packing.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>

// LIGGGHTS
#include <atom.h>
#include <input.h>
#include <lammps.h>

#include "liggghts_plugins/register.hpp"

namespace gasgrain::verification {

namespace {

using LAMMPS_NS::LAMMPS;

// Inserted at random places to a quarter of the volume; steps of a tenth of the contact time.
constexpr const char* settling = R"(
units si
atom_style granular
atom_modify map array
boundary p p f
newton off
communicate single vel yes
soft_particles yes
variable wide equal $(v_width*v_d)
variable roof equal $(v_count*PI/6*v_d^3/v_wide^2/0.25+2*v_d)
region box block 0 ${wide} 0 ${wide} 0 ${roof} units box
create_box 1 box
neighbor $(0.2*v_d) bin
neigh_modify delay 0 contact_distance_factor 1.01
fix k all property/global cgmSpringConstant peratomtypepair 1 30
fix e all property/global coefficientRestitution peratomtypepair 1 0.3
fix mu all property/global coefficientFriction peratomtypepair 1 0.3
pair_style gran model cgm tangential history
pair_coeff * *
timestep $(0.1*PI*sqrt(0.5*2500*PI/6*v_d^3/30))
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
fix floor all wall/gran model cgm tangential history primitive type 1 zplane 0.0
fix kind all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant $(0.5*v_d)
fix kinds all particledistribution/discrete 32452843 1 kind 1.0
region fill block 0 ${wide} 0 ${wide} ${d} $(v_roof-v_d) units box
fix insert all insert/pack seed 49979687 distributiontemplate kinds insert_every once overlapcheck yes all_in yes particles_in_region ${count} region fill
run $(ceil(v_time/dt))
)";

std::unique_ptr<LAMMPS> silent_liggghts() {
  std::array<std::string, 5> words{"gasgrain", "-log", "none", "-screen", "/dev/null"};
  std::array<char*, 5> arguments{};
  std::transform(words.begin(), words.end(), arguments.begin(),
                 [](std::string& word) { return word.data(); });
  auto liggghts =
      std::make_unique<LAMMPS>(static_cast<int>(arguments.size()), arguments.data(), MPI_COMM_SELF);
  plugins::register_styles(*liggghts);
  return liggghts;
}

std::string script(const PackingScene& scene) {
  std::ostringstream text;
  text.precision(17);
  text << "variable d equal " << scene.diameter << "\nvariable width equal " << scene.width
       << "\nvariable count equal " << scene.count << "\nvariable time equal " << scene.time << "\n"
       << settling;
  return text.str();
}

}  // namespace

Packing settled_packing(const PackingScene& scene) {
  const std::unique_ptr<LAMMPS> liggghts = silent_liggghts();
  std::istringstream commands(script(scene));
  for (std::string line; std::getline(commands, line);) liggghts->input->one(line.c_str());
  Packing packing;
  const LAMMPS_NS::Atom& atom = *liggghts->atom;
  for (int n = 0; n < atom.nlocal; ++n) {
    packing.centres.emplace_back(atom.x[n][0], atom.x[n][1], atom.x[n][2]);
    packing.speed += Vec3(atom.v[n][0], atom.v[n][1], atom.v[n][2]).squaredNorm() / atom.nlocal;
  }
  packing.speed = std::sqrt(packing.speed);
  return packing;
}

}  // namespace gasgrain::verification
