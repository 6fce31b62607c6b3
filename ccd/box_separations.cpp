#include "ccd/relative_boxes.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

// Where the compiler can, the functions below exist twice, and the processor decides at load time.
#if defined(KAIROS_WIDE)
// A test compiles this file for one processor after the other.
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) && \
    !defined(__SANITIZE_ADDRESS__)
#define KAIROS_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define KAIROS_WIDE
#endif
#define KAIROS_INLINE [[gnu::always_inline]] inline

// All fifteen separations of two boxes at once, without branches, four lanes at a time (the fourth
// repeats the first). Results do not depend on how wide the registers are: sums are made in the
// same order and nothing is contracted.
namespace kairos::ccd {
namespace {

/// Three components and the first again.
using Lanes [[gnu::vector_size(32)]] = double;
using Bits [[gnu::vector_size(32)]] = std::int64_t;

KAIROS_INLINE void absolute(Lanes& x) {
  Bits bits;
  std::memcpy(&bits, &x, sizeof x);
  bits &= INT64_MAX;
  std::memcpy(&x, &bits, sizeof x);
}
/// x y z -> y z x, and z x y.
KAIROS_INLINE void rotate(const Lanes& x, Lanes& once, Lanes& twice) {
  once = __builtin_shufflevector(x, x, 1, 2, 0, 1);
  twice = __builtin_shufflevector(x, x, 2, 0, 1, 2);
}
/// The columns of a 3 x 3 matrix, read without touching what is behind it.
KAIROS_INLINE void load_columns(const double* m, Lanes (&c)[3]) {
  Lanes last;
  std::memcpy(&c[0], m, sizeof(Lanes));
  std::memcpy(&c[1], m + 3, sizeof(Lanes));
  std::memcpy(&last, m + 5, sizeof(Lanes));
  c[0] = __builtin_shufflevector(c[0], c[0], 0, 1, 2, 0);
  c[1] = __builtin_shufflevector(c[1], c[1], 0, 1, 2, 0);
  c[2] = __builtin_shufflevector(last, last, 1, 2, 3, 1);
}
KAIROS_INLINE void transpose(const Lanes (&c)[3], Lanes (&r)[3]) {
  const Lanes xy01 = __builtin_shufflevector(c[0], c[1], 0, 4, 1, 5);  // 00 01 10 11
  r[0] = __builtin_shufflevector(xy01, c[2], 0, 1, 4, 0);
  r[1] = __builtin_shufflevector(xy01, c[2], 2, 3, 5, 2);
  const Lanes z01 = __builtin_shufflevector(c[0], c[1], 2, 6, 2, 6);
  r[2] = __builtin_shufflevector(z01, c[2], 0, 1, 6, 0);
}

/// Two boxes in the frame of the first.
struct Operands {
  Lanes half_a, d;
  Lanes axis[3];  ///< of b
  const double* half_b;
  double error;  ///< as `RelativeBoxes::error`

