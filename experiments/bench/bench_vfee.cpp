#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/linear_impact.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/query_cost.hpp"
#include "experiments/vfee/linear_families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

namespace kairos::experiments {
namespace {

using ccd::LinearImpact;
using ccd::LinearKind;
using ccd::LinearQuery;
using reference::LinearFamilies;
using reference::LinearFamily;

constexpr std::uint64_t seed = 20260122;
constexpr std::array kinds{LinearKind::vertex_face, LinearKind::edge_edge};

/// Queries of several families in turn: what one does not teach the branch predictor.
std::vector<LinearQuery> mixed(std::span<const LinearFamily> families, LinearKind kind,
                               std::size_t count) {
  std::vector<LinearFamilies> sources;
  for (const LinearFamily family : families) {
    sources.emplace_back(family, kind, seed);
  }
  std::vector<LinearQuery> queries;
  for (std::size_t i = 0; i < count; ++i) {
    queries.push_back(sources[i % sources.size()].next());
  }
  return queries;
}

void print_row(const std::string& name, const QueryCost& cost, const QueryCost& exact,
               const std::vector<LinearImpact>& answers) {
  std::array<double, 4> share{};
  double hits = 0.0;
  const double percent = 100.0 / static_cast<double>(answers.size());
  for (const LinearImpact& answer : answers) {
    share[static_cast<std::size_t>(answer.stage)] += percent;
    hits += answer.hit ? percent : 0.0;
  }
  fmt::print("  {:<28}{:>9.1f}{:>9.1f}{:>9.1f}{:>7.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>11.1f}\n",
             name, cost.mean, cost.median, cost.p99, hits, share[0], share[1], share[2], share[3],
             exact.mean);
}

}  // namespace

void bench_vfee(std::size_t queries, int rounds) {
  fmt::print(
      "Vertex and face, edge and edge on straight lines: {} distinct queries each, exact\n"
      "  {:<28}{:>27}{:>7}{:>36}{:>11}\n"
      "  {:<28}{:>9}{:>9}{:>9}{:>7}{:>9}{:>9}{:>9}{:>9}{:>11}\n",
      queries, "", "ns a query", "", "decided by, %", "integers", "", "mean", "median", "p99",
      "hit %", "boxes", "filter", "2-double", "integers", "only, ns");
  struct Set {
    std::string name;
    std::vector<LinearFamily> families;
  };
  using enum LinearFamily;
  const std::vector<LinearFamily> degenerate{grid,      tiny_grid,   flat,        on_a_line,
                                             at_rest,   one_moves,   translation, touch,
                                             touch_ulp, double_root, cluster,     triple_root};
  std::vector<LinearFamily> some;  // one in eight
  for (const LinearFamily family : degenerate) {
    some.insert(some.end(), 7, close);
    some.push_back(family);
  }
  const std::vector<Set> sets{{"close (after a broad phase)", {close}},
                              {"anywhere in a cube", {general}},
                              {"one in 8 is degenerate", some},
                              {"degenerate", degenerate}};
  for (const Set& set : sets) {
    for (const LinearKind kind : kinds) {
      const std::vector<LinearQuery> asked = mixed(set.families, kind, queries);
      std::vector<LinearImpact> answers(asked.size());
      const std::vector<LinearQuery> few(
          asked.begin(),
          asked.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(4096, queries)));
      const QueryCost exact = cost_of(
          few.size(), rounds, [&](std::size_t i) { answers[i] = ccd::exact_impact(few[i]); });
      const QueryCost cost = cost_of(
          asked.size(), rounds, [&](std::size_t i) { answers[i] = ccd::linear_impact(asked[i]); });
      print_row(set.name + (kind == LinearKind::vertex_face ? ", vf" : ", ee"), cost, exact,
                answers);
    }
  }
}

}  // namespace kairos::experiments
