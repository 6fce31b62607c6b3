#include "experiments/vfee/vfee_stream.hpp"

#include "core/error.hpp"
#include "experiments/vfee/vfee_query.hpp"
#include "simulation/output/csv_row.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {
namespace {

using ccd::LinearImpact;
using ccd::LinearKind;

void write_answer(CsvRow& row, const LinearImpact& impact) {
  row.count(impact.hit ? 1 : 0).number(impact.t_lo).number(impact.t_hi);
  row.text(ccd::linear_stage_names[static_cast<std::size_t>(impact.stage)]);
}
void write_invalid(CsvRow& row) { row.field("").field("").field("").text("invalid"); }

class ColumnAnswerer : public RowAnswerer {
 public:
  explicit ColumnAnswerer(std::shared_ptr<const VfeeFormat> format) : format_(std::move(format)) {}

  std::string_view answer(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    const VfeeRow asked = format_->read(rows.front(), fields_);
    write_answer(row_.field(asked.id), ccd::linear_impact(asked.query));
    return row_.finish();
  }
  std::string_view invalid(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    write_invalid(row_.field(format_->id(rows.front(), fields_)));
    return row_.finish();
  }

 private:
  std::shared_ptr<const VfeeFormat> format_;
  std::vector<std::string_view> fields_;
  CsvRow row_;
};

struct SharedTally {
  std::atomic<std::int64_t> told = 0, false_negatives = 0, false_positives = 0;
};

class RationalAnswerer : public RowAnswerer {
 public:
  RationalAnswerer(LinearKind kind, SharedTally& tally) : kind_(kind), tally_(tally) {}

  std::string_view answer(std::span<const std::string_view> rows, std::int64_t line) override {
    const RationalQuery asked = read_rational_query(rows, kind_);
    const LinearImpact impact = ccd::linear_impact(asked.query);
    ++tally_.told;
    tally_.false_negatives += asked.meets && !impact.hit ? 1 : 0;
    tally_.false_positives += impact.hit && !asked.meets ? 1 : 0;
    write_answer(row_.count(line), impact);
    return row_.count(asked.meets ? 1 : 0).finish();
  }
  std::string_view invalid(std::span<const std::string_view> /*rows*/, std::int64_t line) override {
    write_invalid(row_.count(line));
    return row_.field("").finish();
  }

 private:
  LinearKind kind_;
  SharedTally& tally_;
  CsvRow row_;
};

LinearKind kind_of(const std::string& file, std::optional<LinearKind> asked) {
  const bool face = file.find("vertex-face") != std::string::npos;
  const bool edge = file.find("edge-edge") != std::string::npos;
  if (!asked && face == edge) {
    throw InputError(file, 0, "--kind",
                     "is needed: rows of rational numbers do not tell what meets; allowed: vf, ee");
  }
  return asked ? *asked : (face ? LinearKind::vertex_face : LinearKind::edge_edge);
}

}  // namespace

VfeeTally answer_vfee_queries(LineBlocks& queries, const RowStreamOptions& options,
                              std::optional<LinearKind> kind) {
  SharedTally shared;
  VfeeTally tally;
  tally.bad = answer_rows(queries, options, [&](std::string_view first, std::int64_t line) {
    RowFormat rows;
    rows.answer_header = "id,hit,t_lo,t_hi,stage\n";
    if (is_rational_row(first)) {
      rows.answer_header = "line,hit,t_lo,t_hi,stage,truth\n";
      rows.rows_per_query = RationalQuery::rows;
      rows.first_line_is_a_row = true;
      rows.make_answerer = [&shared, kind = kind_of(queries.name(), kind)] {
        return std::make_unique<RationalAnswerer>(kind, shared);
      };
    } else {
      const auto format = std::make_shared<const VfeeFormat>(first, line, queries.name());
      rows.make_answerer = [format] { return std::make_unique<ColumnAnswerer>(format); };
    }
    return rows;
  });
  tally.told = shared.told;
  tally.false_negatives = shared.false_negatives;
  tally.false_positives = shared.false_positives;
  return tally;
}

}  // namespace kairos::experiments
