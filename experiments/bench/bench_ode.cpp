#include "experiments/bench/bench_peers.hpp"

#ifdef KAIROS_PEER_ODE

#include <ode/ode.h>

namespace kairos::experiments {
namespace {

struct Ground {
  dWorldID world;
  dJointGroupID contacts;
};

/// ODE's callback for a pair of geometries that may touch: an elastic contact.
void on_near(void* data, dGeomID a, dGeomID b) {
  const Ground& ground = *static_cast<const Ground*>(data);
  dContact contact{};
  if (dCollide(a, b, 1, &contact.geom, sizeof(dContact)) == 0) {
    return;
  }
  contact.surface.mode = dContactBounce;
  contact.surface.bounce = 1.0;
  dJointAttach(dJointCreateContact(ground.world, ground.contacts, &contact), dGeomGetBody(a),
               dGeomGetBody(b));
}

}  // namespace

bool has_ode() { return true; }

std::int64_t ode_bounce(std::int64_t steps, double frame) {
  static const int ready = dInitODE2(0);
  if (ready == 0) {
    return 0;
  }
  Ground ground{dWorldCreate(), dJointGroupCreate(0)};
  const dSpaceID space = dSimpleSpaceCreate(nullptr);
  dWorldSetGravity(ground.world, 0.0, -9.8, 0.0);
  dWorldSetAutoDisableFlag(ground.world, 0);
  dCreatePlane(space, 0.0, 1.0, 0.0, 0.0);
  const dGeomID ball = dCreateSphere(space, 0.5);
  const dBodyID body = dBodyCreate(ground.world);
  dMass mass;
  dMassSetSphereTotal(&mass, 1.0, 0.5);
  dBodySetMass(body, &mass);
  dBodySetPosition(body, 0.0, 5.0, 0.0);
  dGeomSetBody(ball, body);
  for (std::int64_t n = 0; n < steps; ++n) {
    dSpaceCollide(space, &ground, &on_near);
    dWorldStep(ground.world, frame);
    dJointGroupEmpty(ground.contacts);
  }
  dJointGroupDestroy(ground.contacts);
  dSpaceDestroy(space);
  dWorldDestroy(ground.world);
  return steps;
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

bool has_ode() { return false; }
std::int64_t ode_bounce(std::int64_t /*steps*/, double /*frame*/) { return 0; }

}  // namespace kairos::experiments

#endif
