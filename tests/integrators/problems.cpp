#include "tests/integrators/problems.hpp"

#include "tests/integrators/reference.hpp"

#include <cmath>

namespace kairos::integrators::test {
namespace {

constexpr double attraction = 1.0;      // of the planet, m^3/s^2
constexpr double top_weight = 0.2;      // of the heavy top, N m
constexpr double stiffness = 4.0;       // of the spring, N/m
constexpr double damping = 0.3;         // N s/m
constexpr double shaking_rate = 1.7;    // rad/s
constexpr double shaking_depth = 0.25;  // m
constexpr double gravity = 9.8;         // m/s^2
constexpr double short_time = 2.0;      // s

const BodyInertia top_inertia{.mass = 2.0, .principal = {0.5, 0.8, 1.1}, .rotates = true};

class Planet final : public Force {
 public:
  void add(Instant /*t*/, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    const Vector3& r = bodies[0].pose.position;
    const double distance = r.norm();
    wrenches[0].force -= top_inertia.mass * attraction / (distance * distance * distance) * r;
    const Vector3 axis = bodies[0].pose.orientation * Vector3::UnitZ();
    wrenches[0].torque -= axis.cross(Vector3(0.0, top_weight, 0.0));
  }
  [[nodiscard]] double potential(Instant /*t*/, std::span<const BodyState> bodies) const override {
    return -top_inertia.mass * attraction / bodies[0].pose.position.norm() +
           top_weight * (bodies[0].pose.orientation * Vector3::UnitZ()).y();
  }
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] std::string description() const override { return "planet and top"; }
};

class ShakenSpring final : public Force {
 public:
  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    const Vector3 anchor(shaking_depth * std::sin(shaking_rate * t.seconds), 0.0, 0.0);
    wrenches[0].force -= stiffness * (bodies[0].pose.position - anchor);
    wrenches[0].force -= damping * bodies[0].twist.linear;
  }
  [[nodiscard]] double potential(Instant /*t*/,
                                 std::span<const BodyState> /*bodies*/) const override {
    return 0.0;
  }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "shaken spring"; }
};

using State13 = Vector<13>;
using Triple = std::array<long double, 3>;

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// v turned by the unit quaternion (w, u); the conjugate for sign -1.
Triple turned(const State13& y, const Triple& v, int sign) {
  const Triple u{sign * y[7], sign * y[8], sign * y[9]};
  const Triple uv = cross(u, v);
  const Triple uuv = cross(u, uv);
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = v[i] + 2 * (y[6] * uv[i] + uuv[i]);
  }
  return result;
}

// Position, velocity, quaternion (w, x, y, z), angular velocity in the world frame, under an
// acceleration and a torque.
State13 body_rate(const State13& y, const Triple& acceleration, const Triple& torque,
                  const BodyInertia& inertia) {
  const Triple w{y[10], y[11], y[12]};
  const Triple w_B = turned(y, w, -1);
  const Triple torque_B = turned(y, torque, -1);
  Triple momentum{};
  for (std::size_t i = 0; i < 3; ++i) {
    momentum[i] = static_cast<long double>(inertia.principal[static_cast<int>(i)]) * w_B[i];
  }
  const Triple gyroscopic = cross(w_B, momentum);
  Triple rate_B{};
  for (std::size_t i = 0; i < 3; ++i) {
    rate_B[i] = (torque_B[i] - gyroscopic[i]) /
                static_cast<long double>(inertia.principal[static_cast<int>(i)]);
  }
  const Triple rate = turned(y, rate_B, 1);
  const Triple wu = cross(w, {y[7], y[8], y[9]});
  State13 dy{};
  for (std::size_t i = 0; i < 3; ++i) {
    dy[i] = y[3 + i];
    dy[3 + i] = acceleration[i];
    dy[7 + i] = (y[6] * w[i] + wu[i]) / 2;
    dy[10 + i] = rate[i];
  }
  dy[6] = -(w[0] * y[7] + w[1] * y[8] + w[2] * y[9]) / 2;
  return dy;
}

State13 kepler_top_rate(long double /*t*/, const State13& y) {
  const long double distance = std::sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
  const long double pull = attraction / (distance * distance * distance);
  const Triple axis = turned(y, {0, 0, 1}, 1);
  const Triple torque = cross({0, static_cast<long double>(top_weight), 0}, axis);
  return body_rate(y, {-pull * y[0], -pull * y[1], -pull * y[2]}, torque, top_inertia);
}

