#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// One of several that do comparable work.
struct Contender {
  std::string name;
  /// Does the work once and returns how many units (steps, impacts, queries) it did.
  std::function<std::int64_t()> work;
};

struct Timing {
  std::string name;
  double nanoseconds = 0.0;  ///< per unit, the least of all rounds
  std::int64_t units = 0;    ///< of one round
};

/// Times all contenders in turn, `rounds` times, in one process: what disturbs the machine disturbs
/// all of them. The least is kept: disturbances only ever add time.
[[nodiscard]] std::vector<Timing> race(const std::vector<Contender>& contenders, int rounds);

/// The table of a race on stdout, each beside its ratio to the first.
void print_race(const std::string& title, const std::string& unit,
                const std::vector<Timing>& timings);

/// Stepping: `original` beside a bare loop and ODE, `event-driven` by the impact.
void bench_stepping(int rounds);
/// Queries: overlap and time of impact of as many distinct pairs, beside FCL and Bullet, with what
/// each missed; then the ratios against their bars.
void bench_queries(std::size_t pairs, int rounds);
/// Vertex and face, edge and edge on straight lines: mean, median and the share of every stage.
void bench_vfee(std::size_t queries, int rounds);
/// A gas of so many balls each: impacts a second, queries an impact, memory a ball (scene and model
/// included; of the largest yet, so counts go up), under cells and, where it ends, a tree; ODE
/// beside them, where it was found; what reading, the model and a frame take of a ball.
/// `with_kinds`: also gases that fall, of several sizes, and denser ones. Then gases of so many
/// tumbling boxes.
void bench_gas(std::vector<std::size_t> counts, const std::vector<std::size_t>& boxes, int rounds,
               bool with_kinds);
/// Stacks of boxes and chains of links, beside Bullet, ODE and Box2D where they were found: time a
/// step, and how far off each ends.
void bench_contact(int rounds);
/// Meshes at rest: two tori in many placements, touching, distance, tolerance; a tree's time and
/// size.
void bench_meshes(int rounds);
/// What is asked of shapes, in one run: vertices and edges, hulls, cylinders, meshes at rest and in
/// motion, boxes, a crowd; beside FCL and Bullet where they were found. Then each goal, met or not.
void bench_shapes(std::size_t pairs, int rounds);
/// Rallies of `table-tennis` with a bat that collides as its box, its hull or its triangles: what
/// each hits, lets pass and costs. Prints a table.
void bench_bats(int rallies);

}  // namespace kairos::experiments
