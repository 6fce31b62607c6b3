#pragma once

#include "ccd/linear/linear_impact.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kairos::reference {

/// Random queries of the kinds that break floating-point predicates, and of those that do not.
enum class LinearFamily : std::uint8_t {
  general,        ///< uniform in a cube
  close,          ///< what a broad phase leaves over: near each other, moving a little
  grid,           ///< small whole numbers: every degeneracy happens
  tiny_grid,      ///< -1, 0 and 1
  flat,           ///< in a plane all the time
  on_a_line,      ///< on a line all the time
  at_rest,        ///< nothing moves
  one_moves,      ///< all but one point are at rest
  translation,    ///< one of the two translates as a whole
  touch,          ///< meet at a given time on a vertex, on an edge or inside, exactly
  touch_ulp,      ///< the same, and one number moved by one ulp
  double_root,    ///< the volume touches zero and turns back, or misses by a little
  cluster,        ///< three roots that are close
  triple_root,    ///< a power of one linear factor times others
  scaled_axes,    ///< a grid whose axes have units from 2^-1000 to 2^1000
  wild_exponents  ///< every number of any magnitude, subnormal to 1e300
};
inline constexpr int linear_families = 16;
inline constexpr std::array linear_family_names{
    "general", "close",       "grid",        "tiny grid",     "flat",      "on a line",
    "at rest", "one moves",   "translation", "touch",         "touch ulp", "double root",
    "cluster", "triple root", "scaled axes", "wild exponents"};

class LinearFamilies {
 public:
  LinearFamilies(LinearFamily family, ccd::LinearKind kind, std::uint64_t seed)
      : family_(family),
        random_(seed, 64 * static_cast<std::uint64_t>(family) + static_cast<std::uint64_t>(kind)) {
    query_.kind = kind;
  }

  ccd::LinearQuery next() {
    query_.separation = 0.0;
    switch (family_) {
      case LinearFamily::general:
        fill([this] { return random_.uniform(-1.0, 1.0); });
        break;
      case LinearFamily::close:
        close();
        break;
      case LinearFamily::grid:
        fill([this] { return whole(3); });
        break;
      case LinearFamily::tiny_grid:
        fill([this] { return whole(1); });
        break;
      case LinearFamily::flat:
        flat();
        break;
      case LinearFamily::on_a_line:
        on_a_line();
        break;
      case LinearFamily::at_rest:
        fill([this] { return whole(2); });
        query_.end = query_.start;
        break;
      case LinearFamily::one_moves:
        one_moves();
        break;
      case LinearFamily::translation:
        translation();
        break;
      case LinearFamily::touch:
        touch();
        break;
      case LinearFamily::touch_ulp:
        touch();
        nudge();
        break;
      case LinearFamily::double_root:
        double_root();
        break;
      case LinearFamily::cluster:
        cluster();
        break;
      case LinearFamily::triple_root:
        triple_root();
        break;
      case LinearFamily::scaled_axes:
        scaled_axes();
        break;
      case LinearFamily::wild_exponents:
        fill([this] {
          return random_.below(4) == 0
                     ? whole(1)
                     : std::ldexp(whole(4), static_cast<int>(random_.below(2060)) - 1074);
        });
        break;
    }
    return query_;
  }

