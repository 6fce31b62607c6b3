#include "simulation/view/packed_run.hpp"

#include "simulation/view/shape_json.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos {
inline namespace simulation {
namespace {

void add_bodies(JsonWriter& json, const std::vector<ViewBody>& bodies) {
  constexpr std::string_view movers[] = {"fixed", "driven", "free"};
  json.open("bodies");
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Actor& actor = bodies[i].actor;
    json.open(fmt::format("{}", i));
    json.text("name", actor.name);
    json.text("entity", actor.entity);
    json.text("moves", movers[static_cast<std::size_t>(bodies[i].moves)]);
    json.flag("field", actor.is_field);
    if (!actor.belt.isZero(0.0)) {
      add_vector(json, "belt", actor.belt);
    }
    add_shape(json, "shape", actor.shape);
    add_shape(json, "collides", actor.collides_as);
    json.close();
  }
  json.close();
}

void add_side(JsonWriter& json, std::string_view key, const JointSide& side) {
  json.open(key);
  json.count("body", side.body ? static_cast<std::int64_t>(*side.body) : -1);
  add_vector(json, "point", side.point);
  add_vector(json, "axis", side.frame * Vector3::UnitX());
  json.close();
}

void add_joints(JsonWriter& json, const std::vector<Joint>& joints) {
  json.open("joints");
  for (std::size_t k = 0; k < joints.size(); ++k) {
    json.open(fmt::format("{}", k));
    json.text("kind", to_string(joints[k].kind));
    json.text("name", joints[k].name);
    json.flag("collide", joints[k].collide);
    add_side(json, "a", joints[k].a);
    add_side(json, "b", joints[k].b);
    json.close();
  }
  json.close();
}

void pack_tracks(PackedArrays& arrays, const std::vector<BodyTrack>& tracks) {
  std::vector<std::uint32_t> first{0};
  std::vector<double> start, duration, coefficients;
  std::vector<std::uint8_t> layout;
  for (const BodyTrack& track : tracks) {
    first.push_back(first.back() + static_cast<std::uint32_t>(track.start.size()));
    start.insert(start.end(), track.start.begin(), track.start.end());
    duration.insert(duration.end(), track.duration.begin(), track.duration.end());
    layout.insert(layout.end(), track.layout.begin(), track.layout.end());
    coefficients.insert(coefficients.end(), track.coefficients.begin(), track.coefficients.end());
  }
  arrays.add("first", first);
  arrays.add("start", start);
  arrays.add("duration", duration);
  arrays.add("layout", layout);
  arrays.add("coefficients", coefficients);
}

void pack_events(PackedArrays& arrays, const std::vector<ViewEvent>& events) {
  std::vector<double> time, approach, gap, vectors;
  std::vector<std::uint8_t> kind;
  std::vector<std::uint32_t> pair;
  for (const ViewEvent& event : events) {
    time.push_back(event.time);
    kind.push_back(static_cast<std::uint8_t>(event.kind));
    pair.push_back(static_cast<std::uint32_t>(event.a));
    pair.push_back(static_cast<std::uint32_t>(event.b));
    gap.push_back(event.contact.gap);
    approach.push_back(event.approach);
    for (const Vector3& v : {event.contact.point, event.contact.normal, event.impulse}) {
      vectors.insert(vectors.end(), v.data(), v.data() + 3);
    }
  }
  arrays.add("event.time", time);
  arrays.add("event.kind", kind);
  arrays.add("event.pair", pair);
  arrays.add("event.gap", gap);
  arrays.add("event.approach", approach);
  arrays.add("event.vectors", vectors);
}

}  // namespace

PackedArrays packed(const ViewRun& run) {
  PackedArrays arrays;
  pack_tracks(arrays, run.tracks);
  arrays.add("frames", run.frame_times);
  for (const auto& [name, values] : run.energy) {
    const bool silent =
        std::all_of(values.begin(), values.end(), [](double joules) { return joules == 0.0; });
    if (!silent || name == "kinetic" || name == "potential") {
      arrays.add("energy." + name, values);
    }
  }
  pack_events(arrays, run.events);
  return arrays;
}

void describe(JsonWriter& json, const ViewRun& run, const PackedArrays& arrays) {
  json.text("title", run.title);
  json.text("summary", run.summary);
  json.text("method", run.method);
  json.text("note", run.note);
  json.text("reason", run.reason);
  add_bodies(json, run.bodies);
  add_joints(json, run.joints);
  json.open("arrays");
  for (const PackedArrays::Entry& entry : arrays.entries()) {
    json.open(entry.name);
    json.text("type", entry.type);
    json.count("offset", static_cast<std::int64_t>(entry.offset));
    json.count("length", static_cast<std::int64_t>(entry.length));
    json.close();
  }
  json.close();
}

}  // namespace simulation
}  // namespace kairos
