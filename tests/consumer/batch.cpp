// Many questions at once: which of a thousand balls that fly at a wall arrive within a second, and
// how much did it cost to know?
#include <kairos/ccd.hpp>
#include <kairos/core.hpp>

#include <iostream>
#include <vector>

int main() {
  using namespace kairos;
  const Shape ball = Sphere{0.1}, wall = HalfSpace{Vector3::UnitX()};
  const Motion standing = Motion::at_rest({}, {});
  std::vector<Motion> flights;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const Random draw(2026, 0, k);  // the same on every platform
    const Twist speed{{-Random(draw).uniform(0.0, 2.0), 0.0, 0.0}, Vector3::Zero()};
    flights.push_back(Motion::ballistic({}, 1.0, {.position = {1.1, 0.0, 0.0}}, speed, {0, 0, 0}));
  }
  const auto certified = ccd::make_certified();
  int arrive = 0, evaluations = 0;
  for (const Motion& flight : flights) {
    const TimeOfImpact toi =
        certified->time_of_impact({ball, flight}, {wall, standing}, {{}, 1.0}, 0.0);
    arrive += toi.status == ToiStatus::impact ? 1 : 0;
    evaluations += toi.evaluations;
  }
  std::cout << arrive << " of " << flights.size() << " arrive, " << evaluations << " evaluations\n";
}
