#include "core/schemes/event/event_predictor.hpp"

#include "core/archive.hpp"
#include "core/ball_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {

EventPredictor::EventPredictor(EventRun& run, const EventMotions& motions, const Grasps& grasps,
                               const ContactGraph& graph, const Method& method)
    : run_(run),
      motions_(motions),
      grasps_(grasps),
      graph_(graph),
      since_(run.model.size()),
      ball_detector_(dynamic_cast<const BallDetector*>(&run.detector)) {
  const Scene& scene = run.model.scene();
  bounds_hold_ = run.detector.info().proves && run.options.toi_tolerance == 0.0;
  only_motions_ = scene.joints.empty() && !scene.periodic && run.model.grips().empty();
  if (!run.model.asks_every_pair() || run.model.scene().periodic) {
    neighbourhood_ = method.neighbourhood(run.model, run.options.toi_tolerance);
    looks_ahead_ = dynamic_cast<const LooksAhead*>(neighbourhood_.get());
    return;
  }
  partners_.resize(run.model.size());
  for (const auto& [a, b] : run.model.pairs()) {
    partners_[a].push_back(b);
    partners_[b].push_back(a);
  }
}

void EventPredictor::predict(BodyIndex i, Instant t, BodyIndex except) {
  since_[i] = t;
  if constexpr (watches_jumps) {
    run_.jumps.predicted(i);
  }
  if (!neighbourhood_) {
    for (const BodyIndex j : partners_[i]) {
      if (j != except) {
        predict_near(i, {j});
      }
    }
    return;
  }
  enter(i, t);
  themselves_.clear();
  neighbours_.clear();
  neighbourhood_->near_apart(i, themselves_, neighbours_);
  survey_all(i, except);
}

/// Asks about all that are near i but `except`.
void EventPredictor::survey_all(BodyIndex i, BodyIndex except) {
  // Of its images the others have not been asked about: it had not entered yet.
  std::erase_if(neighbours_,
                [except](const Neighbour& j) { return j.body == except && is_zero(j.image); });
  survey(i, before_all, except);
  run_.agenda.file(i);
}

void EventPredictor::predict_struck(BodyIndex a, BodyIndex b, Instant t) {
  if (!neighbourhood_ || !only_motions_) {
    predict(a, t);
    return predict(b, t, a);
  }
  const auto turn_to_other = [this] {
    themselves_.swap(themselves_of_other_);
    neighbours_.swap(neighbours_of_other_);
  };
  for (const BodyIndex i : {b, a}) {
    turn_to_other();
    since_[i] = t;
    if constexpr (watches_jumps) {
      run_.jumps.predicted(i);
    }
    enter(i, t);
    themselves_.clear();
    neighbours_.clear();
    neighbourhood_->near_apart(i, themselves_, neighbours_);
    for (const std::uint32_t j : themselves_) {
      motions_.look_up(j);  // it is fetched while others are asked about
    }
  }
  survey_all(a, a);
  turn_to_other();
  survey_all(b, a);
}

void EventPredictor::predict_island(BodyIndex i, Instant t) {
  for (const BodyIndex k : motions_.island(i)) {
    predict(k, t);
  }
}

void EventPredictor::cross(BodyIndex i, Instant t) {
  if (!neighbourhood_) {
    return;  // no body crosses here, but a forged checkpoint may say so
  }
  themselves_.clear();
  neighbours_.clear();
  std::optional<Instant> next;
  if (motions_.flies_parabola(i)) {
    next = neighbourhood_->cross(i, motions_.flight(i), t, last_of(i), themselves_, neighbours_);
  }
  if (!next) {
    next = neighbourhood_->cross(i, motions_.moving(i), t, last_of(i), neighbours_);
  }
  run_.agenda.cross(i, *next);
  survey(i, t);
  run_.agenda.file(i);
}

