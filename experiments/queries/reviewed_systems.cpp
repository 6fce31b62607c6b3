#include "experiments/queries/reviewed_systems.hpp"

#include <string>

namespace kairos::experiments {

Table reviewed_systems() {
  using std::string;
  Table table{{"system", "question", "its algorithm", "here", "algorithm here", "guaranteed"}, {}};
  const auto row = [&table](const char* system, const char* question, const char* its,
                            const char* here, const char* ours, const char* guaranteed) {
    table.rows.push_back({string(system), string(question), string(its), string(here), string(ours),
                          string(guaranteed)});
  };
  row("RAPID [Gottschalk1996]", "which triangles of two meshes touch?",
      "tree of oriented boxes, 15 axes, floats; 1e-6 added to parallel edges",
      "kairos collide, ccd::MeshQueries::collide", "the same tree; boxes rounded outwards",
      "exact: whole numbers decide what doubles cannot");
  row("PQP [Larsen2000]", "how far are two meshes apart? within a tolerance?",
      "tree of swept spheres, best first", "kairos distance, ccd::MeshQueries::distance, within",
      "oriented boxes, best first", "proven bounds, apart by 1e-12 of the distance");
  row("I-COLLIDE [Cohen1995]", "which of many convex polyhedra touch, frame by frame?",
      "sweep and prune; nearest features followed (Lin-Canny)", "ccd::CollisionWorld",
      "sweep and prune; the separating direction of the last frame asked first",
      "any direction is safe: what is told apart is apart");
  row("V-COLLIDE [Hudson1997]", "which of many meshes touch, frame by frame?",
      "sweep and prune, then RAPID", "ccd::CollisionWorld with meshes",
      "sweep and prune, then the tree of boxes", "as of two meshes");
  row("SOLID [Bergen1999]", "which of many shapes touch, and what is to happen then?",
      "sweep and prune; GJK with the last direction kept; responses by object, pair, default",
      "ccd::CollisionWorld::respond", "the same, with filters by group and mask",
      "distance and depth between proven bounds");
  row("SOLID [Bergen1999]", "which faces of deforming meshes touch?",
      "boxes of a tree refit at every step, looked at at its end",
      "kairos deform, ccd::DeformingPair", "boxes at both ends of a step, refit; front kept",
      "all that meets between the ends, exactly, each once");
  row("AERO [Keller1993]", "how do bodies with springs, rods and contacts move?",
      "all pairs looked at every t_col for overlap; impulses, or a stiff spring",
      "kairos run, scene aero; --scheme penalty", "from event to event; joints by multipliers",
      "no contact missed; energy booked line by line");
  row("Isaac [Cremer1997]", "how do jointed bodies move while constraints come and go?",
      "a server whose core changes its equations with the constraints",
      "kairos run: event-driven, in process", "modes of contact between events; joints",
      "complementarity holds in each mode, or the run stops and says why");
  row("Tight-Inclusion [Wang2021]", "when do a vertex and a face on straight lines meet?",
      "intervals, cut until small; conservative", "kairos vfee, ccd::vertex_face, edge_edge",
      "Bernstein coefficients with bounds, double-doubles, whole numbers",
      "exact yes or no; the time to two adjacent doubles");
  row("C2A [Tang2009]", "when do two moving meshes meet?",
      "conservative advancement over a tree of swept spheres", "kairos toi, certified on meshes",
      "chords over a tree of boxes, a queue by proven times",
      "never late; a bracket of a nanometre, or undecided and why");
  return table;
}

}  // namespace kairos::experiments
