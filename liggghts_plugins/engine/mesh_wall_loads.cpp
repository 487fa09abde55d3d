#include "liggghts_plugins/engine/mesh_wall_loads.hpp"

#include <atom.h>
#include <fix_contact_history_mesh.h>
#include <fix_mesh_surface.h>
#include <fix_neighlist_mesh.h>
#include <fix_wall_gran.h>
#include <granular_wall.h>
#include <neighbor.h>
#include <tri_mesh.h>

#include <algorithm>
#include <cmath>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::FixContactHistoryMesh;
using LAMMPS_NS::FixWallGran;

struct WallModel {
  using Member = LIGGGHTS::Walls::IGranularWall* FixWallGran::*;
  friend Member private_member(WallModel);
};
struct WallType {
  using Member = int FixWallGran::*;
  friend Member private_member(WallType);
};
struct ForcesAreWanted {
  using Member = int FixWallGran::*;
  friend Member private_member(ForcesAreWanted);
};
struct HistoryAdvances {
  using Member = int FixWallGran::*;
  friend Member private_member(HistoryAdvances);
};
struct KeptContacts {
  using Member = bool** FixContactHistoryMesh::*;
  friend Member private_member(KeptContacts);
};
struct OverlappingContacts {
  using Member = bool** FixContactHistoryMesh::*;
  friend Member private_member(OverlappingContacts);
};
template struct GrantAccess<WallModel, &FixWallGran::impl>;
template struct GrantAccess<WallType, &FixWallGran::atom_type_wall_>;
template struct GrantAccess<ForcesAreWanted, &FixWallGran::computeflag_>;
template struct GrantAccess<HistoryAdvances, &FixWallGran::shearupdate_>;
template struct GrantAccess<KeptContacts, &FixContactHistoryMesh::keepflag_>;
template struct GrantAccess<OverlappingContacts, &FixContactHistoryMesh::intersectflag_>;

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;
using CornerVelocities = LAMMPS_NS::MultiVectorContainer<double, 3, 3>;

constexpr int corner_count = 3;
constexpr int face = 7;  // of the bits that say inside of which edges the nearest point is

}  // namespace

bool meshes_compute_loads_only(FixWallGran& wall) {
  return std::none_of(wall.mesh_list(), wall.mesh_list() + wall.n_meshes(),
                      [](LAMMPS_NS::FixMeshSurface* mesh) {
                        return mesh->meshMulticontactData() || mesh->meshforceContact() ||
                               mesh->meshforceContactStress();
                      });
}

MeshWallLoads::MeshWallLoads(FixWallGran& wall, int index, LAMMPS_NS::Atom& atom,
                             const LAMMPS_NS::Neighbor& neighbor)
    : wall_(wall),
      fix_(*wall.mesh_list()[index]),
      mesh_(*fix_.triMesh()),
      atom_(atom),
      index_(index),
      cutoff_(neighbor.cutneighmax),
      touching_share_(std::max(0.0, neighbor.contactDistanceFactor - 1.0)) {
  fix_.contactHistory()->markAllContacts();  // makes room for the flags of this list
  load_pairs();
  if (mesh_.isMoving()) {
    corners_.resize(static_cast<std::size_t>(corner_count) *
                    (mesh_.sizeLocal() + mesh_.sizeGhost()));
    note_mesh_motion();
    mesh_travelled_ = 0.0;
  }
}

// Triangles near a grain in the order of the mesh's file, whatever the ranks made of it: the first
// of two coplanar ones gets the contact.
std::vector<int> MeshWallLoads::listed_triangles() const {
  std::vector<int> triangles;
  for (int t = 0; t < mesh_.sizeLocal() + mesh_.sizeGhost(); ++t)
    if (!fix_.meshNeighlist()->get_contact_list(t).empty()) triangles.push_back(t);
  std::stable_sort(triangles.begin(), triangles.end(),
                   [&](int a, int b) { return mesh_.id(a) < mesh_.id(b); });
  return triangles;
}

// Of local grains; ghosts are left out.
void MeshWallLoads::load_pairs() {
  const auto& list = *fix_.meshNeighlist();
  for (const int t : listed_triangles())
    for (const int i : list.get_contact_list(t))
      if (i < atom_.nlocal) {
        pairs_.push_back({.due = 0.0, .triangle = t, .listed = i});
        listed_.push_back({.index = i, .in_question = false});
      }
  constexpr auto in_order = [](const ListedGrain& a, const ListedGrain& b) {
    return a.index < b.index;
  };
  constexpr auto same = [](const ListedGrain& a, const ListedGrain& b) {
    return a.index == b.index;
  };
  std::sort(listed_.begin(), listed_.end(), in_order);
  listed_.erase(std::unique(listed_.begin(), listed_.end(), same), listed_.end());
  for (Pair& pair : pairs_) {
    const ListedGrain grain{.index = pair.listed, .in_question = false};
    pair.listed = static_cast<int>(
        std::lower_bound(listed_.begin(), listed_.end(), grain, in_order) - listed_.begin());
  }
}

