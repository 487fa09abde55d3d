// `run_style verlet` with the inner loop of our own: the fused engine as LIGGGHTS sees it.
//
// Between reneighbourings the grains live in GrainLoop. The atom arrays are brought up to date when
// somebody looks at them: output, fixes that act at the end of a step, reneighbouring, the end of a
// run. Reneighbouring itself, exchange between ranks, insertion and the memory of contacts are
// LIGGGHTS's own, called as Verlet calls them; so are whole steps in which pressure or energy of
// the pair style are asked for.
//
// A step n: [positions of n are known] forces -> half a kick: the end of step n -> half a kick,
// drift to n + 1. Unless somebody may change the grains at the end of step n, the two half kicks
// are one, and the arrays get the end of the step in passing when somebody reads them.
#pragma once

#include <verlet.h>

#include <vector>

#include "liggghts_plugins/engine/ghost_exchange.hpp"
#include "liggghts_plugins/engine/grain_loop.hpp"
#include "liggghts_plugins/engine/mesh_wall_loads.hpp"
#include "liggghts_plugins/engine/pair_search.hpp"
#include "liggghts_plugins/engine/scene_plan.hpp"
#include "liggghts_plugins/engine/stream_grains.hpp"

namespace gasgrain::plugins {

class FusedVerlet : public LAMMPS_NS::Verlet {
 public:
  explicit FusedVerlet(LAMMPS_NS::LAMMPS* liggghts) : Verlet(liggghts, 0, nullptr) {}

  void setup() override;
  void run(int steps) override;

 private:
  // What becomes of the end of a step.
  enum class StepEnd {
    passed,  // nobody looks: the two half kicks are one
    shown,   // the atom arrays hold it, for reading; the grains go on
    closed   // the grains stop there, and go on from the atom arrays
  };

  void plan();
  void print_plan() const;

  // One step each.
  void fused_step();
  void stock_step();
  bool stock_step_due(LAMMPS_NS::bigint step) const;

  void open_step();
  bool reneighbouring_due();
  void reneighbour();
  StepEnd who_looks_at_the_end() const;
  bool is_stream(const LAMMPS_NS::Fix* fix) const;
  void compute_outside_loads();
  void force_pass(StepEnd end);
  void act_at_the_end(StepEnd end);
  void write_output();

  // Between the atom arrays and our records.
  LAMMPS_NS::NeighList& pair_list() const;
  const LAMMPS_NS::NeighList* history_list() const;
  void load_grains();
  void load_pairs();
  void load_state();
  void store_state(int from);
  void show_grain(int i, const LoadRecord& load, const HeldForces& held, double half_kick);
  void store_histories();

  void note_drift(double square_speed);
  bool restart_file_due();
  const double* built_at(int i) const;
  double displacement_since_build() const;
  double largest_of_ranks(double value) const;

  ScenePlan plan_;
  bool planned_ = false;
  bool lists_are_fresh_ = false;  // built for the present positions, by setup()

  GrainLoop loop_;
  PairSearch search_;
  GhostExchange ghosts_;
  std::vector<MeshWallLoads> mesh_loads_;
  StreamGrains streams_;
  // Positions of local grains when the lists were built, unless LIGGGHTS keeps them, too.
  std::vector<Vec3> built_at_;
  double moved_ = 0;  // m, bound on the displacement since then, of all ranks
  bool reneighbour_next_ = false;
  bool closed_ = true;  // the atom arrays hold the end of the present step
  bool histories_are_ours_ = false;
  bool quit_requested_ = false;  // a signal asked for the end, on any rank
  bool write_restart_requested_ = false;
  bool stop_ = false;
  LAMMPS_NS::bigint last_step_ = 0;
};

}  // namespace gasgrain::plugins
