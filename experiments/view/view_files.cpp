#include "experiments/view/view_files.hpp"

#include "core/error.hpp"
#include "core/impact_law.hpp"
#include "core/reading/document.hpp"
#include "experiments/output/table_rows.hpp"
#include "experiments/render/footage.hpp"
#include "simulation/view/straight_motion.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

/// A body at an instant, as it arrives there and as it leaves.
struct Node {
  double time = 0.0;
  BodyState before;
  BodyState after;
  bool turned = true;  ///< whether its orientation is known: an event tells none
};

EventKind kind_of(const TableRows& rows, std::size_t row) {
  const std::string text = rows.text(row, "kind");
  for (const EventKind kind :
       {EventKind::impact, EventKind::contact_begins, EventKind::contact_ends,
        EventKind::field_entered, EventKind::field_left, EventKind::grasped, EventKind::released,
        EventKind::slip_begins, EventKind::stick_begins, EventKind::roll_begins}) {
    if (text == to_string(kind)) {
      return kind;
    }
  }
  rows.fail(row, "kind", "is \"" + text + "\", which is no kind of event");
}

BodyState state_of(const TableRows& rows, std::size_t row, const std::string& prefix) {
  BodyState state;
  state.pose.position = rows.vector(row, prefix + "px", prefix + "py", prefix + "pz");
  state.twist = {rows.vector(row, prefix + "vx", prefix + "vy", prefix + "vz"),
                 rows.vector(row, prefix + "wx", prefix + "wy", prefix + "wz")};
  return state;
}

/// The text of a member of summary.json, whose name no other member with a text has; "" if there is
/// none.
std::string member(const std::string& summary, const std::string& name) {
  const std::string key = "\"" + name + "\": \"";
  const std::size_t found = summary.find(key);
  std::string text;
  if (found == std::string::npos) {
    return text;
  }
  for (std::size_t i = found + key.size(); i < summary.size() && summary[i] != '"'; ++i) {
    i += summary[i] == '\\' ? 1 : 0;
    text += summary[i];
  }
  return text;
}

/// A body that is not free and yet moves is driven.
Mobility mobility_of(const Footage& footage, std::size_t i) {
  if (footage.actors[i].is_free) {
    return Mobility::free;
  }
  const Pose& first = footage.pictures.front().poses[i];
  for (const Footage::Picture& picture : footage.pictures) {
    if (picture.poses[i].position != first.position ||
        picture.poses[i].orientation.coeffs() != first.orientation.coeffs()) {
      return Mobility::driven;
    }
  }
  return Mobility::fixed;
}

/// Frames: poses as a picture has them, and the velocities that go with them.
void read_frames(const Footage& footage, const TableRows& rows, ViewRun& run,
                 std::vector<std::vector<Node>>& nodes) {
  std::map<std::string, BodyIndex> index;
  for (BodyIndex i = 0; i < run.bodies.size(); ++i) {
    index[run.bodies[i].actor.name] = i;
  }
  std::size_t row = 0;
  for (const Footage::Picture& picture : footage.pictures) {
    run.frame_times.push_back(picture.time);
    for (std::size_t n = 0; n < nodes.size(); ++n, ++row) {
      const BodyIndex i = index.at(rows.text(row, "body"));
      const BodyState state{
          picture.poses[i],
          {rows.vector(row, "vx", "vy", "vz"), rows.vector(row, "wx", "wy", "wz")}};
      nodes[i].push_back({picture.time, state, state});
    }
  }
}

