#include "core/error.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/vfee/vfee_stream.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

namespace kairos::experiments {
namespace {

struct VfeeCommand {
  std::string queries;
  std::string kind;
  RowStreamOptions options;

  void run() const;
};

void VfeeCommand::run() const {
  std::optional<ccd::LinearKind> asked;
  if (!kind.empty()) {
    asked = kind == "vf" ? ccd::LinearKind::vertex_face : ccd::LinearKind::edge_edge;
  }
  LineBlocks rows(queries);
  const VfeeTally tally = answer_vfee_queries(rows, options, asked);
  if (tally.told > 0) {
    std::fflush(stdout);
    fmt::print(stderr, "{}: {} queries, {} false negatives, {} false positives by its own truth\n",
               rows.name(), tally.told, tally.false_negatives, tally.false_positives);
  }
  if (tally.bad > 0) {
    throw InputError(
        rows.name(), 0, "",
        fmt::format("{} {} invalid", tally.bad, tally.bad == 1 ? "query is" : "queries are"));
  }
}

}  // namespace

void add_vfee_command(Command& app) {
  const auto command = std::make_shared<VfeeCommand>();
  Command vfee = app.add_subcommand(
      "vfee", "Exact times at which vertices meet faces, and edges edges, on straight lines");
  vfee.add_option("queries", command->queries, "CSV, one query per row; - reads stdin")
      .required()
      .type_name("QUERIES.csv");
  vfee.add_option("--kind", command->kind,
                  "vf or ee: of rows of rational numbers (default: as their folder is called, "
                  "vertex-face or edge-edge)")
      .one_of({"vf", "ee"})
      .type_name("K");
  vfee.add_option("--threads", command->options.threads, "how many (default: one per core)")
      .type_name("N")
      .check(whole_number(0, 1024));
  vfee.add_flag("--keep-going", command->options.keep_going,
                "name bad rows, answer them with the stage `invalid`, and go on; the exit status "
                "is still 2");
  vfee.footer(
      "Columns: id; kind, vf or ee; points 0 to 3 at the start, s0x,s0y,s0z to s3x,s3y,s3z, and "
      "at\n"
      "the end, e0x to e3z, any unit; optional separation: they meet where their distance is at\n"
      "most that. vf: point 0 is the vertex, 1 to 3 the face. ee: the edges are 0 to 1 and 2 to "
      "3.\n"
      "Every point moves on a straight line from its start (t = 0) to its end (t = 1).\n"
      "Answer: id,hit,t_lo,t_hi,stage in the same order. hit is 0 or 1, without error. The first\n"
      "time is t_lo where t_lo = t_hi, otherwise strictly between these adjacent doubles; stage "
      "is\n"
      "what it took: boxes, filter, double-double, integers.\n"
      "Or eight rows a query (point 0 to 3 at the start, 0 to 3 at the end) of seven whole "
      "numbers:\n"
      "x, y, z as numerator,denominator, and 0 or 1: whether they meet. Answered with the line of\n"
      "the first row for an id and the truth of the file in a last column; misses are counted.");
  vfee.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