void EventPredictor::renew(BodyIndex i, Instant t) {
  if (!neighbourhood_) {
    return;  // no body is filed here, but a forged checkpoint may say so
  }
  themselves_.clear();
  neighbours_.clear();
  neighbourhood_->near_apart(i, themselves_, neighbours_);
  survey(i, t);
  run_.agenda.file(i);
}

void EventPredictor::enter(BodyIndex i, Instant t) {
  std::optional<Instant> next;
  if (motions_.flies_parabola(i)) {
    next = neighbourhood_->enter(i, motions_.flight(i), t, last_of(i));
  }
  if (!next) {
    next = neighbourhood_->enter(i, motions_.moving(i), t, last_of(i));
  }
  run_.agenda.cross(i, *next);
}

void EventPredictor::predict_all(Instant t) {
  std::fill(since_.begin(), since_.end(), t);
  if constexpr (watches_jumps) {
    for (BodyIndex i = 0; i < since_.size(); ++i) {
      run_.jumps.predicted(i);
    }
  }
  if (!neighbourhood_) {
    for (const auto& [a, b] : run_.model.pairs()) {
      predict_near(a, {b});
    }
    return;
  }
  for (const BodyIndex i : run_.agenda.by_name()) {
    enter(i, t);
  }
  themselves_.clear();
  for (const BodyIndex i : run_.agenda.by_name()) {
    neighbours_.clear();
    neighbourhood_->near(i, neighbours_);
    std::erase_if(neighbours_, [&](const Neighbour& near) {
      const BodyIndex j = near.body;
      const bool mine = keeps_meeting(i, j);
      return mine == keeps_meeting(j, i) ? j < i : !mine;
    });
    run_.agenda.forget_meeting(i);
    survey(i, before_all);
    run_.agenda.file(i);
  }
  neighbours_ = {};  // a wall has every body as its neighbour: too large to keep
}

/// Asks when i meets each of `themselves_` but `except`, and each of `neighbours_`.
void EventPredictor::survey(BodyIndex i, Instant known, BodyIndex except) {
  if (only_motions_ && motions_.is_usual(i)) {
    survey_usual(i, known, except);
  } else {
    for (const BodyIndex j : themselves_) {
      if (j != i && j != except) {
        neighbours_.push_back({j});
      }
    }
  }
  if (neighbours_.empty()) {
    return;
  }
  const bool flies = motions_.flies(i);
  const bool periodic = run_.model.scene().periodic.has_value();
  balls_.clear();
  if (flies) {
    own_ = motions_.flight(i);
    beside_.begin(own_);
    for (const Neighbour& j : neighbours_) {
      motions_.look_up(j.body);
    }
  }
  const bool meets_plain = motions_.is_plain(i) && run_.model.scene().joints.empty();
  std::erase_if(neighbours_, [&](const Neighbour& j) {
    const bool meets = meets_plain && motions_.is_plain(j.body) && j.body != i;
    if (!meets && !run_.model.interacts(i, j.body)) {
      return true;
    }
    if (!flies || !motions_.flies(j.body)) {
      return false;
    }
    balls_.push_back(j);
    if (periodic && !is_zero(j.image)) {
      BallFlight image = motions_.flight(j.body);
      move_to(j.image, image);
      beside_.add(image);
    } else {
      beside_.add(motions_.flight(j.body));
    }
    return true;
  });
  if (!balls_.empty()) {
    meet_balls(i, known);
  }
  if (flies) {  // all of them, before one is asked about: their order does not matter then
    std::erase_if(neighbours_, [&](const Neighbour& j) { return is_beyond(i, j.body); });
  }
  for (const Neighbour& j : neighbours_) {
    predict_near(i, j, known);
  }
}

