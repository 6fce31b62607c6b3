#include "core/reading/drive_reader.hpp"

#include "core/drives/sinusoid.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/track_reader.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view track_keys[] = {"track", "smooth", "position_scale"};
constexpr std::string_view rotation_keys[] = {"rotation_axis", "rotation_amplitude",
                                              "rotation_phase"};

/// Farthest point of the body from its origin, m; 0 for a half-space, which cannot turn.
double reach(const Body& body) {
  return std::holds_alternative<HalfSpace>(body.shape) ? 0.0
                                                       : bounding_radius(bounding_box(body.shape));
}

/// A half-space that turns moves infinitely fast far out.
void refuse_turning_half_space(const TableReader& table, const Body& body, std::string_view key) {
  if (std::holds_alternative<HalfSpace>(body.shape)) {
    table.fail(key, "a half-space cannot turn; use a box");
  }
}

std::shared_ptr<const Drive> read_track(const TableReader& table, const Body& body,
                                        const std::string& directory) {
  const Item item = *table.find("track");
  const std::string& text = item.text();
  const std::string path = item.readable_file(directory);
  const auto smooth = table.find("smooth");
  const auto scale = table.find("position_scale");
  const double factor = scale ? scale->number(limits::scale) : 1.0;
  Recording recording = read_track_csv(path);
  for (TrackSample& sample : recording.samples) {
    Pose& pose = sample.pose;
    pose.position = body.initial.pose.position + factor * pose.position;
    pose.orientation = (pose.orientation * body.initial.pose.orientation).normalized();
  }
  auto track = std::make_shared<const Track>(
      std::move(recording.samples), Track::Options{.smooth = smooth && smooth->flag(),
                                                   .reach = reach(body),
                                                   .description = fmt::format("track {}", text),
                                                   .gestures = recording.gestures});
  if (track->turns()) {
    refuse_turning_half_space(table, body, "track");
  }
  return track;
}

void read_rotation(const TableReader& table, const Body& body, Sinusoid::Options& options) {
  const auto axis = table.find("rotation_axis");
  if (!axis) {
    for (const std::string_view key : rotation_keys) {
      if (table.has(key)) {
        table.fail(key, "turns about nothing; allowed: beside rotation_axis, a direction");
      }
    }
    return;
  }
  refuse_turning_half_space(table, body, "rotation_axis");
  const Vector3 direction = axis->vector(limits::component);
  if (!(direction.stableNorm() > 0.0)) {
    axis->fail("has length 0; allowed: any other direction");
  }
  options.rotation_axis = (direction / direction.stableNorm()).normalized();
  options.rotation_amplitude =
      table.need("rotation_amplitude", limits::swing.text()).number(limits::swing);
  if (const auto phase = table.find("rotation_phase")) {
    options.rotation_phase = phase->number(limits::angle);
  }
}

std::shared_ptr<const Drive> read_sinusoid(const TableReader& table, const Body& body) {
  for (const std::string_view key : track_keys) {
    if (table.has(key)) {
      table.fail(
          key,
          "is of a track, and frequency makes the drive a sinusoid; allowed: a track without "
          "frequency, or a sinusoid without this");
    }
  }
  Sinusoid::Options options;
  options.centre = body.initial.pose;
  options.frequency = table.find("frequency")->number(limits::frequency);
  options.reach = reach(body);
  if (const auto amplitude = table.find("amplitude")) {
    options.amplitude = amplitude->vector(limits::position);
  } else if (!table.has("rotation_axis")) {
    table.fail("amplitude", "is missing; needed: amplitude, or rotation_axis, or both");
  }
  if (const auto phase = table.find("phase")) {
    options.phase = phase->number(limits::angle);
  }
  read_rotation(table, body, options);
  return std::make_shared<const Sinusoid>(options);
}

}  // namespace

std::shared_ptr<const Drive> read_drive(const Item& item, const Body& body,
                                        const std::string& directory) {
  const TableReader table(item);
  table.refuse_unknown(scene_keys_of("body.drive"));
  if (table.has("frequency")) {
    return read_sinusoid(table, body);
  }
  for (const std::string_view key :
       {"amplitude", "phase", "rotation_axis", "rotation_amplitude", "rotation_phase"}) {
    if (table.has(key)) {
      table.fail("frequency", "is missing; needed: " + limits::frequency.text());
    }
  }
  if (!table.has("track")) {
    table.fail("", "says nothing; needed: track (a recording) or frequency (a sinusoid)");
  }
  return read_track(table, body, directory);
}

}  // namespace core
}  // namespace kairos