 private:
  double whole(int most) {
    return static_cast<double>(random_.below(static_cast<std::uint64_t>(2 * most + 1))) - most;
  }
  template <typename Draw>
  void fill(const Draw& draw) {
    for (ccd::FourPoints* points : {&query_.start, &query_.end}) {
      for (Vector3& p : *points) {
        for (int k = 0; k < 3; ++k) {
          p[k] = draw();
        }
      }
    }
  }
  Vector3 grid_vector(int most) {
    const double x = whole(most);
    const double y = whole(most);
    return {x, y, whole(most)};
  }
  double& any_number() {
    Vector3& p = (random_.below(2) == 0 ? query_.start : query_.end)[random_.below(4)];
    return p[static_cast<int>(random_.below(3))];
  }
  void nudge() {
    double& x = any_number();
    x = x == 0.0 ? 0x1p-60 : std::nextafter(x, random_.below(2) == 0 ? -1e9 : 1e9);
  }
  /// Coordinates change their places and are mixed by small whole numbers: volumes stay.
  void mix() {
    for (int i = 0; i < 3; ++i) {
      const auto from = static_cast<int>(random_.below(3));
      const auto to =
          static_cast<int>((static_cast<std::uint64_t>(from) + 1 + random_.below(2)) % 3);
      const double factor = whole(1);
      for (ccd::FourPoints* points : {&query_.start, &query_.end}) {
        for (Vector3& p : *points) {
          p[to] += factor * p[from];
        }
      }
    }
  }
  Vector3 in_cube(double half) {
    const double x = random_.uniform(-half, half);
    const double y = random_.uniform(-half, half);
    return {x, y, random_.uniform(-half, half)};
  }
  /// A point above or beside a triangle, or two edges that cross above each other.
  void close() {
    const Vector3 drift = in_cube(0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      query_.start[i] = in_cube(1.0);
    }
    const double a = random_.uniform(-0.25, 1.25);
    const double b = random_.uniform(-0.25, 1.25);
    const ccd::FourPoints& p = query_.start;
    if (query_.kind == ccd::LinearKind::vertex_face) {
      query_.start[0] = p[1] + a * (p[2] - p[1]) + (1.0 - a) * b * (p[3] - p[1]) + in_cube(0.1);
    } else {
      const Vector3 shift = p[0] + a * (p[1] - p[0]) - p[2] - b * (p[3] - p[2]) + in_cube(0.1);
      query_.start[2] += shift;
      query_.start[3] += shift;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      query_.end[i] = query_.start[i] + drift + in_cube(0.1);
    }
  }
  void flat() {
    fill([this] { return random_.below(2) == 0 ? whole(2) : 0.25 * whole(9); });
    for (ccd::FourPoints* points : {&query_.start, &query_.end}) {
      const double height = whole(2);
      for (Vector3& p : *points) {
        p[2] = height;
      }
    }
    mix();
  }
  void on_a_line() {
    const Vector3 along = grid_vector(1);
    const Vector3 from = grid_vector(2);
    const Vector3 drift = grid_vector(1);
    for (std::size_t i = 0; i < 4; ++i) {
      query_.start[i] = from + 0.5 * whole(6) * along;
      query_.end[i] = from + drift + 0.5 * whole(6) * along;
    }
    if (random_.below(8) == 0) {
      nudge();
    }
  }
  void one_moves() {
    fill([this] { return whole(2); });
    const auto moving = random_.below(4);
    for (std::size_t i = 0; i < 4; ++i) {
      query_.end[i] = i == moving ? query_.end[i] : query_.start[i];
    }
  }
  void translation() {
    fill([this] { return 0.125 * whole(16); });
    const Vector3 shift = grid_vector(2);
    const std::size_t count = query_.kind == ccd::LinearKind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < 4; ++i) {
      query_.end[i] = i < count ? Vector3(query_.start[i] + shift) : query_.start[i];
    }
  }
  /// Points that touch at a time of a few bits: start and end are on lines through them.
  void touch() {
    const auto halves = static_cast<int>(random_.below(4));
    const double t = std::ldexp(
        1.0 + static_cast<double>(random_.below(1U << static_cast<unsigned>(halves))), -halves);
    ccd::FourPoints at;
    for (Vector3& p : at) {
      p = 4.0 * grid_vector(4);
    }
    const double first = 0.25 * static_cast<double>(random_.below(5));
    const double second = 0.25 * static_cast<double>(random_.below(5));
    if (query_.kind == ccd::LinearKind::vertex_face) {
      const double rest = std::min(second, 1.0 - first);
      at[0] = at[1] + first * (at[2] - at[1]) + rest * (at[3] - at[1]);
    } else {
      at[1] = 4.0 * at[1];
      const Vector3 shift = at[0] + first * (at[1] - at[0]) - at[2] - second * (at[3] - at[2]);
      at[2] += shift;
      at[3] += shift;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3 speed = 8.0 * grid_vector(3);
      query_.start[i] = at[i] - t * speed;
      query_.end[i] = at[i] + (1.0 - t) * speed;
    }
  }
  /// A volume like (t - a)^2 + offset, times a constant: two factors that cross, and a third.
  void double_root() {
    const double a = 0.125 * static_cast<double>(1 + random_.below(7));
    const double offset = random_.below(3) == 0
                              ? 0.0
                              : std::ldexp(whole(2), -static_cast<int>(10 + random_.below(45)));
    const Vector3 rate(1.0 + static_cast<double>(random_.below(3)),
                       1.0 + static_cast<double>(random_.below(3)), 0.0);
    // x = (t - a) rate_0 e_0 + offset e_1, y = (t - a) rate_1 e_1 + c e_0, z = e_2 + ...
    const std::array<Vector3, 3> at{Vector3(0, offset, 0), Vector3(-whole(1), 0, 0),
                                    Vector3(whole(1), whole(1), 1)};
    const std::array<Vector3, 3> speed{Vector3(rate[0], 0, whole(1)), Vector3(0, rate[1], whole(1)),
                                       Vector3(0, 0, 0)};
    place(at, speed, a);
  }
  /// A volume that is a product of t - a - b_i, by a triangular matrix.
  void cluster() {
    const double a = 0.125 * static_cast<double>(1 + random_.below(7));
    const int scale = -static_cast<int>(4 + random_.below(44));
    std::array<Vector3, 3> at;
    std::array<Vector3, 3> speed;
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double sign = random_.below(2) == 0 ? 1.0 : -1.0;
      at[row] = Vector3::Zero();
      speed[row] = Vector3::Zero();
      at[row][i] = -sign * std::ldexp(whole(4), scale);
      speed[row][i] = sign;
      for (int k = i + 1; k < 3; ++k) {
        at[row][k] = whole(3);
        speed[row][k] = whole(1);
      }
    }
    place(at, speed, a);
  }
  void triple_root() {
    const double a = 0.125 * static_cast<double>(random_.below(9));
    const std::array<Vector3, 3> at{Vector3(0, 0, 0), Vector3(0, 0, 0),
                                    Vector3(whole(1), whole(1), whole(1))};
    const std::array<Vector3, 3> speed{grid_vector(2), grid_vector(2), grid_vector(2)};
    place(at, speed, a);
    if (random_.below(4) == 0) {
      nudge();
    }
  }
  /// Three vectors from the first point that are `at` at time a.
  void place(const std::array<Vector3, 3>& at, const std::array<Vector3, 3>& speed, double a) {
    const Vector3 base = grid_vector(1);
    const Vector3 drift = grid_vector(1);
    query_.start[0] = base;
    query_.end[0] = base + drift;
    for (std::size_t i = 0; i < 3; ++i) {
      query_.start[i + 1] = base + at[i] - a * speed[i];
      query_.end[i + 1] = base + drift + at[i] + (1.0 - a) * speed[i];
    }
    mix();
  }
  void scaled_axes() {
    fill([this] { return whole(3); });
    for (int k = 0; k < 3; ++k) {
      const int exponent = static_cast<int>(random_.below(2001)) - 1000;
      for (ccd::FourPoints* points : {&query_.start, &query_.end}) {
        for (Vector3& p : *points) {
          p[k] = std::ldexp(p[k], exponent);
        }
      }
    }
  }

  LinearFamily family_;
  Random random_;
  ccd::LinearQuery query_;
};

}  // namespace kairos::reference
