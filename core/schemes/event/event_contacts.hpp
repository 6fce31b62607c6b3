#pragma once

#include "core/contacts/contact_sweeps.hpp"
#include "core/schemes/event/event_accumulation.hpp"
#include "core/schemes/event/event_modes.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/event/event_predictor.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

class BallDetector;
class GroupLaw;
class PointLaw;

/// What happens when two bodies meet, come to rest on each other, part, or cross a field. Each of
/// these launches who is concerned and predicts what they meet next.
class EventContacts {
 public:
  EventContacts(EventRun& run, EventMotions& motions, EventPredictor& predictor,
                ContactGraph& graph, const Method& method);

  /// The detector told contact within `bracket` (s) of t; `decided`: it proved it.
  void impact(BodyIndex a, BodyIndex b, Instant t, double bracket, bool decided);
  void cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering);

  /// Two solids touch and will stay in touch.
  void stay(BodyIndex a, BodyIndex b, Instant t);
  /// The bounces of a ball have died down: told once, if it is still there.
  void begin_contact(BodyIndex a, BodyIndex b, Instant t);
  /// A group of bodies in touch goes on otherwise: a patch is at its end, or an epoch is.
  void settle_anew(BodyIndex i, Instant t);
  [[nodiscard]] const EventModes& modes() const { return modes_; }
  /// A body that a hand has grasped is held by no contact any more.
  void take_out(BodyIndex i, Instant t);
  /// A ball is no longer supported; takes effect with its next launch.
  void end_contact(BodyIndex i, Instant t);
  /// A supported ball comes to the end of its surface, or the surface draws away.
  void leave_support(BodyIndex i, Instant t);
  /// A driven surface has a new motion: the bodies on it follow or leave it.
  void carry_riders(BodyIndex surface, Instant t);

  /// Body i is about to meet another.
  void look_up(BodyIndex i) const { accumulation_.look_up(i); }

  void persist(Archive& archive);

 private:
  struct Touching {
    Instant settled = Instant::never();         ///< when it last came to rest on a surface
    Instant contact_begins = Instant::never();  ///< when its bounces have died down

    void persist(Archive& archive);
  };

  [[nodiscard]] static Event impact_in(BodyIndex a, BodyIndex b, Instant t, double bracket);
  [[nodiscard]] bool impact_of_balls(BodyIndex a, BodyIndex b, Instant t, double bracket);
  [[nodiscard]] bool is_wall(BodyIndex i) const;
  [[nodiscard]] Contact contact_of_balls(const Event& event, const PlainBall* ball_a,
                                         const PlainBall* ball_b) const;
  void go_on_plain(const Event& event, const PlainBall* ball_a, const PlainBall* ball_b);
  bool meet_in_one_box(BodyIndex a, BodyIndex b, Instant t);
  void meet(Event& event, Instant t);
  void go_on_struck(const Event& event, double approach, std::vector<BodyIndex> group, Instant t);
  void go_on_as_found(const Event& event, const EventAccumulation::Finding& finding, Instant t);
  [[nodiscard]] bool meet_elsewhere(BodyIndex a, BodyIndex b, Instant t);
  void strike(Event& event);
  [[nodiscard]] const JointSystem* joints_of(BodyIndex i) const;
  void put_onto_joints(const Event& event);
  void strike_jointed(Event& event);
  void rub_jointed(Event& event);
  [[nodiscard]] bool rest_on_joints(const Event& event, Instant t);
  void part_hanging(BodyIndex i, Instant t);
  [[nodiscard]] std::pair<BodyState, BodyState> would_leave(const Event& event,
                                                            const BodyInertia& inertia_a,
                                                            const BodyInertia& inertia_b) const;
  [[nodiscard]] bool strikes_flat(Event& event);
  void press_together(Event& event, const ContactManifold& manifold);
  [[nodiscard]] double roundoff(const Contact& contact, BodyIndex a, BodyIndex b) const;
  [[nodiscard]] double no_approach(const Contact& contact, BodyIndex a, BodyIndex b,
                                   double bracket) const;
  [[nodiscard]] bool still_approaching(const Event& event, double approach, Instant t);
  [[nodiscard]] bool settle(std::span<const BodyIndex> seeds, Instant t,
                            const EventModes::SettleOptions& options = {});
  [[nodiscard]] bool settle_stalled(std::span<const BodyIndex> seeds, Instant t);
  [[nodiscard]] bool go_on_stalled(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] bool settle_at_last(std::span<const BodyIndex> seeds, Instant t);
  bool go_on_if(bool settled, std::span<const BodyIndex> seeds);
  [[nodiscard]] bool could_be_supported(BodyIndex a, BodyIndex b, Instant t) const;
  [[nodiscard]] std::string unkept() const;
  [[nodiscard]] bool strike_group(const Event& first, double approach);
  void leave_at_rest(const EventModes::GroupImpact& impact, const Eigen::VectorXd& impulses,
                     std::vector<Twist>& v) const;
  static void return_as_struck(const EventModes::GroupImpact& impact,
                               const Eigen::VectorXd& impulses, const std::vector<Twist>& struck,
                               std::vector<Twist>& v);
  void tell_group(const EventModes::GroupImpact& impact, const Eigen::VectorXd& impulses,
                  std::span<const BodyState> before, const Event& first);
  void hand_on(const Event& first, double approach, std::vector<BodyIndex> bodies, Instant t);
  void go_on_from(std::span<const BodyIndex> bodies, const BodyPair& first, double approach,
                  Instant t);
  [[nodiscard]] bool end_by_pushing(std::span<const BodyIndex> seeds, double remaining, Instant t,
                                    const Event* last = nullptr);
  void take_back(const Event& impact);
  [[nodiscard]] EventModes::GroupImpact group_before(const Event* last,
                                                     std::span<const BodyIndex> seeds, Instant t);
  [[nodiscard]] std::vector<BodyIndex> give(const EventModes::GroupImpact& impact,
                                            const std::vector<ContactSweeps::Vector6>& velocities,
                                            std::span<const BodyIndex> seeds, Instant t);
  /// What contacts of a group can do by pushing.
  struct Pushes {
    std::vector<SweptTouch> touches;             ///< by row of the group
    std::vector<ContactSweeps::Vector6> before;  ///< velocities, by body
    ContactSweeps::Swept swept;
    bool some = false;     ///< whether anything is pushed
    bool settled = false;  ///< whether impulses were found
  };
  [[nodiscard]] std::optional<Pushes> pushes_among(const EventModes::GroupImpact& impact);
  [[nodiscard]] std::vector<BodyIndex> hand_on_at_once(const Event& first,
                                                       std::span<const BodyIndex> bodies,
                                                       double part, Instant t);
  void book_pushes(const EventModes::GroupImpact& impact, const Pushes& pushes, EnergyLine normal);
  void open(BodyIndex a, BodyIndex b, Instant t);
  void set_free(std::span<const BodyIndex> bodies, Instant t);
  [[nodiscard]] bool may_let_go(Instant t);
  [[nodiscard]] bool parts_all_over(BodyIndex a, BodyIndex b, double gap, double bracket) const;
  [[nodiscard]] Contact contact_at(BodyIndex a, BodyIndex b, Instant t, double bracket) const;
  void look_again(BodyIndex a, BodyIndex b, Instant t, double bracket);
  [[nodiscard]] double passes_by(BodyIndex a, BodyIndex b, Instant t) const;
  [[nodiscard]] bool leave_alone(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] double comes_together(BodyIndex a, BodyIndex b, Instant t, double bracket) const;
  void touch(BodyIndex a, BodyIndex b, const Contact& contact, Instant t, double bracket);
  [[nodiscard]] bool lands(BodyIndex a, BodyIndex b, const Contact& contact, Instant t);
  [[nodiscard]] bool leaves_for(BodyIndex ball, const Support& other, double tolerance, Instant t);
  void settle(BodyIndex ball, const Support& support, double pressing, double e, Instant t);
  void resume_support(BodyIndex i, Instant t);
  void follow(BodyIndex ball, const Support& support, Instant t);
  void count_strike(const BodyPair& pair, double speed, Instant t);
  [[nodiscard]] bool strikes_on() const;
  [[nodiscard]] bool is_nothing(BodyIndex a, BodyIndex b, double speed) const;
  void lay_still(BodyIndex a, BodyIndex b);
  [[nodiscard]] double leaving_speed(BodyIndex ball, const Support& support, Instant t) const;
  void depart(BodyIndex a, BodyIndex b, Instant t);
  void relaunch(BodyIndex a, BodyIndex b, Instant t);
  [[nodiscard]] bool in_one_island(BodyIndex a, BodyIndex b) const;

  EventRun& run_;
  EventMotions& motions_;
  EventPredictor& predictor_;
  const ContactGraph& graph_;
  const GroupLaw* group_law_;  ///< the impact law, if it takes groups; else null
  EventAccumulation accumulation_;
  EventModes modes_;
  /// Who is asked of two plain balls that meet, if that is up to them alone; else null.
  const PointLaw* point_law_ = nullptr;
  const BallDetector* ball_detector_;
  /// Balls that a face supports, or has: few of many.
  std::map<BodyIndex, Touching> touching_;
  int stalled_ = 0;  ///< how often bodies in touch were settled at one instant, and when
  Instant stalled_at_ = Instant::never();
  int let_go_ = 0;           ///< how often bodies went on by themselves, in the frame `let_go_in_`
  double let_go_in_ = -1.0;  ///< counted from the start of the run
  int pushed_ = 0;           ///< how often impacts were ended by pushing, in the frame `pushed_in_`
  double pushed_in_ = -1.0;  ///< counted from the start of the run
  double struck_by_ = 0.0;   ///< the fastest approach of those that struck at `struck_at_`, m/s
  Instant struck_at_ = Instant::never();
  BodyPair struck_last_{};  ///< who did, and how often one after the other
  int struck_alike_ = 0;
  int struck_here_ = 0;  ///< how often anybody did at `struck_at_`
};

}  // namespace core
}  // namespace kairos
