#include <kairos/ccd.hpp>

#include <iostream>

int main() {
  using namespace kairos;
  const Shape ball = Sphere{0.1}, floor = HalfSpace{};
  const Motion falling = Motion::ballistic({}, 2.0, {.position = {0.0, 5.0, 0.0}}, {},
                                           {0.0, -9.8, 0.0});  // from 5 m, under gravity
  const Motion resting = Motion::at_rest({}, {});
  const TimeOfImpact toi =
      ccd::make_certified()->time_of_impact({ball, falling}, {floor, resting}, {{}, 2.0}, 0.0);
  std::cout << to_string(toi.status) << " in [" << toi.t_lo << ", " << toi.t_hi << "] s\n";
}
