#include "experiments/parallel_for.hpp"
#include "experiments/rally/interval.hpp"
#include "experiments/rally/rally_run.hpp"
#include "experiments/sweeps/sweep.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kairos::experiments::thesis {
namespace {

constexpr double ball_diameter = 0.04;  // m, of the scene

int rallies(Size size) { return size == Size::full ? 200 : 20; }

/// Every rally by every method: outcome of rally r by method m at [m][r].
std::vector<std::vector<RallyOutcome>> play_all(const std::vector<RallyMethod>& methods,
                                                int count) {
  std::vector<RallyRecording> recordings;
  for (int r = 0; r < count; ++r) {
    recordings.push_back(make_rally({.seed = 1999 + static_cast<std::uint64_t>(r)}));
  }
  const auto per_method = static_cast<std::size_t>(count);
  std::vector outcomes(methods.size(), std::vector<RallyOutcome>(per_method));
  parallel_for(methods.size() * per_method, 0, [&](std::size_t i) {
    const std::size_t m = i / per_method;
    const std::size_t r = i % per_method;
    outcomes[m][r] = play(recordings[r], methods[m]);
  });
  return outcomes;
}

/// The sums over all rallies by one method.
struct Sum {
  std::int64_t strokes = 0;
  std::vector<Cluster> passed;          ///< strokes of each rally
  std::vector<Cluster> penetrated;      ///< strokes that showed the ball inside the bat
  std::vector<double> frames_a_stroke;  ///< of each rally
  std::vector<double> depths;           ///< of the strokes that penetrated
  std::vector<double> jumps;
  std::vector<double> kicks;
  std::int64_t stopped = 0;
};

void add(const StrokeOutcome& stroke, Sum& sum, double& frames) {
  ++sum.strokes;
  frames += stroke.penetrating;
  if (stroke.penetrating > 0) {
    ++sum.penetrated.back().count;
    sum.depths.push_back(stroke.depth);
  }
  sum.jumps.insert(sum.jumps.end(), stroke.jumps.begin(), stroke.jumps.end());
  sum.kicks.insert(sum.kicks.end(), stroke.kicks.begin(), stroke.kicks.end());
}

Sum sum_of(const std::vector<RallyOutcome>& outcomes) {
  Sum sum;
  for (const RallyOutcome& rally : outcomes) {
    double frames = 0.0;
    sum.passed.push_back(rally.passed());
    sum.penetrated.push_back({0, sum.passed.back().of});
    for (const StrokeOutcome& stroke : rally.strokes) {
      add(stroke, sum, frames);
    }
    sum.frames_a_stroke.push_back(frames / static_cast<double>(rally.strokes.size()));
    sum.stopped += rally.status == RunStatus::stopped ? 1 : 0;
  }
  return sum;
}

/// Of the strokes of a rally, which one hand played: where a method passes none, its own effect
/// cannot be known, and the largest of all methods is taken.
double largest_effect(const std::vector<Sum>& sums) {
  double most = 1.0;
  for (const Sum& sum : sums) {
    most = std::max(most, design_effect(sum.passed));
  }
  return most;
}

std::int64_t total(const std::vector<Cluster>& clusters) {
  std::int64_t count = 0;
  for (const Cluster& cluster : clusters) {
    count += cluster.count;
  }
  return count;
}

double middle(std::vector<double> values, double p = 0.5) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : quantile(values, p);
}

double share_above(const std::vector<double>& values, double limit) {
  const auto above =
      std::count_if(values.begin(), values.end(), [limit](double x) { return x > limit; });
  return values.empty() ? 0.0 : static_cast<double>(above) / static_cast<double>(values.size());
}

void append(const Interval& interval, std::vector<Cell>& row) {
  row.insert(row.end(), {number_cell(interval.estimate), number_cell(interval.low),
                         number_cell(interval.high)});
}

