#include "experiments/metrics/metrics.hpp"

#include "core/error.hpp"
#include "core/exact_solution.hpp"
#include "experiments/metrics/metric_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments {

struct MetricRecorder::Watches {
  BodyIndex subject;
  std::optional<MetricsRecorder> frames;
  std::optional<BetweenWatch> between;
  std::optional<CrossingWatch> crossing;
  std::optional<JointWatch> joints;
  ApexWatch apex;
  ImpactWatch impacts;
  std::unique_ptr<const ExactMotion> exact;
};

namespace {

const Metric* find_metric(std::string_view name) {
  const auto found = std::find_if(metric_table().begin(), metric_table().end(),
                                  [name](const Metric& entry) { return entry.info.name == name; });
  return found == metric_table().end() ? nullptr : &*found;
}

bool needed(const MetricRequest& request, Needs needs) {
  return std::any_of(request.metrics.begin(), request.metrics.end(),
                     [needs](const std::string& name) {
                       const Metric* entry = find_metric(name);
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
    for (const Metric& entry : metric_table()) {
      out.push_back(entry.info);
    }
    return out;
  }();
  return infos;
}

bool is_metric(std::string_view name) { return find_metric(name) != nullptr; }

std::string metric_names() {
  std::string out;
  for (const Metric& entry : metric_table()) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", entry.info.name);
  }
  return out;
}

std::string_view metric_unit(std::string_view name) {
  const Metric* entry = find_metric(name);
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
      new Watches{subject, {}, {}, {}, {}, ApexWatch(subject), ImpactWatch(model, subject), {}});
  if (needed(request_, Needs::frames)) {
    watches_->frames.emplace().begin(model);
  }
  if (needed(request_, Needs::between)) {
    watches_->between.emplace(model);
  }
  if (needed(request_, Needs::crossing)) {
    watches_->crossing.emplace(model);
  }
  if (needed(request_, Needs::joints)) {
    watches_->joints.emplace(model);
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
  if (watches_->joints) {
    watches_->joints->frame(frame);
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
  const double x = find_metric(metric)->value(
      {result, w.frames ? &w.frames->metrics() : nullptr, w.between ? &*w.between : nullptr,
       w.crossing ? &*w.crossing : nullptr, w.joints ? &*w.joints : nullptr, w.apex, w.impacts,
       result.state[w.subject], exact ? &*exact : nullptr});
  return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

}  // namespace kairos::experiments
