// Impact laws on their own: what rounding does to the energy in them.

#include "core/laws/newton_law.hpp"
#include "core/laws/routh_law.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>

using namespace kairos;

namespace {

/// A free body of an impact, with the body that a law wants to see.
struct Party {
  Body body;
  BodyInertia inertia;
  BodyState state;
  Vector3 force = Vector3::Zero();

  [[nodiscard]] ImpactBody in_law() { return {body, inertia, state, force}; }
};

Party random_party(Random& random, const Vector3& at) {
  Party party;
  party.body.entity = find_entity("body")->make({});
  party.body.restitution = 1.0;
  party.inertia = {random.log_uniform(1e-3, 1e3),
                   Vector3(random.uniform(0.5, 1.0), random.uniform(0.5, 1.0), 1.0), true, 1.0};
  party.state.pose.position = at;
  party.state.pose.orientation =
      rotate(random.direction() * random.uniform(0.0, 3.0), Quaternion::Identity());
  party.state.twist = {random.direction() * random.uniform(), random.direction()};
  return party;
}

/// As the ledger counts it, in extended precision: the orientation's own rounding drops out.
long double kinetic(const Party& party) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  Eigen::Quaternion<long double> q = party.state.pose.orientation.cast<long double>();
  q.normalize();
  const Vector v = party.state.twist.linear.cast<long double>();
  const Vector w = q.conjugate() * Vector(party.state.twist.angular.cast<long double>());
  const Vector moments = party.inertia.principal.cast<long double>();
  return 0.5L * party.inertia.mass * v.squaredNorm() + 0.5L * w.dot(moments.cwiseProduct(w));
}

}  // namespace

TEST_CASE("newton: what an elastic impact changes of the energy is its roundoff, to the joule",
          "[law][energy]") {
  const auto law = make_newton_law();
  Random random(20261121);
  double largest = 0.0;
  for (int trial = 0; trial < 2000; ++trial) {
    Contact contact;
    contact.normal = random.direction();
    contact.point = random.direction();
    Party a = random_party(random, contact.point - contact.normal + 0.3 * random.direction());
    Party b = random_party(random, contact.point + contact.normal + 0.3 * random.direction());
    const Party before_a = a;
    const Party before_b = b;
    const long double before = kinetic(a) + kinetic(b);
    law->apply(contact, a.in_law(), b.in_law());
    const double change = static_cast<double>(kinetic(a) + kinetic(b) - before);
    const double roundoff =
        law->roundoff(contact, a.in_law(), b.in_law(), before_a.state, before_b.state);
    const double scale = static_cast<double>(before);
    largest = std::max(largest, std::abs(change) / scale);
    // Energies in extended precision: some tens of its roundings each.
    CHECK(std::abs(change - roundoff) <=
          64.0 * static_cast<double>(std::numeric_limits<long double>::epsilon()) * scale);
  }
  CHECK(largest > 1e-16);  // there was something to tell
}

TEST_CASE("newton: a lever that roundoff alone makes turns nothing, one that is there does",
          "[law]") {
  const auto law = make_newton_law();
  Random random(20261122);
  for (int trial = 0; trial < 500; ++trial) {
    CAPTURE(trial);
    Contact contact;
    contact.normal = random.direction();
    const double far = random.log_uniform(1.0, 1e6);  // from the origin, m
    contact.point = far * random.direction();
    const double reach = random.log_uniform(0.1, 10.0);
    Party a = random_party(random, contact.point - reach * contact.normal);
    Party b = random_party(random, contact.point + reach * contact.normal);
    a.state.twist = {contact.normal, Vector3::Zero()};
    b.state.twist = {-contact.normal, Vector3::Zero()};
    // The centroid of a patch that is symmetric about the line of the centres, but for roundoff.
    contact.point += 4.0 * std::numeric_limits<double>::epsilon() * far * random.direction();
    Party c = b;
    law->apply(contact, a.in_law(), b.in_law());
    CHECK(a.state.twist.angular == Vector3::Zero());
    CHECK(b.state.twist.angular == Vector3::Zero());
    // An offset of 1e-8 of the coordinates is an offset.
    const Vector3 aside = contact.normal.cross(random.direction());
    contact.point += 1e-8 * far * aside;
    a.state.twist = {contact.normal, Vector3::Zero()};
    law->apply(contact, a.in_law(), c.in_law());
    CHECK(c.state.twist.angular.norm() > 0.0);
  }
}

TEST_CASE("routh: what hardly slides as it strikes does not go on approaching", "[law][routh]") {
  const auto law = make_routh_law();
  Random random(20261122);
  for (int trial = 0; trial < 2000; ++trial) {
    Contact contact;
    contact.normal = random.direction();
    contact.point = random.direction();
    contact.friction = 0.5;
    contact.restitution = 0.0;
    Party a = random_party(random, contact.point - contact.normal + 0.3 * random.direction());
    Party b = random_party(random, contact.point + contact.normal + 0.3 * random.direction());
    a.state.twist = {contact.normal + random.log_uniform(1e-9, 1e-2) * random.direction(),
                     Vector3::Zero()};
    b.state.twist = {};
    const double before = normal_velocity(contact, a.state, b.state);
    law->apply(contact, a.in_law(), b.in_law());
    // Rounding of some products: arms of one, turned at up to twice the approach.
    CHECK(std::abs(normal_velocity(contact, a.state, b.state)) <= 1e-13 * std::abs(before));
  }
}
