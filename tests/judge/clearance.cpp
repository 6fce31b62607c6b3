#include "tests/judge/clearance.hpp"

#include "tests/judge/turning.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace kairos::judge {
namespace {

Long error_radii(const Query& q) { return Long(q.a.error_radius) + Long(q.b.error_radius); }

bool rounded_boxes(const Query& q) {
  return q.a.kind == Kind::box && q.b.kind == Kind::box && error_radii(q) > 0;
}

template <typename S>
Separation<S> gap_at(const Query& q, const Placed<S>& at) {
  Separation<S> s = rounded_boxes(q) ? distance(q.a, q.b, at) : separation(q.a, q.b, at);
  s.gap = s.gap - S(q.a.error_radius) - S(q.b.error_radius);
  return s;
}

/// Long tells the sign unless the gap is this close to 0; of boxes it may miss the axis of two
/// almost parallel edges, so that only "apart" is taken from it.
bool settled(const Query& q, Long gap, Long rounding) {
  const bool boxes = q.a.kind == Kind::box && q.b.kind == Kind::box;
  return gap > rounding || (!boxes && gap < -rounding);
}

/// One body's part of the bound: sum of h_i |n . u_i| as tangents, remainders and amplitudes.
struct Reach {
  Long constant = 0;  ///< of a sphere
  std::array<Long, 3> half{}, value{}, slope{}, bend{};
  Long widest = 0;  ///< at any time: of the ball, or of the solid of revolution that a box sweeps
  bool turning = false;

  [[nodiscard]] Long tangent(Long x) const {
    Long sum = constant;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += half[i] * (magnitude(value[i] + slope[i] * x) + bend[i] * x * x / 2);
    }
    return sum;
  }
};

/// The lower bound of the gap from one instant on, along one normal.
struct Bound {
  Long value = 0, slope = 0;  ///< of n . offset
  Long pull = 0;              ///< its second derivative, where n stands still
  Reach a, b;
  bool n_turns = false;
  // Of a normal that turns: |w|, |w x n|, |w x offset|, |offset'|, |offset''|.
  Long rate = 0, across = 0, arm = 0, speed = 0, acceleration = 0;

  /// Above `level` on all of [0, x]?
  [[nodiscard]] bool above(Long level, Long x) const {
    return tangents_above(level, x) ||
           (!n_turns && (a.turning || b.turning) && cylinders_above(level, x));
  }

 private:
  [[nodiscard]] Long translation(Long x) const {
    Long second = std::min(pull, Long(0));
    if (n_turns) {
      const Long drift = speed * x + acceleration * x * x / 2;
      second =
          -(across * (arm + rate * drift) + 2 * across * (speed + acceleration * x) + acceleration);
    }
    return value + slope * x + second * x * x / 2;
  }
  [[nodiscard]] Long lowest_translation(Long x) const {
    if (pull > 0 && slope < 0 && -slope < pull * x) {
      return value - slope * slope / (2 * pull);
    }
    return std::min(value, value + slope * x + pull * x * x / 2);
  }
  [[nodiscard]] bool tangents_above(Long level, Long x) const {
    if (!n_turns && !a.turning && !b.turning) {
      return lowest_translation(x) - a.tangent(0) - b.tangent(0) > level;
    }
    return translation(0) - a.tangent(0) - b.tangent(0) > level &&
           translation(x) - a.tangent(x) - b.tangent(x) > level;
  }
  [[nodiscard]] bool cylinders_above(Long level, Long x) const {
    return lowest_translation(x) - a.widest - b.widest > level;
  }
};

/// How far a box reaches along n, whatever the angle that it has turned about its spin.
Long revolved_reach(const Body& body, const Axes<Long>& axes, Vector<Long> n) {
  const Vector<Long> w(body.spin);
  const Long square = dot(w, w);
  const Long along = dot(n, w) / square;
  const Long beside = norm(cross(w, n)) / square;
  Long farthest = 0;
  for (int signs = 0; signs < 8; ++signs) {
    const Vector<Long> corner = axes.world({body.half_extents.x() * ((signs & 1) != 0 ? 1 : -1),
                                            body.half_extents.y() * ((signs & 2) != 0 ? 1 : -1),
                                            body.half_extents.z() * ((signs & 4) != 0 ? 1 : -1)});
    farthest = std::max(farthest, along * dot(corner, w) + beside * norm(cross(w, corner)));
  }
  return farthest;
}

