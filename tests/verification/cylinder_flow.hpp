// Flow past a fixed cylinder across the x-z plane: in a channel (Schaefer and Turek 1996, 2D-1 and
// 2D-2) and free.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"

namespace gasgrain::verification {

// Where the cylinder is and what its coefficients are made with.
struct CylinderFlow {
  cfd::GasCase gas_case;
  double diameter = 0.1;  // m
  double speed = 0.2;     // m/s
  Vec3 centre = Vec3::Zero();
  bool half = false;  // only z > centre is in the grid, behind a slip side
};

// Channel 2.2 m x 0.41 m with a parabolic inlet of mean `speed`, nu = 1e-3 m^2/s, and `cells` per
// diameter (of 0.1 m).
CylinderFlow channel_with_cylinder(int cells, double speed);

// Diameter and oncoming speed 1, `cells` per diameter, in a grid that leaves `before` and `behind`
// diameters to inlet and outlet and `beside` to the slip sides.
struct FreeStream {
  double reynolds_number;
  int cells, before, behind, beside;
};
CylinderFlow free_cylinder(const FreeStream& stream);
CylinderFlow half_free_cylinder(const FreeStream& stream);

std::unique_ptr<cfd::GasSolver> start(const CylinderFlow& flow, const cfd::GasSolver* coarser);

struct ForceCoefficients {
  double drag, lift;
};
// Of the last step, F / (rho U^2 D/2 L): as the solver states the load on the body.
ForceCoefficients force_coefficients(const CylinderFlow& flow, const cfd::GasSolver& solver);
// The same from a control volume of 2 D around the cylinder, for steady flow.
ForceCoefficients control_volume_coefficients(const CylinderFlow& flow,
                                              const cfd::GasSolver& solver);

// Between the two points where the centre line meets the cylinder, Pa.
double pressure_difference(const CylinderFlow& flow, const cfd::GasSolver& solver);
// From the cylinder to where the backflow on the centre line ends, m; 0 without backflow.
double wake_length(const CylinderFlow& flow, const cfd::GasSolver& solver);

// Time series of a flow that sheds vortices.
struct Trace {
  std::vector<double> time, drag, lift;
};
void advance_and_record(Trace& trace, const CylinderFlow& flow, cfd::GasSolver& solver,
                        double duration);

}  // namespace gasgrain::verification
