#include "experiments/accuracy/accuracy.hpp"

#include "experiments/accuracy/query_file.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "experiments/accuracy/truth.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/parallel_for.hpp"
#include "simulation/output/csv_row.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace kairos::experiments {
namespace {

using reference::Difficulty;
using reference::Finding;
using reference::Query;
using reference::Truth;

constexpr std::size_t kinds = std::size(reference::shape_kinds);

Difficulty class_of(std::size_t index) {
  return static_cast<Difficulty>(index % reference::difficulties);
}

/// Query `index` of a seed; classes and pairs of shapes take turns.
Query query_at(std::uint64_t seed, std::size_t index) {
  const std::size_t rest = index / reference::difficulties;
  return reference::random_query(class_of(index), reference::shape_kinds[rest % kinds],
                                 (seed << 32) + rest / kinds);
}

/// The part of an answer that is kept.
struct Outcome {
  ToiStatus status = ToiStatus::separated;
  Finding finding = Finding::right;
  bool judged = false;
  bool timed = false;  ///< an impact that is there: `early` means something
  float width = 0.0F;  ///< of the bracket, s
  float early = 0.0F;  ///< true time of contact less t_lo, s
  int evaluations = 0;
};

/// `truth`: none if the answer is not judged.
Outcome outcome_of(const Query& q, const ContactDetector& detector, const Truth* truth) {
  const TimeOfImpact toi = q.ask(detector);
  Outcome outcome;
  outcome.status = toi.status;
  outcome.width = static_cast<float>(toi.t_hi - toi.t_lo);
  outcome.evaluations = toi.evaluations;
  if (truth != nullptr) {
    const double tolerance = ccd::default_tolerance(q.moving_a(), q.moving_b(), q.window());
    outcome.judged = true;
    outcome.finding = reference::judge(q, toi, *truth, tolerance, detector.info().proves);
    outcome.timed = truth->contact && toi.status == ToiStatus::impact;
    outcome.early = static_cast<float>(truth->time - reference::Real(toi.t_lo));
  }
  return outcome;
}

/// Counts and quantiles of one class.
struct Summary {
  std::size_t asked = 0, judged = 0;
  std::array<std::size_t, 4> status{};
  std::array<std::size_t, 4> finding{};
  double evaluations = 0.0;
  std::vector<float> widths, early;