  KAIROS_INLINE void finish(const double* half) {
    half_a = Lanes{half[0], half[1], half[2], half[0]};
    Lanes size = d;
    absolute(size);
    size += half_a;
    error = 24.0 * unit_roundoff *
            ((size[0] + size[1] + size[2]) + (half_b[0] + half_b[1] + half_b[2]));
  }
};

KAIROS_INLINE void operands_of(const RelativeBoxes& s, Operands& o) {
  load_columns(s.axes_A.data(), o.axis);
  o.d = Lanes{s.d_A[0], s.d_A[1], s.d_A[2], s.d_A[0]};
  o.half_b = s.half_b.data();
  o.finish(s.half_a.data());
}

KAIROS_INLINE void operands_of(const Vector3& half_a, const Matrix3& R_WA, const Vector3& half_b,
                               const Matrix3& R_WB, const Vector3& d, Operands& o) {
  Lanes columns[3], rows[3];
  load_columns(R_WA.data(), columns);
  transpose(columns, rows);
  o.d = rows[0] * d[0] + rows[1] * d[1] + rows[2] * d[2];
  for (int j = 0; j < 3; ++j) {
    const double* axis = R_WB.data() + 3 * j;
    o.axis[j] = rows[0] * axis[0] + rows[1] * axis[1] + rows[2] * axis[2];
  }
  o.half_b = half_b.data();
  o.finish(half_a.data());
}

/// Calls visit(row, values): 0 along the normals of a, 1 along those of b (eq. 1), 2 + j along
/// e_i x axis j of b (eq. 2).
template <typename Visit>
KAIROS_INLINE void for_all_rows(const Operands& o, const Visit& visit) {
  const Lanes half_b{o.half_b[0], o.half_b[1], o.half_b[2], o.half_b[0]};
  Lanes size[3];
  for (int j = 0; j < 3; ++j) {
    size[j] = o.axis[j];
    absolute(size[j]);
  }
  Lanes value = o.d;
  absolute(value);
  value -= o.half_a + (size[0] * o.half_b[0] + size[1] * o.half_b[1] + size[2] * o.half_b[2]);
  visit(0, value);

  Lanes rows[3];
  transpose(o.axis, rows);
  value = rows[0] * o.d[0] + rows[1] * o.d[1] + rows[2] * o.d[2];
  absolute(value);
  for (Lanes& row : rows) {
    absolute(row);
  }
  value -= half_b + (rows[0] * o.half_a[0] + rows[1] * o.half_a[1] + rows[2] * o.half_a[2]);
  visit(1, value);

  Lanes d1, d2, half1, half2;
  rotate(o.d, d1, d2);
  rotate(o.half_a, half1, half2);
  for (int j = 0; j < 3; ++j) {
    Lanes r1, r2;
    rotate(o.axis[j], r1, r2);
    value = d2 * r1 - d1 * r2;
    absolute(value);
    absolute(r1);
    absolute(r2);
    const int m = j == 2 ? 0 : j + 1;
    const int n = j == 0 ? 2 : j - 1;
    value -= (half1 * r2 + half2 * r1) + (size[n] * o.half_b[m] + size[m] * o.half_b[n]);
    visit(2 + j, value);
  }
}

/// Some lane of `bits` set?
KAIROS_INLINE bool any(const Bits& bits) { return (bits[0] | bits[1] | bits[2] | bits[3]) != 0; }

/// Faces decide alone where edges are parallel: turning b by the least angle between two edges
/// moves every separation by less than 4 sine * size.
bool overlap_by_faces(const Operands& o, double faces) {
  double least = infinity;
  for (const Lanes& axis : o.axis) {
    for (int i = 0; i < 3; ++i) {
      const double x = axis[(i + 1) % 3];
      const double y = axis[(i + 2) % 3];
      least = std::min(least, x * x + y * y);
    }
  }
  const double size = o.error / (24.0 * unit_roundoff);
  return 4.0 * (std::sqrt(least) + 16.0 * unit_roundoff) * size < -faces - o.error;
}

/// Is a face apart by more than `face`, or a pair of edges by more than the error?
KAIROS_INLINE bool apart_beyond(const RelativeBoxes& boxes, const Operands& o, double face) {
  Bits apart{};
  Bits inside = ~Bits{};
  Lanes faces[2], edges[3];
  for_all_rows(o, [&](int row, const Lanes& value) {
    apart |= value > (row < 2 ? face : o.error);
    if (row < 2) {
      faces[row] = value;
    } else {
      edges[row - 2] = value;
      inside &= value < -o.error;
    }
  });
  if (any(apart)) {
    return true;
  }
  if (!any(~inside)) {
    return false;
  }
  // A separation that edges hide in their error is at most 4 sine * size above that of the faces.
  const double greatest =
      std::max({faces[0][0], faces[0][1], faces[0][2], faces[1][0], faces[1][1], faces[1][2]});
  const double size = o.error / (24.0 * unit_roundoff);
  const double needed = greatest < 0.0 ? -greatest / (4.0 * size) : 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double x = o.axis[j][(i + 1) % 3];
      const double y = o.axis[j][(i + 2) % 3];
      if (edges[j][i] >= -o.error && x * x + y * y >= needed * needed &&
          unit_edge_separation(boxes, 6 + 3 * i + j).gap() > o.error) {
        return true;
      }
    }
  }
  return false;
}

/// Are all fifteen separations, unnormalised, below -error?
KAIROS_INLINE bool all_inside(const Operands& o, double error) {
  Bits inside = ~Bits{};
  for_all_rows(o, [&](int, const Lanes& value) { inside &= value < -error; });
  return !any(~inside);
}

KAIROS_INLINE Verdict verdict_of(const Operands& o) {
  Bits apart{};
  Bits inside = ~Bits{};
  Bits faces_inside = ~Bits{};
  Lanes faces;
  for_all_rows(o, [&](int row, const Lanes& value) {
    apart |= value > o.error;
    inside &= value < -o.error;
    if (row == 0) {
      faces = value;
    } else if (row == 1) {
      faces = value > faces ? value : faces;
      faces_inside = inside;
    }
  });
  if (any(apart)) {
    return Verdict::separated;
  }
  if (!any(~inside)) {
    return Verdict::overlapping;
  }
  // Some pair of edges cannot decide.
  return !any(~faces_inside) && overlap_by_faces(o, std::max({faces[0], faces[1], faces[2]}))
             ? Verdict::overlapping
             : Verdict::undecided;
}

/// An axis and its separation, not yet with length and sign.
struct Best {
  int axis;
  double value;
};

