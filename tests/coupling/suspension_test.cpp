// Gas and clouds of grains without a DEM code: momentum, hindered settling, drag that follows the
// grains.
#include <gtest/gtest.h>

#include <cmath>

#include "cfd/loops.hpp"
#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

// Cells of 0.25 mm across; `z`: condition of both ends.
std::string column(const std::string& z, double height, const std::string& coupling,
                   double viscosity = 1e-3, double cell_height = 0.25e-3) {
  const GasCaseText gas{.upper = Vec3(0.001, 0.001, height),
                        .cells = {4, 4, static_cast<int>(std::lround(height / cell_height))},
                        .gas = {.density = 10.0, .viscosity = viscosity},
                        .x = {"periodic", "periodic"},
                        .y = {"periodic", "periodic"},
                        .z = {z, z}};
  return gas.text() +
         "[numerics]\nconvection = \"none\"\npressure_tolerance = 1e-11\n[coupling]\n" + coupling;
}

// Grains of 0.1 mm on a cubic lattice of `per_side` places per mm, between two heights.
std::vector<GrainRecord> cloud(int per_side, double lower, double upper, const Vec3& velocity) {
  const GrainKind kind{.original_diameter = 1e-4, .ratio = 1, .density = 2500};
  const double spacing = 0.001 / per_side;
  std::vector<GrainRecord> grains;
  for (double z = lower + 0.5 * spacing; z < upper; z += spacing)
    for (int j = 0; j < per_side; ++j)
      for (int i = 0; i < per_side; ++i) {
        grains.push_back(kind.record(Vec3((i + 0.5) * spacing, (j + 0.5) * spacing, z), velocity));
      }
  return grains;
}

Vec3 momentum(const std::vector<GrainRecord>& grains) {
  Vec3 sum = Vec3::Zero();
  for (const GrainRecord& grain : grains) sum += grain.mass * grain.velocity;
  return sum;
}

// sum eps rho u V of a periodic box, from the fields.
Vec3 gas_momentum(const GasCoupling& coupling) {
  const cfd::GasSolver& gas = coupling.gas();
  Vec3 sum = Vec3::Zero();
  cfd::for_each_cell(gas.decomposition().block().size, [&](int i, int j, int k) {
    const std::ptrdiff_t n = gas.void_fraction().index(i, j, k);
    for (int d = 0; d < 3; ++d) {
      const std::ptrdiff_t below = n - gas.void_fraction().stride(d);
      const double eps = 0.5 * (gas.void_fraction()[n] + gas.void_fraction()[below]);
      sum[d] += eps * gas.velocity()[d][n];
    }
  });
  return sum * gas.gas_case().gas.density * gas.decomposition().grid().cell_volume();
}

// The interval's motion of grains whose drag follows their velocity, F = h - B v, in `steps` steps.
void follow(std::vector<GrainRecord>& grains, const std::vector<Vec3>& forces,
            const std::vector<double>& coefficients, double interval, double given, int steps) {
  const double dt = interval / steps;
  for (std::size_t n = 0; n < grains.size(); ++n) {
    GrainRecord& grain = grains[n];
    const Vec3 start = grain.velocity;
    const Vec3 held = forces[n] + coefficients[n] * grain.velocity;
    for (int s = 0; s < steps; ++s) {
      const Vec3 force = held - coefficients[n] * grain.velocity;
      grain.velocity += dt / grain.mass * force;
      grain.position += dt * grain.velocity;
    }
    grain.carried = grain.mass * (grain.velocity - start) - given * forces[n];
  }
}

// The grains exchange momentum in their places: where the void fraction changes, the advective form
// of the gas's equation leaves a remainder in its momentum.
void keeps_the_momentum(const std::string& coupling_options) {
  const CoupledCase given(column("periodic", 0.002, coupling_options));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<GrainRecord> grains = cloud(5, 0.0004, 0.0014, Vec3(0.02, 0.01, 0.05));
  std::vector<Vec3> forces(grains.size(), Vec3::Zero());
  coupling.begin(forces, grains);
  const Vec3 total = momentum(grains);
  const double dt = 5e-5;
  Vec3 transit = Vec3::Zero();  // given by the gas, not yet received
  for (int step = 0; step < 60; ++step) {
    if (step > 0) {
      for (std::size_t n = 0; n < grains.size(); ++n)
        grains[n].velocity += dt / grains[n].mass * forces[n];
    }
    const ExchangeReport report = coupling.exchange(forces, grains, dt);
    transit = dt * report.force_on_grains;
    EXPECT_LT(report.third_law_residual, 1e-12);
  }
  const Vec3 now = momentum(grains) + transit + gas_momentum(coupling);
  EXPECT_LT((now - total).norm(), 1e-10 * total.norm());
  EXPECT_LT(momentum(grains).norm(), 0.9 * total.norm());  // the gas took part of it
}

