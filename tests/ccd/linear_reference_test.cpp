// Vertex and face, edge and edge against GMP: every family of degeneracies, yes or no and the
// bracket to the bit. KAIROS_LINEAR_QUERIES (per family and kind) makes it longer,
// KAIROS_LINEAR_SEED other; the seed of a failure is in its message.
#ifdef KAIROS_WITH_GMP
#include "tests/ccd/linear_reference.hpp"

#include "ccd/linear/exact_motion.hpp"
#include "experiments/vfee/linear_families.hpp"
#include "tests/catch.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace kairos;
using namespace kairos::ccd;
using namespace kairos::reference;

namespace {

std::uint64_t from_environment(const char* name, std::uint64_t by_default) {
  const char* asked = std::getenv(name);
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : by_default;
}

std::string written(const LinearQuery& q, const LinearImpact& got, const LinearImpact& wanted) {
  char text[256];
  std::string result;
  for (const FourPoints* points : {&q.start, &q.end}) {
    for (const Vector3& p : *points) {
      std::snprintf(text, sizeof text, "{%a,%a,%a},", p[0], p[1], p[2]);
      result += text;
    }
  }
  std::snprintf(text, sizeof text, " separation %a: got %d %.17g %.17g, wanted %d %.17g %.17g",
                q.separation, got.hit ? 1 : 0, got.t_lo, got.t_hi, wanted.hit ? 1 : 0, wanted.t_lo,
                wanted.t_hi);
  return result + text;
}

bool same(const LinearImpact& a, const LinearImpact& b) {
  return a.hit == b.hit && a.t_lo == b.t_lo && a.t_hi == b.t_hi;
}

/// Compares, and returns how many met.
template <typename Change>
std::uint64_t compare_families(std::uint64_t count, const Change& change) {
  const std::uint64_t seed = from_environment("KAIROS_LINEAR_SEED", 1);
  std::uint64_t hits = 0;
  for (int f = 0; f < linear_families; ++f) {
    for (const LinearKind kind : {LinearKind::vertex_face, LinearKind::edge_edge}) {
      LinearFamilies family(static_cast<LinearFamily>(f), kind, seed);
      // Numbers of 2,000 bits, and more in polynomials: the reference takes up to 40 ms a query.
      const bool slow = static_cast<LinearFamily>(f) >= LinearFamily::scaled_axes;
      for (std::uint64_t i = 0; i < (slow ? 1 + count / 64 : count); ++i) {
        LinearQuery query = family.next();
        change(query, i);
        const LinearImpact got = linear_impact(query);
        const LinearImpact wanted = reference_impact(query);
        hits += wanted.hit ? 1 : 0;
        if (!same(got, wanted)) {
          FAIL_CHECK(linear_family_names[static_cast<std::size_t>(f)]
                     << (kind == LinearKind::vertex_face ? " vf" : " ee") << " seed " << seed
                     << " query " << i << ": " << written(query, got, wanted));
        }
      }
    }
  }
  return hits;
}

}  // namespace

TEST_CASE("linear: no false positive, no false negative, and the bracket of the reference",
          "[ccd][linear][reference][slow]") {
  const std::uint64_t count =
      from_environment("KAIROS_LINEAR_QUERIES", 410);  // of 28 that are not slow: 1e4
  const std::uint64_t hits = compare_families(count, [](LinearQuery&, std::uint64_t) {});
  CHECK(hits > count);  // otherwise the families show nothing
  CHECK(hits < 27 * count);
}

TEST_CASE("linear: the same with a separation", "[ccd][linear][reference][slow]") {
  const std::uint64_t count = from_environment("KAIROS_LINEAR_SEPARATIONS", 8);
  const std::uint64_t hits = compare_families(count, [](LinearQuery& query, std::uint64_t i) {
    constexpr std::array separations{0.5, 1.0, 0.1, 0x1p-40, 0.25, 2.0, 1e-300};
    query.separation = separations[i % separations.size()];
  });
  CHECK(hits > count);
}
#endif
