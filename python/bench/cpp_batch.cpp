#include "core/contact_detector.hpp"
#include "simulation/registry.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

// The batch that a C++ programmer writes against the library: bodies as structs, a loop on every
// thread, answers in a vector. `compare.py` loads it and times it beside the Python package.

namespace {

using namespace kairos;

struct Side {
  Shape shape;
  Pose pose;
  Twist twist;
  Vector3 acceleration;
};

struct Batch {
  std::vector<Side> a, b;
  std::vector<double> durations;
  std::vector<TimeOfImpact> impacts;
  std::vector<Overlap> overlaps;
  std::vector<std::uint8_t> touches;
  std::shared_ptr<const ContactDetector> detector = find_detector("certified");
};

template <typename Answer>
void on_threads(std::size_t count, std::size_t threads, const Answer& answer) {
  constexpr std::size_t piece = 256;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t first = next.fetch_add(piece); first < count; first = next.fetch_add(piece)) {
      for (std::size_t i = first; i < std::min(first + piece, count); ++i) {
        answer(i);
      }
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < threads; ++k) {
    others.emplace_back(work);
  }
  work();
}

Vector3 three(const double* x) { return {x[0], x[1], x[2]}; }

}  // namespace

extern "C" {

Batch* batch_new() { return new Batch; }
void batch_delete(Batch* batch) { delete batch; }

/// One side anew. `numbers`: 19 a body: size, position, orientation, velocity, acceleration,
/// angular velocity.
void batch_fill(Batch* batch, bool first, int kind, std::size_t count, const double* numbers) {
  std::vector<Side>& side = first ? batch->a : batch->b;
  side.clear();
  side.shrink_to_fit();
  side.reserve(count);
  for (const double* x = numbers; x != numbers + 19 * count; x += 19) {
    const Shape shape = kind == 1 ? Shape(Sphere{x[0]}) : Shape(Box{three(x)});
    Quaternion q(x[6], x[7], x[8], x[9]);
    q.coeffs() /= q.norm();
    side.push_back({shape, {three(x + 3), q}, {three(x + 10), three(x + 16)}, three(x + 13)});
  }
}

void batch_toi(Batch* batch, double duration, std::size_t threads) {
  Batch& it = *batch;
  it.impacts.clear();
  it.impacts.shrink_to_fit();
  it.impacts.resize(it.a.size());
  on_threads(it.a.size(), threads, [&](std::size_t i) {
    const Side &a = it.a[i], &b = it.b[i];
    const Motion motion_a = Motion::ballistic({}, duration, a.pose, a.twist, a.acceleration);
    const Motion motion_b = Motion::ballistic({}, duration, b.pose, b.twist, b.acceleration);
    it.impacts[i] =
        it.detector->time_of_impact({a.shape, motion_a}, {b.shape, motion_b}, {{}, duration}, 0.0);
  });
}

void batch_overlap(Batch* batch, std::size_t threads) {
  Batch& it = *batch;
  it.touches.assign(it.a.size(), 0);
  on_threads(it.a.size(), threads, [&](std::size_t i) {
    it.touches[i] =
        it.detector->overlaps(it.a[i].shape, it.a[i].pose, it.b[i].shape, it.b[i].pose) ? 1 : 0;
  });
}

void batch_distance(Batch* batch, std::size_t threads) {
  Batch& it = *batch;
  it.overlaps.clear();
  it.overlaps.shrink_to_fit();
  it.overlaps.resize(it.a.size());
  on_threads(it.a.size(), threads, [&](std::size_t i) {
    it.overlaps[i] = it.detector->overlap(it.a[i].shape, it.a[i].pose, it.b[i].shape, it.b[i].pose);
  });
}

/// Sums that two batches have in common where they have the same bits.
void batch_sums(const Batch* batch, double* sums) {
  sums[0] = sums[1] = sums[2] = 0.0;
  for (const TimeOfImpact& toi : batch->impacts) {
    sums[0] += toi.t_lo + toi.t_hi + toi.gap;
  }
  for (const Overlap& overlap : batch->overlaps) {
    sums[1] += overlap.gap;
  }
  for (const std::uint8_t touch : batch->touches) {
    sums[2] += touch;
  }
}

}  // extern "C"
