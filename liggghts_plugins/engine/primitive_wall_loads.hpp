// Stock primitive walls in the fused engine: fix wall/gran computes its contacts itself, whatever
// its model, on the few grains of its own neighbour list.
//
// The fix reads position, velocity and spin of these grains and adds to their force and torque; its
// contact history stays with it. So only these grains are brought up to date in the atom arrays.
#pragma once

#include "liggghts_plugins/engine/grain_loop.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Atom;
class FixWallGran;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

// Whether loads on grains are all that the fix computes in a step: no stored forces, no heat.
bool computes_loads_only(LAMMPS_NS::FixWallGran& wall);

// Takes the grains out of the fix's list that are farther away than `reach` (m, of the surfaces)
// and cannot come into contact before the list is built again. LIGGGHTS lists every grain outside
// of a cylinder.
void keep_near_grains(LAMMPS_NS::FixWallGran& wall, LAMMPS_NS::Atom& atom, double reach);

// Lets the fix compute the loads of the present positions; ascending grains. Overwrites state,
// force and torque of its grains in the atom arrays.
void compute_wall_loads(std::vector<GrainLoad>& loads, LAMMPS_NS::FixWallGran& wall,
                        LAMMPS_NS::Atom& atom, GrainLoop& loop);

}  // namespace gasgrain::plugins
