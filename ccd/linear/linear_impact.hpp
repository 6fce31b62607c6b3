#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace kairos::ccd {

/// Four points at one instant, in one frame and unit: a vertex and the three corners of a face; or
/// the two ends of an edge and those of another.
using FourPoints = std::array<Vector3, 4>;

/// What is asked to meet.
enum class LinearKind : std::uint8_t { vertex_face, edge_edge };

/// What it took to know whether they meet: swept boxes, doubles with a proven error bound,
/// double-doubles with one, or integers. Each answers what the one before it leaves open.
enum class LinearStage : std::uint8_t { boxes, filter, double_double, integers };
inline constexpr std::array linear_stage_names{"boxes", "filter", "double-double", "integers"};

/// Whether and when they first meet. The answer is exact: no rounding is left in it.
struct LinearImpact {
  static constexpr double never = std::numeric_limits<double>::infinity();

  bool hit = false;
  /// The first time as a fraction of the step, in [0, 1]: t_lo itself where both are equal,
  /// otherwise strictly between these two adjacent doubles; `never` without a hit.
  double t_lo = never, t_hi = never;
  LinearStage stage = LinearStage::boxes;
};

/// When two count as meeting.
struct LinearOptions {
  /// They meet where their distance is at most this; >= 0, in the unit of the points.
  double separation = 0.0;
};

/// When a vertex first meets a face (a closed triangle, degenerate ones included), each point
/// moving on a straight line: p(t) = start + t (end - start), t in [0, 1], in real arithmetic.
/// Point 0 is the vertex. Throws `InputError` where a number is not finite or the separation is
/// negative. Method and proof: ccd/README.md, "Linear trajectories, exactly".
[[nodiscard]] LinearImpact vertex_face(const FourPoints& start, const FourPoints& end,
                                       LinearOptions options = {});
/// The same for the edges from point 0 to 1 and from point 2 to 3, both closed.
[[nodiscard]] LinearImpact edge_edge(const FourPoints& start, const FourPoints& end,
                                     LinearOptions options = {});

/// One of many questions.
struct LinearQuery {
  LinearKind kind = LinearKind::vertex_face;
  FourPoints start, end;
  double separation = 0.0;
};
/// `vertex_face` or `edge_edge`, as the query says. Throws as they do.
[[nodiscard]] LinearImpact linear_impact(const LinearQuery& query);
/// Answers all, in order; as many answers as queries. Throws as above, at the first bad query.
void linear_impacts(std::span<const LinearQuery> queries, std::span<LinearImpact> answers);

}  // namespace kairos::ccd
