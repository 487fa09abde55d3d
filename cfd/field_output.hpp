// Gas fields for ParaView, in cells: velocity, pressure, void fraction and wall fraction, those of
// them that `output.fields` of the case names.
#pragma once

#include "cfd/gas_solver.hpp"
#include "coupling/files/frame_writer.hpp"

namespace gasgrain::cfd {

// Collective: appends the present state to the series. The velocity is the mean of a cell's faces.
void write_frame(FrameWriter& writer, const GasSolver& solver, double time);
// The same with the velocity that is given in cells, m/s.
void write_frame(FrameWriter& writer, const GasSolver& solver, double time,
                 const VectorField& velocity_in_cells);

}  // namespace gasgrain::cfd
