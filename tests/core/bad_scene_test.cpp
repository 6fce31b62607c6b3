// Every way of writing a scene wrong that we could think of: refused with the line, the key, what
// is wrong and what is allowed.

#include "core/error.hpp"
#include "core/reading/document.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "tests/catch.hpp"
#include "tests/core/refused.hpp"
#include "tests/locations.hpp"
#include "tests/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

using namespace kairos;

namespace {

using tests::BadScene;

/// Lines 1 to 3 of a scene that has only a floor.
const std::string floor_lines =
    "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n";
/// Lines 1 to 5 of a ball to which a sixth is added.
const std::string ball_lines =
    "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.5\nmass = 1.0\n";
const std::string body_lines =
    "[[body]]\nname = \"box\"\nentity = \"body\"\nhalf_extents = [1, 1, 1]\nmass = 1.0\n";
const std::string wall_lines =
    "[[body]]\nname = \"wall\"\nentity = \"wall\"\nhalf_extents = [1, 1, 1]\n";
const std::string bat_lines =
    "[[body]]\nname = \"bat\"\nentity = \"bat\"\nhalf_extents = [1, 1, 1]\nmass = 1.0\n";

void check_refused(const BadScene& bad) {
  tests::check_refused(
      bad, [](const std::string& text, const char* file) { (void)parse_scene(text, file); });
}

const std::vector<BadScene> top_level = {
    {"", 0, "body", "missing"},
    {"body = []", 1, "body", "at least one"},
    {"body = 3", 1, "body", "a whole number"},
    {"body = [3]", 1, "body[0]", "a table"},
    {"[body]\nname = \"x\"", 1, "body", "a table; allowed: an array"},
    {"durations = 1", 1, "durations", "did you mean \"duration\""},
    {"xyzzy = 1", 1, "xyzzy", "unknown key; allowed"},
    {"duration = \"long\"", 1, "duration", "no duration"},
    {"duration = 0", 1, "duration", "> 0"},
    {"duration = -1.0", 1, "duration", "is -1"},
    {"duration = nan", 1, "duration", "is nan"},
    {"duration = inf", 1, "duration", "is inf"},
    {"duration = 1e13", 1, "duration", "<= 1"},
    {"duration = true", 1, "duration", "a truth value"},
    {"duration = 2020-01-01", 1, "duration", "a date"},
    {"name = 3", 1, "name", "a string"},
    {"summary = []", 1, "summary", "a string"},
    {"frame = 0", 1, "frame", "> 0"},
    {"frame = -0.1", 1, "frame", "> 0"},
    {"frame = \"1/0\"", 1, "frame", "no duration"},
    {"frame = \"-1/60\"", 1, "frame", "no duration"},
    {"frame = \"-1/-60\"", 1, "frame", "no duration"},
    {"frame = \"16 parsecs\"", 1, "frame", "no duration"},
    {"frame = \"\"", 1, "frame", "no duration"},
    {"frame = \"1e400\"", 1, "frame", "no duration"},
    {"frame = [1]", 1, "frame", "an array"},
    {"frame = {}", 1, "frame.mean", "missing"},
    {"frame = {mean = 0.1, jitter = 1}", 1, "frame.jitter", "0 to 0.999"},
    {"frame = {mean = 0.1, jitters = 0}", 1, "frame.jitters", "did you mean \"jitter\""},
    {"frame = {mean = 0.1, spike_probability = 1.5}", 1, "frame.spike_probability", "0 to 1"},
    {"frame = {mean = 0.1, spike_factor = 0.5}", 1, "frame.spike_factor", "from 1"},
    {"frame = {mean = 0.1, seed = 1.5}", 1, "frame.seed", "whole number"},
    {"frame = {mean = 0.1, seed = -1}", 1, "frame.seed", "is -1"},
    {"frame = {csv = \"x.csv\", mean = 0.1}", 1, "frame.mean", "csv is given too"},
    {"frame = {csv = \"nowhere.csv\"}", 1, "frame.csv", "'nowhere.csv'; allowed: the path of"},
    {"gravity = \"down\"", 1, "gravity", "acceleration, force"},
    {"gravity = 9.8", 1, "gravity",
     "a number; it says how gravity acts, allowed: acceleration, force"},
    {"G = -9.8", 1, "G", "0 to"},
    {"bounds = \"box\"", 1, "bounds", "shape, obb"},
    {"friction = -1", 1, "friction", "is -1; allowed: a number from 0"},
    {"friction = nan", 1, "friction", "is nan"},
    {"friction_combine = \"mean\"", 1, "friction_combine", "product, geometric-mean, minimum"},
    {"restitution_combine = 1", 1, "restitution_combine", "product, geometric-mean, minimum"},
    {floor_lines + "[exact]\n", 5, "exact.solution", "missing"},
    {floor_lines + "[exact]\nsolution = \"elastic-drops\"", 6, "exact.solution",
     "did you mean \"elastic-drop\""},
    {floor_lines + "[exact]\nH = 1", 6, "exact.H", "unknown key"},
};

/// Lines 1 to 14: a floor, a ball and a box; a force begins at line 15.
const std::string three_bodies = floor_lines + ball_lines + body_lines;
const std::string drag_lines = three_bodies + "[[force]]\nkind = \"quadratic-drag\"\n";
const std::string linear_lines = three_bodies + "[[force]]\nkind = \"linear-drag\"\n";
const std::string spring_lines =
    three_bodies + "[[force]]\nname = \"tether\"\nkind = \"spring\"\nstiffness = 2\n";

const std::vector<BadScene> forces = {
    {three_bodies + "force = 1", 15, "body.box.force", "unknown key"},
    {"force = 1\n" + three_bodies, 1, "force", "a whole number; allowed: an array"},
    {three_bodies + "[force]\nkind = \"spring\"", 15, "force", "allowed: an array"},
    {three_bodies + "[[force]]", 15, "force[0].kind", "missing"},
    {three_bodies + "[[force]]\nkind = \"drag\"", 16, "force[0].kind", "quadratic-drag"},
    {three_bodies + "[[force]]\nkind = \"sprng\"", 16, "force[0].kind", "did you mean \"spring\""},
    {three_bodies + "[[force]]\nkind = 1", 16, "force[0].kind", "a whole number"},
    {drag_lines + "name = \"\"", 17, "force[0].name", "no name"},
    {drag_lines + "name = \"air\"\n[[force]]\nkind = \"quadratic-drag\"\nname = \"air\"", 20,
     "force.air.name", "line 15"},
    {drag_lines + "densty = 1", 17, "force[0].densty", "did you mean \"density\""},
    {drag_lines + "stiffness = 1", 17, "force[0].stiffness", "unknown key"},
    {drag_lines + "density = -1", 17, "force[0].density", "is -1; allowed: a number from 0"},
    {drag_lines + "density = nan", 17, "force[0].density", "is nan"},
    {drag_lines + "density = inf", 17, "force[0].density", "is inf"},
    {drag_lines + "density = \"thick\"", 17, "force[0].density", "a string"},
    {drag_lines + "drag_coefficient = -0.1", 17, "force[0].drag_coefficient", "is -0.1"},
    {drag_lines + "area = -1e-9", 17, "force[0].area", "is -1e-09"},
    {drag_lines + "wind = [1, 2]", 17, "force[0].wind", "an array of 2"},
    {drag_lines + "wind = [1, nan, 2]", 17, "force[0].wind[1]", "is nan"},
    {drag_lines + "bodies = \"ball\"", 17, "force[0].bodies", "a string; allowed: an array"},
    {drag_lines + "bodies = []", 17, "force[0].bodies", "ball, box"},
    {drag_lines + "bodies = [\"bal\"]", 17, "force[0].bodies[0]", "did you mean \"ball\""},
    {drag_lines + "bodies = [\"ball\", \"moon\"]", 17, "force[0].bodies[1]", "does not exist"},
    {drag_lines + "bodies = [\"ball\", \"ball\"]", 17, "force[0].bodies[1]", "named twice"},
    {drag_lines + "bodies = [1]", 17, "force[0].bodies[0]", "a whole number"},
    {drag_lines + "bodies = [\"floor\"]", 17, "force[0].bodies", "not moved by forces"},
    {floor_lines + "[[force]]\nkind = \"quadratic-drag\"", 5, "force[0]", "acts on nothing"},
    {linear_lines, 15, "force[0].coefficient", "missing"},
    {linear_lines + "coefficient = -1", 17, "force[0].coefficient", "is -1"},
    {linear_lines + "coefficient = 1\nrotational = -1", 18, "force[0].rotational", "is -1"},
    {linear_lines + "coefficient = 1\nrotational = 1\nbodies = [\"ball\"]", 19, "force[0].bodies",
     "does not turn"},
    {three_bodies + "[[force]]\nkind = \"magnus-lift\"\nbodies = [\"ball\"]", 17, "force[0].bodies",
     "allowed: the entity \"body\""},
    {three_bodies + "[[force]]\nkind = \"magnus-lift\"\nbodies = [\"box\"]", 15, "force[0].radius",
     "missing"},
    {three_bodies + "[[force]]\nkind = \"buoyancy\"\nvolume = -1", 17, "force[0].volume", "is -1"},
    {three_bodies + "[[force]]\nkind = \"buoyancy\"\ncentre = [0, inf, 0]", 17,
     "force[0].centre[1]", "is inf"},
    {"gravity = \"force\"\n" + three_bodies + "[[force]]\nkind = \"buoyancy\"", 16, "force[0].G",
     "missing"},
    {spring_lines, 15, "force.tether.bodies", "missing"},
    {spring_lines + "bodies = [\"ball\"]", 15, "force.tether.anchor", "missing"},
    {spring_lines + "bodies = [\"floor\"]", 19, "force.tether.bodies", "not moved by forces"},
    {spring_lines + "bodies = [\"floor\", \"ball\"]", 19, "force.tether.bodies", "first"},
    {spring_lines + "bodies = [\"ball\", \"box\", \"floor\"]", 19, "force.tether.bodies",
     "3 bodies; allowed: 1 or 2"},
    {spring_lines + "bodies = [\"ball\", \"box\"]\nanchor = [0, 0, 0]", 20, "force.tether.anchor",
     "two bodies"},
    {spring_lines + "bodies = [\"ball\"]\nanchor = [0, 0, 0]\npoint_b = [0, 0, 0]", 21,
     "force.tether.point_b", "one body"},
    {spring_lines + "bodies = [\"ball\"]\nanchor = [0, nan, 0]", 20, "force.tether.anchor[1]",
     "is nan"},
    {spring_lines + "bodies = [\"ball\", \"box\"]\npoint_a = [1, 0, 0]", 19, "force.tether.bodies",
     "does not turn"},
    {spring_lines + "bodies = [\"ball\"]\nanchor = [0, 0, 0]\ndamping = -1", 21,
     "force.tether.damping", "is -1"},
    {spring_lines + "bodies = [\"ball\"]\nanchor = [0, 0, 0]\nrest_length = -1", 21,
     "force.tether.rest_length", "is -1"},
    {three_bodies + "[[force]]\nkind = \"spring\"\nbodies = [\"box\"]\nanchor = [0, 0, 0]", 15,
     "force[0].stiffness", "missing"},
    {three_bodies + "[[force]]\nkind = \"damper\"\nbodies = [\"box\"]\nstiffness = 1", 18,
     "force[0].stiffness", "unknown key"},
};

const std::vector<BadScene> not_toml = {
    {"duration 3", 1, "", "not TOML"},
    {"duration = 1\nduration = 2", 2, "", "not TOML"},
    {"name = \"never closed", 1, "", "not TOML"},
    {"[[body", 1, "", "not TOML"},
    {"G = 99999999999999999999", 1, "", "not TOML"},
};

const std::vector<BadScene> bodies = {
    {"[[body]]\nentity = \"ball\"", 1, "body[0].name", "missing"},
    {"[[body]]\nname = \"\"", 2, "body[0].name", "no name"},
    {"[[body]]\nname = \"a,b\"", 2, "body[0].name", "no name"},
    {"[[body]]\nname = 7", 2, "body[0].name", "a string"},
    {"[[body]]\nname = \"x\"", 1, "body.x.entity", "missing"},
    {"[[body]]\nname = \"x\"\nentity = \"bal\"", 3, "body.x.entity", "did you mean \"ball\""},
    {floor_lines + floor_lines, 6, "body.floor.name", "line 1"},
    {ball_lines + "mas = 1", 6, "body.ball.mas", "did you mean \"mass\""},
    {ball_lines + "belt_mass = 1", 6, "body.ball.belt_mass", "unknown key"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nmass = 1", 1, "body.x.shape", "missing"},
    {ball_lines + "half_extents = [1, 1, 1]", 1, "body.ball.shape", "both"},
    {ball_lines + "shape = \"box\"", 4, "body.ball.radius", "no radius"},
    {ball_lines + "shape = \"cube\"", 6, "body.ball.shape", "sphere, box, half-space"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nshape = \"sphere\"", 1, "body.x.radius",
     "missing"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nshape = \"half-space\"\nhalf_extents = [1, 1, 1]",
     5, "body.x.half_extents", "no half_extents"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nradius = 0", 4, "body.x.radius", "is 0"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nradius = -1", 4, "body.x.radius", "is -1"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nradius = nan", 4, "body.x.radius", "is nan"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nradius = 1e300", 4, "body.x.radius", "is 1e+300"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nradius = \"1\"", 4, "body.x.radius", "a string"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nhalf_extents = [1, 1]", 4, "body.x.half_extents",
     "an array of 2"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nhalf_extents = [1, -1, 1]", 4,
     "body.x.half_extents[1]", "is -1"},
    {"[[body]]\nname = \"x\"\nentity = \"wall\"\nhalf_extents = 1", 4, "body.x.half_extents",
     "a whole number"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nradius = 1", 1, "body.x.mass", "missing"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nradius = 1\nmass = 0", 5, "body.x.mass", "is 0"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nradius = 1\nmass = -1", 5, "body.x.mass", "is -1"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nradius = 1\nmass = 1e31", 5, "body.x.mass",
     "1e+31"},
    {"[[body]]\nname = \"x\"\nentity = \"ball\"\nmass = 1\nshape = \"half-space\"", 5,
     "body.x.shape", "cannot move freely"},
    {wall_lines + "mass = 1", 5, "body.wall.mass", "infinite mass"},
    {wall_lines + "velocity = [1, 0, 0]", 5, "body.wall.velocity", "drive"},
    {wall_lines + "angular_velocity = [1, 0, 0]", 5, "body.wall.angular_velocity", "drive"},
    {wall_lines + "inertia = [1, 1, 1]", 5, "body.wall.inertia", "nothing turns"},
    {wall_lines + "normal = [0, 0, 0]", 5, "body.wall.normal", "length 0"},
    {ball_lines + "normal = [0, 1, 0]", 6, "body.ball.normal", "no reflecting face"},
    {floor_lines + "normal = [0, 1, 0]\norientation = [1, 0, 0, 0]", 5, "body.floor.normal",
     "orientation is given too"},
    {floor_lines + "bounds = \"obb\"", 5, "body.floor.bounds", "no box around it"},
    {ball_lines + "position = [0, inf, 0]", 6, "body.ball.position[1]", "is inf"},
    {ball_lines + "position = [0, \"up\", 0]", 6, "body.ball.position[1]", "a string"},
    {ball_lines + "velocity = [0, 1e13, 0]", 6, "body.ball.velocity[1]", "to 1e+12"},
    {ball_lines + "angular_velocity = [0, 1, 0]", 6, "body.ball.angular_velocity", "does not turn"},
    {ball_lines + "orientation = [0, 0, 0, 0]", 6, "body.ball.orientation", "norm 0"},
    {ball_lines + "orientation = [1, 0, 0, 0.01]", 6, "body.ball.orientation", "unit quaternion"},
    {ball_lines + "orientation = [1e300, 0, 0, 0]", 6, "body.ball.orientation[0]", "1e+300"},
    {ball_lines + "orientation = [1, 0, 0]", 6, "body.ball.orientation", "an array of 3"},
    {ball_lines + "axis_angle = [0, 0, 0, 1]", 6, "body.ball.axis_angle", "length 0"},
    {ball_lines + "orientation = [1, 0, 0, 0]\naxis_angle = [1, 0, 0, 1]", 7,
     "body.ball.axis_angle", "one of"},
    {ball_lines + "restitution = 1.1", 6, "body.ball.restitution", "0 to 1"},
    {ball_lines + "restitution = -0.1", 6, "body.ball.restitution", "0 to 1"},
    {ball_lines + "friction = -0.1", 6, "body.ball.friction", "is -0.1; allowed: a number from 0"},
    {ball_lines + "friction = nan", 6, "body.ball.friction", "inf (rough)"},
    {ball_lines + "friction = -inf", 6, "body.ball.friction", "inf (rough)"},
    {ball_lines + "friction = 1e7", 6, "body.ball.friction", "1e+06"},
    {ball_lines + "friction = \"rough\"", 6, "body.ball.friction", "inf (rough)"},
    {ball_lines + "friction = true", 6, "body.ball.friction", "inf (rough)"},
    {ball_lines + "collision_type = \"oval\"", 6, "body.ball.collision_type", "square, round"},
    {ball_lines + "scale = 0", 6, "body.ball.scale", "> 0"},
    {ball_lines + "drive = {frequency = 1}", 6, "body.ball.drive", "moves freely"},
    {body_lines + "inertia = [1, 1, 3]", 6, "body.box.inertia", "exceeds the sum"},
    {body_lines + "inertia = [0, 1, 1]", 6, "body.box.inertia[0]", "> 0"},
    {bat_lines, 1, "body.bat.drive", "missing"},
    {bat_lines + "nudge = -1\ndrive = {frequency = 1}", 6, "body.bat.nudge", "is -1"},
};

const std::vector<BadScene> drives = {
    {bat_lines + "drive = 3", 6, "body.bat.drive", "a table"},
    {bat_lines + "drive = {}", 6, "body.bat.drive", "track"},
    {bat_lines + "drive = {smooth = true}", 6, "body.bat.drive", "track"},
    {bat_lines + "drive = {track = \"nowhere.csv\"}", 6, "body.bat.drive.track", "names no file"},
    {bat_lines + "drive = {track = \".\"}", 6, "body.bat.drive.track", "names no file"},
    {bat_lines + "drive = {track = \"a\\u0000.csv\"}", 6, "body.bat.drive.track", "names no file"},
    {floor_lines + "[[body]]\nname = \"m\"\nentity = \"wall\"\nshape = \"mesh\"\nfile = \"no.off\"",
     9, "body.m.file", "names no file"},
    {bat_lines + "drive = {frequency = 0, amplitude = [1, 0, 0]}", 6, "body.bat.drive.frequency",
     "> 0"},
    {bat_lines + "drive = {frequency = 1}", 6, "body.bat.drive.amplitude", "missing"},
    {bat_lines + "drive = {amplitude = [1, 0, 0]}", 6, "body.bat.drive.frequency", "missing"},
    {bat_lines + "drive = {frequency = 1, track = \"a.csv\"}", 6, "body.bat.drive.track",
     "sinusoid"},
    {bat_lines + "drive = {frequency = 1, amplitude = [1, 0, 0], phase = inf}", 6,
     "body.bat.drive.phase", "is inf"},
    {bat_lines + "drive = {frequency = 1, rotation_amplitude = 1}", 6, "body.bat.drive.amplitude",
     "missing"},
    {bat_lines + "drive = {frequency = 1, amplitude = [1, 0, 0], rotation_amplitude = 1}", 6,
     "body.bat.drive.rotation_amplitude", "rotation_axis"},
    {bat_lines + "drive = {frequency = 1, rotation_axis = [0, 0, 0], rotation_amplitude = 1}", 6,
     "body.bat.drive.rotation_axis", "length 0"},
    {bat_lines + "drive = {frequency = 1, rotation_axis = [0, 0, 1], rotation_amplitude = 4}", 6,
     "body.bat.drive.rotation_amplitude", "3.2"},
    {floor_lines + "drive = {frequency = 1, rotation_axis = [0, 0, 1], rotation_amplitude = 1}", 5,
     "body.floor.drive.rotation_axis", "half-space cannot turn"},
};

}  // namespace

TEST_CASE("bad scenes: the top level", "[scene][input]") {
  for (const BadScene& bad : top_level) {
    check_refused(bad);
  }
}

TEST_CASE("bad scenes: what is no TOML", "[scene][input]") {
  for (const BadScene& bad : not_toml) {
    check_refused(bad);
  }
}

TEST_CASE("bad scenes: bodies", "[scene][input]") {
  for (const BadScene& bad : bodies) {
    check_refused(bad);
  }
}

TEST_CASE("bad scenes: forces", "[scene][input]") {
  for (const BadScene& bad : forces) {
    check_refused(bad);
  }
}

TEST_CASE("bad scenes: drives", "[scene][input]") {
  for (const BadScene& bad : drives) {
    check_refused(bad);
  }
}

TEST_CASE("bad scenes: every prefix of a scene is read or refused, never more", "[scene][input]") {
  const std::string path = tests::source_path("scenes/bat.toml");
  const std::string text = read_text_file(path);
  std::size_t refused = 0;
  for (std::size_t n = 0; n < text.size(); ++n) {
    try {
      (void)parse_scene(text.substr(0, n), path);
    } catch (const InputError&) {
      ++refused;
    }
  }
  CHECK(refused > text.size() / 2);
}

TEST_CASE("bad scenes: files that cannot be read", "[scene][input]") {
  CHECK_THROWS_AS(read_scene("/no/such/scene.toml"), InputError);
  CHECK_THROWS_AS(read_scene(std::filesystem::temp_directory_path().string()), InputError);
}

TEST_CASE("overrides: what they cannot set is named", "[scene][input]") {
  struct BadOverride {
    Override change;
    std::string part;
  };
  const std::vector<BadOverride> cases = {
      {{"body.bal.radius", "1"}, "did you mean \"ball\""},
      {{"body[7].radius", "1"}, "no element [7]"},
      {{"body[x].radius", "1"}, "no index"},
      {{"body.ball.position[3]", "1"}, "no element"},
      {{"body.ball.position[0", "1"}, "without a ]"},
      {{"body.ball.radius.x", "1"}, "holds no keys"},
      {{"frame.jitter", "0.1"}, "to set a value in"},
      {{"", "1"}, "no path"},
      {{"a..b", "1"}, "no path"},
      {{"body.ball.radios", "1"}, "did you mean \"radius\""},
      {{"body.ball.radius", "-1"}, "is -1"},
      {{"body.ball.radius", "1\nG = 2"}, "a string"},
      {{"duration", "nan"}, "is nan"},
      {{"body", "3"}, "a whole number"},
  };
  for (const BadOverride& bad : cases) {
    INFO(bad.change.key << " = " << bad.change.value);
    try {
      (void)parse_scene(ball_lines + "position = [0, 1, 0]\n", "scene.toml", {bad.change});
      FAIL("was not refused");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(error.reason().find(bad.part) != std::string::npos);
    }
  }
}

TEST_CASE("bad tracks and frame times are named by file and line", "[scene][input]") {
  struct BadFile {
    std::string text;
    int line;
    std::string key;
  };
  const tests::TemporaryFolder folder;
  const std::string path = folder.path("track.csv");
  const auto check = [&](const std::string& scene, const BadFile& bad) {
    folder.file("track.csv", bad.text);
    INFO(bad.text);
    try {
      (void)parse_scene(scene, folder.path("scene.toml"));
      FAIL("was not refused");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(error.file() == path);
      CHECK(error.line() == bad.line);
      CHECK(error.key() == bad.key);
    }
  };
  const std::string header = "t,x,y,z,qw,qx,qy,qz\n";
  const std::vector<BadFile> tracks = {
      {"", 0, ""},
      {header, 0, ""},
      {"t,x,y\n0,0,0\n", 1, "z"},
      {"t,x,y,z,qw\n0,0,0,0,1\n", 1, "qx"},
      {"t,x,y,z,x\n0,0,0,0,0\n", 1, "x"},
      {header + "0,0,0,0,1,0,0,0\n1,0,0,0,1,0,", 3, ""},
      {header + "0,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n", 3, "t"},
      {header + "1,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n", 3, "t"},
      {header + "# a comment\n0,0,nan,0,1,0,0,0\n", 3, "y"},
      {header + "0,0,0,up,1,0,0,0\n", 2, "z"},
      {header + "0,0,0,1e13,1,0,0,0\n", 2, "z"},
      {header + "0,0,0,0,1,1,0,0\n", 2, "qw,qx,qy,qz"},
      {header + "0,0,0,0,0,0,0,0\n", 2, "qw,qx,qy,qz"},
      {"t,x,y,z,gesture\n0,0,0,0,2\n", 2, "gesture"},
      {"t,x,y,z,gesture\n0,0,0,0,1\n1,0,0,0,fist\n", 3, "gesture"},
  };
  for (const BadFile& bad : tracks) {
    check(bat_lines + "drive = {track = \"track.csv\"}", bad);
  }
  const std::vector<BadFile> frames = {
      {"", 0, ""},
      {"duration\n", 0, ""},
      {"0.1\n0\n", 2, "duration"},
      {"0.1\n-1\n", 2, "duration"},
      {"0.1\nx\n", 2, "duration"},
      {"time\n0.1\n", 1, "duration"},
      {"0.1\n1e400\n", 2, "duration"},
  };
  for (const BadFile& bad : frames) {
    check("frame = {csv = \"track.csv\"}\n" + floor_lines, bad);
  }
}
