#include "experiments/extremes/extreme_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

// All scenes last a few frames, with the one impact that matters 5.37 frames after the start: a
// phase that is no fraction of a frame.

namespace kairos::experiments {
namespace {

constexpr double h = 1.0 / 60.0;  // s, a frame
constexpr double phase = 5.37;    // frames to the impact
constexpr double radius = 0.02;   // m, of the ball where size is no axis

std::string vector(const Vector3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string head(const std::string& family, double duration, double frame, double G) {
  return fmt::format("name = \"{}\"\nsummary = \"extreme\"\nduration = {}\nframe = {}\nG = {}\n",
                     family, duration, frame, G);
}

std::string wall(const std::string& name, const Vector3& half, const Vector3& at) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nhalf_extents = {}\nposition = {}\n"
      "normal = [-1.0, 0.0, 0.0]\n",
      name, vector(half), vector(at));
}

std::string plane(const std::string& name, const Vector3& normal, const Vector3& at) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = {}\n"
      "position = {}\n",
      name, vector(normal), vector(at));
}

std::string ball(const std::string& name, double r, double mass, const Vector3& p, const Vector3& v,
                 double e = 1.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = {}\nmass = {}\nposition = {}\n"
      "velocity = {}\nrestitution = {}\n",
      name, r, mass, vector(p), vector(v), e);
}

/// Distance from where and how fast the body should be, relative to L and V.
double state_error(const BodyState& s, const Vector3& p, const Vector3& v, double L, double V) {
  return std::max((s.pose.position - p).norm() / L, (s.twist.linear - v).norm() / V);
}

/// The ball flies at a wall (or what the scene has in its place) and returns to its start.
struct Reflection {
  double speed = 1.0;
  double size = radius;
  double thickness = 0.02;
  double frame = h;
  Vector3 origin = Vector3::Zero();  ///< the near face of the wall
};

ExtremeCase reflection(const std::string& family, const Reflection& r,
                       const std::string& more = "") {
  const double gap = phase * r.speed * r.frame;
  const Vector3 start = r.origin - Vector3(gap + r.size, 0.0, 0.0);
  const Vector3 v(r.speed, 0.0, 0.0);
  const double side = 1e3 * std::max(r.size, r.thickness);
  ExtremeCase c;
  c.family = family;
  c.toml = head(family, 2.0 * phase * r.frame, r.frame, 0.0) +
           wall("wall", {0.5 * r.thickness, side, side},
                r.origin + Vector3(0.5 * r.thickness, 0.0, 0.0)) +
           more + ball("zz", r.size, 1.0, start, v);
  c.error = [=](const ExtremeRun& run) {
    return state_error(run.end.back(), start, -v, gap, r.speed);
  };
  return c;
}

/// Decades from lowest to highest, every `stride`th.
std::vector<double> decades(int lowest, int highest, int stride) {
  std::vector<double> out;
  for (int k = lowest; k <= highest; k += stride) {
    out.push_back(std::pow(10.0, k));
  }
  return out;
}

class Cases {
 public:
  explicit Cases(Size size) : full_(size == Size::full) {}

  std::vector<ExtremeCase> all() {
    speed_and_thickness();
    size_and_speed();
    frame_and_speed();
    distance_and_speed();
    mass_ratio();
    restitution_and_gravity();
    stiffness();
    spin();
    grazing();
    resting();
    simultaneous();
    consecutive();
    singles();
    return std::move(cases_);
  }

 private:
  [[nodiscard]] int stride(int quick) const { return full_ ? 1 : quick; }

  void add(ExtremeCase c, const std::string& x_name, double x, const std::string& y_name = "",
           double y = 0.0) {
    c.x_name = x_name;
    c.x = x;
    c.y_name = y_name;
    c.y = y;
    cases_.push_back(std::move(c));
  }

  void speed_and_thickness() {
    for (const double v : decades(-6, 8, stride(2))) {
      for (const double w : decades(-12, 0, stride(4))) {
        add(reflection("speed, wall", {.speed = v, .thickness = w}), "speed / m/s", v,
            "wall thickness / m", w);
      }
    }
  }

