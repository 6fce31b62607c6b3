#include "studio/engine/later_start.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

namespace kairos::studio {
namespace {

/// A drive that began some time ago.
class BegunDrive final : public Drive {
 public:
  BegunDrive(std::shared_ptr<const Drive> drive, double ago)
      : drive_(std::move(drive)), ago_(ago) {}

  [[nodiscard]] Motion motion(Instant t, double at_most) const override {
    Motion motion = drive_->motion(t + ago_, at_most);
    motion.start = t;
    return motion;
  }
  [[nodiscard]] std::string description() const override { return drive_->description(); }
  [[nodiscard]] bool has_gestures() const override { return drive_->has_gestures(); }
  [[nodiscard]] bool closed(Instant t) const override { return drive_->closed(t + ago_); }

 private:
  std::shared_ptr<const Drive> drive_;
  double ago_;  ///< s
};

std::string_view cut(std::string_view& text, char at) {
  const std::size_t end = std::min(text.find(at), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

double number(std::string_view text) {
  if (const auto x = parse_number(text)) {
    return *x;
  }
  throw InputError("", 0, "start", "\"" + std::string(text) + "\" is no number");
}

BodyState state(std::string_view text) {
  std::array<double, 13> x{};
  for (double& component : x) {
    component = number(cut(text, ' '));
  }
  BodyState state;
  state.pose = {{x[0], x[1], x[2]}, Quaternion(x[3], x[4], x[5], x[6]).normalized()};
  state.twist = {{x[7], x[8], x[9]}, {x[10], x[11], x[12]}};
  return state;
}

}  // namespace

void start_later(Scene& scene, std::string_view start) {
  if (start.empty()) {
    return;
  }
  const double ago = number(cut(start, '\n'));
  for (Body& body : scene.bodies) {
    if (body.drive) {
      body.drive = std::make_shared<const BegunDrive>(body.drive, ago);
      const Motion motion = body.drive->motion(Instant{}, 1.0);
      body.initial = {motion.pose(0.0), motion.twist(0.0)};
    }
  }
  while (!start.empty()) {
    std::string_view line = cut(start, '\n');
    const std::string_view name = cut(line, '\t');
    const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                   [name](const Body& each) { return each.name == name; });
    if (body != scene.bodies.end()) {
      body->initial = state(line);
    }
  }
}

}  // namespace kairos::studio