void tell_methods(const std::vector<RallyMethod>& methods, const std::vector<Sum>& sums,
                  FigureData& data) {
  Table& table = data.table(
      "methods", {{"method", "", "scheme and its options"},
                  {"bat", "kg", "mass of the bat"},
                  {"nudge", "s", "factor of the nudge"},
                  {"reading", "", "of the nudge: along v' - v (change) or v' (prose)"},
                  {"rallies", "", "played"},
                  {"strokes", "", "in all"},
                  {"stopped", "", "rallies that ended before their time"},
                  {"passed", "", "share of strokes in which the ball went through the bat"},
                  {"passed_low", "", "95 % interval"},
                  {"passed_high", "", "95 % interval"},
                  {"frames", "", "penetrating frames per stroke"},
                  {"frames_low", "", "95 % interval"},
                  {"frames_high", "", "95 % interval"},
                  {"penetrated", "", "share of strokes with a penetrating frame"},
                  {"penetrated_low", "", "95 % interval"},
                  {"penetrated_high", "", "95 % interval"},
                  {"depth", "m", "median depth, of the strokes that penetrated"},
                  {"jump", "m", "median jump of a hit ball"},
                  {"jumps", "", "share of hits that move the ball by more than its diameter"}});
  const double most = largest_effect(sums);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const Sum& sum = sums[m];
    const double nudge = std::max(methods[m].nudge, methods[m].nudge_prose);
    std::vector<Cell> row{methods[m].name,
                          methods[m].bat_mass,
                          nudge,
                          std::string(methods[m].nudge > 0.0         ? "change"
                                      : methods[m].nudge_prose > 0.0 ? "prose"
                                                                     : ""),
                          static_cast<std::int64_t>(sum.frames_a_stroke.size()),
                          sum.strokes,
                          sum.stopped};
    append(share_interval(sum.passed, most), row);
    append(mean_interval(sum.frames_a_stroke), row);
    append(share_interval(sum.penetrated, most), row);
    row.insert(row.end(), {number_cell(middle(sum.depths)), number_cell(middle(sum.jumps)),
                           number_cell(share_above(sum.jumps, ball_diameter))});
    table.rows.push_back(std::move(row));
  }
}

/// Compares the speeds of 13.8 with the truth, by the true speed of the bat.
void tell_speeds(const std::vector<RallyOutcome>& original, FigureData& data) {
  Table& table = data.table("speeds", {{"from", "m/s", "true speed of the bat"},
                                       {"to", "m/s", "true speed of the bat"},
                                       {"frames", "", "drawn frames"},
                                       {"truth", "m/s", "median true speed"},
                                       {"q1", "m/s", "speed told, lower quartile"},
                                       {"told", "m/s", "speed told, median"},
                                       {"q3", "m/s", "speed told, upper quartile"}});
  const std::vector<double> bounds{0.0, 0.01, 0.03, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 8.5};
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    std::vector<double> told;
    std::vector<double> truth;
    for (const RallyOutcome& rally : original) {
      for (const SpeedReading& speed : rally.speeds) {
        if (bounds[i] <= speed.truth && speed.truth < bounds[i + 1]) {
          told.push_back(speed.told);
          truth.push_back(speed.truth);
        }
      }
    }
    table.rows.push_back({bounds[i], bounds[i + 1], static_cast<std::int64_t>(told.size()),
                          number_cell(middle(truth)), number_cell(middle(told, 0.25)),
                          number_cell(middle(told)), number_cell(middle(told, 0.75))});
  }
  data.value("told_still", std::get<double>(table.rows.front()[5]), "m/s",
             "median speed told while the bat stands still", 2);
  data.value("told_slow", std::get<double>(table.rows[3][5]) / std::get<double>(table.rows[3][3]),
             "", "speed told over true speed, at 0.1 to 0.2 m/s", 2);
  data.value("told_fast", std::get<double>(table.rows[8][5]) / std::get<double>(table.rows[8][3]),
             "", "speed told over true speed, at 3 to 5 m/s", 3);
}

const Sum& named(std::string_view name, const std::vector<RallyMethod>& methods,
                 const std::vector<Sum>& sums) {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (methods[m].name == name) {
      return sums[m];
    }
  }
  throw std::out_of_range(std::string(name));
}

