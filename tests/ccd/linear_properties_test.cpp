// What must hold of every answer of vertex and face, edge and edge, whatever the question.
#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/linear_filter.hpp"
#include "ccd/linear/linear_impact.hpp"
#include "experiments/vfee/linear_families.hpp"
#include "tests/allocations.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace kairos;
using namespace kairos::ccd;
using namespace kairos::reference;

namespace {

constexpr std::uint64_t seed = 20260122;

bool same(const LinearImpact& a, const LinearImpact& b) {
  return a.hit == b.hit && a.t_lo == b.t_lo && a.t_hi == b.t_hi;
}

template <typename Check>
void for_all_families(int count, const Check& check) {
  for (int f = 0; f < linear_families; ++f) {
    for (const LinearKind kind : {LinearKind::vertex_face, LinearKind::edge_edge}) {
      LinearFamilies family(static_cast<LinearFamily>(f), kind, seed);
      // Numbers of 2,000 bits take milliseconds.
      const bool slow = static_cast<LinearFamily>(f) == LinearFamily::wild_exponents;
      for (int i = 0; i < (slow ? 1 + count / 8 : count); ++i) {
        const LinearQuery query = family.next();
        if (!check(query, static_cast<LinearFamily>(f))) {
          FAIL_CHECK(linear_family_names[static_cast<std::size_t>(f)]
                     << (kind == LinearKind::vertex_face ? " vf" : " ee") << " seed " << seed
                     << " query " << i);
        }
      }
    }
  }
}

template <typename Change>
LinearQuery changed(LinearQuery query, const Change& change) {
  for (FourPoints* points : {&query.start, &query.end}) {
    change(*points);
  }
  return query;
}

}  // namespace

TEST_CASE("linear: stages that stop early say what the integers say", "[ccd][linear]") {
  std::array<int, 4> stages{};
  for_all_families(1000, [&](const LinearQuery& query, LinearFamily family) {
    if (family == LinearFamily::wild_exponents) {
      return true;  // never leaves to others than the integers
    }
    const LinearImpact impact = linear_impact(query);
    ++stages[static_cast<std::size_t>(impact.stage)];
    return same(impact, exact_impact(query));
  });
  for (const int count : stages) {
    CHECK(count > 100);  // each stage was asked
  }
}

TEST_CASE("linear: what rounding does is within the bound, and the bound within reason",
          "[ccd][linear]") {
  double largest = 0.0;  // of the bound
  for (const LinearFamily f :
       {LinearFamily::general, LinearFamily::close, LinearFamily::touch_ulp}) {
    for (const LinearKind kind : {LinearKind::vertex_face, LinearKind::edge_edge}) {
      LinearFamilies family(f, kind, seed);
      for (int i = 0; i < 5000; ++i) {
        const LinearQuery query = family.next();
        const LinearFilter<double> rounded(query);
        const LinearFilter<DoubleDouble> exact(query);  // to 1e-30
        if (!rounded.in_range()) {
          continue;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const DoubleDouble error =
              DoubleDouble(rounded.coefficients()[k]) - exact.coefficients()[k];
          largest = std::max(largest, std::abs(error.high) / rounded.error_bound());
        }
      }
    }
  }
  CAPTURE(largest);
  CHECK(largest <= 1.0);
  CHECK(largest >= 0.01);  // worst cases do not add up; a bound a hundred times too wide is a slip
}

TEST_CASE("linear: the bracket is a number or two adjacent ones in [0, 1]", "[ccd][linear]") {
  for_all_families(200, [](const LinearQuery& query, LinearFamily) {
    const LinearImpact impact = linear_impact(query);
    if (!impact.hit) {
      return impact.t_lo == LinearImpact::never && impact.t_hi == LinearImpact::never;
    }
    return impact.t_lo >= 0.0 && impact.t_hi <= 1.0 &&
           (impact.t_lo == impact.t_hi || std::nextafter(impact.t_lo, 2.0) == impact.t_hi);
  });
}

