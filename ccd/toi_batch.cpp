#include "ccd/toi_batch.hpp"

#include <cstddef>
#include <stdexcept>

namespace kairos::ccd {

void toi_batch(const ContactDetector& detector, std::span<const ToiQuery> queries,
               std::span<TimeOfImpact> answers) {
  if (queries.size() != answers.size()) {
    throw std::invalid_argument("toi_batch: as many answers as queries are needed");
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ToiQuery& q = queries[i];
    answers[i] = detector.time_of_impact(q.a, q.b, q.window, q.tolerance);
  }
}

}  // namespace kairos::ccd
