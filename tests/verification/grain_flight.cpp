#include "tests/verification/grain_flight.hpp"

#include <memory>
#include <utility>

namespace gasgrain::verification {

namespace {

plugins::GrainContactTable contacts_of(const GrainMaterial& material) {
  return plugins::GrainContactTable(
      plugins::GrainContact({.spring_constant = material.spring_constant,
                             .restitution = material.restitution,
                             .friction_coefficient = material.friction},
                            {1.0, 1.0}, {}));
}

}  // namespace

Shape sampled(const Shape& shape, double half_size, double spacing, Interpolation interpolation) {
  return std::make_shared<const SampledDistance>(
      sample_shape(*shape, {.lower = Vec3::Constant(-half_size),
                            .upper = Vec3::Constant(half_size),
                            .spacing = spacing,
                            .band = 2.0,
                            .cut = true,
                            .interpolation = interpolation}));
}

GrainFlight::GrainFlight(Shape wall, const GrainMaterial& material) : material_(material) {
  Body body;
  body.shape = std::move(wall);
  wall_ = plugins::SdfWall(std::move(body), 1);
  wall_.set_contacts(contacts_of(material));
}

void GrainFlight::find_forces(const plugins::TangentialStep& step) {
  const plugins::GrainAtWall grain{.tag = 1,
                                   .type = 1,
                                   .radius = material_.radius,
                                   .mass = material_.mass,
                                   .position = Eigen::Map<const Vec3>(position.data()),
                                   .velocity = Eigen::Map<const Vec3>(velocity.data()),
                                   .spin = Eigen::Map<const Vec3>(spin.data())};
  plugins::WallLoad load;
  touch_ =
      material_.friction > 0
          ? wall_.touch<plugins::TangentialModel::history>(grain, walls_, displacement_, step, load)
          : wall_.touch<plugins::TangentialModel::off>(grain, walls_, displacement_, step, load);
}

void GrainFlight::step(double duration) {
  const double inertia = 0.4 * material_.mass * material_.radius * material_.radius;
  const auto kick = [&] {
    velocity += 0.5 * duration * (touch_.force / material_.mass + gravity);
    spin += 0.5 * duration / inertia * touch_.torque;
  };
  kick();
  position += duration * velocity;
  find_forces({plugins::History::advance, duration});
  kick();
}

double GrainFlight::gap() const {
  LocalWalls walls;
  walls.come_to(*wall_.body().shape, position, material_.radius);
  return (walls.count() > 0 ? walls.seen_from(position, 0).distance : wall_.distance(position)) -
         material_.radius;
}

double GrainFlight::kinetic_energy() const {
  return 0.5 * material_.mass * velocity.squaredNorm();
}

}  // namespace gasgrain::verification
