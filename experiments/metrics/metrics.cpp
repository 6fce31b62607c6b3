#include "experiments/metrics/metrics.hpp"

#include "core/error.hpp"
#include "core/exact_solution.hpp"
#include "experiments/metrics/metric_apex.hpp"
#include "experiments/metrics/metric_between.hpp"
#include "experiments/metrics/metric_crossing.hpp"
#include "experiments/metrics/metric_impacts.hpp"
#include "experiments/metrics/run_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::experiments {

struct MetricRecorder::Watches {
  BodyIndex subject;
  std::optional<MetricsRecorder> frames;
  std::optional<BetweenWatch> between;
  std::optional<CrossingWatch> crossing;
  ApexWatch apex;
  ImpactWatch impacts;
  std::unique_ptr<const ExactMotion> exact;
};

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();  // becomes an empty value

/// What metrics are computed from; watches that nobody asked for are null.
struct Observation {
  const RunResult& result;
  const RunMetrics* frames;
  const BetweenWatch* between;
  const CrossingWatch* crossing;
  const ApexWatch& apex;
  const ImpactWatch& impacts;
  const BodyState& subject;
  const BodyState* exact;  ///< null: there is none, or nobody asked
};

/// What must be watched for a metric.
enum class Needs { nothing, frames, between, crossing, apex, exact };

struct Entry {
  MetricInfo info;
  Needs needs;
  double (*value)(const Observation&);
};

template <EnergyLine line>
double ledger(const Observation& o) {
  return o.result.ledger.line(line);
}

template <std::int64_t Cost::*count>
double counted(const Observation& o) {
  return static_cast<double>(o.result.cost.*count);
}

template <int axis>
double end_position(const Observation& o) {
  return o.subject.pose.position[axis];
}

double position_error(const Observation& o) {
  return o.exact == nullptr ? none : (o.subject.pose.position - o.exact->pose.position).norm();
}

double energy_gain(const Observation& o) {
  return o.result.ledger.energy() - o.result.ledger.initial_energy();
}

