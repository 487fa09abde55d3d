// Which solver the pressure equation gets, and what steps in when it fails.
#pragma once

namespace gasgrain::cfd {

enum class PressureMethod {
  multigrid,       // own conjugate gradients with multigrid: pressure_multigrid.cpp
  hypre_pfmg,      // conjugate gradients with hypre's PFMG, Galerkin coarse operators
  hypre_pfmg_rap,  // the same with seven-point coarse operators: cheaper, fails around some bodies
  hypre_smg,       // conjugate gradients with hypre's SMG
  hypre_boomeramg  // conjugate gradients with hypre's BoomerAMG
};

enum class PressureFallback { none, hypre_boomeramg, hypre_pfmg };

}  // namespace gasgrain::cfd
