// Least squares with signs, against the conditions of Karush, Kuhn and Tucker that define them.

#include "core/contacts/nonnegative_solve.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <Eigen/QR>

using namespace kairos;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd random_matrix(Random& random, Index rows, Index columns) {
  MatrixXd A(rows, columns);
  for (Index j = 0; j < columns; ++j) {
    for (Index i = 0; i < rows; ++i) {
      A(i, j) = random.uniform(-1.0, 1.0);
    }
  }
  return A;
}

}  // namespace

TEST_CASE(
    "nonnegative least squares satisfies the conditions of an optimum, redundant columns or not",
    "[friction]") {
  constexpr std::uint64_t seed = 20261127;
  Random random(seed);
  INFO("seed " << seed);
  int held = 0;
  int solved = 0;
  for (int trial = 0; trial < 2'000; ++trial) {
    const Index rows = 1 + trial % 30;
    const Index columns = 1 + (7 * trial) % 45;
    const Index free = trial % 3 == 0 ? std::min<Index>(columns, trial % 7) : 0;
    // Every other problem of fewer directions than columns, with columns that come twice.
    const Index rank = trial % 2 == 0 ? rows : 1 + rows / 2;
    MatrixXd A = random_matrix(random, rows, rank) * random_matrix(random, rank, columns);
    if (trial % 5 == 0 && columns > 2) {
      A.col(columns - 1) = A.col(columns / 2);
    }
    // Every fourth right-hand side can be made exactly, and by few.
    VectorXd b = random_matrix(random, rows, 1);
    if (trial % 4 == 0) {
      VectorXd x = random_matrix(random, columns, 1).cwiseMax(0.0);
      b = A * x;
    }
    CAPTURE(trial, rows, columns, free);
    const NonnegativeSolution found = solve_nonnegative(A, b, free);
    const VectorXd rest = b - A * found.x;
    REQUIRE(found.x.allFinite());
    REQUIRE(found.residual == rest.cwiseAbs().maxCoeff());
    REQUIRE((columns == free || found.x.tail(columns - free).minCoeff() >= 0.0));
    // Roundoff of columns that nearly depend on each other: solver, 1e-9 of A and b.
    const double tolerance = 1e-9 * (1.0 + b.norm()) * (1.0 + A.norm());
    const VectorXd slope = A.transpose() * rest;
    for (Index j = 0; j < columns; ++j) {
      CAPTURE(j, slope[j], found.x[j]);
      REQUIRE(slope[j] <= tolerance);
      if (j < free || found.x[j] > 1e-9) {
        REQUIRE(slope[j] >= -tolerance);
      }
      held += j >= free && found.x[j] == 0.0 ? 1 : 0;
    }
    if (trial % 4 == 0 && free == 0) {
      REQUIRE(found.residual <= tolerance);
      ++solved;
    }
  }
  CHECK(held > 5'000);
  CHECK(solved > 300);
}

TEST_CASE("nonnegative least squares of nothing, and of what no column makes", "[friction]") {
  const NonnegativeSolution none = solve_nonnegative(MatrixXd(3, 0), VectorXd::Ones(3), 0);
  CHECK(none.x.size() == 0);
  CHECK(none.residual == 1.0);
  CHECK(solve_nonnegative(MatrixXd(0, 2), VectorXd(0), 0).residual == 0.0);
  // The only column points away: it is not taken.
  const NonnegativeSolution away =
      solve_nonnegative(-MatrixXd::Identity(2, 1), VectorXd::Ones(2), 0);
  CHECK(away.x[0] == 0.0);
  CHECK(away.residual == 1.0);
  // Of free columns that are the same each takes half: least norm.
  const NonnegativeSolution same = solve_nonnegative(MatrixXd::Ones(2, 2), VectorXd::Ones(2), 2);
  CHECK((same.x - VectorXd::Constant(2, 0.5)).norm() <= 1e-15);
}
