#include "experiments/bench/gas_peers.hpp"

#ifdef KAIROS_PEER_ODE

#include "experiments/processor_time.hpp"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace kairos::experiments {
namespace {

struct Room {
  dWorldID world;
  dJointGroupID contacts;
  double deepest = 0.0;
};

/// ODE's callback for a pair of geometries that may touch: an elastic contact without friction.
void on_near(void* data, dGeomID a, dGeomID b) {
  Room& room = *static_cast<Room*>(data);
  dContact contact{};
  if (dGeomGetBody(a) == dGeomGetBody(b) ||
      dCollide(a, b, 1, &contact.geom, sizeof(dContact)) == 0) {
    return;
  }
  room.deepest = std::max(room.deepest, static_cast<double>(contact.geom.depth));
  contact.surface.mode = dContactBounce;
  contact.surface.mu = 0.0;
  contact.surface.bounce = 1.0;
  contact.surface.bounce_vel = 0.0;
  dJointAttach(dJointCreateContact(room.world, room.contacts, &contact), dGeomGetBody(a),
               dGeomGetBody(b));
}

double kinetic(const std::vector<dBodyID>& bodies) {
  double sum = 0.0;
  for (const dBodyID body : bodies) {
    const dReal* v = dBodyGetLinearVel(body);
    sum += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  }
  return sum;
}

}  // namespace

std::optional<GasOutcome> ode_gas(const GasTask& task) {
  static const int ready = dInitODE2(0);
  if (ready == 0) {
    return std::nullopt;
  }
  Room room{dWorldCreate(), dJointGroupCreate(0)};
  dWorldSetGravity(room.world, 0.0, 0.0, 0.0);
  dWorldSetAutoDisableFlag(room.world, 0);
  const dSpaceID space = dHashSpaceCreate(nullptr);
  const int level = static_cast<int>(std::ceil(std::log2(2.0 * task.radius)));
  dHashSpaceSetLevels(space, level, level + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [axis](int k) { return k == axis ? 1.0 : 0.0; };
    dCreatePlane(space, along(0), along(1), along(2), 0.0);
    dCreatePlane(space, -along(0), -along(1), -along(2), -1.0);
  }
  std::vector<dBodyID> bodies;
  dMass mass;
  dMassSetSphereTotal(&mass, task.mass, task.radius);
  for (const BodyState& state : task.start) {
    const dBodyID body = dBodyCreate(room.world);
    const Vector3& p = state.pose.position;
    const Vector3& v = state.twist.linear;
    dBodySetMass(body, &mass);
    dBodySetPosition(body, p.x(), p.y(), p.z());
    dBodySetLinearVel(body, v.x(), v.y(), v.z());
    dGeomSetBody(dCreateSphere(space, task.radius), body);
    bodies.push_back(body);
  }
  GasOutcome outcome;
  const double energy = kinetic(bodies);
  const auto steps = static_cast<std::int64_t>(std::ceil(task.duration / task.frame));
  const double start = processor_seconds();
  for (std::int64_t n = 0; n < steps; ++n) {
    dSpaceCollide(space, &room, &on_near);
    dWorldQuickStep(room.world, task.frame);
    dJointGroupEmpty(room.contacts);
  }
  outcome.seconds = processor_seconds() - start;
  outcome.energy_ratio = kinetic(bodies) / energy;
  outcome.deepest = room.deepest;
  dJointGroupDestroy(room.contacts);
  dSpaceDestroy(space);
  dWorldDestroy(room.world);
  return outcome;
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::optional<GasOutcome> ode_gas(const GasTask& /*task*/) { return std::nullopt; }

}  // namespace kairos::experiments

#endif
