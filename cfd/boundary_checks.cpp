#include "cfd/boundary_checks.hpp"

#include <algorithm>
#include <sstream>

#include "cfd/halo_exchange.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

// Sums over all ranks, per part of the sides; the flux also per region without outlet.
struct Openings {
  std::vector<double> area;                  // m^2
  std::vector<std::vector<double>> trapped;  // [region][part], m^3/s into regions without outlet
};

Openings measure(const GasDomain& domain, const GasRegions& regions) {
  const SideConditions& sides = domain.sides;
  const std::size_t parts = sides.parts().size();
  Openings openings{std::vector<double>(parts, 0.0), {}};
  openings.trapped.assign(regions.regions.size(), std::vector<double>(parts, 0.0));
  const Index3& size = domain.size();
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      if (!domain.decomposition.at_boundary(d, side)) continue;
      for_each_in(plane_of(domain, d, domain.side_layer(d, side)), [&](int i, int j, int k) {
        const Index3 cell = domain.global_cell(i, j, k);
        const std::size_t part = sides.part(d, side, cell);
        const std::ptrdiff_t n = domain.open_share.index(i, j, k);
        const std::ptrdiff_t face = n + (side == 1 ? domain.open_share.stride(d) : 0);
        const double area = domain.walls.open_area[d][face] * domain.face_area(d);
        openings.area[part] += area;
        const int region = regions.region_of_cell[i + std::size_t(size[0]) * (j + size[1] * k)];
        const Boundary& stated = sides.parts()[part].stated;
        if (region == GasRegions::none || stated.type != BoundaryType::inlet) return;
        const double speed = std::abs(stated.superficial_velocity[d]);
        openings.trapped[region][part] += area * speed * stated.factor.largest_magnitude();
      });
    }
  }
  sum_over_ranks(domain.decomposition, openings.area);
  for (std::vector<double>& fluxes : openings.trapped) sum_over_ranks(domain.decomposition, fluxes);
  return openings;
}

void check_covered(const GasDomain& domain, const Openings& openings) {
  const std::vector<SidePart>& parts = domain.sides.parts();
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const BoundaryType type = parts[n].stated.type;
    const bool flows = type == BoundaryType::inlet || type == BoundaryType::outlet;
    if (!flows || parts[n].faces == 0 || openings.area[n] > 0.0) continue;
    throw UserError(title(parts[n]) + ": bodies cover all of its " +
                    std::to_string(parts[n].faces) +
                    " faces, so no gas can pass; move the bodies or make it a wall");
  }
}

void check_trapped(const GasDomain& domain, const GasRegions& regions, const Openings& openings) {
  for (std::size_t r = 0; r < regions.regions.size(); ++r) {
    if (regions.regions[r].has_outlet) continue;
    std::ostringstream inlets;
    double total = 0.0;
    for (std::size_t n = 0; n < openings.trapped[r].size(); ++n) {
      if (openings.trapped[r][n] == 0.0) continue;
      total += openings.trapped[r][n];
      inlets << (inlets.str().empty() ? "" : ", ") << title(domain.sides.parts()[n]) << " "
             << openings.trapped[r][n] << " m^3/s";
    }
    if (total == 0.0) continue;
    std::ostringstream message;
    const Index3& cell = regions.regions[r].first_cell;
    const Vec3 steps(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
    const Vec3 place = domain.decomposition.grid().lower + steps.cwiseProduct(domain.spacing);
    message << "the gas around " << text(place) << " m has no outlet, but " << total
            << " m^3/s blow into it (" << inlets.str()
            << "); give it an outlet of the same region, or take its inlets away";
    throw UserError(message.str());
  }
}

}  // namespace

void check_boundaries(const GasDomain& domain, const GasRegions& regions) {
  for (const Body& body : domain.bodies) {
    if (body.acts_on_gas && body.motion.sweeps()) return;
  }
  const Openings openings = measure(domain, regions);
  check_covered(domain, openings);
  check_trapped(domain, regions, openings);
}

}  // namespace gasgrain::cfd