const std::vector<Entry>& entries() {
  using O = const Observation&;
  static const std::vector<Entry> all = {
      {{"max_penetration", "m", "deepest overlap of two solids in a drawn frame"},
       Needs::frames,
       [](O o) { return o.frames->max_depth; }},
      {{"max_penetration_between", "m", "deepest overlap along the motions between frames"},
       Needs::between,
       [](O o) { return o.between->max_depth(); }},
      {{"overlap_time", "s", "how long drawn frames showed an overlap"},
       Needs::frames,
       [](O o) { return o.frames->time_overlapping; }},
      {{"overlap_frames", "", "drawn frames that showed an overlap"},
       Needs::frames,
       [](O o) { return static_cast<double>(o.frames->frames_overlapping); }},
      {{"tunnelled", "", "1 if a free body ended on the other side of a solid"},
       Needs::crossing,
       [](O o) { return o.crossing->tunnelled() ? 1.0 : 0.0; }},
      {{"crossings", "", "how often a centre passed through a solid"},
       Needs::crossing,
       [](O o) { return static_cast<double>(o.crossing->crossings()); }},
      {{"energy_error", "", "energy that no physics accounts for, relative to the energy there is"},
       Needs::frames,
       [](O o) { return o.frames->relative(energy_error(o.result.ledger)); }},
      {{"energy_gain", "J", "energy at the end minus energy at the start"},
       Needs::nothing,
       energy_gain},
      {{"energy", "J", "energy at the end"},
       Needs::nothing,
       [](O o) { return o.result.ledger.energy(); }},
      {{"kinetic", "J", "kinetic energy at the end"},
       Needs::nothing,
       [](O o) { return o.result.ledger.kinetic(); }},
      {{"field_work", "J", "ledger: work of fields"},
       Needs::nothing,
       ledger<EnergyLine::field_work>},
      {{"driven_work", "J", "ledger: work of driven bodies"},
       Needs::nothing,
       ledger<EnergyLine::driven_work>},
      {{"restitution_loss", "J", "ledger: lost in impacts"},
       Needs::nothing,
       ledger<EnergyLine::restitution_loss>},
      {{"truncation", "J", "ledger: truncation of the integrator"},
       Needs::nothing,
       ledger<EnergyLine::truncation>},
      {{"late_impact", "J", "ledger: impacts handled late"},
       Needs::nothing,
       ledger<EnergyLine::late_impact>},
      {{"position_correction", "J", "ledger: bodies moved out of others"},
       Needs::nothing,
       ledger<EnergyLine::position_correction>},
      {{"conveyor_and_hand", "J", "ledger: belts and hands"},
       Needs::nothing,
       ledger<EnergyLine::conveyor_and_hand>},
      {{"roundoff", "J", "ledger: roundoff, where it was asked for"},
       Needs::nothing,
       ledger<EnergyLine::roundoff>},
      {{"unexplained", "J", "what no line of the ledger explains"},
       Needs::nothing,
       [](O o) { return o.result.ledger.unexplained(); }},
      {{"flow", "J", "sum of the magnitudes of all flows of energy"},
       Needs::nothing,
       [](O o) { return o.result.ledger.flow(); }},
      {{"first_apex", "m", "height of the first apex"},
       Needs::apex,
       [](O o) { return o.apex.apexes().empty() ? none : o.apex.apexes().front().height; }},
      {{"last_apex", "m", "height of the last apex"},
       Needs::apex,
       [](O o) { return o.apex.apexes().empty() ? none : o.apex.apexes().back().height; }},
      {{"first_impact", "s", "time of the first impact of the subject"},
       Needs::nothing,
       [](O o) { return o.impacts.first().value_or(none); }},
      {{"last_impact", "s", "time of the last impact of the subject"},
       Needs::nothing,
       [](O o) { return o.impacts.last().value_or(none); }},
      {{"rest_time", "s", "when the subject came to rest on a surface"},
       Needs::nothing,
       [](O o) { return o.impacts.rest().value_or(none); }},
      {{"separating_impacts", "", "impacts handled although the bodies were moving apart"},
       Needs::nothing,
       [](O o) { return static_cast<double>(o.impacts.separating()); }},
      {{"bounces", "", "impacts of bodies that were approaching"},
       Needs::nothing,
       [](O o) { return static_cast<double>(o.impacts.approaching()); }},
      {{"end_time", "s", "how far the run got"},
       Needs::nothing,
       [](O o) { return o.result.end.seconds; }},
      {{"end_x", "m", "position of the subject at the end"}, Needs::nothing, end_position<0>},
      {{"end_y", "m", "position of the subject at the end"}, Needs::nothing, end_position<1>},
      {{"end_z", "m", "position of the subject at the end"}, Needs::nothing, end_position<2>},
      {{"position_error", "m",
        "distance of the subject from the scene's exact solution at the end"},
       Needs::exact,
       position_error},
      {{"end_speed", "m/s", "speed of the subject at the end"},
       Needs::nothing,
       [](O o) { return o.subject.twist.linear.norm(); }},
      {{"end_spin", "rad/s", "angular speed of the subject at the end"},
       Needs::nothing,
       [](O o) { return o.subject.twist.angular.norm(); }},
      {{"frames", "", "frames"}, Needs::nothing, counted<&Cost::frames>},
      {{"steps", "", "integrator steps"}, Needs::nothing, counted<&Cost::steps>},
      {{"right_hand_sides", "", "right-hand sides evaluated"},
       Needs::nothing,
       counted<&Cost::right_hand_sides>},
      {{"overlap_tests", "", "overlap tests"}, Needs::nothing, counted<&Cost::overlap_tests>},
      {{"toi_queries", "", "time-of-impact queries"}, Needs::nothing, counted<&Cost::toi_queries>},
      {{"toi_evaluations", "", "gap evaluations in these"},
       Needs::nothing,
       counted<&Cost::toi_evaluations>},
      {{"impacts", "", "impacts handled"}, Needs::nothing, counted<&Cost::impacts>},
      {{"events", "", "events"}, Needs::nothing, counted<&Cost::events>},
  };
  return all;
}

const Entry* find_entry(std::string_view name) {
  const auto found = std::find_if(entries().begin(), entries().end(),
                                  [name](const Entry& entry) { return entry.info.name == name; });
  return found == entries().end() ? nullptr : &*found;
}