  void size_and_speed() {
    for (const double r : decades(-9, 9, stride(3))) {
      for (const double part : {0.01, 1.0, 100.0}) {  // of its radius, in a frame
        add(reflection("size", {.speed = part * r / h, .size = r, .thickness = r}), "radius / m", r,
            "radii a frame", part);
      }
    }
  }

  void frame_and_speed() {
    for (const double frame : decades(-6, 1, stride(1))) {
      for (const double v : decades(-3, 6, stride(3))) {
        add(reflection("frame", {.speed = v, .frame = frame}), "frame / s", frame, "speed / m/s",
            v);
      }
    }
  }

  void distance_and_speed() {
    for (const double far : decades(0, 9, stride(3))) {
      for (const double v : {1.0, 100.0}) {
        add(reflection("far from the origin",
                       {.speed = v, .origin = far * Vector3(0.48, 0.6, 0.64)}),
            "distance from the origin / m", far, "speed / m/s", v);
      }
    }
  }

  /// A ball meets one at rest, head on; either may be the heavy one.
  void mass_ratio() {
    for (const double ratio : decades(0, 12, stride(3))) {
      for (const double moving : {1.0, ratio}) {
        const double other = moving == 1.0 ? ratio : 1.0;
        const double v = 1.0, gap = phase * h * v;
        const double v1 = (moving - other) / (moving + other) * v;
        const double v2 = 2.0 * moving / (moving + other) * v;
        const double t = phase * h;
        const Vector3 end1(-2.0 * radius + v1 * t, 0.0, 0.0), end2(v2 * t, 0.0, 0.0);
        ExtremeCase c;
        c.family = "mass ratio";
        c.toml = head(c.family, 2.0 * t, h, 0.0) +
                 ball("a", radius, moving, {-gap - 2.0 * radius, 0.0, 0.0}, {v, 0.0, 0.0}) +
                 ball("b", radius, other, Vector3::Zero(), Vector3::Zero());
        c.error = [=](const ExtremeRun& run) {
          return std::max(state_error(run.end[0], end1, {v1, 0.0, 0.0}, gap, v),
                          state_error(run.end[1], end2, {v2, 0.0, 0.0}, gap, v));
        };
        add(c, "mass ratio", ratio, "moving: 0: the light, 1: the heavy",
            moving == 1.0 ? 0.0 : 1.0);
        if (ratio == 1.0) {
          break;
        }
      }
    }
  }

  /// A ball falls; the run ends before it would land for the second time with e = 1/2.
  void restitution_and_gravity() {
    for (const double e : {0.0, 0.5, 0.9, 1.0 - 1e-15, 1.0}) {
      for (const double g : {0.0, 1e-6, 1.0, 1e3, 1e6}) {
        const double t = phase * h, after = 0.9 * t;
        const double H = 0.5 * g * t * t;
        const double u = e * g * t;
        const double still = g == 0.0 ? H : u * after - 0.5 * g * after * after;
        const double y = radius + (e == 0.0 || g == 0.0 ? 0.0 : still);
        const Vector3 v(0.0, e == 0.0 || g == 0.0 ? 0.0 : u - g * after, 0.0);
        ExtremeCase c;
        c.family = "restitution, gravity";
        c.toml = head(c.family, t + after, h, g) +
                 plane("floor", Vector3::UnitY(), Vector3::Zero()) +
                 ball("zz", radius, 1.0, {0.0, radius + H, 0.0}, Vector3::Zero(), e);
        c.error = [=](const ExtremeRun& run) {
          return state_error(run.end.back(), {0.0, y, 0.0}, v, std::max(H, 1e-3 * radius),
                             std::max(g * t, radius));
        };
        add(c, "restitution", e, "gravity / m/s^2", g);
      }
    }
  }

  /// A ball on a spring, no contact.
  void stiffness() {
    for (const double k : decades(0, full_ ? 12 : 6, stride(2))) {
      const double w = std::sqrt(k), t = 2.0 * phase * h;
      ExtremeCase c;
      c.family = "stiffness";
      c.toml = head(c.family, t, h, 0.0) +
               ball("zz", radius, 1.0, {1.0, 0.0, 0.0}, Vector3::Zero()) +
               fmt::format(
                   "[[force]]\nkind = \"spring\"\nname = \"s\"\nbodies = [\"zz\"]\n"
                   "anchor = [0.0, 0.0, 0.0]\nstiffness = {}\n",
                   k);
      c.error = [=](const ExtremeRun& run) {
        return state_error(run.end.back(), {std::cos(w * t), 0.0, 0.0},
                           {-w * std::sin(w * t), 0.0, 0.0}, 1.0, w);
      };
      add(c, "stiffness / N/m", k);
    }
  }