TEST_CASE("linear: no order of the points, no axis and no power of two changes an answer",
          "[ccd][linear][slow]") {
  for_all_families(150, [](const LinearQuery& query, LinearFamily family) {
    const LinearImpact impact = linear_impact(query);
    const bool face = query.kind == LinearKind::vertex_face;
    bool holds =
        same(impact,
             linear_impact(changed(query, [&](FourPoints& p) { std::swap(p[2], p[3]); }))) &&
        same(impact, linear_impact(changed(query,
                                           [&](FourPoints& p) {
                                             face ? std::swap(p[1], p[3]) : std::swap(p[0], p[1]);
                                           }))) &&
        same(impact, linear_impact(changed(query,
                                           [&](FourPoints& p) {
                                             if (!face) {
                                               std::swap(p[0], p[2]);
                                               std::swap(p[1], p[3]);
                                             }
                                           }))) &&
        same(impact, linear_impact(changed(query, [](FourPoints& p) {
               for (Vector3& x : p) {
                 x = Vector3(x.z(), x.x(), -x.y());
               }
             })));
    if (family < LinearFamily::scaled_axes) {
      for (const double factor : {0x1p-300, 0x1p300, 0x1p-7}) {
        holds = holds && same(impact, linear_impact(changed(query, [factor](FourPoints& p) {
                                for (Vector3& x : p) {
                                  x *= factor;
                                }
                              })));
      }
    }
    return holds;
  });
}

TEST_CASE("linear: backwards they meet as well", "[ccd][linear]") {
  for_all_families(300, [](const LinearQuery& query, LinearFamily) {
    LinearQuery back = query;
    std::swap(back.start, back.end);
    const LinearImpact forth = linear_impact(query);
    const LinearImpact impact = linear_impact(back);
    // The first time is not before the last one, which is the first one backwards.
    return forth.hit == impact.hit && (!forth.hit || forth.t_lo <= 1.0 - impact.t_lo);
  });
}

TEST_CASE("linear: a larger separation is reached no later; 0 is its limit", "[ccd][linear]") {
  for_all_families(6, [](LinearQuery query, LinearFamily family) {
    if (family >= LinearFamily::scaled_axes) {
      return true;  // what takes seconds is left to the reference
    }
    double before = linear_impact(query).t_lo;
    for (const double separation : {0x1p-60, 0.125, 0.5}) {
      query.separation = separation;
      const double t = linear_impact(query).t_lo;
      if (t > before) {
        return false;
      }
      before = t;
    }
    return true;
  });
}

TEST_CASE("linear: a batch answers as one by one", "[ccd][linear]") {
  std::vector<LinearQuery> queries;
  for_all_families(5, [&](const LinearQuery& query, LinearFamily) {
    queries.push_back(query);
    return true;
  });
  std::vector<LinearImpact> answers(queries.size());
  linear_impacts(queries, answers);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const LinearImpact one = linear_impact(queries[i]);
    CHECK(same(answers[i], one));
    CHECK(answers[i].stage == one.stage);
  }
}

TEST_CASE("linear: queries of ordinary numbers do not allocate", "[ccd][linear][allocation]") {
  std::vector<LinearQuery> queries;
  for (const LinearFamily f : {LinearFamily::general, LinearFamily::touch, LinearFamily::at_rest,
                               LinearFamily::translation, LinearFamily::flat}) {
    for (const LinearKind kind : {LinearKind::vertex_face, LinearKind::edge_edge}) {
      LinearFamilies family(f, kind, seed);
      for (int i = 0; i < 200; ++i) {
        queries.push_back(family.next());
      }
    }
  }
  std::vector<LinearImpact> answers(queries.size());
  const std::size_t before = test::allocations();
  linear_impacts(queries, answers);
  CHECK(test::allocations() == before);
}