/// `w_n`: spin of the normal, 0 if it stands still.
Reach reach_of(const Body& body, const Axes<Long>& axes, const Turning& turning, Vector<Long> n,
               Vector<Long> w_n) {
  Reach reach;
  if (body.kind == Kind::sphere) {
    reach.constant = body.half_extents.x();
    reach.widest = reach.constant;
  }
  if (body.kind != Kind::box) {
    return reach;
  }
  const Vector<Long> w = turning.w;
  const Long swing = norm(cross(w_n, n));
  reach.turning = !turning.steady || norm(w - w_n) > 0;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    reach.half[i] = body.half_extents[k];
    reach.value[i] = dot(n, axes[k]);
    if (!reach.turning) {
      continue;
    }
    reach.slope[i] = dot(n, cross(w - w_n, axes[k]));
    // Of steady turning, |w x u| and |w_n x n| are constant.
    const Long turn_u = turning.steady ? norm(cross(w, axes[k])) : turning.rate;
    const Long turn_n = swing > 0 || !turning.steady ? turning.rate : norm(cross(w, n));
    reach.bend[i] = swing * norm(w_n) + 2 * swing * turn_u + turn_n * turn_u + turning.change;
  }
  if (!turning.steady) {
    reach.widest = Long(body.reach()) * (1 + 1e-15L);
  } else {
    reach.widest = turning.rate > 0 ? revolved_reach(body, axes, n) : reach.tangent(0);
  }
  return reach;
}

/// How both bodies go on from an instant.
struct Flight {
  Turning a, b;
  Vector<Long> velocity;      ///< of b less that of a
  Vector<Long> acceleration;  ///< likewise, the constant part
  Long change = 0;            ///< bound of the rest of it
};

Flight flight_from(const Query& q, Long t) {
  const Travel a = travel_of(q.a, t, q.duration);
  const Travel b = travel_of(q.b, t, q.duration);
  return {turning_of(q.a, t, q.duration), turning_of(q.b, t, q.duration), b.velocity - a.velocity,
          b.acceleration - a.acceleration, a.change + b.change};
}

/// The velocity of n that keeps it across the edges which it is across of, of bodies that turn.
Vector<Long> following(const Query& q, const Placed<Long>& at, const Flight& flight,
                       Vector<Long> n) {
  Vector<Long> first;
  Vector<Long> velocity;
  int found = 0;
  for (const bool of_a : {true, false}) {
    const Body& body = of_a ? q.a : q.b;
    if (body.kind != Kind::box) {
      continue;
    }
    const Axes<Long>& axes = of_a ? at.a : at.b;
    for (int k = 0; k < 3 && found < 2; ++k) {
      if (magnitude(dot(n, axes[k])) > 1e-6L) {
        continue;
      }
      Vector<Long> u = axes[k] - n * dot(n, axes[k]);
      const Long wanted =
          -dot(n, cross((of_a ? flight.a : flight.b).w, axes[k])) - dot(velocity, axes[k]);
      if (found == 1) {
        u = u - first * dot(first, u);
      }
      const Long square = dot(u, u);
      if (square < 1e-6L) {
        continue;  // parallel to the first
      }
      velocity = velocity + u * (wanted / square);
      first = u * (1 / root(square));
      ++found;
    }
  }
  return velocity;
}

/// How the normal may turn: at most four ways worth trying.
struct Spins {
  std::array<Vector<Long>, 4> spin;
  std::size_t count = 0;

  void add(Vector<Long> w) { spin[count++] = w; }
};

Spins spins_of_normal(const Query& q, const Placed<Long>& at, const Flight& flight,
                      Vector<Long> n) {
  Spins spins;
  for (const Body* body : {&q.a, &q.b}) {
    if (body->kind == Kind::half_space) {
      spins.add(Vector<Long>(body->spin));
      return spins;
    }
  }
  spins.add({});
  const Vector<Long> velocity = following(q, at, flight, n);
  if (norm(velocity) > 0) {
    spins.add(cross(n, velocity));
  }
  if (q.a.kind == Kind::box && flight.a.rate > 0) {
    spins.add(flight.a.w);
  }
  if (q.b.kind == Kind::box && flight.b.rate > 0) {
    spins.add(flight.b.w);
  }
  return spins;
}

Bound bound_along(const Query& q, const Placed<Long>& at, const Flight& flight, Vector<Long> n,
                  Vector<Long> w_n) {
  Bound bound;
  bound.value = dot(n, at.offset) - error_radii(q);
  bound.slope = dot(n, flight.velocity) + dot(cross(w_n, n), at.offset);
  bound.pull = dot(n, flight.acceleration) - flight.change;
  bound.a = reach_of(q.a, at.a, flight.a, n, w_n);
  bound.b = reach_of(q.b, at.b, flight.b, n, w_n);
  bound.rate = norm(w_n);
  bound.n_turns = bound.rate > 0;
  bound.across = norm(cross(w_n, n));
  bound.arm = norm(cross(w_n, at.offset));
  bound.speed = norm(flight.velocity);
  bound.acceleration = norm(flight.acceleration) + flight.change;
  return bound;
}

/// The bodies as balls, along the line of their centres.
Bound bound_of_balls(const Query& q, const Placed<Long>& at, const Flight& flight) {
  Bound bound = bound_along(q, at, flight, at.offset * (1 / norm(at.offset)), {});
  bound.a = {};
  bound.b = {};
  bound.a.constant = bound.a.widest = Long(q.a.reach()) * (1 + 1e-15L);
  bound.b.constant = bound.b.widest = Long(q.b.reach()) * (1 + 1e-15L);
  return bound;
}

/// The bounds that may hold from one instant on.
struct Bounds {
  std::array<Bound, 13> bound;  // four ways to turn of three normals, and the balls
  std::size_t count = 0;