TEST(Suspension, impulse_between_gas_and_a_cloud_keeps_the_momentum) {
  keeps_the_momentum("");
}

TEST(Suspension, viscous_stress_on_a_cloud_keeps_the_momentum) {
  keeps_the_momentum("viscous_stress = true\n");
}

// A uniform suspension in a closed column: weight against drag B v/eps and the pressure gradient of
// the weight of the mixture gives m g eps = B v/eps. With Wen & Yu's drag of small Re,
// B = 3 pi mu d eps^-2.65, so v = v_t eps^4.65, Richardson and Zaki's law.
TEST(Suspension, settles_by_the_law_of_richardson_and_zaki) {
  const double terminal = 2500 * 9.81 * 1e-8 / (18 * 1e-3);
  std::vector<double> logs_eps, logs_v;
  for (const int per_side : {4, 5, 6}) {
    const CoupledCase given(column("no-slip", 0.004, ""));
    GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
    const double eps = 1.0 - M_PI / 6 * std::pow(0.1 * per_side, 3);
    const double law = terminal * std::pow(eps, 4.65);
    std::vector<GrainRecord> grains = cloud(per_side, 0.0, 0.004, Vec3(0, 0, -0.9 * law));
    std::vector<Vec3> forces(grains.size(), Vec3::Zero());
    coupling.begin(forces, grains);
    const double dt = 5e-5;
    for (int step = 0; step < 160; ++step) {  // six relaxation times; 0.1 mm of way at most
      for (std::size_t n = 0; n < grains.size(); ++n) {
        GrainRecord& grain = grains[n];
        grain.velocity += dt * (forces[n] / grain.mass - Vec3(0, 0, 9.81));
        if (grain.position[2] + dt * grain.velocity[2] > 0.00005)
          grain.position += dt * grain.velocity;
      }
      coupling.exchange(forces, grains, dt);
    }
    double sum = 0;
    int count = 0;
    for (const GrainRecord& grain : grains) {
      if (grain.position[2] < 0.0013 || grain.position[2] > 0.0027) continue;
      sum -= grain.velocity[2];
      ++count;
    }
    EXPECT_NEAR(sum / count / law, 1.0, 0.02) << "eps " << eps;
    logs_eps.push_back(std::log(eps));
    logs_v.push_back(std::log(sum / count));
  }
  const double exponent = (logs_v[2] - logs_v[0]) / (logs_eps[2] - logs_eps[0]);
  EXPECT_NEAR(exponent, 4.65, 0.15);
  RecordProperty("exponent", std::to_string(exponent));
}

// The difference of impulses goes back to the gas: nothing is lost but what is on its way and the
// remainder of the advective form, which is reported and small.
TEST(Suspension, drag_that_follows_the_grains_keeps_the_momentum) {
  const CoupledCase given(column("periodic", 0.002, "drag_update = \"dem-step\"\n"));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<GrainRecord> grains = cloud(5, 0.0004, 0.0014, Vec3(0.02, 0.01, 0.05));
  std::vector<Vec3> forces(grains.size(), Vec3::Zero());
  std::vector<double> coefficients(grains.size(), 0.0);
  coupling.begin(forces, grains);
  const Vec3 total = momentum(grains);
  Vec3 transit = Vec3::Zero(), remainder = Vec3::Zero();
  double last = 0.0;
  for (int step = 0; step < 60; ++step) {
    const double interval = step % 3 == 0 ? 5e-5 : 3e-5;
    if (last > 0) follow(grains, forces, coefficients, interval, last, 10);
    const ExchangeReport report = coupling.exchange(forces, grains, interval);
    coupling.coefficients_of(coefficients);
    last = interval;
    transit = interval * report.force_on_grains;
    remainder += report.gas_momentum.convection;
    EXPECT_LT(report.third_law_residual, 1e-12);
  }
  const Vec3 now = momentum(grains) + transit + gas_momentum(coupling);
  EXPECT_LT((now - remainder - total).norm(), 1e-10 * total.norm());
  EXPECT_LT(remainder.norm(), 1e-5 * total.norm());
}

// Held drag and intervals that change their length: gas and grains give back what is owed.
TEST(Suspension, intervals_of_changing_length_keep_the_momentum) {
  const CoupledCase given(column("periodic", 0.002, ""));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<GrainRecord> grains = cloud(5, 0.0004, 0.0014, Vec3(0.02, 0.01, 0.05));
  std::vector<Vec3> forces(grains.size(), Vec3::Zero());
  coupling.begin(forces, grains);
  const Vec3 total = momentum(grains);
  Vec3 transit = Vec3::Zero();
  double last = 0.0;
  for (int step = 0; step < 60; ++step) {
    const double interval = step % 3 == 0 ? 5e-5 : 3e-5;
    for (std::size_t n = 0; n < grains.size() && last > 0; ++n) {
      grains[n].velocity += interval / grains[n].mass * forces[n];
      grains[n].carried = (interval - last) * forces[n];
    }
    const ExchangeReport report = coupling.exchange(forces, grains, interval);
    last = interval;
    transit = interval * report.force_on_grains;
    EXPECT_LT(report.third_law_residual, 1e-12);
  }
  const Vec3 now = momentum(grains) + transit + gas_momentum(coupling);
  EXPECT_LT((now - total).norm(), 1e-10 * total.norm());
}

