#include "core/reading/many_reader.hpp"

#include "core/exponential.hpp"
#include "core/free_memory.hpp"
#include "core/placement.hpp"
#include "core/random.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/scene_name.hpp"
#include "core/solid_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view placements[] = {"lattice", "random"};
constexpr std::string_view orientations[] = {"same", "random"};
constexpr Range factor{.lowest = 1e-6, .highest = 1e6};
constexpr Range speed_deviation{.lowest = 0.0, .highest = 1e11, .unit = "m/s"};
constexpr Range spin_deviation{.lowest = 0.0, .highest = 1e11, .unit = "rad/s"};
/// How many bodies one table may make.
constexpr std::int64_t most_bodies = 10'000'000;

/// Independent streams of random numbers, so that one choice leaves the others' draws alone.
enum Stream : std::uint64_t { sizes_stream = 1, velocity_stream, spin_stream, turn_stream };

void refuse_unknown_keys(const TableReader& table) {
  std::vector<std::string_view> known = scene_keys_of("many");
  for (const std::string_view key : scene_keys_of("body")) {
    known.push_back(key);
  }
  for (const EntityType& type : entity_catalogue()) {
    for (const EntityKey& key : type.keys) {
      known.push_back(key.key);
    }
  }
  table.refuse_unknown(known);
}

/// The body that the table would be, without the keys that make many of it.
Body read_template(const Item& item, const TableReader& table, const BodyDefaults& defaults) {
  for (const std::string_view key : {"position", "drive", "holds", "normal"}) {
    if (table.has(key)) {
      table.fail(
          key, "is of one body; allowed: a region for many bodies, which nothing drives or holds");
    }
  }
  Table one = *item.value().table();
  for (const std::string_view key : scene_keys_of("many")) {
    const auto at = std::find(one.keys.begin(), one.keys.end(), key);
    if (key != "name" && at != one.keys.end()) {
      one.values.erase(one.values.begin() + (at - one.keys.begin()));
      one.keys.erase(at);
    }
  }
  const Value value{one, item.value().file, item.value().line};
  Body body = read_body(Item(value, item.path()), defaults);
  if (std::holds_alternative<HalfSpace>(body.shape)) {
    table.fail("shape", "a half-space fills half the world; allowed: shapes of finite size");
  }
  if (body.entity->mobility() == Mobility::driven) {
    table.fail("entity",
               fmt::format("a {} needs a drive of its own; allowed: entities that move freely "
                           "or not at all",
                           body.entity->kind()));
  }
  return body;
}

Region read_region(const TableReader& many) {
  const TableReader table(many.need("region", "a table with min and max"));
  table.refuse_unknown(scene_keys_of("many.region"));
  const Item high = table.need("max", "an array of 3 numbers (m)");
  const Region region{table.need("min", "an array of 3 numbers (m)").vector(limits::position),
                      high.vector(limits::position)};
  if (!((region.highest - region.lowest).array() > 0.0).all()) {
    high.fail("is not above min on every axis; allowed: three numbers above those of min (m)");
  }
  return region;
}

/// The factors by which the bodies are larger than the one that is written.
std::vector<double> read_sizes(const TableReader& table, std::size_t count, std::uint64_t seed) {
  std::vector<double> sizes(count, 1.0);
  if (const auto item = table.find("sizes")) {
    const std::vector<double> range = item->numbers(2, factor);
    if (range[0] > range[1]) {
      item->fail("the first is above the second; allowed: [least, greatest]");
    }
    Random random(seed, sizes_stream);
    for (double& size : sizes) {
      size = random.uniform(range[0], range[1]);
    }
  }
  return sizes;
}

double ball_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * power(radius, 3); }

/// Where the bodies are: balls of their bounding radii do not touch.
std::vector<Vector3> place(const TableReader& table, const Region& region,
                           const std::vector<double>& radii, std::uint64_t seed) {
  const auto placement = table.find("placement");
  const bool random = placement && placement->choice(placements) == 1;
  if (!random) {
    const double radius = *std::max_element(radii.begin(), radii.end());
    std::vector<Vector3> sites = lattice_sites(region, radius, radii.size());
    if (sites.empty()) {
      table.fail("region",
                 fmt::format("has no room for {} bodies within {} m of their centres; "
                             "allowed: at most {} on a lattice, smaller bodies, or a larger "
                             "region",
                             radii.size(), radius, most_on_lattice(region, radius)));
    }
    return sites;
  }
  RandomSites sites = random_sites(region, radii, seed);
  if (sites.placed < radii.size()) {
    double volume = 0.0;
    for (const double radius : radii) {
      volume += ball_volume(radius);
    }
    table.fail(
        "region",
        fmt::format("has no room for more than {} of {} bodies at random, whose balls would "
                    "fill {:.3f} of it; random placement jams at 0.38, allowed: fewer, "
                    "smaller, a larger region, or placement = \"lattice\"",
                    sites.placed, radii.size(), volume / (region.highest - region.lowest).prod()));
  }
  return std::move(sites.centres);
}

