// Sums over control volumes that make up the momentum budget of a step.
#pragma once

#include <array>
#include <vector>

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/gas_solver.hpp"

namespace gasgrain::cfd {

// All sums are of this rank only.

// sum of eps rho u V, kg m/s.
Vec3 gas_momentum(const GasDomain& domain, const FaceMedium& medium, const VectorField& velocity);

// sum of field * V over faces that take part.
Vec3 volume_integral(const GasDomain& domain, const VectorField& field);

// Adds gravity, drag and both shares of the pressure gradient over a step of dt with the velocity
// at its end. Returns gas_momentum() with that velocity, a by-product of the sweep.
Vec3 add_forces(MomentumBudget& budget, const GasDomain& domain, const FaceMedium& medium,
                const VectorField& velocity, const VectorField& pressure_gradient, double dt);

// Pressure on a side of the grid times open area, N, extrapolated from the cells next to it: the
// face behind them has a control volume of 3/2 cells, hence half a cell of its gradient more.
double side_force(const GasDomain& domain, const Field& pressure,
                  const VectorField& pressure_gradient, int direction, int side);
double side_open_area(const GasDomain& domain, int direction, int side);  // m^2

// Owned cells whose two faces along a direction have different control volumes, as storage indices:
// cells at bodies and sides. Again after the walls have moved.
using UnevenCells = std::array<std::vector<std::ptrdiff_t>, 3>;
UnevenCells find_uneven_cells(const GasDomain& domain);

// Adds the same pressure force from the cells' side: of the sides and of the bodies. A
// `uniform_gradient` [Pa/m] of a periodic direction acts on the whole cross-section of its sides;
// what bodies occupy of the volume between is taken by them.
void add_pressure_reactions(MomentumBudget& budget, const GasDomain& domain,
                            const UnevenCells& uneven, const Field& pressure,
                            const VectorField& pressure_gradient, const Vec3& uniform_gradient,
                            double dt);

// Sums every row over all ranks.
void sum_over_ranks(const Decomposition& decomposition, MomentumBudget& budget);

}  // namespace gasgrain::cfd