// A plug that moves as one in a closed tube, eps u + (1 - eps) v = 0, sets the gas between its
// grains in motion against it: (M + M_gas) dv/dt = F with
//
//   M_gas = rho A integral of (1 - eps)^2/eps dz.
//
// Without drag to speak of the grains follow the constant force F by that law. From rest they are
// faster for a few intervals, until the gas's resistance is felt in full: the first third is left
// out. Returns the relative error of the velocity gained; M_gas/M in `displaced`.
double error_of_plug(double density, double cell_height, double& displaced) {
  const CoupledCase given(column("no-slip", 0.003, "", 1e-12, cell_height));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<GrainRecord> grains = cloud(10, 0.0008, 0.0019, Vec3::Zero());
  double mass = 0.0;
  for (GrainRecord& grain : grains) mass += grain.mass = density * grain.volume;
  std::vector<Vec3> forces(grains.size(), Vec3::Zero());
  coupling.begin(forces, grains);
  const cfd::Field& eps = coupling.void_fraction();
  double integral = 0.0;
  cfd::for_each_cell(eps.size(), [&](int i, int j, int k) {
    integral += (1 - eps(i, j, k)) * (1 - eps(i, j, k)) / eps(i, j, k);
  });
  const double gas_density = 10.0;
  displaced = gas_density * integral * coupling.gas().decomposition().grid().cell_volume() / mass;
  const double dt = 1e-4, acceleration = 1e-4;  // so slow that drag is nothing
  constexpr int steps = 150, first = 50;
  double velocity = 0.0, at_first = 0.0;
  for (int step = 0; step < steps; ++step) {
    if (step == first) at_first = velocity;
    Vec3 gas = Vec3::Zero();
    for (const Vec3& force : forces) gas += force;
    const double before = velocity;
    velocity += dt * (acceleration + gas[2] / mass);
    for (GrainRecord& grain : grains) {
      grain.velocity = Vec3(0, 0, velocity);
      grain.position[2] += 0.5 * dt * (before + velocity);
    }
    const ExchangeReport report = coupling.exchange(forces, grains, dt);
    EXPECT_LT(report.third_law_residual, 1e-12);
    EXPECT_LT(report.pressure_residual, 1e-12);
  }
  const double law = acceleration * (steps - first) * dt / (1 + displaced);
  return (velocity - at_first) / law - 1;
}

// At the last density the displaced gas weighs more than the grains: a force that came an interval
// after its cause would grow from interval to interval. Second order in the cell.
TEST(Suspension, plug_carries_the_inertia_of_the_gas_that_it_displaces) {
  for (const double density : {2500.0, 12.0, 5.0}) {
    double displaced = 0.0;
    const double coarse = std::abs(error_of_plug(density, 0.25e-3, displaced));
    const double fine = std::abs(error_of_plug(density, 0.125e-3, displaced));
    EXPECT_LT(fine, 0.01) << density << ": displaced " << displaced;
    EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " and " << fine;
    RecordProperty("at_density_" + std::to_string(static_cast<int>(density)), std::to_string(fine));
  }
}

// One grain in a wide stream, exchanges four times its relaxation time apart: held drag throws it
// to and fro with growing amplitude, drag that follows it brings it to the gas's velocity.
TEST(Suspension, drag_that_follows_the_grains_has_no_limit_of_its_own) {
  const CoupledCase given(column("periodic", 0.002, "feedback = \"one-way\""));
  const double relaxation = 2500 * 1e-8 / (18 * 1e-3);
  double left[2];
  for (const bool follows : {false, true}) {
    GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
    std::vector<GrainRecord> grain{cloud(1, 0.0, 0.001, Vec3(0, 0, 0.01))};
    std::vector<Vec3> force(1, Vec3::Zero());
    std::vector<double> coefficient(1, 0.0);
    coupling.begin(force, grain);
    coupling.coefficients_of(coefficient);
    const double interval = 4 * relaxation;
    for (int step = 0; step < 5; ++step) {
      if (follows) {
        follow(grain, force, coefficient, interval, interval, 200);
      } else {
        grain[0].velocity += interval / grain[0].mass * force[0];
      }
      coupling.exchange(force, grain, interval);
      coupling.coefficients_of(coefficient);
    }
    left[follows] = std::abs(grain[0].velocity[2]) / 0.01;
  }
  EXPECT_GT(left[0], 10.0);
  EXPECT_LT(left[1], 1e-6);
}

}  // namespace
}  // namespace gasgrain::coupling
