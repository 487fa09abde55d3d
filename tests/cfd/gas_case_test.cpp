#include <gtest/gtest.h>

#include "cfd/gas_case.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

const std::string complete = R"(
[grid]
lower = [0, 0, 0]
upper = [1, 2, 3]
cells = [4, 5, 6]
[gas]
density = 1.2
viscosity = 1.8e-5
gravity = [0, 0, -9.81]
[boundary]
x_lower = {type = "no-slip", wall_velocity = [0, 1, 0]}
x_upper = {type = "slip"}
y_lower = {type = "periodic"}
y_upper = {type = "periodic"}
z_lower = {type = "inlet", superficial_velocity = 0.2}
z_upper = {type = "outlet", pressure = 5}
[numerics]
convection = "central"
pressure_solver = "hypre-smg"
pressure_fallback = "none"
pressure_tolerance = 1e-8
[fixed_bed]
void_fraction = 0.4
diameter = 1e-3
[coupling]
anything = 1
)";

GasCase read(const std::string& text) {
  return read_gas_case(ConfigTable::parse(text, "c.toml"));
}

void expect_error(const std::string& text, const std::string& part) {
  expect_contains(user_error([&] { read(text); }), part);
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = complete;
  return text.replace(text.find(from), from.size(), to);
}

TEST(GasCase, reads_every_section) {
  const GasCase c = read(complete);
  EXPECT_EQ(c.grid.cells, (Index3{4, 5, 6}));
  EXPECT_EQ(c.gas.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(c.boundaries[0][0].wall_velocity, Vec3(0, 1, 0));
  EXPECT_EQ(c.boundaries[1][0].type, BoundaryType::periodic);
  EXPECT_EQ(c.boundaries[2][0].superficial_velocity, Vec3(0, 0, 0.2));
  EXPECT_EQ(c.boundaries[2][1].pressure, 5.0);
  EXPECT_EQ(c.numerics.convection, Convection::central);
  EXPECT_EQ(c.numerics.pressure_solver, PressureMethod::hypre_smg);
  EXPECT_EQ(c.numerics.pressure_fallback, PressureFallback::none);
  EXPECT_TRUE(c.fixed_bed.present);
  EXPECT_EQ(c.fixed_bed.upper, c.grid.upper);
}

TEST(GasCase, an_inlet_number_points_inwards_at_the_upper_side_too) {
  const GasCase c = read(with("z_upper = {type = \"outlet\", pressure = 5}",
                              "z_upper = {type = \"inlet\", superficial_velocity = 0.3}"));
  EXPECT_EQ(c.boundaries[2][1].superficial_velocity, Vec3(0, 0, -0.3));
}

TEST(GasCase, errors_name_file_line_and_key_and_suggest_the_nearest) {
  expect_error(with("density", "densty"),
               "c.toml:7: gas.densty: is not a known key; did you mean 'density'?");
  expect_error(with("[numerics]", "[numeric]"), "did you mean 'numerics'");
  expect_error(with("\"slip\"", "\"slipp\""), "did you mean 'slip'");
  expect_error(with("x_upper", "x_uper"), "did you mean 'x_upper'");
}

TEST(GasCase, values_out_of_range_are_errors) {
  expect_error(with("density = 1.2", "density = 0"), "gas.density: is 0, but must be in (0");
  expect_error(with("viscosity = 1.8e-5", "viscosity = -1"),
               "gas.viscosity: is -1, but must be in [0");
  expect_error(with("cells = [4, 5, 6]", "cells = [4, 0, 6]"),
               "grid.cells: is [4, 0, 6], but must hold three integers in [1");
  expect_error(with("upper = [1, 2, 3]", "upper = [1, -2, 3]"),
               "grid.upper: is (1, -2, 3), but must exceed grid.lower = (0, 0, 0)");
  expect_error(with("void_fraction = 0.4", "void_fraction = 1.4"),
               "fixed_bed.void_fraction: is 1.4, but must be in (0, 1)");
  expect_error(with("pressure_tolerance = 1e-8", "pressure_tolerance = 0"),
               "numerics.pressure_tolerance: is 0");
}

TEST(GasCase, output_fields_are_known_ones_named_once) {
  EXPECT_EQ(read(complete).output.fields.size(), 4U);
  const auto output = [](const std::string& fields) {
    return complete + "[output]\nfields = " + fields + "\n";
  };
  EXPECT_EQ(read(output("['pressure', 'velocity']")).output.fields,
            (std::vector<std::string>{"pressure", "velocity"}));
  expect_error(output("['presure']"), "output.fields: has no field 'presure'");
  expect_error(output("['pressure', 'pressure']"), "twice");
  expect_error(output("[]"), "is empty");
}

TEST(GasCase, density_scaling_belongs_to_volume_forcing) {
  const std::string forcing = "[numerics]\nimmersed_boundary = \"volume-forcing\"\n";
  const Numerics n = read(with("[numerics]\n", forcing + "density_scaling = 500\n")).numerics;
  EXPECT_EQ(n.immersed_boundary, BodyMethod::volume_forcing);
  EXPECT_EQ(n.density_scaling, 500.0);
  EXPECT_EQ(read(with("[numerics]\n", forcing)).numerics.density_scaling, 1000.0);
  EXPECT_EQ(read(complete).numerics.immersed_boundary, BodyMethod::interpolation);
  expect_error(with("[numerics]\n", forcing + "density_scaling = 0.5\n"),
               "numerics.density_scaling: is 0.5, but must be in [1");
  expect_error(with("[numerics]\n", "[numerics]\ndensity_scaling = 500\n"), "volume-forcing");
}

TEST(GasCase, implicit_viscosity_needs_ab2_and_interpolation) {
  const std::string viscous = "[numerics]\nviscosity = \"implicit\"\n";
  EXPECT_EQ(read(with("[numerics]\n", viscous)).numerics.viscosity, Viscosity::implicit_step);
  EXPECT_EQ(read(complete).numerics.viscosity, Viscosity::explicit_step);
  expect_error(with("[numerics]\n", viscous + "time_scheme = \"rk2\"\n"), "ab2");
  expect_error(with("[numerics]\n", viscous + "immersed_boundary = \"volume-forcing\"\n"),
               "interpolation");
}

TEST(GasCase, boundaries_that_cannot_be_are_errors) {
  expect_error(with("y_lower = {type = \"periodic\"}", "y_lower = {type = \"slip\"}"),
               "boundary.y_lower: must be periodic too");
  expect_error(with("[0, 1, 0]", "[1, 0, 0]"), "wall_velocity: has a component across the side");
  expect_error(with("velocity = 0.2", "velocity = [0, 0, -1]"),
               "superficial_velocity: points out of the grid");
  expect_error(with("{type = \"slip\"}", "{type = \"slip\", pressure = 1}"),
               "pressure: belongs to");
  expect_error(with("{type = \"slip\"}", "{type = \"inlet\"}"), "superficial_velocity: is missing");
}

}  // namespace
}  // namespace gasgrain::cfd
