#include "experiments/toi/toi_stream.hpp"

#include "experiments/toi/row_stream.hpp"
#include "experiments/toi/toi_query.hpp"
#include "simulation/output/csv_row.hpp"

#include <cmath>
#include <string_view>

namespace kairos::experiments {
namespace {

class Answerer : public RowAnswerer {
 public:
  Answerer(std::shared_ptr<const ToiQueryFormat> format, const ToiStreamOptions& options)
      : format_(std::move(format)), options_(options) {}

  std::string_view answer(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    const ToiQuery query = format_->read(rows.front(), scratch_);
    const TimeOfImpact toi = options_.detector->time_of_impact(
        {query.shape_a, query.motion_a}, {query.shape_b, query.motion_b},
        {Instant{}, query.duration}, options_.tolerance);
    if (!std::isfinite(toi.t_lo + toi.t_hi + toi.gap + toi.normal.sum())) {
      throw BadField{"", "the answer is beyond the range of a double"};
    }
    row_.field(query.id).text(to_string(toi.status)).number(toi.t_lo).number(toi.t_hi);
    return row_.number(toi.gap).vector(toi.normal).count(toi.evaluations).finish();
  }
  std::string_view invalid(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    row_.field(format_->id(rows.front(), scratch_)).text("invalid");
    for (int i = 0; i < 7; ++i) {
      row_.field("");
    }
    return row_.finish();
  }

 private:
  std::shared_ptr<const ToiQueryFormat> format_;
  const ToiStreamOptions& options_;
  ToiQueryFormat::Scratch scratch_;
  CsvRow row_;
};

}  // namespace

std::int64_t answer_toi_queries(LineBlocks& queries, const ToiStreamOptions& options) {
  return answer_rows(queries, {options.keep_going, options.threads},
                     [&](std::string_view header, std::int64_t line) {
                       const auto format =
                           std::make_shared<const ToiQueryFormat>(header, line, queries.name());
                       RowFormat rows;
                       rows.answer_header = "id,status,t_lo,t_hi,gap,nx,ny,nz,evaluations\n";
                       rows.make_answerer = [format, &options] {
                         return std::make_unique<Answerer>(format, options);
                       };
                       return rows;
                     });
}

}  // namespace kairos::experiments
