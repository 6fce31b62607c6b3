#include "ccd/moving_cores.hpp"

#include "ccd/core_witness.hpp"

#include <cmath>
#include <limits>

namespace kairos::ccd {
namespace {

/// How near below the distance a separation along a witness has to be, as a part of it.
constexpr double precision = 1e-8;
/// A direction off by so much from a face's normal, or from across an edge, is fixed to it, rad.
constexpr double feature_noise = 1e-6;
/// Edges with a smaller sine do not tell a direction.
constexpr double least_sine = 1e-3;

/// Fixes the direction to edges of both, if it then separates nearly as well.
bool fix_to_edges(const PairMotion& motion, const Kinematics& k, const Vector3& a, const Vector3& b,
                  Witness& witness) {
  const Vector3 cross = a.cross(b);
  const double sine = cross.norm();
  if (!(sine > least_sine)) {
    return false;
  }
  const double sign = cross.dot(witness.n) < 0.0 ? -1.0 : 1.0;
  const Vector3 n = cross * (sign / sine);
  const double gap = core_pair(motion, k).separation(n) - motion.reach();
  const double separation = std::abs(witness.gap + motion.reach());
  if (!(gap >= witness.gap - k.error - 1e-3 * separation)) {
    return false;
  }
  witness.n = n;
  witness.gap = gap;
  witness.sine = sine;
  witness.along_a = a;
  witness.along_b = sign * b;
  witness.frame = WitnessFrame::edges;
  return true;
}

void fix(const PairMotion& motion, const Kinematics& k, Witness& witness) {
  const bool turns_a = motion.turns_a();
  const bool turns_b = motion.turns_b();
  if (!turns_a && !turns_b) {
    return;
  }
  const Feature a = motion.core_a().feature(k.R_WA.transpose() * witness.n, feature_noise);
  const Feature b = motion.core_b().feature(-(k.R_WB.transpose() * witness.n), feature_noise);
  const WitnessFrame with_a = turns_a ? WitnessFrame::a : WitnessFrame::world;
  const WitnessFrame with_b = turns_b ? WitnessFrame::b : WitnessFrame::world;
  if (a.dimension == 2 || b.dimension == 2) {
    witness.frame = a.dimension == 2 ? with_a : with_b;
  } else if (a.dimension == 1 && b.dimension == 1) {
    if (!fix_to_edges(motion, k, k.R_WA * a.along, k.R_WB * b.along, witness)) {
      witness.frame = with_a;
    }
  } else if (a.dimension == 1 || b.dimension == 1) {
    witness.frame = a.dimension == 1 ? with_a : with_b;
  }
}

}  // namespace

Witness between_cores(const PairMotion& motion, const Kinematics& k) {
  const CoreWitness found = core_witness(core_pair(motion, k), motion.reach(), precision, k.error);
  Witness witness;
  witness.n = found.n;
  witness.gap = found.separation - motion.reach();
  witness.depth = found.depth;
  witness.upper = found.upper;
  witness.on_a = found.on_a;
  witness.on_b = found.on_b;
  fix(motion, k, witness);
  return witness;
}

Witness along_direction(const PairMotion& motion, const Kinematics& k, const Vector3& n) {
  Witness witness;
  witness.n = n;
  witness.gap = core_pair(motion, k).separation(n) - motion.reach();
  fix(motion, k, witness);
  return witness;
}

Witness along_two_edges(const PairMotion& motion, const Kinematics& k, const Vector3& edge_a,
                        const Vector3& edge_b, const Vector3& n) {
  Witness witness;
  witness.gap = -std::numeric_limits<double>::infinity();
  const Vector3 cross = edge_a.cross(edge_b);
  const double sine = cross.norm();
  if (sine > least_sine) {
    const double sign = cross.dot(n) < 0.0 ? -1.0 : 1.0;
    witness.n = cross * (sign / sine);
    witness.gap = core_pair(motion, k).separation(witness.n) - motion.reach();
    witness.sine = sine;
    witness.along_a = edge_a;
    witness.along_b = sign * edge_b;
    witness.frame = WitnessFrame::edges;
  }
  return witness;
}

double proven_depth(const PairMotion& motion, const Kinematics& k, const Witness& witness) {
  // Points of both, put together from some products each, are off by less than a separation is.
  return motion.reach() +
         (witness.depth > 0.0 ? witness.depth - k.error : -witness.upper - 2.0 * k.error);
}

bool cores_proven_overlapping(const PairMotion& motion, const Kinematics& k,
                              const Witness& witness) {
  return witness.gap < -k.error && (witness.depth > 0.0 || proven_depth(motion, k, witness) > 0.0);
}

double core_hull_support(const ConvexCore& core, const Matrix3& R, bool spins, const Vector3& w,
                         const Vector3& n) {
  const Vector3 n_B = R.transpose() * n;
  return spins ? core.spun_support(n_B, R.transpose() * w.normalized()) : core.support(n_B);
}

}  // namespace kairos::ccd
