#include "tests/judge/separation.hpp"

#include <array>

namespace kairos::judge {
namespace {

template <typename S>
Axes<S> axes_of(Vector<S> v, S w) {
  const S length = root(dot(v, v) + w * w);
  v = v * (1 / length);
  w = w / length;
  const S two = 2;
  return {{{1 - two * (v.y * v.y + v.z * v.z), two * (v.x * v.y + w * v.z),
            two * (v.x * v.z - w * v.y)},
           {two * (v.x * v.y - w * v.z), 1 - two * (v.x * v.x + v.z * v.z),
            two * (v.y * v.z + w * v.x)},
           {two * (v.x * v.z + w * v.y), two * (v.y * v.z - w * v.x),
            1 - two * (v.x * v.x + v.y * v.y)}}};
}

template <int Dim, typename S>
std::array<S, Dim> horner(const Polynomial<Dim>& p, S s) {
  std::array<S, Dim> sum{};
  for (int k = p.degree(); k >= 0; --k) {
    for (int i = 0; i < Dim; ++i) {
      S& x = sum[static_cast<std::size_t>(i)];
      x = x * s + S(p[k][i]);
    }
  }
  return sum;
}

/// Axes of a body that turned for s seconds: exp(w s / 2) q.
template <typename S>
Axes<S> turned_axes(const Body& body, S s) {
  if (body.polynomial) {
    const std::array<S, 4> c = horner<4, S>(body.turn, s);
    return axes_of(Vector<S>(c[1], c[2], c[3]), c[0]);
  }
  const Quaternion& q = body.orientation;
  const Vector<S> v(S(q.x()), S(q.y()), S(q.z()));
  const S w = S(q.w());
  const Vector<S> spin(body.spin);
  const S rate = norm(spin);
  if (!(rate > 0)) {
    return axes_of(v, w);
  }
  const S half = rate * s / 2;
  const S cosine_half = cosine(half);
  const Vector<S> turn = spin * (sine(half) / rate);
  return axes_of(v * cosine_half + turn * w + cross(turn, v), cosine_half * w - dot(turn, v));
}

template <typename S>
Vector<S> place_of(const Body& body, S s) {
  if (body.polynomial) {
    const std::array<S, 3> c = horner<3, S>(body.course, s);
    return {c[0], c[1], c[2]};
  }
  return Vector<S>(body.position) + Vector<S>(body.velocity) * s +
         Vector<S>(body.acceleration) * (s * s / 2);
}

template <typename S>
Separation<S> exchanged(Separation<S> s) {
  return {s.gap, -s.normal};
}

template <typename S>
Placed<S> exchanged(const Placed<S>& at) {
  return {-at.offset, at.b, at.a};
}

/// Half-space a against a sphere or a box b.
template <typename S>
Separation<S> above_plane(const Body& plane, const Body& b, const Placed<S>& at) {
  const Vector<S> up = outward(plane, at.a);
  return {dot(up, at.offset) - support(b, at.b, -up), up};
}

template <typename S>
Separation<S> of_spheres(const Body& a, const Body& b, const Placed<S>& at) {
  const S length = norm(at.offset);
  const Vector<S> normal = length > 0 ? at.offset * (1 / length) : Vector<S>(0, 1, 0);
  return {length - S(a.half_extents.x()) - S(b.half_extents.x()), normal};
}

/// Box a against sphere b.
template <typename S>
Separation<S> of_box_and_sphere(const Body& a, const Body& b, const Placed<S>& at) {
  const Vector<S> half(a.half_extents);
  const Vector<S> p = at.a.along(at.offset);
  const S radius = S(b.half_extents.x());
  const Vector<S> nearest(clamped(p.x, -half.x, half.x), clamped(p.y, -half.y, half.y),
                          clamped(p.z, -half.z, half.z));
  const Vector<S> out = p - nearest;
  const S length = norm(out);
  if (length > 0) {
    return {length - radius, at.a.world(out * (1 / length))};
  }
  int best = 0;
  S inside = magnitude(p.x) - half.x;
  for (int i = 1; i < 3; ++i) {
    if (magnitude(p[i]) - half[i] > inside) {
      inside = magnitude(p[i]) - half[i];
      best = i;
    }
  }
  return {inside - radius, p[best] < 0 ? -at.a[best] : at.a[best]};
}

/// The fifteen axes of two boxes, all of length one.
template <typename S>
Separation<S> of_boxes(const Body& a, const Body& b, const Placed<S>& at) {
  const Vector<S> half_a(a.half_extents);
  const Vector<S> half_b(b.half_extents);
  Separation<S> best;
  bool first = true;
  const auto consider = [&](S along, S reach, const Vector<S>& axis) {
    const S gap = magnitude(along) - reach;
    if (first || gap > best.gap) {
      best = {gap, along < 0 ? -axis : axis};
      first = false;
    }
  };
  S r[3][3];
  S m[3][3];
  S t[3];
  for (int i = 0; i < 3; ++i) {
    t[i] = dot(at.offset, at.a[i]);
    for (int j = 0; j < 3; ++j) {
      r[i][j] = dot(at.a[i], at.b[j]);
      m[i][j] = magnitude(r[i][j]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    consider(t[i], half_a[i] + half_b.x * m[i][0] + half_b.y * m[i][1] + half_b.z * m[i][2],
             at.a[i]);
  }
  for (int j = 0; j < 3; ++j) {
    consider(dot(at.offset, at.b[j]),
             half_b[j] + half_a.x * m[0][j] + half_a.y * m[1][j] + half_a.z * m[2][j], at.b[j]);
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      // a_i x b_j has components (0, -r[i2][j], r[i1][j]) along a: no cancellation in its length.
      const S sine = root(r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j]);
      if (!(sine > S(1e-28))) {
        continue;  // parallel: the axes of the faces are enough
      }
      const S n1 = -r[i2][j] / sine;
      const S n2 = r[i1][j] / sine;
      // All three edges of b: whatever rounding makes of the axis, the gap along it is a bound.
      S reach = half_a[i1] * magnitude(n1) + half_a[i2] * magnitude(n2);
      for (int k = 0; k < 3; ++k) {
        reach += half_b[k] * magnitude(n1 * r[i1][k] + n2 * r[i2][k]);
      }
      consider(t[i1] * n1 + t[i2] * n2, reach, at.a[i1] * n1 + at.a[i2] * n2);
    }
  }
  return best;
}

/// The nearest points of two segments p + u s, q + v t with s, t in [-1, 1], as q's minus p's.
template <typename S>
Vector<S> between_segments(Vector<S> p, Vector<S> u, Vector<S> q, Vector<S> v) {
  const Vector<S> w = q - p;
  const S uu = dot(u, u);
  const S vv = dot(v, v);
  const S uv = dot(u, v);
  const S wu = dot(w, u);
  const S wv = dot(w, v);
  const Vector<S> n = cross(u, v);
  const S nn = dot(n, n);
  S s = nn > 0 ? clamped(dot(cross(w, v), n) / nn, S(-1), S(1)) : S(0);
  const S t = clamped((uv * s - wv) / vv, S(-1), S(1));
  s = clamped((uv * t + wu) / uu, S(-1), S(1));
  return w + v * t - u * s;
}

template <typename S>
void keep_shorter(Vector<S> candidate, Vector<S>& shortest) {
  if (dot(candidate, candidate) < dot(shortest, shortest)) {
    shortest = candidate;
  }
}

template <typename S>
Vector<S> corner(const Body& body, const Axes<S>& axes, int signs) {
  const Vector<S> half(body.half_extents);
  return axes.world({(signs & 1) != 0 ? half.x : -half.x, (signs & 2) != 0 ? half.y : -half.y,
                     (signs & 4) != 0 ? half.z : -half.z});
}

/// From box a to the vertices of box b.
template <typename S>
Vector<S> to_vertices(const Body& a, const Body& b, const Placed<S>& at) {
  const Vector<S> half(a.half_extents);
  Vector<S> shortest = at.offset * S(4) + Vector<S>(1, 1, 1) * (S(a.reach()) + S(b.reach()));
  for (int signs = 0; signs < 8; ++signs) {
    const Vector<S> p = at.a.along(at.offset + corner(b, at.b, signs));
    const Vector<S> nearest(clamped(p.x, -half.x, half.x), clamped(p.y, -half.y, half.y),
                            clamped(p.z, -half.z, half.z));
    keep_shorter(at.a.world(p - nearest), shortest);
  }
  return shortest;
}

template <typename S>
Vector<S> between_boxes(const Body& a, const Body& b, const Placed<S>& at) {
  Vector<S> shortest = to_vertices(a, b, at);
  keep_shorter(-to_vertices(b, a, exchanged(at)), shortest);
  const Vector<S> half_a(a.half_extents);
  const Vector<S> half_b(b.half_extents);
  for (int edge_a = 0; edge_a < 12; ++edge_a) {
    const int i = edge_a / 4;
    const Vector<S> u = at.a[i] * half_a[i];
    const Vector<S> p =
        at.a[(i + 1) % 3] * ((edge_a & 1) != 0 ? half_a[(i + 1) % 3] : -half_a[(i + 1) % 3]) +
        at.a[(i + 2) % 3] * ((edge_a & 2) != 0 ? half_a[(i + 2) % 3] : -half_a[(i + 2) % 3]);
    for (int edge_b = 0; edge_b < 12; ++edge_b) {
      const int j = edge_b / 4;
      const Vector<S> v = at.b[j] * half_b[j];
      const Vector<S> q =
          at.offset +
          at.b[(j + 1) % 3] * ((edge_b & 1) != 0 ? half_b[(j + 1) % 3] : -half_b[(j + 1) % 3]) +
          at.b[(j + 2) % 3] * ((edge_b & 2) != 0 ? half_b[(j + 2) % 3] : -half_b[(j + 2) % 3]);
      keep_shorter(between_segments(p, u, q, v), shortest);
    }
  }
  return shortest;
}

}  // namespace

template <typename S>
Placed<S> placed(const Query& query, S t) {
  const S s_a = S(query.a.age) + t;
  const S s_b = S(query.b.age) + t;
  return {place_of(query.b, s_b) - place_of(query.a, s_a), turned_axes(query.a, s_a),
          turned_axes(query.b, s_b)};
}

template <typename S>
Placed<S> placed(const Pose& a, const Pose& b) {
  const auto axes = [](const Quaternion& q) {
    return axes_of(Vector<S>(S(q.x()), S(q.y()), S(q.z())), S(q.w()));
  };
  return {Vector<S>(b.position) - Vector<S>(a.position), axes(a.orientation), axes(b.orientation)};
}

template <typename S>
Vector<S> outward(const Body& half_space, const Axes<S>& axes) {
  const Vector<S> normal(half_space.normal);
  return axes.world(normal * (1 / norm(normal)));
}

template <typename S>
S support(const Body& body, const Axes<S>& axes, Vector<S> direction) {
  switch (body.kind) {
    case Kind::sphere:
      return S(body.half_extents.x());
    case Kind::half_space:
      return S(0);
    case Kind::box:
      break;
  }
  S sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum += S(body.half_extents[i]) * magnitude(dot(axes[i], direction));
  }
  return sum;
}