/// Records what fig. 15 changes, rally by rally: both methods play the same ones.
void tell_difference(const std::string& value, const Sum& literal, const Sum& original,
                     FigureData& data) {
  std::vector<double> more;
  for (std::size_t r = 0; r < original.passed.size(); ++r) {
    const auto of = static_cast<double>(original.passed[r].of);
    more.push_back(100.0 * static_cast<double>(literal.passed[r].count - original.passed[r].count) /
                   of);
  }
  const Interval points = mean_interval(more);
  data.text(value,
            fmt::format("{:+.1f} ({:+.1f} to {:+.1f})", points.estimate, points.low, points.high),
            "points of the share that passes, fig. 15 minus original, with its 95 % interval");
}

void quote(const std::vector<RallyMethod>& methods, const std::vector<Sum>& sums,
           FigureData& data) {
  const auto percent = [](double x) { return 100.0 * x; };
  const auto passed = [&](std::string_view name) {
    const Sum& sum = named(name, methods, sums);
    return percent(static_cast<double>(total(sum.passed)) / static_cast<double>(sum.strokes));
  };
  const auto frames = [&](std::string_view name) {
    return mean_interval(named(name, methods, sums).frames_a_stroke).estimate;
  };
  const Sum& original = named("original", methods, sums);
  const Sum& event_driven = named("event-driven", methods, sums);
  data.count("rallies", static_cast<std::int64_t>(original.frames_a_stroke.size()), "played");
  data.count("strokes", original.strokes, "by each method");
  data.value("passed", passed("original"), "%", "of strokes pass, original", 3);
  const double most = largest_effect(sums);
  const auto interval = [&](std::string_view value, std::string_view name) {
    const Interval share = share_interval(named(name, methods, sums).passed, most);
    data.text(value, fmt::format("{:.1f} to {:.1f} %", percent(share.low), percent(share.high)),
              "95 % interval");
  };
  interval("passed_interval", "original");
  data.count("passed_events", total(event_driven.passed), "strokes that pass, event-driven");
  data.value("passed_most", percent(share_interval(event_driven.passed, most).high), "%",
             "upper end of its 95 % interval", 2);
  data.value("effect", most, "", "largest design effect of a rally's strokes", 2);
  data.value("passed_boxes", passed("original, boxes"), "%", "with the thesis' boxes", 3);
  interval("passed_boxes_interval", "original, boxes");
  data.value("passed_literal_boxes", passed("substepped, 0.0275 m, boxes"), "%",
             "fig. 15 with the thesis' boxes", 3);
  interval("passed_literal_interval", "substepped, 0.0275 m");
  data.value("passed_equal", passed("equal substeps, 0.0275 m"), "%", "equal substeps", 3);
  data.value("passed_bisected", passed("bisected"), "%", "contact located in the substep", 2);
  tell_difference("literal_more", named("substepped, 0.0275 m", methods, sums), original, data);
  tell_difference("coarse_more", named("substepped, 0.055 m", methods, sums), original, data);
  tell_difference("boxes_more", named("substepped, 0.0275 m, boxes", methods, sums),
                  named("original, boxes", methods, sums), data);
  data.value("passed_nudged", passed("original, nudge 0.0025"), "%", "with the nudge of 7.4", 3);
  data.value("passed_literal", passed("substepped, 0.0275 m"), "%", "fig. 15, literally", 3);
  data.value("frames", frames("original"), "", "penetrating frames per stroke, original", 3);
  data.value("frames_literal", frames("substepped, 0.0275 m"), "", "fig. 15, literally", 3);
  const auto removed = [&](const std::string& name, std::string_view more) {
    return percent(1.0 - frames(name + std::string(more)) / frames(name));
  };
  data.value("removed", removed("original", ", nudge 0.0025"), "%",
             "of penetrating frames that the nudge of 13.9 removes", 2);
  data.value("frames_equal", frames("original, equal masses"), "",
             "penetrating frames per stroke, bat as heavy as the ball", 3);
  data.value("removed_equal", removed("original, equal masses", ", nudge 0.0025"), "%",
             "of these that the nudge of 13.9 removes", 3);
  data.value("removed_prose", removed("original, equal masses", ", nudge 0.0025 (prose)"), "%",
             "that the nudge of the prose removes", 3);
  data.value("removed_most", removed("original, equal masses", ", nudge 0.02"), "%",
             "that eight times the factor of 13.9 removes", 3);
  // A ball that moves by more than its diameter at once leaves a gap between its two pictures.
  data.value("jump", 100.0 * middle(named("original, nudge 0.0025", methods, sums).jumps), "cm",
             "median jump at a factor of 0.0025", 2);
  data.value("visible", ball_diameter / middle(original.kicks), "s",
             "factor at which the median hit moves the ball by its diameter", 2);
}

