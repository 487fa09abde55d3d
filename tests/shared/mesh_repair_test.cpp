#include "coupling/shared/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <random>

#include "coupling/shared/error.hpp"
#include "tests/shared/mesh_fixture.hpp"

namespace gasgrain {
namespace {

const Triangles cube = box_triangles(Vec3::Zero(), Vec3::Constant(2));
const Triangles hollow = box_triangles(Vec3::Constant(0.5), Vec3::Constant(1.5));  // volume 1

TEST(MeshRepair, LeavesASoundMeshAlone) {
  const RepairedMesh mesh = repair_mesh(cube);
  ASSERT_EQ(mesh.solids.size(), 1u);
  EXPECT_EQ(mesh.solids[0].triangles.size(), 12u);
  EXPECT_EQ(mesh.solids[0].vertices.size(), 8u);
  EXPECT_DOUBLE_EQ(mesh.report.volume, 8);
  EXPECT_DOUBLE_EQ(mesh.report.area, 24);
  EXPECT_EQ(mesh.report.parts, 1u);
  EXPECT_EQ(mesh.report.turned + mesh.report.inverted_parts + mesh.report.cavities +
                mesh.report.duplicates + mesh.report.degenerate + mesh.report.open_edges +
                mesh.report.branched_edges + mesh.report.holes,
            0u);
}

TEST(MeshRepair, LeavesOutDuplicatesOfEitherSide) {
  Triangles list = cube;
  list.push_back({cube[3][1], cube[3][2], cube[3][0]});
  list.push_back(cube[5]);
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_EQ(mesh.report.duplicates, 2u);
  EXPECT_DOUBLE_EQ(mesh.report.volume, 8);
  // an opposite pair cancels, and the gap it leaves is closed again
  list = cube;
  list.push_back(turned(cube[3]));
  EXPECT_DOUBLE_EQ(repair_mesh(list).report.volume, 8);
}

TEST(MeshRepair, TurnsTrianglesThatDisagreeWithTheirNeighbours) {
  Triangles list = cube;
  for (const int t : {0, 4, 11}) list[t] = turned(list[t]);
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_EQ(mesh.report.turned, 3u);
  EXPECT_DOUBLE_EQ(mesh.report.volume, 8);
}

TEST(MeshRepair, TurnsPartsThatAreInsideOut) {
  const Triangles other = box_triangles(Vec3(5, 0, 0), Vec3(6, 1, 1));
  const RepairedMesh mesh = repair_mesh(both(turned(cube), other));
  EXPECT_EQ(mesh.report.inverted_parts, 1u);
  EXPECT_EQ(mesh.report.parts, 2u);
  EXPECT_DOUBLE_EQ(mesh.report.volume, 9);
}

TEST(MeshRepair, KeepsCavitiesAlsoWhenEverythingIsInsideOut) {
  for (const bool inside_out : {false, true}) {
    Triangles list = both(cube, turned(hollow));
    if (inside_out) list = turned(list);
    const RepairedMesh mesh = repair_mesh(list);
    EXPECT_EQ(mesh.report.cavities, 1u);
    EXPECT_EQ(mesh.report.inverted_parts, inside_out ? 1u : 0u);
    ASSERT_EQ(mesh.solids.size(), 1u);
    EXPECT_DOUBLE_EQ(mesh.report.volume, 7);
  }
}

TEST(MeshRepair, ASolidWithinACavityIsASolid) {
  const Triangles core = box_triangles(Vec3::Constant(0.9), Vec3::Constant(1.1));
  const RepairedMesh mesh = repair_mesh(both(both(cube, turned(hollow)), core));
  EXPECT_EQ(mesh.solids.size(), 2u);
  EXPECT_NEAR(mesh.report.volume, 7.008, 1e-12);
}

TEST(MeshRepair, ClosesHoles) {
  Triangles list = ball_triangles(Vec3(1, 2, 3), 1.0, 24);
  const double volume = repair_mesh(list).report.volume;
  list.erase(list.begin() + 400);
  list.erase(list.begin() + 100, list.begin() + 103);
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_EQ(mesh.report.holes, 2u);
  EXPECT_EQ(mesh.report.open_edges, 3u + 5u);
  EXPECT_NEAR(mesh.report.volume, volume, 1e-3 * volume);
  EXPECT_LT(mesh.report.largest_hole, 0.5);
}

TEST(MeshRepair, ClosesAnOpenBoxByItsLid) {
  Triangles list = cube;
  list.erase(list.begin() + 4, list.begin() + 6);
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_EQ(mesh.report.holes, 1u);
  EXPECT_NEAR(mesh.report.largest_hole, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(mesh.report.volume, 8, 1e-12);
}

// A side of the box whose edge has a corner in its middle that the neighbouring side lacks.
TEST(MeshRepair, ClosesCracksBetweenFacesThatDoNotMeetInCorners) {
  Triangles list = cube;
  const LooseTriangle t = list.back();
  list.pop_back();
  const Vec3 middle = 0.5 * (t[0] + t[1]);
  list.push_back({t[0], middle, t[2]});
  list.push_back({middle, t[1], t[2]});
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_NEAR(mesh.report.volume, 8, 1e-12);
}

TEST(MeshRepair, KeepsPartsThatMeetAtAnEdge) {
  const RepairedMesh mesh = repair_mesh(both(cube, box_triangles(Vec3(2, 2, 0), Vec3(4, 4, 2))));
  EXPECT_EQ(mesh.report.branched_edges, 1u);
  EXPECT_NEAR(mesh.report.volume, 16, 1e-12);
}

TEST(MeshRepair, CountsTrianglesWithoutArea) {
  Triangles list = cube;
  list.push_back({Vec3::Zero(), Vec3::Zero(), Vec3::Ones()});
  list.push_back({Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(7, 0, 0)});
  const RepairedMesh mesh = repair_mesh(list);
  EXPECT_EQ(mesh.report.degenerate, 2u);
  EXPECT_NEAR(mesh.report.volume, 8, 1e-12);
  EXPECT_THROW(repair_mesh({list[12], list[13]}), UserError);
}

// Any soup of triangles ends as surfaces without boundary.
TEST(MeshRepair, AnySoupBecomesClosed) {
  std::mt19937 random{3};
  int solids = 0;
  for (int n = 0; n < 300; ++n) {
    Triangles soup;
    for (int t = 0; t < 30; ++t) {
      LooseTriangle triangle;
      for (Vec3& corner : triangle)
        for (int d = 0; d < 3; ++d) corner[d] = static_cast<double>(random() % 3);
      soup.push_back(triangle);
    }
    RepairedMesh mesh;
    try {
      mesh = repair_mesh(soup);
    } catch (const UserError&) {
      continue;  // everything cancelled
    }
    for (const TriangleMesh& solid : mesh.solids) {
      ++solids;
      Vec3 vector_area = Vec3::Zero();  // of a closed surface: zero
      for (std::size_t t = 0; t < solid.triangles.size(); ++t)
        vector_area += (solid.corner(t, 1) - solid.corner(t, 0))
                           .cross(solid.corner(t, 2) - solid.corner(t, 0));
      EXPECT_LT(vector_area.norm(), 1e-11);
      EXPECT_GE(enclosed_volume(solid), -1e-12);
    }
  }
  EXPECT_GT(solids, 200);  // most soups leave one
}

}  // namespace
}  // namespace gasgrain
