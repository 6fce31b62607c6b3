#include "ccd/box_batch.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

// Where the compiler can, the two loops below exist three times, and the processor decides at load
// time.
#if defined(KAIROS_WIDEST)
// A test compiles this file for one processor after the other.
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) && \
    !defined(__SANITIZE_ADDRESS__)
#define KAIROS_WIDEST [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define KAIROS_WIDEST
#endif
#define KAIROS_INLINE [[gnu::always_inline]] inline

// One loop over pairs, without branches, that the compiler turns into registers as wide as the
// processor's. Sums are made in the order of box_separations.cpp, and nothing is contracted: the
// same bits, however wide they are.
namespace kairos::ccd {
namespace {

/// Pairs in one loop, so that their results stay in the first cache.
constexpr std::size_t block = 64;

KAIROS_INLINE double magnitude(double x) { return __builtin_fabs(x); }
/// The remainder of i < 5 by 3.
constexpr std::size_t wrapped(std::size_t i) { return i < 3 ? i : i - 3; }

/// Two boxes in the frame of the first.
struct Pair {
  double half_a[3], half_b[3], d[3];
  double R[3][3];  ///< R[i][j]: component i of axis j of b

  KAIROS_INLINE void load(const double* const (&c)[BoxBatch::components], std::size_t pair) {
    for (std::size_t i = 0; i < 3; ++i) {
      half_a[i] = c[i][pair];
      half_b[i] = c[3 + i][pair];
      d[i] = c[6 + i][pair];
      R[i][0] = c[9 + i][pair];
      R[i][1] = c[12 + i][pair];
      R[i][2] = c[15 + i][pair];
    }
  }
  /// As `RelativeBoxes::error`.
  [[nodiscard]] KAIROS_INLINE double error() const {
    return 24.0 * unit_roundoff *
           (((magnitude(d[0]) + half_a[0]) + (magnitude(d[1]) + half_a[1]) +
             (magnitude(d[2]) + half_a[2])) +
            (half_b[0] + half_b[1] + half_b[2]));
  }
  /// Distance of the centres along an axis, and the separation.
  struct Along {
    double distance, separation;
  };
  [[nodiscard]] KAIROS_INLINE Along face_of_a(std::size_t i) const {
    return {d[i], magnitude(d[i]) - (half_a[i] + (magnitude(R[i][0]) * half_b[0] +
                                                  magnitude(R[i][1]) * half_b[1] +
                                                  magnitude(R[i][2]) * half_b[2]))};
  }
  [[nodiscard]] KAIROS_INLINE Along face_of_b(std::size_t j) const {
    const double along = R[0][j] * d[0] + R[1][j] * d[1] + R[2][j] * d[2];
    return {along, magnitude(along) - (half_b[j] + (magnitude(R[0][j]) * half_a[0] +
                                                    magnitude(R[1][j]) * half_a[1] +
                                                    magnitude(R[2][j]) * half_a[2]))};
  }
  [[nodiscard]] KAIROS_INLINE Along edges(std::size_t i, std::size_t j) const {
    const std::size_t k = wrapped(i + 1), l = wrapped(i + 2);
    const std::size_t m = wrapped(j + 1), n = wrapped(j + 2);
    const double along = d[l] * R[k][j] - d[k] * R[l][j];
    return {along,
            magnitude(along) - ((half_a[k] * magnitude(R[l][j]) + half_a[l] * magnitude(R[k][j])) +
                                (magnitude(R[i][n]) * half_b[m] + magnitude(R[i][m]) * half_b[n]))};
  }
  /// Square of the sine of two edges.
  [[nodiscard]] KAIROS_INLINE double square(std::size_t i, std::size_t j) const {
    const double x = R[wrapped(i + 1)][j];
    const double y = R[wrapped(i + 2)][j];
    return x * x + y * y;
  }
};

/// The greatest of the fifteen separations as they are, and their bound.
KAIROS_INLINE void greatest_of_all(const Pair& p, double& greatest, double& error) {
  double most = p.face_of_a(0).separation;
  const auto take = [&most](double value) __attribute__((always_inline)) {
    most = value > most ? value : most;
  };
  take(p.face_of_a(1).separation);
  take(p.face_of_a(2).separation);
  take(p.face_of_b(0).separation);
  take(p.face_of_b(1).separation);
  take(p.face_of_b(2).separation);
  take(p.edges(0, 0).separation);
  take(p.edges(1, 0).separation);
  take(p.edges(2, 0).separation);
  take(p.edges(0, 1).separation);
  take(p.edges(1, 1).separation);
  take(p.edges(2, 1).separation);
  take(p.edges(0, 2).separation);
  take(p.edges(1, 2).separation);
  take(p.edges(2, 2).separation);
  greatest = most;
  error = p.error();
}

/// The best face of a pair; `edges` is 1 where a pair of edges could be better, otherwise 0.
struct BestFace {
  double axis, value, distance, error, edges;
};

KAIROS_INLINE BestFace best_face(const Pair& p) {
  Pair::Along best = p.face_of_a(0);
  double axis = 0.0;
  const auto take = [&](double which, const Pair::Along& other) __attribute__((always_inline)) {
    const bool better = other.separation > best.separation;
    axis = better ? which : axis;
    best.distance = better ? other.distance : best.distance;
    best.separation = better ? other.separation : best.separation;
  };
  take(1.0, p.face_of_a(1));
  take(2.0, p.face_of_a(2));
  take(3.0, p.face_of_b(0));
  take(4.0, p.face_of_b(1));
  take(5.0, p.face_of_b(2));
  const double error = p.error();
  const double positive = best.separation > 0.0 ? best.separation : 0.0;
  const double square_of_best = positive * positive;
  double edges = best.separation < 0.0 ? 1.0 : 0.0;
  const auto look = [&](std::size_t i, std::size_t j) __attribute__((always_inline)) {
    const double f = p.edges(i, j).separation - error;
    const double above = f > 0.0 ? f : 0.0;
    edges = above * above > square_of_best * p.square(i, j) ? 1.0 : edges;
  };
  look(0, 0);
  look(1, 0);
  look(2, 0);
  look(0, 1);
  look(1, 1);
  look(2, 1);
  look(0, 2);
  look(1, 2);
  look(2, 2);
  return {axis, best.separation, best.distance, error, edges};
}

/// An axis as it is: its separation and length, and the distance of the centres along it.
struct BestAxis {
  double axis, gap, value, distance, length;
};

/// The edge pairs against the best face, one after the other.
KAIROS_INLINE void try_edges(const Pair& p, double error, BestAxis& best) {
  const auto take = [&](double which, std::size_t i, std::size_t j) __attribute__((always_inline)) {
    const Pair::Along at = p.edges(i, j);
    const double square = p.square(i, j);
    const double f = at.separation - error;
    // As for one pair, which takes no root if the sign decides: roots are rounded.
    const double by_sign = best.gap >= 0.0 ? 0.0 : 1.0;
    const double by_square = f * f <= best.gap * best.gap * square ? 0.0 : 1.0;
    const double below = f <= 0.0 ? by_sign : by_square;
    double wins = f <= best.gap ? below : 1.0;
    const double length = __builtin_sqrt(square);
    wins = f > best.gap * length ? wins : 0.0;
    wins = length > 0.0 ? wins : 0.0;
    const double gap = f / length;
    const bool better = wins > 0.0;
    best.axis = better ? which : best.axis;
    best.gap = better ? gap : best.gap;
    best.value = better ? f + error : best.value;
    best.distance = better ? at.distance : best.distance;
    best.length = better ? length : best.length;
  };
  take(6.0, 0, 0);
  take(9.0, 1, 0);
  take(12.0, 2, 0);
  take(7.0, 0, 1);
  take(10.0, 1, 1);
  take(13.0, 2, 1);
  take(8.0, 0, 2);
  take(11.0, 1, 2);
  take(14.0, 2, 2);
}

/// Where the components of the pairs from `first` on begin.
KAIROS_INLINE void components_of(const BoxBatch& pairs, std::size_t first,
                                 const double* (&c)[BoxBatch::components]) {
  for (std::size_t k = 0; k < BoxBatch::components; ++k) {
    c[k] = pairs.component(k, first);
  }
}

}  // namespace

void BoxBatch::reserve(std::size_t pairs) {
  for (std::vector<double>& values : values_) {
    values.reserve(pairs);
  }
}

void BoxBatch::clear() {
  for (std::vector<double>& values : values_) {
    values.clear();
  }
}

void BoxBatch::push_back(const RelativeBoxes& boxes) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    values_[i].push_back(boxes.half_a[k]);
    values_[3 + i].push_back(boxes.half_b[k]);
    values_[6 + i].push_back(boxes.d_A[k]);
    for (std::size_t j = 0; j < 3; ++j) {
      values_[9 + 3 * j + i].push_back(boxes.axes_A(k, static_cast<Eigen::Index>(j)));
    }
  }
}