/// The same of those of `themselves_` that are balls like i; appends the others to `neighbours_`.
void EventPredictor::survey_usual(BodyIndex i, Instant known, BodyIndex except) {
  own_ = motions_.usual_flight(i);
  beside_.begin_alike(own_);
  if (usual_.size() < themselves_.size()) {
    usual_.resize(themselves_.size());
  }
  std::size_t count = 0;
  std::size_t others = 0;
  const auto takes = [&, found = themselves_.data(), usual = usual_.data()](std::size_t k) {
    const std::uint32_t j = found[k];
    usual[count] = j;
    const bool other = (j != i) & (j != except);
    const bool taken = other & motions_.is_usual(j);
    count += static_cast<std::size_t>(taken);
    others += static_cast<std::size_t>(other);
    return taken;
  };
  motions_.add_usual(themselves_, beside_, takes);
  if (count != others) {
    for (const std::uint32_t j : themselves_) {
      if (j != i && j != except && !motions_.is_usual(j)) {
        neighbours_.push_back({j});
      }
    }
  }
  if (count == 0) {
    return;
  }
  filter_beside();
  near_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    if (clear_[k] < std::numeric_limits<double>::infinity()) {
      const Instant later = std::max(own_.start, motions_.start_of_usual(usual_[k]));
      near_.push_back({{usual_[k]}, later + clear_[k], true});
    }
  }
  ask_near(i, known);
}

/// Asks about `balls_`.
void EventPredictor::meet_balls(BodyIndex i, Instant known) {
  const Instant start = motions_.start_of(i);
  filter_beside();
  near_.clear();
  for (std::size_t k = 0; k < balls_.size(); ++k) {
    if (clear_[k] < std::numeric_limits<double>::infinity()) {
      const Instant later = std::max(start, motions_.start_of(balls_[k].body));
      near_.push_back({balls_[k], later + clear_[k]});
    }
  }
  ask_near(i, known);
}

/// For how long those in `beside_` are clear of the one.
void EventPredictor::filter_beside() {
  const std::size_t room =
      (beside_.size() + FlightsBeside::block - 1) / FlightsBeside::block * FlightsBeside::block;
  if (clear_.size() < room) {
    clear_.resize(room);
  }
  run_.detector.clear_times(beside_, run_.options.toi_tolerance, clear_);
}

/// Asks about `near_`, earliest possible meeting first, and ends when no other can be earlier: body
/// i is asked again when its earliest meeting comes up.
void EventPredictor::ask_near(BodyIndex i, Instant known) {
  while (!near_.empty()) {
    const auto next = std::min_element(
        near_.begin(), near_.end(), [](const Near& x, const Near& y) { return x.clear < y.clear; });
    if (run_.agenda.meeting(i) < next->clear) {
      return;
    }
    if (next->usual) {
      ask_usual(i, next->who.body, known);
    } else {
      predict_near(i, next->who, known);
    }
    *next = near_.back();
    near_.pop_back();
  }
}

/// `ask` of two usual balls, the first of which is surveyed, of which nothing but their motions
/// says when they meet: what that finds out beside is known.
void EventPredictor::ask_usual(BodyIndex i, BodyIndex j, Instant known) {
  const Instant from = std::max(since_[i], since_[j]);
  if (ball_detector_ == nullptr || !graph_.empty()) {
    return ask(i, {j}, from, known);
  }
  const double duration = run_.epoch_end() - from;
  if (!(duration > 0.0)) {
    return;
  }
  const BallFlight other = motions_.usual_flight(j);
  const bool in_order = run_.agenda.before(i, j);
  const auto meeting = ball_detector_->ball_meeting(in_order ? own_ : other,
                                                    in_order ? other : own_, {from, duration});
  if (!meeting) {
    return ask(i, {j}, from, known);
  }
  ++run_.cost.toi_queries;
  run_.cost.toi_evaluations += meeting->evaluations;
  if (!meeting->meets) {
    return;
  }
  const double bracket = meeting->t_hi - meeting->t_lo;
  if (const Instant t = from + meeting->t_lo; known < t) {
    run_.agenda.meet(i, j, t, bracket);
  } else {
    const auto [a, b] = in_order ? std::pair{i, j} : std::pair{j, i};
    ask_on({a, b, from, duration, known, true, i}, t + bracket);
  }
}