/// Reads events, and the states of bodies in them.
void read_events(const std::string& path, ViewRun& run, std::vector<std::vector<Node>>& nodes) {
  std::map<std::string, BodyIndex> index;
  for (BodyIndex i = 0; i < run.bodies.size(); ++i) {
    index[run.bodies[i].actor.name] = i;
  }
  const TableRows rows(path);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ViewEvent event{.time = rows.number(row, "t"), .kind = kind_of(rows, row)};
    for (const auto& [column, body] : {std::pair("a", &event.a), std::pair("b", &event.b)}) {
      const auto found = index.find(rows.text(row, column));
      if (found == index.end()) {
        rows.fail(row, column, "is not in summary.json");
      }
      *body = found->second;
      const std::string prefix(column);
      Node node{event.time, state_of(rows, row, prefix + "_before_"),
                state_of(rows, row, prefix + "_after_"), false};
      nodes[*body].push_back(node);
    }
    event.contact = {rows.vector(row, "px", "py", "pz"), rows.vector(row, "nx", "ny", "nz"),
                     rows.number(row, "gap")};
    if (event.kind == EventKind::impact) {
      event.approach = normal_velocity(event.contact, nodes[event.a].back().before,
                                       nodes[event.b].back().before);
    }
    run.events.push_back(event);
  }
}

void read_energy(const std::string& path, ViewRun& run) {
  const TableRows rows(path);
  std::vector<std::string> names{"kinetic", "potential"};
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    names.emplace_back(to_string(static_cast<EnergyLine>(i)));
  }
  names.emplace_back("unexplained");
  if (rows.size() != run.frame_times.size()) {
    throw InputError(path, 0, "", "has another number of frames than trajectory.csv");
  }
  for (const std::string& name : names) {
    std::vector<double>& values = run.energy.emplace_back(name, std::vector<double>()).second;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      values.push_back(rows.number(row, name));
    }
  }
}

/// The orientation of a node that has none: on the way between the frames around it.
void fill_orientations(std::vector<Node>& nodes) {
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
    if (!nodes[k].turned) {
      const Node& left = nodes[k - 1];
      const auto right = std::find_if(nodes.begin() + static_cast<std::ptrdiff_t>(k), nodes.end(),
                                      [](const Node& node) { return node.turned; });
      const double whole = right == nodes.end() ? 0.0 : right->time - left.time;
      nodes[k].before.pose.orientation = left.after.pose.orientation;
      if (whole > 0.0) {
        const Motion way = straight_motion({left.time}, whole, left.after, right->before);
        nodes[k].before.pose.orientation = way.orientation(nodes[k].time - left.time);
      }
      nodes[k].after.pose.orientation = nodes[k].before.pose.orientation;
    }
  }
}

void make_track(std::vector<Node>& nodes, BodyTrack& track) {
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const Node& a, const Node& b) { return a.time < b.time; });
  fill_orientations(nodes);
  track.add(Motion::ballistic({nodes.front().time}, 0.0, nodes.front().after.pose,
                              nodes.front().after.twist, Vector3::Zero()));
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double h = nodes[k].time - nodes[k - 1].time;
    if (h > 0.0) {
      track.add(smooth_motion({nodes[k - 1].time}, h, nodes[k - 1].after, nodes[k].before));
    }
  }
  track.finish();
}

}  // namespace

bool is_run(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(fs::path(path) / "trajectory.csv", error) ||
         (fs::path(path).filename() == "trajectory.csv" && fs::is_regular_file(path, error));
}

ViewRun read_run(const std::string& path) {
  const Footage footage = read_footage(path);
  const fs::path folder = fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
  const TableRows trajectory((folder / "trajectory.csv").string());
  ViewRun run;
  run.title = footage.title;
  const std::string summary = read_text_file((folder / "summary.json").string());
  run.method = member(summary, "scheme") + " + " + member(summary, "integrator") + " + " +
               member(summary, "detector") + " + " + member(summary, "impact");
  run.reason = member(summary, "reason");
  run.note = "read from files: between frames and events interpolated, impulses not known";
  run.joints = footage.joints;
  for (std::size_t i = 0; i < footage.actors.size(); ++i) {
    run.bodies.push_back({footage.actors[i], mobility_of(footage, i)});
  }
  std::vector<std::vector<Node>> nodes(run.bodies.size());
  read_frames(footage, trajectory, run, nodes);
  read_events((folder / "events.csv").string(), run, nodes);
  read_energy((folder / "energy.csv").string(), run);
  run.tracks.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    make_track(nodes[i], run.tracks[i]);
  }
  return run;
}

}  // namespace kairos::experiments
