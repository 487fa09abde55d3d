// An SDF wall as grains feel it: where it is, its contacts with a grain, and their springs.
//
//   contact while phi < r,   F_n = k (r - phi) grad(phi) - eta v_n n,   n = grad(phi)/|grad(phi)|
//
// (eq 17-20) with the exact gradient of the field as it is stored, so that the elastic force is the
// gradient of the potential 1/2 k (r - phi)^2 and conserves energy. At concave edges of one body a
// grain has a contact with each wall, each with its own spring. Where a body can have such edges,
// the walls around a grain are looked for once and remembered while it moves a little way
// (local_walls.hpp); else phi is that of the shape in every step.
//
// A wall that moves is looked at in its own frame; its velocity at the contact point enters the
// dashpot and the slip, and the tangential spring turns with it.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "coupling/shared/body.hpp"
#include "coupling/shared/local_walls.hpp"
#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {

// Sums over the contacts of this rank in one step.
struct WallLoad {
  Vec3 force = Vec3::Zero();   // on the body, N
  Vec3 torque = Vec3::Zero();  // on the body about its torque point, N m
  double contacts = 0;
  double unsure_contacts = 0;  // with walls whose nearest place was not found
  LargestOverlap largest;
};

// A grain as the wall needs it.
struct GrainAtWall {
  int tag;
  int type;
  double radius;                    // m
  double mass;                      // kg
  Eigen::Map<const Vec3> position;  // m
  Eigen::Map<const Vec3> velocity;  // m/s
  Eigen::Map<const Vec3> spin;      // rad/s
};

struct WallTouch {
  bool touches = false;
  double way = 0.0;           // m, that grain and wall can go before they may, if they do not touch
  Vec3 force = Vec3::Zero();  // on the grain, N
  Vec3 torque = Vec3::Zero();  // on the grain, N m
};

// The spring of one of several contacts.
struct EdgeSpring {
  Vec3 normal;
  Vec3 displacement;  // m
};

// Translation of a wall from outside.
struct Carriage {
  Vec3 displacement;  // from where the body was stated, m
  Vec3 velocity;      // of its points, m/s
  double sweep;       // way of the last step over its duration, m/s
};

class SdfWall {
 public:
  SdfWall() = default;
  SdfWall(Body body, int wall_type);

  void set_contacts(const GrainContactTable& contacts) { contacts_ = contacts; }
  const GrainContactTable& contacts() const { return contacts_; }
  const Body& body() const { return body_; }
  int wall_type() const { return wall_type_; }

  // Where the wall is at `time` [s], a step of `duration` [s] after where it was.
  void set_time(double time, double duration);
  // Puts a wall without a motion of its own there, after set_time().
  void carry(const Carriage& carriage);
  // Distance of a place from the wall where it is now, m.
  double distance(const Vec3& x) const;
  // Fastest that any point of it moves within a box, m/s; 0 for a wall that does not sweep.
  double fastest_sweep(const Vec3& lower, const Vec3& upper) const;
  bool sweeps() const { return carried_ || body_.motion.sweeps(); }

  // Whether the walls around each grain are to be remembered.
  bool has_local_walls() const { return several_; }
  // The contacts of a grain: force on it, and their sum added to `load`. `walls` are remembered
  // from the grain's last step. `displacement` is the spring of a single contact, m; those of
  // several are kept here, by the grain's tag.
  template <TangentialModel tangential>
  WallTouch touch(const GrainAtWall& grain, LocalWalls& walls, Vec3& displacement,
                  const TangentialStep& step, WallLoad& load);

  // Springs of a grain with several contacts, or nullptr.
  const std::vector<EdgeSpring>* edge_springs(int tag) const;
  void set_edge_springs(int tag, std::vector<EdgeSpring> springs);
  void forget(int tag) {
    if (!edge_springs_.empty()) edge_springs_.erase(tag);
  }

 private:
  struct Contacts {
    int count = 0;
    int unsure = 0;
    std::array<DistanceSample, NearSurfaces::most> wall;
  };

  Vec3 in_body(const Vec3& x) const { return sweeps() ? pose_.to_body(x) : x; }
  DistanceSample in_world(const DistanceSample& wall) const {
    return sweeps() ? DistanceSample{wall.distance, pose_.rotation * wall.gradient} : wall;
  }
  Vec3 velocity_at(const Vec3& x) const;
  Contacts find_contacts(const GrainAtWall& grain, LocalWalls& walls, double& way) const;
  template <TangentialModel tangential>
  void add_contact(const GrainAtWall& grain, const DistanceSample& wall, Vec3& displacement,
                   const TangentialStep& step, WallTouch& touch, WallLoad& load) const;
  template <TangentialModel tangential>
  void touch_edge(const GrainAtWall& grain, const Contacts& contacts, Vec3& displacement,
                  const TangentialStep& step, WallTouch& touch, WallLoad& load);

  Body body_;
  int wall_type_ = 0;
  bool several_ = false;   // contacts of one grain are possible
  double steepest_ = 1.0;  // gradient of the body's distance
  GrainContactTable contacts_;
  std::unordered_map<int, std::vector<EdgeSpring>> edge_springs_;  // never iterated over

  // Of the present time.
  double time_ = 0.0;  // s
  bool carried_ = false;
  Vec3 carried_velocity_ = Vec3::Zero();  // m/s
  double carried_sweep_ = 0.0;            // m/s
  Pose pose_;
  Mat3 turn_ = Mat3::Identity();      // since a step ago
  Vec3 torque_point_ = Vec3::Zero();  // m
};

}  // namespace gasgrain::plugins
