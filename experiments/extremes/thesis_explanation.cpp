#include "experiments/extremes/thesis_explanation.hpp"

namespace kairos::experiments {
namespace {

constexpr const char* late = "fig. 13: handled where the frame finds it, up to v h late";
constexpr const char* tunnelled =
    "prediction 4, tunnelling: looked at once a frame, missed with probability max(0, 1 - "
    "(w + 2r)/(v h))";

std::string falling(double restitution) {
  return restitution < 1.0 ? "the original scheme 4: v is reflected whole, the thesis knows no "
                             "restitution; and prediction 1"
                           : "prediction 1: in flight it gains G^2 h^2/(2m) a frame; and fig. 13, "
                             "handled late";
}

}  // namespace

std::string why_thesis_is_wrong(const ExtremeCase& extreme, const Judged& judged) {
  const std::string& family = extreme.family;
  if (judged.verdict == Verdict::reported) {
    return "said so: " + judged.reason;
  }
  if (family == "restitution, gravity") {
    return falling(extreme.x);
  }
  if (family == "at rest in contact") {
    return "prediction 1: nothing is ever at rest, and what falls and is turned back gains "
           "G^2 h^2/(2m) a frame";
  }
  if (family == "stiffness") {
    return "the original scheme 6: p += v h, v += a h, a = F/m, all from the old values, a frame "
           "in arrears: an oscillation grows";
  }
  if (family == "spin") {
    return "prediction 4, of what turns: looked at once a frame, it is past the plate in between";
  }
  if (family == "simultaneous impacts" && extreme.x > 1.0) {
    return "prediction 8: the floor as `current` meets one ball a frame; the others sink on";
  }
  if (family == "simultaneous impacts") {
    return falling(1.0);
  }
  if (family == "consecutive impacts") {
    return extreme.x > 1e4 ? "prediction 8: one collision a frame, where ten are due"
                           : "fig. 13: each is up to a frame late, and that adds up";
  }
  if (family == "corner") {
    return "prediction 8: the `oldnext` guard lets one wall a frame meet the ball; what waits "
           "sinks "
           "so deep that it is turned back inwards (prediction 2)";
  }
  if (family == "closing gap") {
    return "the original scheme 4: a reflection whatever the direction, and no test whether there "
           "is room";
  }
  return judged.impacts == 0 ? tunnelled : late;
}

}  // namespace kairos::experiments