  /// A long box that turns in place meets the corner of a plate: when, is known.
  void spin() {
    std::vector<double> angles{1.0, 40.0, 1e3};  // rad in a frame
    if (full_) {  // integrators take some 1e7 steps of a body that tumbles so fast
      angles.insert(angles.end(), {1e4, 1e5, 4e5});
    }
    for (const double angle : angles) {
      const double w = angle / h;
      const double reach = std::hypot(0.3, 0.005);
      const double turned =
          0.5 * std::numbers::pi - std::atan2(0.005, 0.3) - std::asin(0.05 / reach);
      ExtremeCase c;
      c.family = "spin";
      c.toml = head(c.family, 3.0 * h, h, 0.0) +
               "[[body]]\nname = \"plate\"\nentity = \"wall\"\nhalf_extents = [0.15, 0.005, 0.3]\n"
               "position = [0.45, 0.0, 0.0]\n" +
               fmt::format(
                   "[[body]]\nname = \"rod\"\nentity = \"body\"\nhalf_extents = [0.5, 0.05, "
                   "0.03]\nmass = 1.0\naxis_angle = [0.0, 0.0, 1.0, {}]\n"
                   "angular_velocity = [0.0, 0.0, {}]\n",
                   0.5 * std::numbers::pi, -w);
      c.error = [=](const ExtremeRun& run) {
        return run.impacts.empty() ? 1.0 : std::min(1.0, std::abs(run.impacts[0] - turned / w) * w);
      };
      add(c, "rad in a frame", angle);
    }
  }

  /// A ball flies at a floor under an angle that is next to nothing.
  void grazing() {
    for (const double angle : decades(-12, 0, stride(3))) {
      const double v = 1.0, down = v * std::sin(angle), along = v * std::cos(angle);
      const double t = phase * h;
      ExtremeCase c;
      c.family = "grazing";
      c.toml = head(c.family, 2.0 * t, h, 0.0) + plane("floor", Vector3::UnitY(), Vector3::Zero()) +
               ball("zz", radius, 1.0, {0.0, radius + down * t, 0.0}, {along, -down, 0.0});
      c.error = [=](const ExtremeRun& run) {
        // The error is relative to the way down, not along.
        return std::abs(run.end.back().twist.linear.y() - down) / down;
      };
      add(c, "angle / rad", angle);
    }
  }

  /// A body that lies on a floor stays.
  void resting() {
    for (const double e : {0.0, 0.5, 0.9, 1.0}) {
      for (const bool box : {false, true}) {
        ExtremeCase c;
        c.family = "at rest in contact";
        c.toml = head(c.family, 30.0 * h, h, 9.8) +
                 plane("floor", Vector3::UnitY(), Vector3::Zero()) +
                 (box ? fmt::format("[[body]]\nname = \"zz\"\nentity = \"body\"\nhalf_extents = "
                                    "[0.1, 0.02, 0.1]\nmass = 1.0\nposition = [0.0, 0.02, 0.0]\n"
                                    "restitution = {}\n",
                                    e)
                      : ball("zz", radius, 1.0, {0.0, radius, 0.0}, Vector3::Zero(), e));
        c.error = [](const ExtremeRun& run) {
          return state_error(run.end.back(), {0.0, radius, 0.0}, Vector3::Zero(), radius, 1.0);
        };
        add(c, "restitution", e, "what rests: 0: a ball, 1: a box", box ? 1.0 : 0.0);
      }
    }
  }

