// When does a turning box touch another? Asked of three detectors.
#include <kairos/ccd.hpp>

#include <iostream>

int main() {
  using namespace kairos;
  const Shape crate = Box{{0.5, 0.5, 0.5}}, plank = Box{{1.0, 0.1, 0.2}};
  const Motion still = Motion::at_rest({}, {});
  // A plank above the crate turns about z until its lower face meets an edge.
  const Pose above{{0.0, 1.2, 0.0}, Quaternion::Identity()};
  const Twist turning{Vector3::Zero(), {0.0, 0.0, 1.0}};
  const Motion plank_moves = Motion::ballistic({}, 2.0, above, turning, Vector3::Zero());
  for (const auto& detector :
       {ccd::make_certified(), ccd::make_conservative_advancement(), ccd::make_bisection()}) {
    const TimeOfImpact toi =
        detector->time_of_impact({crate, still}, {plank, plank_moves}, {{}, 2.0}, 1e-9);
    std::cout << detector->info().name << ": " << to_string(toi.status) << " at " << toi.t_lo
              << " s, " << toi.evaluations << " evaluations\n";
  }
}