bool needed(const MetricRequest& request, Needs needs) {
  return std::any_of(request.metrics.begin(), request.metrics.end(),
                     [needs](const std::string& name) {
                       const Entry* entry = find_entry(name);
                       return entry != nullptr && entry->needs == needs;
                     });
}

}  // namespace

BodyIndex subject_of(const Model& model, const std::string& name) {
  BodyIndex first_free = 0;
  for (BodyIndex i = model.size(); i-- > 0;) {
    if (!name.empty() && model.body(i).name == name) {
      return i;
    }
    first_free = model.is_free(i) ? i : first_free;
  }
  if (!name.empty()) {
    throw InputError(model.scene().path, 0, "subject",
                     fmt::format("the scene has no body '{}'", name));
  }
  return first_free;
}

std::span<const MetricInfo> metric_catalogue() {
  static const std::vector<MetricInfo> infos = [] {
    std::vector<MetricInfo> out;
    for (const Entry& entry : entries()) {
      out.push_back(entry.info);
    }
    return out;
  }();
  return infos;
}

bool is_metric(std::string_view name) { return find_entry(name) != nullptr; }

std::string metric_names() {
  std::string out;
  for (const Entry& entry : entries()) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", entry.info.name);
  }
  return out;
}

std::string_view metric_unit(std::string_view name) {
  const Entry* entry = find_entry(name);
  return entry == nullptr ? std::string_view{} : entry->info.unit;
}

MetricRecorder::MetricRecorder(MetricRequest request) : request_(std::move(request)) {
  for (const std::string& metric : request_.metrics) {
    if (!is_metric(metric)) {
      throw InputError("", 0, "metrics",
                       fmt::format("there is no metric '{}'; allowed: {}", metric, metric_names()));
    }
  }
}
MetricRecorder::~MetricRecorder() = default;

bool MetricRecorder::wants_motions() const {
  return needed(request_, Needs::between) || needed(request_, Needs::apex);
}

void MetricRecorder::begin(const Model& model) {
  const BodyIndex subject = subject_of(model, request_.subject);
  watches_.reset(
      new Watches{subject, {}, {}, {}, ApexWatch(subject), ImpactWatch(model, subject), {}});
  if (needed(request_, Needs::frames)) {
    watches_->frames.emplace().begin(model);
  }
  if (needed(request_, Needs::between)) {
    watches_->between.emplace(model);
  }
  if (needed(request_, Needs::crossing)) {
    watches_->crossing.emplace(model);
  }
  if (needed(request_, Needs::exact)) {
    watches_->exact = solve_exactly(model.scene());
  }
}

void MetricRecorder::frame(const Frame& frame) {
  if (watches_->frames) {
    watches_->frames->frame(frame);
  }
  if (watches_->between) {
    watches_->between->frame(frame);
  }
  if (watches_->crossing) {
    watches_->crossing->frame(frame);
  }
}

void MetricRecorder::motion(BodyIndex body, const Motion& motion) {
  if (watches_->between) {
    watches_->between->motion(body, motion);
  }
  watches_->apex.motion(body, motion);
}

void MetricRecorder::event(const Event& event) {
  watches_->apex.event(event);
  watches_->impacts.event(event);
}

std::optional<double> MetricRecorder::value(std::string_view metric,
                                            const RunResult& result) const {
  const auto& requested = request_.metrics;
  if (std::find(requested.begin(), requested.end(), metric) == requested.end()) {
    throw InputError("", 0, "metrics", fmt::format("'{}' was not requested", metric));
  }
  if (watches_ == nullptr || watches_->subject >= result.state.size()) {
    return std::nullopt;
  }
  const Watches& w = *watches_;
  const auto exact = w.exact ? w.exact->state(w.subject, result.end) : std::nullopt;
  const double x = find_entry(metric)->value(
      {result, w.frames ? &w.frames->metrics() : nullptr, w.between ? &*w.between : nullptr,
       w.crossing ? &*w.crossing : nullptr, w.apex, w.impacts, result.state[w.subject],
       exact ? &*exact : nullptr});
  return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

}  // namespace kairos::experiments
