// `bisection` beside the bracketing solvers of GSL on the same gap.
#ifdef KAIROS_WITH_GSL

#include "ccd/bisection.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/catch.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <memory>
#include <string>

using namespace kairos;
using namespace kairos::reference;

namespace {

double gap_at(double t, void* query) {
  return static_cast<double>(static_cast<const Query*>(query)->separation(t));
}

/// The root of the gap between `low` (apart) and `high` (overlapping), until the bracket is 4 ulp.
double root_by_gsl(const gsl_root_fsolver_type* type, Query& query, double low, double high) {
  const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
      gsl_root_fsolver_alloc(type), gsl_root_fsolver_free);
  gsl_function f{&gap_at, &query};
  REQUIRE(gsl_root_fsolver_set(solver.get(), &f, low, high) == GSL_SUCCESS);
  for (int i = 0; i < 200; ++i) {
    gsl_root_fsolver_iterate(solver.get());
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver.get()),
                               gsl_root_fsolver_x_upper(solver.get()), 0.0,
                               0x1p-50) == GSL_SUCCESS) {
      break;
    }
  }
  return gsl_root_fsolver_root(solver.get());
}

}  // namespace

TEST_CASE("bisection finds the root that GSL's bracketing solvers find", "[ccd][bisection]") {
  gsl_set_error_handler_off();
  const auto bisection = ccd::make_bisection();
  int compared = 0;
  for (const ShapeKinds kinds : shape_kinds) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      Query q = random_query(Difficulty::turning, kinds, seed);
      const TimeOfImpact toi = q.ask(*bisection);
      // A bracket of 1 ms: the roundings of 10 m over 1e-13 s a ulp play no role at its ends.
      const double low = std::max(0.0, toi.t_lo - 5e-4);
      const double high = toi.t_hi + 5e-4;
      if (toi.status != ToiStatus::impact || q.separation(low) <= 0 || q.separation(high) >= 0) {
        continue;
      }
      for (const gsl_root_fsolver_type* type :
           {gsl_root_fsolver_bisection, gsl_root_fsolver_falsepos, gsl_root_fsolver_brent}) {
        CAPTURE(std::string(type->name), kinds.a, kinds.b, seed);
        // Solver: 4 ulp of GSL's; roundoff: 100 u of 10 m over the 1e-3 m/s at which all but grazes
        // close.
        CHECK(root_by_gsl(type, q, low, high) == Approx(toi.t_lo).margin(1e-10).epsilon(1e-14));
      }
      ++compared;
    }
  }
  CHECK(compared > 50);
}

#endif
