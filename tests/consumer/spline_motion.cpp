// A robot's arm follows a cubic spline; when does it first touch a ball? A motion is polynomials,
// so that each piece of a spline is one, and the answer is proven for all of it.
#include <kairos/ccd.hpp>

#include <array>
#include <iostream>

int main() {
  using namespace kairos;
  const Shape gripper = Box{{0.05, 0.05, 0.05}}, ball = Sphere{0.1};
  const Motion resting = Motion::at_rest({}, {.position = {1.0, 0.0, 0.0}});

  // x = 3 t^2 - 2 t^3: from rest at 0 to rest at 1 m in a second; then straight on at rest.
  Motion reach;
  reach.duration = 1.0;
  using Coefficient = Polynomial<3>::Value;
  reach.position = Polynomial<3>(Coefficient(0, 0, 0), Coefficient(0, 0, 0), Coefficient(3, 0, 0),
                                 Coefficient(-2, 0, 0));
  reach.velocity = reach.position.differentiated();
  Motion wait = Motion::at_rest(reach.end(), reach.pose(reach.duration));

  const auto certified = ccd::make_certified();
  for (const Motion& piece : {reach, wait}) {
    const Window window{piece.start, std::min(piece.duration, 1.0)};
    const TimeOfImpact toi =
        certified->time_of_impact({gripper, piece}, {ball, resting}, window, 0.0);
    if (toi.status == ToiStatus::impact) {
      std::cout.precision(12);
      std::cout << "touches at " << (piece.start + toi.t_lo).seconds << " s, gap " << toi.gap
                << " m\n";
      return 0;
    }
  }
  std::cout << "never touches\n";
}