/// Whether ball i, which flies, meets this wall later than what is known of its meetings, for sure,
/// or not before the epoch ends: then it need not be asked about. From its height and speed above
/// the plane, all made worse by far more than what a detector that proves leaves between the two.
bool EventPredictor::is_beyond(BodyIndex i, BodyIndex wall) const {
  const auto* const half_space = std::get_if<HalfSpace>(&run_.model.shape(wall));
  if (half_space == nullptr || !bounds_hold_ || !keeps_meeting(i, wall)) {
    return false;
  }
  constexpr double worse = 1e-6;
  const BallFlight ball = motions_.flight(i);
  const Pose& pose = motions_.now(wall).pose;  // it is fixed
  const Vector3 up = half_space_normal(*half_space, pose);
  const double sizes = ball.position.lpNorm<1>() + pose.position.lpNorm<1>() + ball.radius;
  const double height = up.dot(ball.position - pose.position) - ball.radius - worse * sizes;
  const double falls = -up.dot(ball.velocity) + worse * ball.velocity.lpNorm<1>();
  const double faster =
      std::max(0.0, -up.dot(ball.acceleration) + worse * ball.acceleration.lpNorm<1>());
  if (!(height > 0.0)) {
    return false;
  }
  // height = falls t + faster t^2 / 2, without cancellation.
  const double root = std::sqrt(falls * falls + 2.0 * faster * height);
  double clear = std::numeric_limits<double>::infinity();
  if (falls > 0.0) {
    clear = 2.0 * height / (falls + root);
  } else if (faster > 0.0) {
    clear = (root - falls) / faster;
  }
  const Instant earliest = ball.start + (1.0 - worse) * clear;
  return run_.agenda.meeting(i) < earliest || run_.epoch_end() < earliest;
}

/// Moves a flight to its periodic image n.
void EventPredictor::move_to(const Image& n, BallFlight& flight) const {
  const auto& box = run_.model.scene().periodic;
  if (!box || is_zero(n)) {
    return;
  }
  const Vector3 shift = box->shift(n);
  flight.position += shift;
  // The sum rounds, and a query may round the other way.
  constexpr double roundings = 8.0 * std::numeric_limits<double>::epsilon();
  flight.radius += roundings * (flight.position.lpNorm<1>() + shift.lpNorm<1>());
}

/// Whether the balls that bound the two stay apart for the whole query. A body that tumbles is
/// asked about anew with each segment of its rotation, and is far from most others.
bool EventPredictor::stay_clear(const PairQuery& of) {
  if (!neighbourhood_ || (motions_.flies(of.a) && motions_.flies(of.b))) {
    return false;  // not worth it for few bodies; done already for two balls
  }
  const BallFlight a = motions_.flight(of.a);
  BallFlight b = motions_.flight(of.b);
  if (!std::isfinite(a.radius + b.radius)) {
    return false;
  }
  move_to(of.image, b);
  pair_.begin(a);
  pair_.add(b);
  std::array<double, FlightsBeside::block> clear{};
  run_.detector.clear_times(pair_, run_.options.toi_tolerance, clear);
  return std::max(a.start, b.start) + clear[0] > of.from + of.duration;
}

/// Whether body i keeps only its earliest meeting, among those with bodies like `with`.
bool EventPredictor::keeps_meeting(BodyIndex i, BodyIndex with) const {
  return neighbourhood_ && motions_.flies(i) &&
         (motions_.flies(with) ||
          (run_.model.mobility(with) == Mobility::fixed && !run_.model.is_field(with) &&
           std::holds_alternative<HalfSpace>(run_.model.shape(with))));
}

