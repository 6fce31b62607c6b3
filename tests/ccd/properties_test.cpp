// Properties of `certified` over seeded random queries of every class of difficulty and pair of
// shapes: what DESIGN promises, judged by the reference. KAIROS_CCD_QUERIES (per class and pair)
// makes it longer; the seed of a failure is in its message.
#include "ccd/certified.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/catch.hpp"

#include <cstdlib>

using namespace kairos;
using namespace kairos::reference;

namespace {

const auto certified = ccd::make_certified();

int queries_per_class(int by_default) {
  const char* asked = std::getenv("KAIROS_CCD_QUERIES");
  return asked != nullptr ? std::atoi(asked) : by_default;
}

template <typename Check>
void for_random_queries(int count, const Check& check) {
  for (int d = 0; d < difficulties; ++d) {
    for (const ShapeKinds kinds : shape_kinds) {
      for (int i = 0; i < count; ++i) {
        const auto seed = static_cast<std::uint64_t>(i);
        check(random_query(static_cast<Difficulty>(d), kinds, seed),
              "class " + std::to_string(d) + " shapes " + std::to_string(kinds.a) +
                  std::to_string(kinds.b) + " seed " + std::to_string(i));
      }
    }
  }
}

}  // namespace

TEST_CASE("certified keeps its promises on random queries", "[ccd][properties]") {
  int undecided = 0;
  for_random_queries(queries_per_class(500), [&](const Query& q, const std::string& name) {
    const TimeOfImpact toi = q.ask(*certified);
    const std::string broken = broken_promise(q, toi, 100);
    undecided += toi.status == ToiStatus::undecided ? 1 : 0;
    if (!broken.empty()) {
      FAIL_CHECK(name << ": " << broken << ", t_lo " << toi.t_lo);
    }
  });
  CHECK(undecided == 0);
}

TEST_CASE("answers are symmetric in a and b", "[ccd][properties]") {
  for_random_queries(queries_per_class(300), [](const Query& q, const std::string& name) {
    const TimeOfImpact toi = q.ask(*certified);
    const TimeOfImpact other = q.exchanged().ask(*certified);
    const bool brackets_meet = toi.t_lo <= other.t_hi && other.t_lo <= toi.t_hi;
    if (toi.status != other.status || !brackets_meet) {
      FAIL_CHECK(name << ": " << toi.t_lo << " against " << other.t_lo);
    }
  });
}

TEST_CASE("answers are invariant under rigid transformations", "[ccd][properties]") {
  const Quaternion turn = turned({1, -2, 0.5}, 2.1);
  const Vector3 shift(0.3, -0.8, 1.1);
  const auto transformed = [&](Motion motion, double size) {
    for (int k = 0; k <= motion.position.degree(); ++k) {
      motion.position[k] = turn * motion.position[k];
    }
    motion.position[0] += size * shift;
    motion.rotation_rate = turn * motion.rotation_rate;
    for (int k = 0; k <= motion.quaternion.degree(); ++k) {
      const Vector4 c = motion.quaternion[k];
      const Quaternion q = turn * Quaternion(c[0], c[1], c[2], c[3]);
      motion.quaternion[k] = Vector4(q.w(), q.x(), q.y(), q.z());
    }
    return motion;
  };
  for_random_queries(queries_per_class(200), [&](const Query& q, const std::string& name) {
    const double size = std::min(smallest_extent(q.a), smallest_extent(q.b));
    const Query moved{q.a, q.b, transformed(q.motion_a, size), transformed(q.motion_b, size), 1.0};
    const TimeOfImpact toi = q.ask(*certified);
    const TimeOfImpact other = moved.ask(*certified);
    // The transformed coefficients are rounded: 1e-13 of coordinates up to 10 extents, and at 1e6 m
    // 1e-9; with rates of the gap above 1e-3 extents a second (a graze may differ by more).
    const double far = q.motion_a.position[0].norm() > 1e5 ? 1e-6 : 1e-9;
    const bool same = toi.status == other.status &&
                      (toi.status != ToiStatus::impact || std::abs(toi.t_lo - other.t_lo) < far);
    if (!same) {
      FAIL_CHECK(name << ": " << toi.t_lo << " against " << other.t_lo);
    }
  });
}