  /// N balls land at the same instant.
  void simultaneous() {
    for (const int n : {1, 4, 16, 64}) {
      const double g = 9.8, t = phase * h, H = 0.5 * g * t * t;
      ExtremeCase c;
      c.family = "simultaneous impacts";
      c.toml = head(c.family, 2.0 * t, h, g) + plane("a floor", Vector3::UnitY(), Vector3::Zero());
      for (int k = 0; k < n; ++k) {
        c.toml += ball(fmt::format("b{:03}", k), radius, 1.0,
                       {0.1 * (k % 8), radius + H, 0.1 * (k / 8)}, Vector3::Zero());
      }
      c.error = [=](const ExtremeRun& run) {
        double worst = 0.0;
        for (int k = 0; k < n; ++k) {
          const BodyState& s = run.end[static_cast<std::size_t>(k) + 1];
          worst = std::max(worst, std::abs(s.pose.position.y() - radius - H) / H);
        }
        return worst;
      };
      add(c, "bodies", n);
    }
  }

  /// A ball bounces between two walls.
  void consecutive() {
    for (const double n : decades(1, full_ ? 7 : 4, 1)) {
      const double gap = 1.0, v = 1.0;
      // Impacts per frame: irrational, so that no method is right because two errors cancel.
      const double every = std::numbers::phi * (n > 1e4 ? 6.0 : 0.25);
      const double frame = every * gap / v;
      const double end = (n - 0.5) * gap / v + 0.25 * gap / v;
      ExtremeCase c;
      c.family = "consecutive impacts";
      c.toml = head(c.family, end, frame, 0.0) +
               plane("left", Vector3::UnitX(), {-0.5 * gap - radius, 0.0, 0.0}) +
               plane("right", -Vector3::UnitX(), {0.5 * gap + radius, 0.0, 0.0}) +
               ball("zz", radius, 1.0, Vector3::Zero(), {v, 0.0, 0.0});
      // Flights of a whole gap lie between; after the n-th impact a quarter of one is left.
      const double side = std::fmod(n, 2.0) == 1.0 ? 1.0 : -1.0;
      const Vector3 p(side * 0.25 * gap, 0.0, 0.0), to(-side * v, 0.0, 0.0);
      c.error = [=](const ExtremeRun& run) { return state_error(run.end.back(), p, to, gap, v); };
      add(c, "impacts", n);
    }
  }

  void singles() {
    const double v = 1.0, t = phase * h, gap = v * t;
    const Vector3 diagonal(v, v, v);
    ExtremeCase corner;
    corner.family = "corner";
    corner.toml = head("corner", 2.0 * t, h, 0.0) + plane("x", -Vector3::UnitX(), Vector3::Zero()) +
                  plane("y", -Vector3::UnitY(), Vector3::Zero()) +
                  plane("z", -Vector3::UnitZ(), Vector3::Zero()) +
                  ball("zz", radius, 1.0, Vector3::Constant(-radius - gap), diagonal);
    corner.error = [=](const ExtremeRun& run) {
      return state_error(run.end.back(), Vector3::Constant(-radius - gap), -diagonal, gap, v);
    };
    add(corner, "walls met at once", 3.0);

    std::string nested;
    for (int k = 0; k < 5; ++k) {
      const double half = 0.5 / (k + 2);
      nested += wall(fmt::format("nested {}", k), Vector3::Constant(half), {half + 1e-3, 0.0, 0.0});
    }
    add(reflection("nested static boxes", {.thickness = 1.0}, nested), "boxes", 6.0);

    // Two walls close in on a ball: impacts without end, and no room in the end.
    for (const double closing : {0.1, 1.0}) {
      ExtremeCase gap_case;
      gap_case.family = "closing gap";
      gap_case.toml = head("closing gap", 1.0 / closing, h, 0.0) +
                      plane("fixed", -Vector3::UnitX(), {0.3, 0.0, 0.0}) +
                      plane("moving", Vector3::UnitX(), {-0.3, 0.0, 0.0}) +
                      fmt::format("[body.drive]\namplitude = [0.7, 0.0, 0.0]\nfrequency = {}\n",
                                  0.25 * closing) +
                      ball("zz", 0.1, 1.0, Vector3::Zero(), {1.0, 0.0, 0.0});
      gap_case.error = [](const ExtremeRun&) { return 1.0; };  // there is no answer: it must say so
      add(gap_case, "speed / m/s", closing);
    }
  }

  bool full_;
  std::vector<ExtremeCase> cases_;
};

}  // namespace

std::vector<ExtremeCase> extreme_cases(Size size) { return Cases(size).all(); }

}  // namespace kairos::experiments
