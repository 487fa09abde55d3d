// The impulse that walls report closes the momentum balance of the grains to round-off, at every
// step and on any number of ranks.
#include "liggghts_plugins/grain_wall.hpp"

#include <atom.h>
#include <gtest/gtest.h>
#include <input.h>
#include <lammps.h>
#include <mpi.h>
#include <update.h>

#include <fstream>
#include <memory>
#include <regex>
#include <string>

#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/register.hpp"

namespace gasgrain::plugins {
namespace {

constexpr double gravity = 9.81;  // m/s^2, along -z

const char* const case_text = R"(
[[body]]
name = "floor"
plane = {point = [0, 0, 0.5e-3], normal = [0, 0.1, 1]}
[[body]]
name = "sides"
complement = {box = {lower = [0, 0, -1], upper = [0.01, 0.01, 1]}}
)";

const char* const script = R"(
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
region box block 0 0.01 0 0.01 0 0.02 units box
create_box 2 box
neighbor 1e-4 bin
neigh_modify delay 0
lattice sc 0.00115
region grains block 0.0009 0.0095 0.0009 0.0095 0.0014 0.008 units box
create_atoms 1 region grains
set group all diameter 1e-3 density 2500
velocity all set 0.2 -0.1 -0.3
fix k all property/global cgmSpringConstant peratomtypepair 2 50 50 50 50
fix e all property/global coefficientRestitution peratomtypepair 2 0.8 0.8 0.8 0.8
fix m all property/global coefficientFriction peratomtypepair 2 0.4 0.4 0.4 0.4
pair_style gran model cgm tangential history
pair_coeff * *
timestep 1e-5
fix gravity all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
fix floor all wall/sdf case CASE_FILE body floor type 2
fix sides all wall/sdf case CASE_FILE body sides type 2
fix lid all wall/gran model cgm tangential history primitive type 2 xplane 0.0002
thermo_modify lost error
)";

class LiggghtsRun {
 public:
  LiggghtsRun() {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const std::string case_file = "grain_wall_test." + std::to_string(ranks) + ".toml";
    if (rank == 0) std::ofstream(case_file) << case_text;
    MPI_Barrier(MPI_COMM_WORLD);
    std::string words[] = {"test", "-log", "none", "-screen", "/dev/null", "-echo", "none"};
    char* arguments[std::size(words)];
    for (std::size_t i = 0; i < std::size(words); ++i) arguments[i] = words[i].data();
    liggghts_ = std::make_unique<LAMMPS_NS::LAMMPS>(static_cast<int>(std::size(words)), arguments,
                                                    MPI_COMM_WORLD);
    register_styles(*liggghts_);
    commands(std::regex_replace(script, std::regex("CASE_FILE"), case_file));
  }

  void commands(const std::string& text) {
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = text.find('\n', begin);
      const std::string line = text.substr(begin, end - begin);
      if (!line.empty()) liggghts_->input->one(line.c_str());
      begin = end == std::string::npos ? text.size() : end + 1;
    }
  }

  LAMMPS_NS::LAMMPS& liggghts() { return *liggghts_; }

  struct Momentum {
    Vec3 momentum = Vec3::Zero();  // N s
    double mass = 0;               // kg
  };
  Momentum momentum() const {
    const LAMMPS_NS::Atom& atom = *liggghts_->atom;
    Vec3 local = Vec3::Zero();
    double local_mass = 0;
    for (int i = 0; i < atom.nlocal; ++i) {
      local += atom.rmass[i] * Eigen::Map<Vec3>(atom.v[i]);
      local_mass += atom.rmass[i];
    }
    Momentum sum;
    MPI_Allreduce(local.data(), sum.momentum.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(&local_mass, &sum.mass, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
  }

  // Of all walls, over all ranks.
  Vec3 take_impulse() {
    Vec3 local = Vec3::Zero(), sum;
    for (GrainWall* wall : grain_walls(*liggghts_)) local += wall->take_impulse();
    MPI_Allreduce(local.data(), sum.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
  }

 private:
  std::unique_ptr<LAMMPS_NS::LAMMPS> liggghts_;
};

// One LIGGGHTS instance for all tests: a process holds one.
class GrainWallTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { instance_ = std::make_unique<LiggghtsRun>(); }
  static void TearDownTestSuite() { instance_.reset(); }
  LiggghtsRun& run = *instance_;

 private:
  static std::unique_ptr<LiggghtsRun> instance_;
};
std::unique_ptr<LiggghtsRun> GrainWallTest::instance_;

TEST_F(GrainWallTest, impulse_on_walls_closes_the_momentum_balance) {
  ASSERT_EQ(grain_walls(run.liggghts()).size(), 3u);
  run.commands("run 0\n");
  run.take_impulse();
  LiggghtsRun::Momentum before = run.momentum();
  const double unit = before.mass * 0.3;
  bool touched = false;
  for (const int steps : {1, 1, 7, 500, 1, 1000, 333}) {
    run.commands("run " + std::to_string(steps) + "\n");
    const Vec3 impulse = run.take_impulse();
    const LiggghtsRun::Momentum after = run.momentum();
    const double time = steps * 1e-5;
    const Vec3 weight(0, 0, -gravity * before.mass * time);
    const Vec3 residual = after.momentum - before.momentum - weight + impulse;
    EXPECT_LT(residual.norm() / unit, 1e-12) << "after " << steps << " steps";
    touched = touched || impulse.norm() > 0.1 * unit;
    before = after;
  }
  EXPECT_TRUE(touched);
}

TEST_F(GrainWallTest, largest_overlap_is_taken_once) {
  run.commands("run 2000\n");
  const LargestOverlap seen = contact_statistics().take();
  double local[2] = {seen.length, seen.relative}, largest[2];
  MPI_Allreduce(local, largest, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  // head-on impact at 0.3 m/s gives v sqrt(m/k) = 5e-5 m; a bed of grains some times that
  EXPECT_GT(largest[0], 1e-6);
  EXPECT_LT(largest[0], 5e-4);
  EXPECT_GT(largest[1], largest[0] / 1.1e-3);
  EXPECT_EQ(contact_statistics().take().length, 0.0);
}

}  // namespace
}  // namespace gasgrain::plugins
