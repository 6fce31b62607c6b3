#include "core/mesh_body.hpp"
#include "core/solid_size.hpp"
#include "experiments/rally/rally_bats.hpp"
#include "experiments/rally/rally_run.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <algorithm>

namespace kairos::experiments::thesis {
namespace {

constexpr std::uint64_t first_seed = 1999;

struct Played {
  std::int64_t completed = 0;
  std::int64_t queries = 0;
  std::int64_t looks = 0;
  double volume = 0.0;  ///< of what the bat collides as, m^3
};

Played play(const RallyBat& bat, const Shape& mesh, int rallies, BatWatch& watch) {
  Played played;
  for (int r = 0; r < rallies; ++r) {
    const RallyRecording rally = make_rally({.seed = first_seed + static_cast<std::uint64_t>(r)});
    Scene scene = rally_scene(rally, {.name = "event-driven"});
    if (bat.mesh) {
      take_bat(scene, rally, mesh, bat.bounds);
    }
    const Model model(std::move(scene));
    const RunResult result = simulate(model, {}, watch);
    played.completed += result.status == RunStatus::completed ? 1 : 0;
    played.queries += result.cost.toi_queries;
    played.looks += result.cost.toi_evaluations;
    for (BodyIndex i = 0; i < model.size(); ++i) {
      if (model.body(i).name == "bat") {
        played.volume = solid_volume(model.shape(i));
      }
    }
  }
  return played;
}

/// Where the outlines cross the plane of the blade: seen from the front.
void add_outlines(FigureData& data, const CollisionMesh& mesh) {
  Table& edges = data.table("edges", {{"x0", "m", "an edge of the mesh"},
                                      {"y0", "m", "an edge of the mesh"},
                                      {"x1", "m", "its other end"},
                                      {"y1", "m", "its other end"}});
  for (const Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      const Vector3& from = mesh.vertices()[a];
      const Vector3& to = mesh.vertices()[b];
      if (a < b && from.z() < 0.0 && to.z() < 0.0) {  // those of one face
        edges.rows.push_back({from.x(), from.y(), to.x(), to.y()});
      }
    }
  }
}

void measure(FigureData& data) {
  const int rallies = data.size() == Size::quick ? 20 : 200;
  const Shape mesh = bat_mesh();
  const double solid = solid_volume(mesh);
  add_outlines(data, std::get<Mesh>(mesh).body->mesh);
  Table& bats =
      data.table("bats", {{"bat", "", "what the bat collides as"},
                          {"volume", "", "of that, relative to the solid inside the mesh"},
                          {"completed", "", "rallies that came to their end"},
                          {"hits", "", "impacts of bat and ball"},
                          {"early", "", "of them farther than 0.1 mm from the mesh"},
                          {"mean_gap", "m", "from the mesh at an impact, mean"},
                          {"most_gap", "m", "from the mesh at an impact, the most"},
                          {"inside", "", "frames with the ball in what the bat collides as"},
                          {"passed", "", "times that it went through the blade without an impact"},
                          {"queries", "", "times of impact that were asked for, a rally"},
                          {"looks", "", "instants that these looked at, a rally"}});
  for (const RallyBat& bat : rally_bats) {
    BatWatch watch(mesh);
    const Played played = play(bat, mesh, rallies, watch);
    const double mean =
        watch.sum_of_gaps / static_cast<double>(std::max<std::int64_t>(1, watch.hits));
    bats.rows.push_back({std::string(bat.name), played.volume / solid, played.completed, watch.hits,
                         watch.early, mean, watch.farthest, watch.inside, watch.passed,
                         static_cast<double>(played.queries) / rallies,
                         static_cast<double>(played.looks) / rallies});
    const std::string key = !bat.mesh                    ? "scene"
                            : bat.bounds == Bounds::obb  ? "obb"
                            : bat.bounds == Bounds::hull ? "hull"
                                                         : "mesh";
    data.value(key + "_volume", played.volume / solid, "", "of it, the mesh = 1", 3);
    data.count(key + "_hits", watch.hits, "impacts of bat and ball");
    data.count(key + "_early", watch.early, "of them farther than 0.1 mm from the mesh");
    data.value(key + "_most", 1e3 * watch.farthest, "mm", "farthest from the mesh at an impact", 3);
    data.count(key + "_passed", watch.passed, "times the ball went through the blade");
    data.count(key + "_looks", played.looks / rallies, "instants that were looked at, a rally");
  }
  data.count("rallies", rallies, "recordings, seeds from 1999 on");
  data.count("triangles",
             static_cast<std::int64_t>(std::get<Mesh>(mesh).body->mesh.triangles().size()),
             "of the bat");
}

}  // namespace

ThesisFigure bat_in_bounds() {
  return {
      .name = "3.2",
      .chapter = "3",
      .title = "3.2: the bat in its box, in its hull, as itself",
      .shows =
          "“Simplify the problem even further by bounding each object with only one "
          "bounding box ... to increase speed at the cost of some accuracy” (3.1); a volume that "
          "is larger than its object detects collisions “earlier than they should” (3.4). "
          "Argued by areas, not measured.",
      .how =
          "{rallies} recordings of rallies are played from event to event by one bat, an .off "
          "mesh of {triangles} triangles (a blade with a handle), that collides as its box "
          "(bounds = \"obb\"), its hull (\"hull\") or itself, and by the scene's own box. At each "
          "impact of the ball its proven distance from the mesh is asked for: how early "
          "it was hit.",
      .caption =
          "Left: the mesh from the front, and its box. Right: how far from the mesh the ball "
          "was when it was hit, and what a rally costs, by what the bat collides as.",
      .finding =
          "In its box, {obb_volume} times as large as the bat, the bat hits the ball "
          "{obb_hits} times, {obb_early} of them where there is no bat, up to {obb_most} away; "
          "in its hull ({hull_volume} times) {hull_early} of {hull_hits}, up to {hull_most}; "
          "as itself {mesh_early} of {mesh_hits}. No ball goes through ({obb_passed}, "
          "{hull_passed}, {mesh_passed}). A rally takes {obb_looks}, {hull_looks} and {mesh_looks} "
          "looks "
          "at an instant: accuracy costs that much.",
      .script = "thesis.sec32",
      .measure = measure};
}

}  // namespace kairos::experiments::thesis
