#include "experiments/bench/contact_peers.hpp"

#ifdef KAIROS_PEER_ODE

#include <ode/ode.h>

#include <array>
#include <cstdarg>

namespace kairos::experiments {
namespace {

struct World {
  dWorldID world = nullptr;
  dSpaceID space = nullptr;
  dJointGroupID contacts = nullptr;
};

void on_near(void* data, dGeomID a, dGeomID b) {
  const World& world = *static_cast<const World*>(data);
  std::array<dContact, 8> contacts{};
  const int found =
      dCollide(a, b, static_cast<int>(contacts.size()), &contacts[0].geom, sizeof(dContact));
  for (int i = 0; i < found; ++i) {
    dContact& contact = contacts[static_cast<std::size_t>(i)];
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = 0.5;
    dJointAttach(dJointCreateContact(world.world, world.contacts, &contact), dGeomGetBody(a),
                 dGeomGetBody(b));
  }
}

/// Dantzig's solver tells of each pivot that it cannot take; how the stack stands tells enough.
void be_silent(int /*number*/, const char* /*message*/, va_list /*arguments*/) {}

Vector3 vector(const dReal* x) { return {x[0], x[1], x[2]}; }

/// `quick`: twenty sweeps of SOR; otherwise Dantzig's pivoting. Both with ODE's own ERP and CFM.
std::vector<BodyState> run(const ContactTask& task, bool quick) {
  static const int ready = dInitODE2(0);
  if (ready == 0) {
    return {};
  }
  dSetMessageHandler(&be_silent);
  World world{dWorldCreate(), dSimpleSpaceCreate(nullptr), dJointGroupCreate(0)};
  dWorldSetGravity(world.world, 0.0, -9.8, 0.0);
  dWorldSetAutoDisableFlag(world.world, 0);
  const Vector3 half = task.half();
  const bool stack = task.kind == ContactTask::Kind::stack;
  if (stack) {
    dCreatePlane(world.space, 0.0, 1.0, 0.0, 0.0);
  }
  std::vector<dBodyID> bodies;
  for (int i = 0; i < task.bodies; ++i) {
    const dBodyID body = dBodyCreate(world.world);
    dMass mass;
    dMassSetBoxTotal(&mass, 1.0, 2.0 * half.x(), 2.0 * half.y(), 2.0 * half.z());
    dBodySetMass(body, &mass);
    const Vector3 at = task.place(i);
    dBodySetPosition(body, at.x(), at.y(), at.z());
    if (stack) {
      const dGeomID box = dCreateBox(world.space, 2.0 * half.x(), 2.0 * half.y(), 2.0 * half.z());
      dGeomSetBody(box, body);
    } else {
      const dJointID joint = dJointCreateBall(world.world, nullptr);
      dJointAttach(joint, body, i == 0 ? nullptr : bodies.back());
      dJointSetBallAnchor(joint, at.x() - half.x(), at.y(), at.z());
    }
    bodies.push_back(body);
  }
  for (std::int64_t n = 0; n < task.steps; ++n) {
    dSpaceCollide(world.space, &world, &on_near);
    quick ? dWorldQuickStep(world.world, task.frame) : dWorldStep(world.world, task.frame);
    dJointGroupEmpty(world.contacts);
  }
  std::vector<BodyState> states;
  for (const dBodyID body : bodies) {
    const dReal* q = dBodyGetQuaternion(body);
    states.push_back({{vector(dBodyGetPosition(body)), Quaternion(q[0], q[1], q[2], q[3])},
                      {vector(dBodyGetLinearVel(body)), vector(dBodyGetAngularVel(body))}});
  }
  dJointGroupDestroy(world.contacts);
  dSpaceDestroy(world.space);
  dWorldDestroy(world.world);
  return states;
}

}  // namespace

std::vector<ContactPeer> ode_contact_peers() {
  return {{"ODE, quick step", [](const ContactTask& task) { return run(task, true); }},
          {"ODE, Dantzig", [](const ContactTask& task) { return run(task, false); }}};
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<ContactPeer> ode_contact_peers() { return {}; }

}  // namespace kairos::experiments

#endif
