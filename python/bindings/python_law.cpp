#include <fmt/format.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/callables.hpp"
#include "python/bindings/errors.hpp"
#include <cmath>

namespace py = pybind11;

namespace kairos::python {
namespace {

/// One of the two bodies, as a law sees it.
struct LawBody {
  std::string name;
  std::string entity;
  double mass = 0.0;  ///< infinite: not free
  double restitution = 1.0;
  std::array<double, 3> position{}, velocity{}, angular_velocity{};
};

/// What a law is called with.
struct LawContact {
  std::array<double, 3> point{}, normal{};
  double gap = 0.0;
  double restitution = 1.0, friction = 0.0;  ///< of the pair
  LawBody a, b;
};

std::array<double, 3> three(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

py::array_t<double> array_of(const std::array<double, 3>& v) {
  return py::array_t<double>(3, v.data());
}

LawBody law_body(const ImpactBody& body) {
  return {body.body.name,
          std::string(body.body.entity->kind()),
          body.inertia.mass > 0.0 ? body.inertia.mass : INFINITY,
          body.body.restitution,
          three(body.state.pose.position),
          three(body.state.twist.linear),
          three(body.state.twist.angular)};
}

/// An impact law of the user's: new velocities of both.
class PythonLaw final : public ImpactLaw {
 public:
  explicit PythonLaw(const py::object& callable) : callable_(callable) {}

  [[nodiscard]] LawInfo info() const override {
    return {.name = "python", .needs_contact = true, .summary = "a callable of the user's"};
  }

  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    const py::gil_scoped_acquire lock;
    const LawContact seen{three(contact.point), three(contact.normal), contact.gap,
                          contact.restitution,  contact.friction,      law_body(a),
                          law_body(b)};
    const py::object answer = callable_.get()(seen);
    if (!py::isinstance<py::tuple>(answer) || py::len(answer) != 2) {
      fail(seen, fmt::format("returned {}; needed: (velocity_a, velocity_b), None for one that "
                             "stays as it is",
                             std::string(py::repr(answer))));
    }
    const auto pair = py::reinterpret_borrow<py::tuple>(answer);
    const double gained = take(pair[0], a, seen) + take(pair[1], b, seen);
    return gained > 0.0 ? ImpactEnergy{.driven_work = gained}
                        : ImpactEnergy{.restitution_loss = gained};
  }

 private:
  [[noreturn]] static void fail(const LawContact& contact, const std::string& what) {
    throw CallableError(
        fmt::format("impact law on '{}' and '{}': {}", contact.a.name, contact.b.name, what));
  }

  /// Gives a body its new velocity; returns the kinetic energy that it gained, J.
  static double take(const py::handle& velocity, ImpactBody& body, const LawContact& contact) {
    if (velocity.is_none()) {
      return 0.0;
    }
    const Doubles v = Doubles::ensure(velocity);
    if (!v || v.ndim() != 1 || v.shape(0) != 3) {
      PyErr_Clear();
      fail(contact, fmt::format("gave '{}' the velocity {}; needed: an array of the shape (3,)",
                                body.body.name, std::string(py::repr(velocity))));
    }
    const Vector3 after(v.data()[0], v.data()[1], v.data()[2]);
    if (!after.allFinite()) {
      fail(contact, fmt::format("gave '{}' the velocity ({}, {}, {}); needed: finite numbers",
                                body.body.name, after.x(), after.y(), after.z()));
    }
    if (!(body.inertia.mass > 0.0)) {
      fail(contact,
           fmt::format("gave '{}' a velocity; it is not free: return None for it", body.body.name));
    }
    Vector3& now = body.state.twist.linear;
    const double gained = 0.5 * body.inertia.mass * (after - now).dot(after + now);
    now = after;
    return gained;
  }

  Callable callable_;
};

}  // namespace

std::shared_ptr<const ImpactLaw> make_python_law(const py::object& callable) {
  return std::make_shared<const PythonLaw>(callable);
}

void bind_contact(py::module_& module) {
  py::class_<LawBody>(module, "ContactBody", "One of the two bodies of a contact.")
      .def_readonly("name", &LawBody::name)
      .def_readonly("entity", &LawBody::entity)
      .def_readonly("mass", &LawBody::mass, "kg; infinite: not free.")
      .def_readonly("restitution", &LawBody::restitution)
      .def_property_readonly("position", [](const LawBody& b) { return array_of(b.position); })
      .def_property_readonly("velocity", [](const LawBody& b) { return array_of(b.velocity); })
      .def_property_readonly("angular_velocity",
                             [](const LawBody& b) { return array_of(b.angular_velocity); });
  py::class_<LawContact>(module, "Contact", "Where and how two bodies touch.")
      .def_readonly("gap", &LawContact::gap, "m; negative: penetration.")
      .def_readonly("restitution", &LawContact::restitution, "Of the pair, 0 to 1.")
      .def_readonly("friction", &LawContact::friction, "Coulomb's, of the pair; may be infinite.")
      .def_readonly("a", &LawContact::a)
      .def_readonly("b", &LawContact::b)
      .def_property_readonly("point", [](const LawContact& c) { return array_of(c.point); })
      .def_property_readonly(
          "normal", [](const LawContact& c) { return array_of(c.normal); }, "Unit, from a to b.");
}

}  // namespace kairos::python