void EventPredictor::solids_near(BodyIndex i, std::vector<Neighbour>& out) {
  const auto add = [&](const Neighbour& j) {
    if (run_.model.interacts(i, j.body) && !run_.model.is_field(i) &&
        !run_.model.is_field(j.body) && !grasps_.involve(i, j.body)) {
      out.push_back(j);
    }
  };
  if (!neighbourhood_) {
    for (const BodyIndex j : partners_[i]) {
      add({j, {}});
    }
    return;
  }
  neighbours_.clear();
  neighbourhood_->near(i, neighbours_);
  std::for_each(neighbours_.begin(), neighbours_.end(), add);
}

bool EventPredictor::goes_alone(BodyIndex i) const {
  if (!run_.model.is_free(i) || graph_.holds(i)) {
    return false;
  }
  const auto& support = motions_.support(i);
  return !support || std::holds_alternative<HalfSpace>(run_.model.shape(support->surface));
}

void EventPredictor::go_on_as(BodyIndex i, const Image& n) { neighbourhood_->go_on_as(i, n); }

void EventPredictor::predict_near(BodyIndex i, const Neighbour& j, Instant known) {
  ask(i, j, std::max(since_[i], since_[j.body]), known);
}

void EventPredictor::predict_pair(BodyIndex i, BodyIndex j, const Image& n, Instant t) {
  ask(i, {j, n}, t, before_all);
  if (neighbourhood_) {
    run_.agenda.file(i);  // the meeting may be kept as that of i
  }
}

void EventPredictor::ask(BodyIndex i, const Neighbour& other, Instant from, Instant known,
                         int links) {
  // Queries go by name, so that their bits do not depend on who asks.
  const BodyIndex j = other.body;
  const bool in_order = run_.agenda.before(i, j);
  const auto [a, b] = in_order ? std::pair{i, j} : std::pair{j, i};
  const bool leaving = grasps_.leaving(a, b).has_value();
  if (!leaving && grasps_.involve(a, b)) {
    return;
  }
  const bool untied = motions_.is_plain(a) && motions_.is_plain(b);
  if (!untied && (motions_.is_supported_by(a, b) || motions_.is_supported_by(b, a))) {
    return;
  }
  if (graph_.joins(a, b)) {
    return;
  }
  double duration = std::min({motions_.end_of(a), motions_.end_of(b), run_.epoch_end()}) - from;
  for (const BodyIndex k : {a, b}) {  // end - from would lose a step of 1e-22 s
    if (motions_.start_of(k) == from) {
      duration = std::min(duration, motions_.duration_of(k));
    }
  }
  if (!(duration > 0.0)) {
    return;
  }
  const Image image = in_order ? other.image : -other.image;
  const PairQuery query{a, b, from, duration, known, keeps_meeting(i, j), i, image, links};
  if (leaving) {
    predict_parting(query, DueKind::clear_of_hand);
  } else if (!untied && (motions_.is_in_field(a, b) || motions_.is_in_field(b, a))) {
    predict_parting(query, DueKind::field_left);
  } else if (!stay_clear(query)) {
    predict_meeting(query);
  }
}

/// Puts what is due of a pair on the agenda. What is due before `known` has been dealt with: the
/// pair is asked about what follows, as it was then. What it touched without an impact, it may
/// meet.
void EventPredictor::push(const PairQuery& of, double after, DueKind kind, double bracket,
                          bool decided) {
  const Instant t = of.from + after;
  if (!(of.known < t)) {
    if (kind == DueKind::recheck) {
      ask_on(of, t);
    } else if (kind == DueKind::impact) {
      ask_on(of, t + bracket);
    }
    return;
  }
  if (of.kept && kind == DueKind::impact && decided) {
    run_.agenda.meet(of.asker, of.asker == of.a ? of.b : of.a, t, bracket);
  } else {
    run_.agenda.push(t, kind, of.a, of.b, bracket, decided, of.image);
  }
}

