#pragma once

#include <cstdint>
#include <optional>

namespace kairos {
inline namespace core {

/// What can be told to the schemes that step over contacts, named as in the sources that they
/// follow. 0 of a count: what the scheme's source takes.
struct TimeSteppingOptions {
  /// Steps in a frame, all equally long. 0: moreau-jean and pgs 1, xpbd 20, penalty 100.
  std::int64_t substeps = 0;
  /// Sweeps over all contacts in a step: of moreau-jean at most so many (0: 1000), of pgs (0: 10),
  /// of xpbd's position solve (0: 1).
  std::int64_t iterations = 0;

  double theta = 0.5;               ///< moreau-jean: weight of the end of a step, 1/2 to 1
  double solver_tolerance = 1e-12;  ///< moreau-jean: sweeps end when velocities change by less,
                                    ///< relative to the largest there is
  double beta = 0.2;    ///< pgs, Baumgarte: share of the penetration that a step is to undo
  double slop = 0.005;  ///< pgs: penetration that is left alone, m
  double restitution_threshold = 1.0;  ///< pgs: slower approaches do not rebound, m/s
  bool warm_starting = true;           ///< pgs: begin with the impulses of the last step
  double compliance = 0.0;             ///< xpbd, alpha of contacts, m/N
  double stiffness = 1e6;              ///< penalty: k of a contact point, N/m^exponent
  double exponent = 1.5;               ///< penalty: n, 3/2 after Hertz; 1 is a linear spring
  std::optional<double> dissipation;   ///< penalty: alpha of Hunt and Crossley, s/m; none: from
                                       ///< the pair's restitution, e = 1 - alpha v
  double stiction_velocity = 0.01;     ///< penalty: slower slip has less friction, m/s
};

}  // namespace core
}  // namespace kairos