RelativeBoxes BoxBatch::at(std::size_t pair) const {
  RelativeBoxes boxes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    boxes.half_a[k] = values_[i][pair];
    boxes.half_b[k] = values_[3 + i][pair];
    boxes.d_A[k] = values_[6 + i][pair];
    for (std::size_t j = 0; j < 3; ++j) {
      boxes.axes_A(k, static_cast<Eigen::Index>(j)) = values_[9 + 3 * j + i][pair];
    }
  }
  return boxes;
}

KAIROS_WIDEST void classify_batch(const BoxBatch& pairs, std::span<Verdict> verdicts) {
  if (verdicts.size() != pairs.size()) {
    throw std::invalid_argument("classify_batch: as many verdicts as pairs are needed");
  }
  const double* c[BoxBatch::components];
  double greatest[block], error[block];
  for (std::size_t first = 0; first < pairs.size(); first += block) {
    const std::size_t count = std::min(block, pairs.size() - first);
    components_of(pairs, first, c);
    for (std::size_t k = 0; k < count; ++k) {
      Pair p;
      p.load(c, k);
      greatest_of_all(p, greatest[k], error[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      // If edges cannot decide, the pair is looked at by itself.
      verdicts[first + k] = greatest[k] > error[k]    ? Verdict::separated
                            : greatest[k] < -error[k] ? Verdict::overlapping
                                                      : classify(pairs.at(first + k));
    }
  }
}

KAIROS_WIDEST void greatest_separation_batch(const BoxBatch& pairs,
                                             std::span<AxisSeparation> separations,
                                             std::span<double> errors) {
  if (separations.size() != pairs.size() || (!errors.empty() && errors.size() != pairs.size())) {
    throw std::invalid_argument(
        "greatest_separation_batch: as many separations (and errors) as pairs are needed");
  }
  const double* c[BoxBatch::components];
  double axis[block], value[block], distance[block], length[block], error[block], edges[block];
  for (std::size_t first = 0; first < pairs.size(); first += block) {
    const std::size_t count = std::min(block, pairs.size() - first);
    components_of(pairs, first, c);
    for (std::size_t k = 0; k < count; ++k) {
      Pair p;
      p.load(c, k);
      const BestFace best = best_face(p);
      axis[k] = best.axis;
      value[k] = best.value;
      distance[k] = best.distance;
      length[k] = 1.0;
      error[k] = best.error;
      edges[k] = best.edges;
    }
    if (std::any_of(edges, edges + count, [](double wanted) { return wanted > 0.0; })) {
      for (std::size_t k = 0; k < count; ++k) {
        Pair p;
        p.load(c, k);
        BestAxis best{axis[k], value[k], value[k], distance[k], length[k]};
        try_edges(p, error[k], best);
        const bool wanted = edges[k] > 0.0;
        axis[k] = wanted ? best.axis : axis[k];
        value[k] = wanted ? best.value : value[k];
        distance[k] = wanted ? best.distance : distance[k];
        length[k] = wanted ? best.length : length[k];
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      separations[first + k] = {static_cast<int>(axis[k]), value[k], length[k],
                                distance[k] < 0.0 ? -1.0 : 1.0};
    }
    if (!errors.empty()) {
      std::copy_n(error, count, errors.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }
}

}  // namespace kairos::ccd
