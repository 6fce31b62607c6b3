#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/linear_impact.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/vfee/linear_families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <numeric>
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
using Clock = std::chrono::steady_clock;

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

struct Cost {
  double mean = 0.0, median = 0.0, p99 = 0.0;  ///< ns, what the clock costs taken off
};

double nanoseconds(Clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

/// What it costs to read the clock twice.
double clock_cost() {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const auto start = Clock::now();
    least = std::min(least, nanoseconds(Clock::now() - start));
  }
  return least;
}

constexpr std::size_t chunk_size = 64;

/// The mean from chunks, of each the least of all rounds: short enough that some round is left
/// alone by others. Median and 99 % from each query by itself, the least of all rounds too.
template <typename Answer>
Cost cost_of(const std::vector<LinearQuery>& queries, std::vector<LinearImpact>& answers,
             int rounds, const Answer& answer) {
  Cost cost;
  const double clock = clock_cost();
  std::vector<double> each(queries.size(), std::numeric_limits<double>::infinity());
  std::vector<double> chunks((queries.size() + chunk_size - 1) / chunk_size,
                             std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const std::size_t last = std::min(queries.size(), (c + 1) * chunk_size);
      const auto start = Clock::now();
      for (std::size_t i = c * chunk_size; i < last; ++i) {
        answers[i] = answer(queries[i]);
      }
      chunks[c] = std::min(chunks[c], nanoseconds(Clock::now() - start) - clock);
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const auto begin = Clock::now();
      answers[i] = answer(queries[i]);
      each[i] = std::min(each[i], nanoseconds(Clock::now() - begin) - clock);
    }
  }
  cost.mean =
      std::accumulate(chunks.begin(), chunks.end(), 0.0) / static_cast<double>(queries.size());
  const auto quantile = [&each](double part) {
    const auto at =
        each.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(each.size() - 1));
    std::nth_element(each.begin(), at, each.end());
    return *at;
  };
  cost.median = quantile(0.5);
  cost.p99 = quantile(0.99);
  return cost;
}

void print_row(const std::string& name, const Cost& cost, const Cost& exact,
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
      const Cost exact = cost_of(few, answers, rounds, ccd::exact_impact);
      const Cost cost = cost_of(asked, answers, rounds, ccd::linear_impact);
      print_row(set.name + (kind == LinearKind::vertex_face ? ", vf" : ", ee"), cost, exact,
                answers);
    }
  }
}

}  // namespace kairos::experiments