/// Asks about what follows an answer: from where the event of that answer asked, so that the bits
/// are the same. Where that gets nowhere it is left to an event of its own.
void EventPredictor::ask_on(const PairQuery& of, Instant from) {
  constexpr int most_links = 64;
  if (of.from < from && of.links < most_links) {
    const bool by_a = of.asker == of.a;
    return ask(of.asker, {by_a ? of.b : of.a, by_a ? of.image : -of.image}, from, of.known,
               of.links + 1);
  }
  run_.agenda.push(of.known, DueKind::recheck, of.a, of.b, 0.0, true, of.image);
}

TimeOfImpact EventPredictor::counted(const TimeOfImpact& toi) {
  ++run_.cost.toi_queries;
  run_.cost.toi_evaluations += toi.evaluations;
  return toi;
}

/// The motion of one of the two, as the other sees it: perhaps as an image.
Motion EventPredictor::motion_of(BodyIndex i, const PairQuery& of) const {
  Motion motion = motions_.of(i);
  if (is_imaged(of) && i == mover(of.a, of.b)) {
    motion.position[0] += run_.model.scene().periodic->shift(i == of.b ? of.image : -of.image);
  }
  return motion;
}

TimeOfImpact EventPredictor::time_of_impact(const PairQuery& of, double duration) {
  const Window window{of.from, duration};
  if (!is_imaged(of)) {
    if (motions_.flies_parabola(of.a) && motions_.flies_parabola(of.b)) {
      if (const auto toi =
              run_.detector.ball_impact(motions_.flight(of.a), motions_.flight(of.b), window)) {
        return counted(*toi);
      }
    }
    if (const auto toi = ball_meets_plane(of, window)) {
      return counted(*toi);
    }
    return counted(run_.detector.time_of_impact(motions_.moving(of.a), motions_.moving(of.b),
                                                window, run_.options.toi_tolerance));
  }
  const Motion a = motion_of(of.a, of);
  const Motion b = motion_of(of.b, of);
  return counted(run_.detector.time_of_impact({run_.model.shape(of.a), a},
                                              {run_.model.shape(of.b), b}, window,
                                              run_.options.toi_tolerance));
}

/// Of a ball that flies and a half-space that is fixed.
std::optional<TimeOfImpact> EventPredictor::ball_meets_plane(const PairQuery& of,
                                                             const Window& window) const {
  if (ball_detector_ == nullptr) {
    return std::nullopt;
  }
  for (const auto& [ball, wall] : {std::pair{of.a, of.b}, std::pair{of.b, of.a}}) {
    const auto* const half_space = std::get_if<HalfSpace>(&run_.model.shape(wall));
    if (half_space != nullptr && run_.model.mobility(wall) == Mobility::fixed &&
        motions_.flies_parabola(ball)) {
      return ball_detector_->ball_meets_plane(motions_.flight(ball), *half_space,
                                              motions_.now(wall).pose, window);
    }
  }
  return std::nullopt;
}

/// The greatest gap at which an undecided answer is that of a touch, also where one of the two is
/// seen as an image: about the tolerance of the detectors, half of `touching_gap`. What they ran
/// out of work at above it may be above `touching_gap` as measured there.
double EventPredictor::answered_gap(const PairQuery& of) const {
  const double gap = 0.5 * touching_gap(of.a, of.b);
  if (!is_imaged(of)) {
    return gap;
  }
  return gap + 352.0 * std::numeric_limits<double>::epsilon() *
                   run_.model.scene().periodic->shift(of.image).lpNorm<1>();
}