  void add(const Outcome& outcome) {
    ++asked;
    judged += outcome.judged ? 1 : 0;
    ++status[static_cast<std::size_t>(outcome.status)];
    finding[static_cast<std::size_t>(outcome.finding)] += outcome.judged ? 1 : 0;
    evaluations += outcome.evaluations;
    if (outcome.status == ToiStatus::impact) {
      widths.push_back(outcome.width);
    }
    if (outcome.timed) {
      early.push_back(outcome.early);
    }
  }
};

/// The q-quantile; 0 where there is none.
double quantile(std::vector<float>& values, double q) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

const char* const columns =
    "detector,class,queries,separated,impact,overlapping,undecided,judged,missed,late,wrong,"
    "width_median,width_max,early_median,early_max,evaluations\n";

/// One line of the table, on stdout and for the file.
std::string tell(const std::string& detector, const std::string& name, Summary& s) {
  const double width[2] = {quantile(s.widths, 0.5), quantile(s.widths, 1.0)};
  const double early[2] = {quantile(s.early, 0.5), quantile(s.early, 1.0)};
  const double evaluations = s.evaluations / static_cast<double>(std::max<std::size_t>(1, s.asked));
  fmt::print(
      "  {:<12}{:>9}{:>9}{:>9}{:>10}{:>8}{:>6}{:>7}{:>10.1e}{:>10.1e}{:>10.1e}{:>10.1e}{:>8.1f}\n",
      name, s.asked, s.status[1], s.status[2], s.status[3], s.finding[1], s.finding[2],
      s.finding[3], width[0], width[1], early[0], early[1], evaluations);
  CsvRow row;
  row.text(detector).text(name).count(static_cast<std::int64_t>(s.asked));
  for (const std::size_t count : s.status) {
    row.count(static_cast<std::int64_t>(count));
  }
  row.count(static_cast<std::int64_t>(s.judged));
  for (std::size_t i = 1; i < s.finding.size(); ++i) {
    row.count(static_cast<std::int64_t>(s.finding[i]));
  }
  row.number(width[0]).number(width[1]).number(early[0]).number(early[1]).number(evaluations);
  return std::string(row.finish());
}

/// Why an answer is undecided: what the reference sees in its bracket, against the roundoff of the
/// coordinates.
void explain(std::uint64_t seed, std::size_t index, const ContactDetector& detector) {
  const Query q = query_at(seed, index);
  const TimeOfImpact toi = q.ask(detector);
  const auto f = [&q](reference::Real t) { return q.separation(t); };
  const double least = static_cast<double>(reference::least(f, toi.t_lo, toi.t_hi, 400));
  // The tolerance without the share of the extents: the roundoff alone.
  const double extent = std::min(smallest_extent(q.a), smallest_extent(q.b));
  const double roundoff =
      ccd::default_tolerance(q.moving_a(), q.moving_b(), q.window()) - 1e-9 * extent;
  const char* why = std::abs(least) <= roundoff ? "a graze within roundoff"
                    : toi.t_hi >= q.duration    ? "contact begins at the end of the window"
                                                : "not explained";
  fmt::print(
      "  undecided: {} {} query {}: in [{:.9g}, {:.9g}] the least gap is {:.2g} m, "
      "roundoff {:.2g} m: {}\n",
      reference::difficulty_names[static_cast<std::size_t>(class_of(index))], shape_name(q.a),
      index, toi.t_lo, toi.t_hi, least, roundoff, why);
}

/// Prints the answers of one detector by class; returns how many were missed, late or wrong.
std::size_t tell_detector(const AccuracyOptions& options, const ContactDetector& detector,
                          const std::vector<Outcome>& outcomes, std::string& csv) {
  const std::string name(detector.info().name);
  fmt::print("{}\n  {:<12}{:>9}{:>9}{:>9}{:>10}{:>8}{:>6}{:>7}{:>10}{:>10}{:>10}{:>10}{:>8}\n",
             name, "", "queries", "impact", "overlap", "undecided", "missed", "late", "wrong",
             "width 50%", "max / s", "early 50%", "max / s", "looks");
  std::vector<Summary> classes(reference::difficulties);
  Summary all;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    classes[i % reference::difficulties].add(outcomes[i]);
    all.add(outcomes[i]);
  }
  for (std::size_t d = 0; d < classes.size(); ++d) {
    csv += tell(name, reference::difficulty_names[d], classes[d]);
  }
  csv += tell(name, "all", all);
  for (std::size_t i = 0; i < outcomes.size() && detector.info().proves; ++i) {
    if (outcomes[i].status == ToiStatus::undecided) {
      explain(options.seed, i, detector);
    }
  }
  return all.finding[1] + all.finding[2] + all.finding[3];
}

}  // namespace

std::size_t measure_accuracy(const AccuracyOptions& options) {
  std::vector<std::shared_ptr<const ContactDetector>> detectors;
  for (const std::string& name : options.detectors) {
    detectors.push_back(find_detector(name));
  }
  std::vector<std::vector<Outcome>> outcomes(detectors.size(),
                                             std::vector<Outcome>(options.queries));
  constexpr std::size_t block = 256;
  parallel_for((options.queries + block - 1) / block, options.threads, [&](std::size_t b) {
    for (std::size_t i = b * block; i < std::min(options.queries, (b + 1) * block); ++i) {
      const Query q = query_at(options.seed, i);
      // Every class and pair of shapes is judged alike: whole rounds of them.
      const bool judged = (i / (reference::difficulties * kinds)) % options.judge_every == 0;
      const Truth truth = judged ? reference::find_truth(q) : Truth{};
      for (std::size_t d = 0; d < detectors.size(); ++d) {
        outcomes[d][i] = outcome_of(q, *detectors[d], judged ? &truth : nullptr);
      }
    }
  });

  fmt::print("{} queries, seed {}, against long double\n", options.queries, options.seed);
  std::string csv = columns;
  std::size_t broken = 0;
  for (std::size_t d = 0; d < detectors.size(); ++d) {
    const std::size_t bad = tell_detector(options, *detectors[d], outcomes[d], csv);
    broken += detectors[d]->info().proves ? bad : 0;
  }
  if (!options.out.empty()) {
    OutputFolder out(options.out,
                     {.seal = "accuracy.csv", .begins = columns, .replace = options.force});
    out.file("accuracy.csv").write(csv);
    AtomicFile& file = out.file("queries.csv");
    file.write(query_file_header());
    for (std::size_t i = 0; i < options.queries; ++i) {
      if (class_of(i) != Difficulty::polynomial) {  // the format has no polynomials
        file.write(query_file_row(i, query_at(options.seed, i)));
      }
    }
    out.publish();
  }
  return broken;
}

}  // namespace kairos::experiments
