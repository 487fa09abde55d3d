// Stock mesh walls in the fused engine: LIGGGHTS's contact model, its test of a grain against a
// triangle and its contact histories, on the pairs of its neighbour lists that may touch.
//
// Differences from the loop of fix wall/gran: a pair is not tested again before grain and mesh can
// have travelled its gap, and contact flags are cleared for the grains in question only, not for
// all. Between tests nothing of a pair changes: a pair that touches is tested in every step, and
// one whose contact has ended has been taken out of the history in the step that saw it end.
#pragma once

#include <vector>

#include "coupling/shared/vec3.hpp"
#include "liggghts_plugins/engine/grain_loop.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Atom;
class FixMeshSurface;
class FixWallGran;
class Neighbor;
class TriMesh;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

// One mesh of a fix wall/gran, from one building of the lists to the next.
class MeshWallLoads {
 public:
  // After the mesh's lists have been built. `index` of the mesh in the wall.
  MeshWallLoads(LAMMPS_NS::FixWallGran& wall, int index, LAMMPS_NS::Atom& atom,
                const LAMMPS_NS::Neighbor& neighbor);

  // Computes the loads of the present positions; ascending grains. `travelled`: bound on the way of
  // each grain since the construction, m. Overwrites state, force and torque of the grains in
  // question in the atom arrays.
  void compute(std::vector<GrainLoad>& loads, GrainLoop& loop, double travelled);

 private:
  struct Pair {
    double due;    // m, way after which the pair may touch
    int triangle;  // local index
    int listed;    // index in listed_
  };
  struct ListedGrain {
    int index;
    bool in_question;  // in this step
  };

  std::vector<int> listed_triangles() const;
  void load_pairs();
  void note_mesh_motion();
  void bring_up_to_date(int grain, GrainLoop& loop);
  double test(const Pair& pair, const GrainRecord& grain);

  LAMMPS_NS::FixWallGran& wall_;
  LAMMPS_NS::FixMeshSurface& fix_;
  LAMMPS_NS::TriMesh& mesh_;
  LAMMPS_NS::Atom& atom_;
  int index_;
  double cutoff_;          // m, gaps beyond are those of edges that LIGGGHTS skips
  double touching_share_;  // of the radius: gap up to which the contact model is asked
  std::vector<Pair> pairs_;
  std::vector<ListedGrain> listed_;        // ascending
  std::vector<Vec3> corners_;              // of a moving mesh, at the last test
  double mesh_travelled_ = 0.0;            // m
  double*** corner_velocities_ = nullptr;  // m/s, by triangle; nullptr: at rest
};

// Whether no mesh of the wall keeps values of contacts.
bool meshes_compute_loads_only(LAMMPS_NS::FixWallGran& wall);

}  // namespace gasgrain::plugins