void resize(Body& body, double size) {
  body.shape = resized(body.shape, size);
  if (body.mass > 0.0) {  // of the same density
    body.mass *= power(size, 3);
    body.inertia *= power(size, 5);
  }
}

double read_deviation(const TableReader& table, const Body& body, std::string_view key,
                      const Range& range) {
  const auto item = table.find(key);
  if (item && body.entity->mobility() != Mobility::free) {
    item->fail(fmt::format("a {} does not move; allowed: a ball or a body", body.entity->kind()));
  }
  if (item && key == "angular_velocity_deviation" && !body.entity->rotates()) {
    item->fail(fmt::format("a {} does not turn; allowed: none, or the entity \"body\"",
                           body.entity->kind()));
  }
  return item ? item->number(range) : 0.0;
}

Vector3 normal_vector(Random& random, double deviation) {
  const double x = random.normal();
  const double y = random.normal();
  const double z = random.normal();
  return deviation * Vector3(x, y, z);
}

}  // namespace

void read_many(const Item& item, const BodyDefaults& defaults, std::vector<Body>& bodies) {
  const TableReader table(item);
  refuse_unknown_keys(table);
  const Body body = read_template(item, table, defaults);
  const std::string& name = read_name(table.need("name", "a name; bodies are NAME-1, NAME-2, ..."));
  const Item counted = table.need("count", "how many bodies");
  const auto count = static_cast<std::size_t>(counted.whole_number(1, most_bodies));
  const double bytes_a_body = bytes_in_model + bytes_in_run;
  if (const std::string why = why_no_room(count, bytes_a_body, free_memory()); !why.empty()) {
    counted.fail(why);
  }
  const Region region = read_region(table);
  const auto seed_item = table.find("seed");
  const std::uint64_t seed = seed_item ? static_cast<std::uint64_t>(seed_item->whole_number(
                                             0, std::numeric_limits<std::int64_t>::max()))
                                       : 1;
  const double speed = read_deviation(table, body, "velocity_deviation", speed_deviation);
  const double spin = read_deviation(table, body, "angular_velocity_deviation", spin_deviation);
  const auto turned = table.find("orientations");
  const bool at_random = turned && turned->choice(orientations) == 1;
  if (at_random && (table.has("orientation") || table.has("axis_angle"))) {
    turned->fail("an orientation is given too; allowed: one of both");
  }
  const std::vector<double> sizes = read_sizes(table, count, seed);
  std::vector<double> radii;
  radii.reserve(count);
  for (const double size : sizes) {
    radii.push_back(size * bounding_radius(body.collision_shape()));
  }
  const std::vector<Vector3> centres = place(table, region, radii, seed);
  const std::size_t width = std::to_string(count).size();
  if (name.size() + 1 + width > 64) {
    table.fail("name", fmt::format("is too long for names with a number of {} digits; allowed: 64 "
                                   "characters in all",
                                   width));
  }
  Random velocities(seed, velocity_stream);
  Random spins(seed, spin_stream);
  Random turns(seed, turn_stream);
  bodies.reserve(bodies.size() + count);
  for (std::size_t i = 0; i < count; ++i) {
    Body& each = bodies.emplace_back(body);
    each.name = fmt::format("{}-{:0{}}", name, i + 1, width);
    resize(each, sizes[i]);
    each.initial.pose.position = centres[i];
    if (at_random) {
      each.initial.pose.orientation = turns.orientation();
    }
    if (speed > 0.0) {
      each.initial.twist.linear += normal_vector(velocities, speed);
    }
    if (spin > 0.0) {
      each.initial.twist.angular += normal_vector(spins, spin);
    }
  }
}

}  // namespace core
}  // namespace kairos
