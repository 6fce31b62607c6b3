#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"

#include <vector>

namespace kairos::experiments {

/// How high a body rises between two impacts: the highest point of its motions, exact for
/// parabolas (a drawn frame would miss the top by up to g h^2/8).
class ApexWatch {
 public:
  struct Apex {
    double time = 0.0;    ///< s
    double height = 0.0;  ///< m
  };

  explicit ApexWatch(BodyIndex body) : body_(body) {}
  void motion(BodyIndex body, const Motion& motion);
  void event(const Event& event);
  /// Apexes of completed rises: from the start or an impact to the next impact.
  [[nodiscard]] const std::vector<Apex>& apexes() const { return apexes_; }

 private:
  void look(const Motion& motion, double duration);
  void look_at(const Motion& motion, double s);

  BodyIndex body_;
  bool moving_ = false;
  Motion current_;
  bool any_ = false;
  Apex highest_;
  std::vector<Apex> apexes_;
};

}  // namespace kairos::experiments
