#include "experiments/meshes/mesh_stream.hpp"

#include "simulation/output/csv_row.hpp"

#include <array>
#include <memory>
#include <string>
#include <utility>

namespace kairos::experiments {
namespace {

using ccd::MeshVerdict;

constexpr std::array verdict_names{"apart", "touching", "a inside", "b inside"};
constexpr std::array within_names{"yes", "no", "undecided"};

const char* name_of(MeshVerdict verdict) {
  return verdict_names[static_cast<std::size_t>(verdict)];
}

/// One kind of question: its answers are lines, gathered in a text.
class Question {
 public:
  Question(std::string header_line, std::size_t field_count)
      : header(std::move(header_line)), fields(field_count) {}
  virtual ~Question() = default;
  virtual void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
                      ccd::MeshQueries& queries, std::string& lines) const = 0;

  const std::string header;
  const std::size_t fields;  ///< of an answer, id and what it is included
};

/// Empty fields up to the end of a line of so many.
std::string_view finish(CsvRow& row, std::size_t missing) {
  for (std::size_t i = 0; i < missing; ++i) {
    row.field("");
  }
  return row.finish();
}

struct FirstContact : Question {
  FirstContact() : Question("id,verdict,a_triangle,b_triangle\n", 4) {}
  void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
              ccd::MeshQueries& queries, std::string& lines) const override {
    const ccd::MeshContact contact = queries.collide(a, b);
    CsvRow row;
    row.field(id).text(name_of(contact.verdict));
    if (contact.verdict == MeshVerdict::touching) {
      row.count(contact.pair.a).count(contact.pair.b);
    }
    lines += finish(row, contact.verdict == MeshVerdict::touching ? 0 : 2);
  }
};

struct AllContacts : Question {
  AllContacts() : Question("id,verdict,a_triangle,b_triangle\n", 4) {}
  void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
              ccd::MeshQueries& queries, std::string& lines) const override {
    CsvRow row;
    const auto& pairs = queries.touching_pairs(a, b);
    for (const ccd::TrianglePair& pair : pairs) {
      lines += row.field(id).text("touching").count(pair.a).count(pair.b).finish();
    }
    if (pairs.empty()) {
      row.field(id).text(name_of(queries.collide(a, b).verdict));
      lines += finish(row, 2);
    }
  }
};

void write_distance(CsvRow& row, const ccd::MeshDistance& d, std::string& lines) {
  row.number(d.lower).number(d.upper);
  if (d.verdict == MeshVerdict::a_inside || d.verdict == MeshVerdict::b_inside) {
    lines += finish(row, 8);  // no points of the surfaces are at that distance
  } else {
    lines += row.vector(d.on_a).vector(d.on_b).count(d.pair.a).count(d.pair.b).finish();
  }
}

struct Distance : Question {
  Distance() : Question("id,verdict,lower,upper,ax,ay,az,bx,by,bz,a_triangle,b_triangle\n", 12) {}
  void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
              ccd::MeshQueries& queries, std::string& lines) const override {
    const ccd::MeshDistance d = queries.distance(a, b);
    CsvRow row;
    write_distance(row.field(id).text(name_of(d.verdict)), d, lines);
  }
};

struct Within : Question {
  explicit Within(double metres) : Question("id,within,lower,upper\n", 4), tolerance(metres) {}
  void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
              ccd::MeshQueries& queries, std::string& lines) const override {
    const ccd::MeshWithin answer = queries.within(a, b, tolerance);
    CsvRow row;
    row.field(id).text(within_names[static_cast<std::size_t>(answer.verdict)]);
    lines += row.number(answer.distance.lower).number(answer.distance.upper).finish();
  }
  double tolerance;
};

struct AllWithin : Question {
  explicit AllWithin(double metres)
      : Question("id,within,a_triangle,b_triangle,lower,upper\n", 6), tolerance(metres) {}
  void answer(std::string_view id, const PosedMesh& a, const PosedMesh& b,
              ccd::MeshQueries& queries, std::string& lines) const override {
    CsvRow row;
    const auto& pairs = queries.pairs_within(a, b, tolerance);
    for (const ccd::NearPair& near : pairs) {
      row.field(id).text(near.upper <= tolerance ? "yes" : "undecided");
      lines +=
          row.count(near.pair.a).count(near.pair.b).number(near.lower).number(near.upper).finish();
    }
    if (pairs.empty()) {
      lines += finish(row.field(id).text("no"), 4);
    }
  }
  double tolerance;
};

class Answerer : public RowAnswerer {
 public:
  Answerer(std::shared_ptr<const MeshQueryFormat> format, const Question& question)
      : format_(std::move(format)), question_(question) {}

  std::string_view answer(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    const MeshRow asked = format_->read(rows.front(), fields_);
    lines_.clear();
    question_.answer(asked.id, {*asked.mesh_a, asked.pose_a}, {*asked.mesh_b, asked.pose_b},
                     queries_, lines_);
    return lines_;
  }
  std::string_view invalid(std::span<const std::string_view> rows, std::int64_t /*line*/) override {
    row_.field(format_->id(rows.front(), fields_)).text("invalid");
    return finish(row_, question_.fields - 2);
  }

 private:
  std::shared_ptr<const MeshQueryFormat> format_;
  const Question& question_;
  ccd::MeshQueries queries_;
  std::vector<std::string_view> fields_;
  std::string lines_;
  CsvRow row_;
};

std::int64_t answer(LineBlocks& queries, const MeshStreamOptions& options,
                    const Question& question) {
  MeshLibrary library(options.meshes);
  return answer_rows(queries, options.rows, [&](std::string_view header, std::int64_t line) {
    const auto format =
        std::make_shared<const MeshQueryFormat>(header, line, queries.name(), library);
    RowFormat rows;
    rows.answer_header = question.header;
    rows.make_answerer = [format, &question] {
      return std::make_unique<Answerer>(format, question);
    };
    return rows;
  });
}

}  // namespace

std::int64_t answer_collide_queries(LineBlocks& queries, const MeshStreamOptions& options) {
  return options.all ? answer(queries, options, AllContacts())
                     : answer(queries, options, FirstContact());
}

std::int64_t answer_distance_queries(LineBlocks& queries, const MeshStreamOptions& options) {
  if (!options.tolerance) {
    return answer(queries, options, Distance());
  }
  return options.all ? answer(queries, options, AllWithin(*options.tolerance))
                     : answer(queries, options, Within(*options.tolerance));
}

}  // namespace kairos::experiments
