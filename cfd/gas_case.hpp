// Everything a gas case file states: docs/case_file.md.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/grid.hpp"
#include "cfd/pressure_method.hpp"
#include "cfd/probe_case.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/config_table.hpp"

namespace gasgrain::cfd {

struct GasProperties {
  double density = 1.0;         // rho, kg/m^3
  double viscosity = 1.8e-5;    // mu, Pa s; 0 skips the viscous terms
  Vec3 gravity = Vec3::Zero();  // m/s^2
};

enum class Convection { none, central, van_leer };

enum class TimeScheme { ab2, rk2 };

enum class Viscosity { explicit_step, implicit_step };

enum class BodyMethod { interpolation, volume_forcing };

struct Numerics {
  Convection convection = Convection::van_leer;
  PressureMethod pressure_solver = PressureMethod::multigrid;
  PressureFallback pressure_fallback = PressureFallback::hypre_boomeramg;
  double pressure_tolerance = 1e-6;  // residual over right-hand side, 2-norm
  int pressure_iterations = 200;     // largest number of CG iterations before the fallback
  double reference_pressure = 0.0;   // Pa, mean of a region without outlet
  TimeScheme time_scheme = TimeScheme::ab2;
  Viscosity viscosity = Viscosity::explicit_step;  // implicit: with ab2 and interpolation only
  BodyMethod immersed_boundary = BodyMethod::interpolation;
  double density_scaling = 1000.0;  // gamma, with volume forcing: density inside bodies over rho
  double courant_number = 0.25;     // largest |u| dt / dx
  double largest_step = std::numeric_limits<double>::infinity();  // s
  Index3 ranks{0, 0, 0};  // blocks per direction; 0 = choose
};

// Initial and, for the stand-alone solver, imposed state.
struct InitialState {
  Vec3 velocity = Vec3::Zero();  // m/s
};

// A bed of grains at rest that never moves: verification and packed beds of the stand-alone solver.
struct FixedBed {
  bool present = false;
  double void_fraction = 1.0;                       // inside the box
  double diameter = 0.0;                            // d0, m
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // box, m
  std::string drag = "gidaspow";                    // closure name, see coupling/shared/drag.hpp
};

// The value of `restart` that stands for the newest checkpoint of the output directory.
inline constexpr const char* latest_checkpoint = "latest";

struct RunControl {                  // stand-alone solver
  double end_time = 0.0;             // s
  double step = 0.0;                 // s; 0 = from the limits
  double checkpoint_interval = 0.0;  // s of simulated time; 0 = none but when it is stopped
  std::string restart;  // checkpoint to continue from: a path, "latest" or "" (start anew)
};

// Fields that a frame may hold.
inline constexpr std::array output_field_names{"velocity", "pressure", "void_fraction",
                                               "wall_fraction"};

struct Output {
  std::string directory;  // "" = no files
  double interval = 0.0;  // s of simulated time between frames; 0 = only the last
  std::vector<std::string> fields{output_field_names.begin(), output_field_names.end()};
};

struct GasCase {
  Grid grid;
  GasProperties gas;
  Boundaries boundaries;
  std::vector<BoundaryPatch> patches;
  std::vector<Body> bodies;
  Numerics numerics;
  InitialState initial;
  FixedBed fixed_bed;
  RunControl run;
  Output output;
  std::vector<ProbeSettings> probes;
  std::vector<ConfigStatement> statements;  // all that the case file says; empty without a file
};

// Reads all sections but [coupling], which is left to the coupling. Throws UserError:
// another section, an unknown key, a value out of the range that docs/case_file.md gives for it.
GasCase read_gas_case(const ConfigTable& file);

}  // namespace gasgrain::cfd