// No point of a triangle travels farther than one of its corners.
void MeshWallLoads::note_mesh_motion() {
  double largest = 0.0;
  for (std::size_t n = 0; n < corners_.size(); ++n) {
    Vec3 corner;
    mesh_.node(static_cast<int>(n / corner_count), static_cast<int>(n % corner_count),
               corner.data());
    largest = std::max(largest, (corner - corners_[n]).squaredNorm());
    corners_[n] = corner;
  }
  mesh_travelled_ += std::sqrt(largest);
}

void MeshWallLoads::bring_up_to_date(int grain, GrainLoop& loop) {
  Column(atom_.x[grain]) = ConstColumn(loop.grain(grain).position);
  Column(atom_.v[grain]) = ConstColumn(loop.grain(grain).velocity);
  Column(atom_.omega[grain]) = ConstColumn(loop.spin(grain).velocity);
  Column(atom_.f[grain]).setZero();
  Column(atom_.torque[grain]).setZero();
  FixContactHistoryMesh& history = *fix_.contactHistory();
  const int count = history.nneighs(grain);
  std::fill_n((history.*private_member(KeptContacts()))[grain], count, false);
  std::fill_n((history.*private_member(OverlappingContacts()))[grain], count, false);
}

// Computes the contact, if it is one, and returns the gap or a lower bound of it, m.
double MeshWallLoads::test(const Pair& pair, const GrainRecord& grain) {
  const int i = listed_[pair.listed].index, t = pair.triangle;
  double to_wall[3], weights[3];
  int inside = 0;
  const double gap = mesh_.resolveTriSphereContactBary(i, t, grain.radius, atom_.x[i], to_wall,
                                                       weights, inside, true);
  // the nearest point is on an edge or corner that belongs to another triangle
  if (gap > cutoff_)
    return mesh_.resolveTriSphereContactBary(i, t, grain.radius, atom_.x[i], to_wall, weights,
                                             inside, false);
  if (gap > touching_share_ * grain.radius) return gap;

  const bool overlapping = gap <= 0.0;
  LIGGGHTS::ContactModels::SurfacesIntersectData contact;
  if (!fix_.contactHistory()->handleContact(i, mesh_.id(t), contact.contact_history, overlapping,
                                            inside == face))
    return gap;  // a coplanar neighbour has computed it
  Vec3 wall_velocity = Vec3::Zero();
  if (corner_velocities_)
    for (int corner = 0; corner < corner_count; ++corner)
      wall_velocity += weights[corner] * ConstColumn(corner_velocities_[t][corner]);
  contact.is_wall = true;
  contact.is_non_spherical = false;
  contact.i = i;
  contact.radi = grain.radius;
  contact.deltan = -gap;
  Column(contact.delta) = -ConstColumn(to_wall);
  contact.mesh = &mesh_;
  contact.fix_mesh = &fix_;
  (wall_.*private_member(WallModel()))
      ->compute_force(&wall_, contact, overlapping, wall_velocity.data(), &fix_, index_, &mesh_, t);
  return gap;
}

void MeshWallLoads::compute(std::vector<GrainLoad>& loads, GrainLoop& loop, double travelled) {
  if (!corners_.empty()) note_mesh_motion();
  auto* velocities = mesh_.prop().getElementProperty<CornerVelocities>("v");
  corner_velocities_ = velocities ? velocities->begin() : nullptr;
  wall_.*private_member(WallType()) = fix_.atomTypeWall();
  wall_.*private_member(ForcesAreWanted()) = 1;
  wall_.*private_member(HistoryAdvances()) = 1;
  const double way = travelled + mesh_travelled_;
  for (Pair& pair : pairs_) {
    if (way < pair.due) continue;
    ListedGrain& listed = listed_[pair.listed];
    const GrainRecord& grain = loop.grain(listed.index);
    if (!listed.in_question) bring_up_to_date(listed.index, loop);
    listed.in_question = true;
    pair.due = way + test(pair, grain) - touching_share_ * grain.radius;
  }
  loads.clear();
  for (ListedGrain& listed : listed_) {
    if (!listed.in_question) continue;
    listed.in_question = false;
    const int i = listed.index;
    fix_.contactHistory()->cleanUpContacts(i, i + 1);
    const ConstColumn force(atom_.f[i]), torque(atom_.torque[i]);
    if (!force.isZero(0.0) || !torque.isZero(0.0)) loads.push_back({i, force, torque});
  }
}

}  // namespace gasgrain::plugins
