// Gas fields for ParaView: cell-centred velocity, pressure, void fraction and wall fraction.
#pragma once

#include <string>

#include "cfd/gas_solver.hpp"
#include "coupling/files/frame_writer.hpp"

namespace gasgrain::cfd {

// Collective: appends the present state to the series.
void write_frame(FrameWriter& writer, const GasSolver& solver, double time);

}  // namespace gasgrain::cfd
