// The four stages in order; each answers what the one before it leaves open.
#include "ccd/linear/linear_impact.hpp"

#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/linear_filter.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace kairos::ccd {
namespace {

void refuse_nonsense(const LinearQuery& query) {
  if (!(query.separation >= 0.0 && std::isfinite(query.separation))) {
    throw InputError("", 0, "separation", "is not allowed; allowed: finite numbers >= 0");
  }
  double none = 0.0;  // a zero of each, or NaN
  for (std::size_t i = 0; i < 4; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      none += 0.0 * query.start[i][k] + 0.0 * query.end[i][k];
    }
  }
  if (none != 0.0) {  // NaN compares unequal
    throw InputError("", 0, "points", "are not all finite; allowed: finite numbers");
  }
}

/// By how much all of one group are beyond all of the other along an axis, at one instant: exact in
/// sign, and else rounded. Positive: above; negative: below; 0: neither.
double gap(double a_low, double a_high, double b_low, double b_high) {
  return a_low > b_high ? a_low - b_high : (b_low > a_high ? a_high - b_low : 0.0);
}

double gap_along(LinearKind kind, const FourPoints& p, Eigen::Index k) {
  const double low = std::min(p[2][k], p[3][k]);
  const double high = std::max(p[2][k], p[3][k]);
  if (kind == LinearKind::vertex_face) {
    return gap(p[0][k], p[0][k], std::min(low, p[1][k]), std::max(high, p[1][k]));
  }
  return gap(std::min(p[0][k], p[1][k]), std::max(p[0][k], p[1][k]), low, high);
}

/// Stage 1, equation (6): on one axis, on the same side at the start and at the end.
bool boxes_stay_apart(const LinearQuery& query) {
  const double separation = query.separation * (1.0 + 0x1p-50);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double start = gap_along(query.kind, query.start, k);
    const double end = gap_along(query.kind, query.end, k);
    if ((start > separation && end > separation) || (start < -separation && end < -separation)) {
      return true;
    }
  }
  return false;
}

double down(const DoubleDouble& x) { return x.low < 0.0 ? std::nextafter(x.high, -1.0) : x.high; }

bool at_most(const DoubleDouble& x, double bound) {
  return x.high < bound || (x.high == bound && x.low <= 0.0);
}

/// The two doubles around the only root within a bracket, or the root itself; nothing where the
/// bracket is wider than two steps of doubles.
std::optional<LinearImpact> time_of(const LinearQuery& query,
                                    const RootBracket<DoubleDouble>& root) {
  const double below = down(root.lower);
  const double next = std::nextafter(below, 2.0);
  const double after = std::nextafter(next, 2.0);
  if (at_most(root.upper, next)) {
    return LinearImpact{.hit = true, .t_lo = below, .t_hi = next};
  }
  if (!at_most(root.upper, after)) {
    return std::nullopt;
  }
  const int sign = exact_volume_sign(query, next);
  return LinearImpact{.hit = true,
                      .t_lo = sign == 0 || sign == root.before ? next : below,
                      .t_hi = sign == root.before ? after : next};
}

LinearImpact in_integers(const LinearQuery& query) {
  return query.separation > 0.0 ? exact_impact_at_distance(query) : exact_impact(query);
}

/// Stage 3; also where stage 2 knows that they meet, and only the time is to be found.
LinearImpact in_double_doubles(const LinearQuery& query, FilterVerdict known,
                               const RootBracket<double>& near) {
  const LinearFilter<DoubleDouble> filter(query);
  RootBracket<DoubleDouble> root;
  FilterVerdict verdict = known;
  if (known == FilterVerdict::unknown) {
    verdict = filter.never_coplanar(0.0) ? FilterVerdict::apart : filter.classify(root);
  } else if (!filter.bracket_root(0.5 * (near.lower + near.upper), near.lower, near.upper,
                                  near.before, root)) {
    verdict = FilterVerdict::unknown;
  }
  if (verdict == FilterVerdict::apart) {
    return {.stage = LinearStage::double_double};
  }
  if (verdict == FilterVerdict::meet) {
    if (std::optional<LinearImpact> impact = time_of(query, root)) {
      impact->stage =
          known == FilterVerdict::meet ? LinearStage::filter : LinearStage::double_double;
      return *impact;
    }
  }
  return in_integers(query);
}

}  // namespace

LinearImpact linear_impact(const LinearQuery& query) {
  refuse_nonsense(query);
  if (boxes_stay_apart(query)) {
    return {.stage = LinearStage::boxes};
  }
  const LinearFilter<double> filter(query);
  if (!filter.in_range()) {
    return in_integers(query);
  }
  if (filter.never_coplanar(query.separation)) {
    return {.stage = LinearStage::filter};
  }
  if (query.separation > 0.0) {
    return in_integers(query);
  }
  RootBracket<double> root;
  const FilterVerdict verdict = filter.classify(root);
  if (verdict == FilterVerdict::apart) {
    return {.stage = LinearStage::filter};
  }
  return in_double_doubles(query, verdict, root);
}

LinearImpact vertex_face(const FourPoints& start, const FourPoints& end, LinearOptions options) {
  return linear_impact({LinearKind::vertex_face, start, end, options.separation});
}

LinearImpact edge_edge(const FourPoints& start, const FourPoints& end, LinearOptions options) {
  return linear_impact({LinearKind::edge_edge, start, end, options.separation});
}

void linear_impacts(std::span<const LinearQuery> queries, std::span<LinearImpact> answers) {
  assert(queries.size() == answers.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    answers[i] = linear_impact(queries[i]);
  }
}

}  // namespace kairos::ccd