template <typename S>
Separation<S> separation(const Body& a, const Body& b, const Placed<S>& at) {
  if (a.kind == Kind::half_space) {
    return above_plane(a, b, at);
  }
  if (b.kind == Kind::half_space) {
    return exchanged(above_plane(b, a, exchanged(at)));
  }
  if (a.kind == Kind::sphere && b.kind == Kind::sphere) {
    return of_spheres(a, b, at);
  }
  if (b.kind == Kind::sphere) {
    return of_box_and_sphere(a, b, at);
  }
  if (a.kind == Kind::sphere) {
    return exchanged(of_box_and_sphere(b, a, exchanged(at)));
  }
  return of_boxes(a, b, at);
}

template <typename S>
Separation<S> distance(const Body& a, const Body& b, const Placed<S>& at) {
  const Separation<S> along_axes = separation(a, b, at);
  if (a.kind != Kind::box || b.kind != Kind::box || !(along_axes.gap > 0)) {
    return along_axes;
  }
  const Vector<S> between = between_boxes(a, b, at);
  const S length = norm(between);
  if (!(length > along_axes.gap)) {
    return along_axes;
  }
  return {length, between * (1 / length)};
}

#define KAIROS_JUDGE_INSTANTIATE(S)                                                 \
  template Placed<S> placed<S>(const Query&, S);                                    \
  template Placed<S> placed<S>(const Pose&, const Pose&);                           \
  template Separation<S> separation<S>(const Body&, const Body&, const Placed<S>&); \
  template Separation<S> distance<S>(const Body&, const Body&, const Placed<S>&);   \
  template Vector<S> outward<S>(const Body&, const Axes<S>&);                       \
  template S support<S>(const Body&, const Axes<S>&, Vector<S>);
KAIROS_JUDGE_INSTANTIATE(Long)
KAIROS_JUDGE_INSTANTIATE(Quad)
#undef KAIROS_JUDGE_INSTANTIATE

}  // namespace kairos::judge