  [[nodiscard]] bool above(Long level, Long x) const {
    return std::any_of(bound.begin(), bound.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const Bound& b) { return b.above(level, x); });
  }
};

/// n put across the edges that it is almost across of: a direction between nearest points that are
/// 1e-9 m apart is no better than 1e-10.
Vector<Long> straightened(const Query& q, const Placed<Long>& at, Vector<Long> n) {
  Vector<Long> first;
  int found = 0;
  for (const bool of_a : {true, false}) {
    if ((of_a ? q.a : q.b).kind != Kind::box) {
      continue;
    }
    for (int k = 0; k < 3 && found < 2; ++k) {
      Vector<Long> u = (of_a ? at.a : at.b)[k];
      if (magnitude(dot(n, u)) > 1e-6L) {
        continue;
      }
      u = u - first * dot(first, u);
      const Long square = dot(u, u);
      if (square < 1e-6L) {
        continue;
      }
      n = n - u * (dot(n, u) / square);
      first = u * (1 / root(square));
      ++found;
    }
  }
  return n * (1 / norm(n));
}

void add_bounds(const Query& q, const Placed<Long>& at, const Flight& flight, Vector<Long> n,
                Bounds& bounds) {
  const Spins spins = spins_of_normal(q, at, flight, n);
  for (std::size_t i = 0; i < spins.count; ++i) {
    bounds.bound[bounds.count++] = bound_along(q, at, flight, n, spins.spin[i]);
  }
}

Bounds bounds_from(const Query& q, const Placed<Long>& at, Vector<Long> n, Long t) {
  Bounds bounds;
  const Flight flight = flight_from(q, t);
  add_bounds(q, at, flight, n, bounds);
  if (rounded_boxes(q)) {
    add_bounds(q, at, flight, straightened(q, at, n), bounds);
    add_bounds(q, at, flight, separation(q.a, q.b, at).normal, bounds);
  }
  const bool balls = q.a.kind != Kind::half_space && q.b.kind != Kind::half_space;
  if (balls && norm(at.offset) > 0) {
    bounds.bound[bounds.count++] = bound_of_balls(q, at, flight);
  }
  return bounds;
}

}  // namespace

double roundoff(const Query& q, double t) {
  const Long s_a = Long(q.a.age) + t;
  const Long s_b = Long(q.b.age) + t;
  Long places = travelled(q.a, s_a) + travelled(q.b, s_b);
  for (const Body* body : {&q.a, &q.b}) {
    if (body->kind == Kind::half_space) {
      places *= 1 + angle_turned(*body, body->age + Long(t));
    }
  }
  const Long reaches =
      q.a.reach() * (1 + angle_turned(q.a, s_a)) + q.b.reach() * (1 + angle_turned(q.b, s_b));
  const Long unit = 8 * std::numeric_limits<double>::epsilon();
  return static_cast<double>(unit * (places + reaches + error_radii(q)) + 1e-321L);
}

Long Level::stop(const Query& q, Long t) const {
  const Long size = std::max(Long(floor), share * Long(roundoff(q, static_cast<double>(t))));
  return above ? size : -size;
}

Long Level::prove(const Query& q, Long t) const { return stop(q, t) * (above ? 0.5L : 2.0L); }

double exact_gap(const Query& q, Long t) {
  const Long rough = gap_at(q, placed<Long>(q, t)).gap;
  if (settled(q, rough, Long(roundoff(q, static_cast<double>(t))) / 16)) {
    return static_cast<double>(rough);
  }
  return static_cast<double>(gap_at(q, placed<Quad>(q, Quad(t))).gap);
}

double exact_gap(const Query& q, const Pose& a, const Pose& b) {
  const Long rough = gap_at(q, placed<Long>(a, b)).gap;
  if (settled(q, rough, Long(roundoff(q, 0.0)) / 16)) {
    return static_cast<double>(rough);
  }
  return static_cast<double>(gap_at(q, placed<Quad>(a, b)).gap);
}

Look look(const Query& q, Long t0, Long t1, const Level& levels, int budget) {
  Long t = t0;
  Long step = t1 - t0;
  for (int looks = 0; looks < budget; ++looks) {
    const Placed<Long> at = placed<Long>(q, t);
    Separation<Long> s = gap_at(q, at);
    const Long stop = levels.stop(q, t);
    if (s.gap <= stop) {
      const Separation<Quad> sure = gap_at(q, placed<Quad>(q, Quad(t)));
      if (sure.gap <= Quad(stop)) {
        return {Finding::contact, t};
      }
      s.normal = {Long(sure.normal.x), Long(sure.normal.y), Long(sure.normal.z)};
    }
    if (t >= t1) {
      return {Finding::clear, t};
    }
    const Long level = levels.prove(q, t);
    const Bounds bounds = bounds_from(q, at, s.normal, t);
    step = std::min(4 * step, t1 - t);
    while (!bounds.above(level, step)) {
      step /= 2;
      if (!(t + step > t)) {
        return {Finding::unproven, t};
      }
    }
    t = step < t1 - t ? t + step : t1;
  }
  return {Finding::unproven, t};
}

}  // namespace kairos::judge