State13 free_top_rate(long double /*t*/, const State13& y) {
  return body_rate(y, {0, -static_cast<long double>(gravity), 0}, {0, 0, 0}, top_inertia);
}

State13 shaken_spring_rate(long double t, const State13& y) {
  const long double k = stiffness / top_inertia.mass, c = damping / top_inertia.mass;
  const long double anchor = shaking_depth * std::sin(static_cast<long double>(shaking_rate) * t);
  return body_rate(y, {-k * (y[0] - anchor) - c * y[3], -k * y[1] - c * y[4], -k * y[2] - c * y[5]},
                   {0, 0, 0}, top_inertia);
}

State13 flat(const BodyState& state) {
  const Vector3 &p = state.pose.position, &v = state.twist.linear, &w = state.twist.angular;
  const Quaternion& q = state.pose.orientation;
  return {p.x(), p.y(), p.z(), v.x(), v.y(), v.z(), q.w(),
          q.x(), q.y(), q.z(), w.x(), w.y(), w.z()};
}

BodyState body_state(const State13& y) {
  const auto part = [&](std::size_t i) { return static_cast<double>(y[i]); };
  return {{{part(0), part(1), part(2)}, Quaternion(part(6), part(7), part(8), part(9))},
          {{part(3), part(4), part(5)}, {part(10), part(11), part(12)}}};
}

/// The solution at the ends of `count` equal parts.
template <typename Rate>
std::vector<BodyState> solution_at(const Rate& rate, const Problem& problem, int count) {
  constexpr int steps = 192;  // of the reference, at least, each of order 20
  std::vector<BodyState> states;
  State13 y = flat(problem.initial);
  long double t = 0;
  for (int k = 1; k <= count; ++k) {
    const double next = problem.duration * k / count;
    y = solve<13>(rate, t, y, next, (steps + count - 1) / count);
    t = next;
    states.push_back(body_state(y));
  }
  return states;
}

template <typename Rate>
void solve_reference(const Rate& rate, Problem& problem) {
  constexpr int samples = 97;  // coprime to the halved steps: samples fall inside them
  for (int k = 1; k <= samples; ++k) {
    problem.times.push_back(problem.duration * k / samples);
  }
  problem.solution = solution_at(rate, problem, samples);
  problem.quarters = solution_at(rate, problem, 4);
}

Problem make(std::string name, double duration, const Vector3& constant_force, bool rotates,
             std::unique_ptr<const Force> force) {
  Problem problem;
  problem.name = std::move(name);
  BodyInertia inertia = top_inertia;
  inertia.rotates = rotates;
  problem.island = {
      .bodies = {0}, .inertia = {inertia}, .constant_force = {constant_force}, .forces = {}};
  if (force) {
    problem.island.forces.push_back(force.get());
    problem.forces.push_back(std::move(force));
  }
  problem.initial.pose.position = {0.8, 0.1, -0.2};
  problem.initial.twist.linear = {-0.1, 1.2, 0.3};
  if (rotates) {
    problem.initial.pose.orientation = Quaternion(0.5, -0.5, 0.5, 0.5);
    problem.initial.twist.angular = {-0.1, 2.1, 0.6};
  }
  problem.duration = duration;
  return problem;
}

}  // namespace

Problem make_kepler_top(double duration) {
  Problem made = make("kepler top", duration, Vector3::Zero(), true, std::make_unique<Planet>());
  solve_reference(kepler_top_rate, made);
  return made;
}

Problem make_free_top(double duration) {
  Problem made = make("free top", duration, {0.0, -gravity * top_inertia.mass, 0.0}, true, nullptr);
  solve_reference(free_top_rate, made);
  return made;
}

Problem make_shaken_spring(double duration) {
  Problem made =
      make("shaken spring", duration, Vector3::Zero(), false, std::make_unique<ShakenSpring>());
  solve_reference(shaken_spring_rate, made);
  return made;
}

const Problem& kepler_top() {
  static const Problem problem = make_kepler_top(short_time);
  return problem;
}

const Problem& free_top() {
  static const Problem problem = make_free_top(short_time);
  return problem;
}

const Problem& shaken_spring() {
  static const Problem problem = make_shaken_spring(short_time);
  return problem;
}

}  // namespace kairos::integrators::test
