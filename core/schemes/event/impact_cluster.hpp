#pragma once

#include <cstdint>
#include <vector>

namespace kairos {
inline namespace core {

/// Two bodies that are nearly in touch, seen along their normal.
struct ClusterContact {
  double gap = 0.0;           ///< m, >= 0
  double rate = 0.0;          ///< of the gap, m/s; negative: approaching
  double acceleration = 0.0;  ///< of the gap between impacts, m/s^2; negative: pressed together
  double restitution = 1.0;
};

/// Bodies that are nearly in touch, linearised: normals and accelerations are taken as constant.
/// Gaps and their rates are all that is left, so that nothing cancels however small they become.
struct ImpactCluster {
  std::vector<ClusterContact> contacts;
  /// J M^-1 J^T, row by row: what an impulse at a contact does to the rates of all, 1/kg.
  std::vector<double> coupling;
};

/// What becomes of a cluster.
struct ClusterFate {
  enum class Kind {
    parts,        ///< finitely many impacts, then none for as long as was asked
    accumulates,  ///< infinitely many in a finite time, or a contact that lasts
    undecided,    ///< too many impacts to tell
  };
  Kind kind = Kind::undecided;
  double duration = 0.0;     ///< until then, s
  std::int64_t impacts = 0;  ///< that were looked at
};

/// Follows a cluster from impact to impact, each by Newton's law. It accumulates (inelastic
/// collapse [McNamara1992], [Bernu1990]; a Zeno phenomenon) where speeds of impact have shrunk by
/// 1e-24 or impacts follow each other without time passing: the linear motion is self-similar
/// there, so that what happened over the last decades happens over all that follow. `horizon`, s:
/// how long the linearisation holds; a cluster without impact for so long has parted. After
/// `most_impacts` it is `undecided`.
[[nodiscard]] ClusterFate follow(ImpactCluster cluster, double horizon, std::int64_t most_impacts);

}  // namespace core
}  // namespace kairos
