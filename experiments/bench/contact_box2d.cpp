#include "experiments/bench/contact_peers.hpp"

#ifdef KAIROS_PEER_BOX2D

#include <box2d/box2d.h>

#include <cmath>

namespace kairos::experiments {
namespace {

b2Vec2 flat(const Vector3& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }

/// In the plane; eight sweeps of velocities and three of positions, as its manual says.
std::vector<BodyState> run(const ContactTask& task) {
  b2World world({0.0F, -9.8F});
  world.SetAllowSleeping(false);
  const Vector3 half = task.half();
  b2BodyDef fixed;
  b2Body* ground = world.CreateBody(&fixed);
  const bool stack = task.kind == ContactTask::Kind::stack;
  if (stack) {
    b2EdgeShape line;
    line.SetTwoSided({-100.0F, 0.0F}, {100.0F, 0.0F});
    b2FixtureDef floor;
    floor.shape = &line;
    floor.friction = 0.5F;
    ground->CreateFixture(&floor);
  }
  std::vector<b2Body*> bodies;
  for (int i = 0; i < task.bodies; ++i) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = flat(task.place(i));
    b2Body* body = world.CreateBody(&definition);
    b2PolygonShape box;
    box.SetAsBox(static_cast<float>(half.x()), static_cast<float>(half.y()));
    b2FixtureDef fixture;
    fixture.shape = &box;
    fixture.friction = 0.5F;
    fixture.density = static_cast<float>(1.0 / (4.0 * half.x() * half.y()));
    fixture.filter.groupIndex = static_cast<int16>(stack ? 0 : -1);  // links pass each other
    body->CreateFixture(&fixture);
    if (!stack) {
      b2RevoluteJointDef joint;
      joint.Initialize(i == 0 ? ground : bodies.back(), body,
                       flat(task.place(i) - Vector3(half.x(), 0.0, 0.0)));
      world.CreateJoint(&joint);
    }
    bodies.push_back(body);
  }
  for (std::int64_t n = 0; n < task.steps; ++n) {
    world.Step(static_cast<float>(task.frame), 8, 3);
  }
  std::vector<BodyState> states;
  for (const b2Body* body : bodies) {
    const b2Vec2 p = body->GetPosition();
    const b2Vec2 v = body->GetLinearVelocity();
    const double angle = static_cast<double>(body->GetAngle());
    states.push_back({{Vector3(p.x, p.y, 0.0),
                       Quaternion(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle))},
                      {Vector3(v.x, v.y, 0.0), Vector3(0.0, 0.0, body->GetAngularVelocity())}});
  }
  return states;
}

}  // namespace

std::vector<ContactPeer> box2d_contact_peers() { return {{"Box2D, in the plane", run}}; }

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<ContactPeer> box2d_contact_peers() { return {}; }

}  // namespace kairos::experiments

#endif
