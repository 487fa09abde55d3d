#include "cfd/side_states.hpp"

namespace gasgrain::cfd {

std::vector<SideState> side_states(const GasSolver& solver) {
  std::vector<SideState> states;
  for (int d = 0; d < 3; ++d) {
    const bool periodic = solver.decomposition().periodic()[d];
    for (int side = 0; side < (periodic ? 1 : 2); ++side) {
      states.push_back({names_of_sides[d][side], periodic,
                        periodic ? 0.0 : solver.side_pressure(d, side), solver.side_flux(d, side)});
    }
  }
  return states;
}

}  // namespace gasgrain::cfd