double EventPredictor::touching_gap(BodyIndex a, BodyIndex b) const {
  double coordinates = 0.0;
  double radii = 0.0;
  double errors = 0.0;
  double extent = std::numeric_limits<double>::infinity();
  for (const BodyIndex i : {a, b}) {
    coordinates += motions_.coordinates_reached(i, run_.epoch());
    const double radius = bounding_radius(run_.model.shape(i));
    radii += std::isfinite(radius) ? radius : 0.0;
    errors += motions_.error_radius(i);
    extent = std::min(extent, smallest_extent(run_.model.shape(i)));
  }
  const double asked = run_.options.toi_tolerance;
  // The roundoff in the detectors' default tolerance: 704 u of the largest coordinates, where u is
  // half of epsilon.
  const double roundoff = 352.0 * std::numeric_limits<double>::epsilon() * (coordinates + radii);
  return 2.0 * ((asked > 0.0 ? asked : 1e-9 * extent) + roundoff + errors);
}

double EventPredictor::least_touching_gap(const PlainBall* a, const PlainBall* b) const {
  const auto extent = [](const PlainBall* ball) {
    return ball != nullptr ? 2.0 * ball->radius : std::numeric_limits<double>::infinity();
  };
  const double asked = run_.options.toi_tolerance;
  return 2.0 * (asked > 0.0 ? asked : 1e-9 * std::min(extent(a), extent(b)));
}

/// The answer is undecided and the two are far apart: the detector ran out of work. Skips the time
/// that it proved free of contact, and asks about what follows in shorter windows.
void EventPredictor::look_nearer(const PairQuery& query, TimeOfImpact toi) {
  constexpr double worth_it = 1.0 / 16.0;  // of the window
  constexpr int most_tries = 40;           // to 1e-24 of the window
  const Instant t = query.from;
  const double allowed = answered_gap(query);
  double duration = query.duration;
  for (int k = 0; k < most_tries; ++k) {
    const bool touching = toi.status != ToiStatus::undecided || toi.gap <= allowed;
    if (touching && toi.status != ToiStatus::separated) {
      return push_meeting(query, toi);
    }
    const double free = toi.status == ToiStatus::separated ? duration : toi.t_lo;
    if (free >= worth_it * duration) {
      return push(query, free, DueKind::recheck);
    }
    duration *= 0.25;
    toi = time_of_impact(query, duration);
  }
  run_.stop(
      t, fmt::format("undecided: whether {} meet, {} m apart, in the next {} s: the detector "
                     "'{}' ran out of work; allowed: a slower rotation, a larger --tolerance, "
                     "or another detector",
                     run_.names(query.a, query.b), toi.gap, duration, run_.detector.info().name));
}

/// A field is entered where overlap is proven, at t_hi; solids strike before that, at t_lo.
void EventPredictor::push_meeting(const PairQuery& of, const TimeOfImpact& toi) {
  const bool field = run_.model.is_field(of.a) || run_.model.is_field(of.b);
  push(of, field ? toi.t_hi : toi.t_lo, field ? DueKind::field_entered : DueKind::impact,
       toi.t_hi - toi.t_lo, toi.status == ToiStatus::impact);
}

void EventPredictor::predict_meeting(const PairQuery& query) {
  const auto [a, b] = std::pair{query.a, query.b};
  const TimeOfImpact toi = time_of_impact(query, query.duration);
  if (!run_.model.is_free(a) && !run_.model.is_free(b)) {
    return;  // asked only where no pair is left out; nothing can come of it
  }
  take_answer(query, toi);
}

void EventPredictor::take_answer(const PairQuery& query, const TimeOfImpact& toi) {
  const auto [a, b] = std::pair{query.a, query.b};
  const bool field = run_.model.is_field(a) || run_.model.is_field(b);
  switch (toi.status) {
    case ToiStatus::separated:
      return;
    case ToiStatus::undecided:
      if (toi.gap > answered_gap(query)) {
        return look_nearer(query, toi);
      }
      return push_meeting(query, toi);
    case ToiStatus::impact:
      // What their motions may be off by may be more than what they have parted by so far.
      if (!field && toi.t_lo == 0.0 && motions_.error_radius(a) + motions_.error_radius(b) > 0.0 &&
          !approach(query)) {
        return leave_overlap(query);
      }
      return push_meeting(query, toi);
    case ToiStatus::overlapping:
      return field ? push(query, 0.0, DueKind::field_entered) : leave_overlap(query);
  }
}

