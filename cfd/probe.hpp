// What a probe measures in the gas: rows of numbers under named columns.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "cfd/probe_case.hpp"

namespace gasgrain::cfd {

class Probe {
 public:
  virtual ~Probe() = default;
  // Without the time. Units are part of the names.
  virtual std::vector<std::string> columns() const = 0;
  // Rows of that many values, one after the other; complete on rank 0 only. NaN where there is no
  // gas. Collective.
  virtual std::vector<double> sample(const GasSolver& solver) const = 0;
};

// All are collective: every rank makes the same probes in the same order.

// Velocity, pressure and void fraction at points of a line, or at one.
std::unique_ptr<Probe> make_point_probe(const PointProbe& place, const Decomposition& blocks);
std::unique_ptr<Probe> make_line_probe(const LineProbe& place, const Decomposition& blocks);
// Flux through a plane, means over its open area.
std::unique_ptr<Probe> make_plane_probe(const PlaneProbe& place, const Decomposition& blocks);
// Means over the open volume of a box.
std::unique_ptr<Probe> make_box_probe(const BoxProbe& place, const Decomposition& blocks);
// Force and torque of the gas on a body.
std::unique_ptr<Probe> make_body_probe(const BodyProbe& place);

}  // namespace gasgrain::cfd