void measure(FigureData& data) {
  const std::vector<RallyMethod> methods = rally_methods();
  const auto outcomes = play_all(methods, rallies(data.size()));
  std::vector<Sum> sums;
  for (const auto& of_method : outcomes) {
    sums.push_back(sum_of(of_method));
  }
  tell_methods(methods, sums, data);
  tell_speeds(outcomes.front(), data);
  quote(methods, sums, data);
}

}  // namespace

ThesisFigure table_tennis() {
  return {
      .name = "table-tennis",
      .chapter = "7",
      .title = "Table tennis: strokes that pass through the ball",
      .shows =
          "The bat often passes through the ball; a nudge along the ball's velocity \"reduces "
          "the number of penetrations that occur, but does not prevent these totally\", and "
          "too much of it makes the ball \"appear to disappear\" (7.4, 9.1.3).",
      .how =
          "{rallies} seeded rallies of 24 strokes each at 2 to 8 m/s, recorded by noisy "
          "trackers (kairos record), played by each method on the scene table-tennis at 60 "
          "frames a second. Every stroke starts with a served ball. Passed: the ball's centre "
          "went through the bat's face in the drawn frames. The nudge is run at five factors, "
          "along v' - v (13.9, after line 20 of 13.7) and along v' (the prose of 7.4). "
          "Intervals hold 95 %. The strokes of a rally are not independent: shares have Wilson's "
          "interval with the strokes divided by the design effect of the rallies (at most "
          "{effect}), frames the standard error over rallies, both with Student's quantile. Balls "
          "are spheres and gravity an acceleration, as in the scene; two methods are also run with "
          "the thesis' boxes and its force (--thesis leaves both to the scene).",
      .caption =
          "Above: strokes that pass through the ball, and frames per stroke that show the "
          "ball inside the bat, with 95 % intervals. Below left: what the nudge does, and how "
          "many hits make the ball jump by more than its diameter. Below right: the bat's "
          "speed as 13.8 tells it, against the true one; quartiles.",
      .finding =
          "Looked at once a frame, {passed} of strokes pass through the ball ({passed_interval}), "
          "with {frames} penetrating frames per stroke; with the thesis' boxes {passed_boxes} "
          "({passed_boxes_interval}). From impact to impact {passed_events} of {strokes} do "
          "(95 % interval: below {passed_most}). A bat that weighs what a bat weighs throws the "
          "ball off at twice its own speed, so that no hit ball is inside for a second frame and "
          "the nudge of 0.0025 removes {removed} of the penetrating frames: the one in which the "
          "hit is found has been drawn by then. With a bat as heavy as the ball, which takes the "
          "bat's own velocity and stays inside, {frames_equal} frames per stroke penetrate, and "
          "the nudge removes {removed_equal} of them along v' - v, {removed_prose} along v' and "
          "{removed_most} at eight times the factor. It never helps a ball that was never seen "
          "inside: {passed_nudged} of strokes pass all the same. It moves the median hit by "
          "{jump}; at a factor of {visible} by the ball's diameter, a visible jump. Fig. 15 taken "
          "literally, which 9.1.3 says solves this problem, does not: at a threshold of 2.75 cm "
          "{passed_literal} pass ({passed_literal_interval}), in points of the same rallies "
          "{literal_more}; at 5.5 cm {coarse_more}, and with the thesis' boxes {boxes_more}: where "
          "these intervals lie above 0, the cure is worse than the disease. {frames_literal} "
          "frames per stroke penetrate, for short last substeps turn balls back into the bat. "
          "Substeps of equal length (2.75 cm) let {passed_equal} pass. While the bat stands "
          "still, 13.8 goes on telling "
          "{told_still}; at 0.1 to 0.2 m/s it tells {told_slow} times the true speed, at 3 to "
          "5 m/s {told_fast} times.",
      .script = "thesis.table_tennis",
      .measure = measure};
}

}  // namespace kairos::experiments::thesis