/// Whether two solids approach each other where they are nearest when they are asked about.
bool EventPredictor::approach(const PairQuery& query) const {
  const auto [a, b] = std::pair{query.a, query.b};
  const auto state_of = [&](BodyIndex i) {
    const Motion motion = motion_of(i, query);
    const double s = std::min(query.from - motion.start, motion.duration);
    return BodyState{motion.pose(s), motion.twist(s)};
  };
  const BodyState state_a = state_of(a);
  const BodyState state_b = state_of(b);
  const Overlap o =
      run_.detector.overlap(run_.model.shape(a), state_a.pose, run_.model.shape(b), state_b.pose);
  return normal_velocity({o.point, o.normal, o.gap}, state_a, state_b) < 0.0;
}

/// Two solids that overlap by roundoff: an impact if they approach, nothing if they part. A pair
/// that stays would fall through each other, unless a mode of contact can hold it.
void EventPredictor::leave_overlap(const PairQuery& query) {
  if (approach(query)) {
    return push(query, 0.0, DueKind::impact);
  }
  const TimeOfImpact meanwhile = without_errors(query);
  if (meanwhile.status == ToiStatus::undecided && meanwhile.gap > answered_gap(query) &&
      meanwhile.t_lo > 0.0) {
    return push(query, meanwhile.t_lo, DueKind::recheck);  // out of work, and apart until then
  }
  if (meanwhile.status == ToiStatus::impact || meanwhile.status == ToiStatus::undecided) {
    return push_meeting(query, meanwhile);
  }
  // A detector without proofs lets bodies overlap by what it misses.
  const bool deeper = meanwhile.status == ToiStatus::overlapping && run_.detector.info().proves;
  const TimeOfImpact parting = time_of_separation(query);
  if (deeper || parting.status == ToiStatus::overlapping) {
    return push(query, 0.0, DueKind::stays);
  }
  push(query, parting.t_hi, DueKind::recheck);
}

/// When the two touch if the error radii of their motions are left out: with these a pair in touch
/// overlaps for a while, and could go deeper elsewhere than where it parts.
TimeOfImpact EventPredictor::without_errors(const PairQuery& of) {
  Motion motion_a = motion_of(of.a, of);
  Motion motion_b = motion_of(of.b, of);
  motion_a.error_radius = motion_b.error_radius = 0.0;
  const TimeOfImpact toi = run_.detector.time_of_impact(
      {run_.model.shape(of.a), motion_a}, {run_.model.shape(of.b), motion_b},
      {of.from, of.duration}, run_.options.toi_tolerance);
  ++run_.cost.toi_queries;
  run_.cost.toi_evaluations += toi.evaluations;
  return toi;
}

void EventPredictor::predict_parting(const PairQuery& query, DueKind kind) {
  const TimeOfImpact toi = time_of_separation(query);
  if (toi.status != ToiStatus::overlapping) {
    push(query, toi.t_hi, kind);
  }
}

TimeOfImpact EventPredictor::time_of_separation(const PairQuery& of) {
  if (!is_imaged(of)) {
    return counted(run_.detector.time_of_separation(motions_.moving(of.a), motions_.moving(of.b),
                                                    {of.from, of.duration},
                                                    run_.options.toi_tolerance));
  }
  const Motion a = motion_of(of.a, of);
  const Motion b = motion_of(of.b, of);
  return counted(
      run_.detector.time_of_separation({run_.model.shape(of.a), a}, {run_.model.shape(of.b), b},
                                       {of.from, of.duration}, run_.options.toi_tolerance));
}

void EventPredictor::persist(Archive& archive) {
  archive(since_);
  if (neighbourhood_) {
    neighbourhood_->persist(archive);
  }
}

}  // namespace core
}  // namespace kairos
