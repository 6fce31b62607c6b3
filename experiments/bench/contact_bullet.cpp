#include "experiments/bench/contact_peers.hpp"

#ifdef KAIROS_PEER_BULLET

#include "experiments/bench/bullet_types.hpp"

#include <btBulletDynamicsCommon.h>

#include <memory>

namespace kairos::experiments {
namespace {

Vector3 ours(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// Of each body: what acts is the product, 0.5.
constexpr auto root_of_half = btScalar(0.7071067811865476);

/// Sequential impulses, ten iterations: the defaults.
std::vector<BodyState> run(const ContactTask& task) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broad_phase, &solver, &configuration);
  world.setGravity({0, btScalar(-9.8), 0});
  btStaticPlaneShape ground_shape({0, 1, 0}, 0);
  btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground_shape));
  ground.setFriction(root_of_half);
  if (task.kind == ContactTask::Kind::stack) {
    world.addRigidBody(&ground);
  }
  btBoxShape shape(vector(task.half()));
  btVector3 inertia;
  shape.calculateLocalInertia(1, inertia);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints;
  const btVector3 end(static_cast<btScalar>(task.half().x()), 0, 0);
  for (int i = 0; i < task.bodies; ++i) {
    bodies.push_back(std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, inertia)));
    btRigidBody& body = *bodies.back();
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), vector(task.place(i))));
    body.setFriction(root_of_half);
    body.setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(&body);
    if (task.kind == ContactTask::Kind::chain) {
      joints.push_back(i == 0 ? std::make_unique<btPoint2PointConstraint>(body, -end)
                              : std::make_unique<btPoint2PointConstraint>(
                                    *bodies[static_cast<std::size_t>(i - 1)], body, end, -end));
      world.addConstraint(joints.back().get(), true);
    }
  }
  for (std::int64_t n = 0; n < task.steps; ++n) {
    world.stepSimulation(static_cast<btScalar>(task.frame), 0);
  }
  std::vector<BodyState> states;
  for (const auto& body : bodies) {
    const btTransform& at = body->getWorldTransform();
    const btQuaternion q = at.getRotation();
    states.push_back({{ours(at.getOrigin()), Quaternion(q.w(), q.x(), q.y(), q.z())},
                      {ours(body->getLinearVelocity()), ours(body->getAngularVelocity())}});
  }
  for (const auto& joint : joints) {
    world.removeConstraint(joint.get());
  }
  for (const auto& body : bodies) {
    world.removeRigidBody(body.get());
  }
  if (task.kind == ContactTask::Kind::stack) {
    world.removeRigidBody(&ground);
  }
  return states;
}

}  // namespace

std::vector<ContactPeer> bullet_contact_peers() { return {{"Bullet", run}}; }

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<ContactPeer> bullet_contact_peers() { return {}; }

}  // namespace kairos::experiments

#endif