TEST_CASE("time reversal: the first contact forwards is the last parting backwards",
          "[ccd][properties]") {
  // Backwards from t_lo the window [0, t_lo) is free of contact as well.
  for (const ShapeKinds kinds : shape_kinds) {
    for (int i = 0; i < queries_per_class(300); ++i) {
      const Query q = random_query(Difficulty::turning, kinds, static_cast<std::uint64_t>(i));
      const TimeOfImpact toi = q.ask(*certified);
      if (toi.status != ToiStatus::impact) {
        continue;
      }
      const auto backwards = [&](const Motion& motion) {
        Motion reversed = motion.shifted(toi.t_lo);
        reversed.start = {};
        reversed.duration = toi.t_lo;
        if (reversed.position.degree() > 0) {
          reversed.position[1] = -reversed.position[1];
        }
        reversed.velocity = reversed.position.differentiated();
        reversed.rotation_rate = -reversed.rotation_rate;
        return reversed;
      };
      const Query reversed{q.a, q.b, backwards(q.motion_a), backwards(q.motion_b), toi.t_lo};
      const TimeOfImpact back = reversed.ask(*certified);
      // It starts in touch to roundoff: leaving, or at once and nothing later.
      const bool free = back.status == ToiStatus::separated || back.t_lo < 1e-6;
      if (!free) {
        FAIL_CHECK("shapes " << kinds.a << kinds.b << " seed " << i << ": " << back.t_lo);
      }
    }
  }
}

TEST_CASE("at t_lo the shapes do not overlap as the simulation sees them", "[ccd][properties]") {
  for_random_queries(queries_per_class(300), [](const Query& q, const std::string& name) {
    const TimeOfImpact toi = q.ask(*certified);
    if (toi.status == ToiStatus::impact && toi.t_lo > 0.0 &&
        certified->overlaps(q.a, q.motion_a.pose(toi.t_lo), q.b, q.motion_b.pose(toi.t_lo))) {
      FAIL_CHECK(name);
    }
  });
}

TEST_CASE("brackets are a few ulp wide where bodies do not turn", "[ccd][properties]") {
  // A gap of k u of the coordinates (about 10 extents) over an approach of 1e-3 extents a second
  // and more: 1e-10 s bounds all but grazes.
  int wide = 0;
  int impacts = 0;
  for (const ShapeKinds kinds : shape_kinds) {
    for (int i = 0; i < queries_per_class(300); ++i) {
      const TimeOfImpact toi =
          random_query(Difficulty::straight, kinds, static_cast<std::uint64_t>(i)).ask(*certified);
      impacts += toi.status == ToiStatus::impact ? 1 : 0;
      wide += toi.status == ToiStatus::impact && toi.t_hi - toi.t_lo > 1e-10 ? 1 : 0;
    }
  }
  CHECK(impacts > 100);
  CHECK(wide == 0);
}

TEST_CASE("windows that start within the motions see the same contacts", "[ccd][properties]") {
  for_random_queries(queries_per_class(100), [](const Query& q, const std::string& name) {
    const TimeOfImpact whole = q.ask(*certified);
    const double s = 0.4 * (whole.status == ToiStatus::impact ? whole.t_lo : q.duration);
    const TimeOfImpact later =
        certified->time_of_impact(q.moving_a(), q.moving_b(), {Instant{} + s, q.duration - s}, 0.0);
    const double far = q.motion_a.position[0].norm() > 1e5 ? 1e-6 : 1e-9;  // roundoff over rates
    const bool same = whole.status == later.status && (whole.status != ToiStatus::impact ||
                                                       std::abs(later.t_lo + s - whole.t_lo) < far);
    if (!same && whole.status != ToiStatus::overlapping) {
      FAIL_CHECK(name << ": " << whole.t_lo << " against " << later.t_lo + s);
    }
  });
}