/// The edge pairs against the best face, one after the other.
Best against_edges(Best best, const Lanes (&edges)[3], const Lanes (&squares)[3]) {
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double f = edges[j][i];
      const double square = squares[j][i];
      // Dividing by a sine raises only positive values: most pairs need no root.
      if (f <= best.value &&
          (f <= 0.0 ? best.value >= 0.0 : f * f <= best.value * best.value * square)) {
        continue;
      }
      const double length = std::sqrt(square);
      if (f > best.value * length && length > 0.0) {
        best = {6 + 3 * i + j, f / length};
      }
    }
  }
  return best;
}

KAIROS_INLINE AxisSeparation greatest_of(const Operands& o) {
  Lanes faces[2], edges[3], squares[3];
  for_all_rows(o, [&](int row, const Lanes& value) {
    if (row < 2) {
      faces[row] = value;
    } else {
      edges[row - 2] = value;
    }
  });
  Best best{0, faces[0][0]};
  for (int i = 1; i < 6; ++i) {
    const double f = faces[i / 3][i % 3];
    best.axis = f > best.value ? i : best.axis;
    best.value = f > best.value ? f : best.value;
  }
  // Could an edge pair, less its rounding error, beat that? Squared, so as not to divide.
  const double square_of_best = best.value > 0.0 ? best.value * best.value : 0.0;
  Bits better{};
  for (int j = 0; j < 3; ++j) {
    Lanes x, y;
    rotate(o.axis[j], x, y);
    squares[j] = x * x + y * y;
    const Lanes f = edges[j] - o.error;
    better |= (f > 0.0) & (f * f > square_of_best * squares[j]);
    edges[j] = f;
  }
  const Best face = best;
  if (any(better) || best.value < 0.0) {
    best = against_edges(face, edges, squares);
  }
  if (best.axis < 3) {
    return {best.axis, best.value, 1.0, o.d[best.axis] < 0.0 ? -1.0 : 1.0};
  }
  if (best.axis < 6) {
    const Lanes product = o.d * o.axis[best.axis - 3];
    const double along = product[0] + product[1] + product[2];
    return {best.axis, best.value, 1.0, along < 0.0 ? -1.0 : 1.0};
  }
  const int i = (best.axis - 6) / 3;
  const int j = (best.axis - 6) % 3;
  const int k = i == 2 ? 0 : i + 1;
  const int l = i == 0 ? 2 : i - 1;
  const double along = o.d[l] * o.axis[j][k] - o.d[k] * o.axis[j][l];
  return {best.axis, edges[j][i] + o.error, std::sqrt(squares[j][i]), along < 0.0 ? -1.0 : 1.0};
}

}  // namespace

KAIROS_WIDE bool boxes_overlap(const RelativeBoxes& boxes) {
  Operands o;
  operands_of(boxes, o);
  return !apart_beyond(boxes, o, 0.0);
}

KAIROS_WIDE bool boxes_apart(const RelativeBoxes& boxes) {
  Operands o;
  operands_of(boxes, o);
  return apart_beyond(boxes, o, o.error);
}

KAIROS_WIDE AxisSeparation greatest_separation(const RelativeBoxes& boxes) {
  Operands o;
  operands_of(boxes, o);
  return greatest_of(o);
}

KAIROS_WIDE AxisSeparation greatest_separation(const Vector3& half_a, const Matrix3& R_WA,
                                               const Vector3& half_b, const Matrix3& R_WB,
                                               const Vector3& d_W) {
  Operands o;
  operands_of(half_a, R_WA, half_b, R_WB, d_W, o);
  return greatest_of(o);
}

KAIROS_WIDE Verdict classify(const RelativeBoxes& boxes) {
  Operands o;
  operands_of(boxes, o);
  return verdict_of(o);
}

KAIROS_WIDE Verdict classify(const Vector3& half_a, const Matrix3& R_WA, const Vector3& half_b,
                             const Matrix3& R_WB, const Vector3& d_W) {
  Operands o;
  operands_of(half_a, R_WA, half_b, R_WB, d_W, o);
  return verdict_of(o);
}

KAIROS_WIDE bool all_separations_below(const Vector3& half_a, const Matrix3& R_WA,
                                       const Vector3& half_b, const Matrix3& R_WB,
                                       const Vector3& d_W, double error) {
  Operands o;
  operands_of(half_a, R_WA, half_b, R_WB, d_W, o);
  return all_inside(o, std::max(error, o.error));
}

KAIROS_WIDE Verdict classify(const OrientedBox& a, const OrientedBox& b) {
  const Vector3 d = b.centre - a.centre;
  Operands o;
  operands_of(a.half_extents, a.axes, b.half_extents, b.axes, d, o);
  return verdict_of(o);
}

}  // namespace kairos::ccd
