#include "integrators/sundials/cvode.hpp"

#include "integrators/dense_output.hpp"
#include "integrators/sundials/watched_system.hpp"

#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <vector>

namespace kairos::integrators {
namespace {

using sundials::IslandSystem;
using sundials::WatchedSystem;

struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
struct FreeNonlinear {
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
/// The last step of the solver as polynomials of the flat state, in powers of the time since it
/// began.
class History {
 public:
  static constexpr std::size_t rows = Polynomial<3>::max_degree + 1;

  void resize(std::size_t size) {
    size_ = size;
    coefficients_.assign(rows * size, 0.0);
    degree_ = 0;
  }
  [[nodiscard]] double& at(int power, std::size_t n) {
    return coefficients_[static_cast<std::size_t>(power) * size_ + n];
  }
  [[nodiscard]] double at(int power, std::size_t n) const {
    return coefficients_[static_cast<std::size_t>(power) * size_ + n];
  }
  void set_degree(int degree) { degree_ = degree; }

  [[nodiscard]] double value(double s, std::size_t n) const {
    double sum = at(degree_, n);
    for (int k = degree_ - 1; k >= 0; --k) {
      sum = sum * s + at(k, n);
    }
    return sum;
  }
  /// Moves the origin of time by s0.
  void shift(double s0) {
    for (int i = 0; i < degree_; ++i) {
      for (int k = degree_ - 1; k >= i; --k) {
        for (std::size_t n = 0; n < size_; ++n) {
          at(k, n) += at(k + 1, n) * s0;
        }
      }
    }
  }
  /// Adds the straight line that makes component n start at y0 and leaves its end at h.
  void tilt(std::size_t n, double y0, double h) {
    const double jump = y0 - at(0, n);
    at(0, n) = y0;
    at(1, n) -= jump / h;
  }
  template <int Dim>
  [[nodiscard]] Polynomial<Dim> polynomial(std::size_t offset) const {
    Polynomial<Dim> result;
    result.resize(degree_);
    for (int k = 0; k <= degree_; ++k) {
      for (int axis = 0; axis < Dim; ++axis) {
        result[k][axis] = at(k, offset + static_cast<std::size_t>(axis));
      }
    }
    return result;
  }

 private:
  std::size_t size_ = 0;
  int degree_ = 0;
  std::vector<double> coefficients_;
};

class Cvode final : public Stepper {
 public:
  Cvode(const StepperInfo& info, int method, const StepperOptions& options)
      : info_(info), method_(method), options_(options) {}
  [[nodiscard]] StepperInfo info() const override { return info_; }
  [[nodiscard]] std::int64_t evaluations() const override { return ode_.evaluations(); }

  [[nodiscard]] std::string refuses(const Island& /*island*/) const override {
    if (!sundials::controlled(options_)) {
      return std::string(info_.name) + " chooses its steps itself: it needs finite tolerances";
    }
    return {};
  }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    ode_.layout(island);
    create();
    system_.watch(memory_.get(), states);
    history_.resize(ode_.size());
    current_.resize(ode_.size());
    packed_.assign(ode_.size(), 0.0);
    orientations_.resize(states.size());
    restart(island, t, states);
  }

  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {
    fresh_ = true;
  }

  bool watch(std::shared_ptr<const GapFunction> gaps) override {
    system_.gaps = std::move(gaps);
    return true;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (fresh_ || !(remaining_ > 0.0)) {
      if (!advance_solver(island, t, states)) {
        return {.advanced = 0.0,
                .error = 0.0,
                .ok = false,
                .reason = "CVODE: no step is short enough for the tolerance"};
      }
    }
    // Cut the next piece; no sliver is left over.
    const double piece = h >= remaining_ * (1.0 - 1e-9) && h < remaining_ ? 0.5 * h : h;
    start_ = t;
    h_ = std::min(piece, remaining_);
    for (std::size_t i = 0; i < states.size(); ++i) {
      orientations_[i] = states[i].pose.orientation;
    }
    current_ = history_;
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      packed_[n] = history_.value(h_, n);
    }
    ode_.unpack(packed_.data(), states);
    history_.shift(h_);
    remaining_ -= h_;
    // What a piece ends with is what the next begins with.
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      history_.at(0, n) = packed_[n];
    }
    return {.advanced = h_, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const IslandOde::Slot& slot = ode_.slots()[i];
      Motion& motion = motions[i];
      motion.start = start_;
      motion.duration = h_;
      motion.error_radius = 0.0;
      motion.position = current_.polynomial<3>(slot.offset + IslandOde::position);
      motion.velocity = current_.polynomial<3>(slot.offset + IslandOde::velocity);
      if (slot.rotates) {
        motion.rotation = RotationKind::polynomial;
        motion.quaternion = current_.polynomial<4>(slot.offset + IslandOde::quaternion);
        motion.angular_velocity = current_.polynomial<3>(slot.offset + IslandOde::angular);
      } else {
        fixed_rotation(motion, orientations_[i]);
      }
    }
  }

 private:
  void create() {
    memory_.reset();
    nonlinear_.reset();
    linear_.reset();
    matrix_.reset();
    context_ = sundials::make_context();
    y_ = sundials::make_vector(ode_.size(), context_.get());
    derivative_ = sundials::make_vector(ode_.size(), context_.get());
    N_VConst(0.0, y_.get());
    system_.ode = &ode_;
    memory_.reset(CVodeCreate(method_, context_.get()));
    sundials::silence_cvode(memory_.get());
    CVodeInit(memory_.get(), IslandSystem::rhs, 0.0, y_.get());
    CVodeSetUserData(memory_.get(), system_.self());
    const sundials::Tolerances tolerances(options_, ode_.size());
    CVodeSStolerances(memory_.get(), tolerances.relative, tolerances.absolute);
    if (method_ == CV_ADAMS) {
      nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_.get()));
      CVodeSetNonlinearSolver(memory_.get(), nonlinear_.get());
    } else {
      const auto size = static_cast<sunindextype>(ode_.size());
      matrix_.reset(SUNDenseMatrix(size, size, context_.get()));
      linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_.get()));
      CVodeSetLinearSolver(memory_.get(), linear_.get(), matrix_.get());
    }
  }

  // One step of the solver from t, and its Nordsieck array into `history_`.
  bool advance_solver(const Island& island, Instant t, std::span<const BodyState> states) {
    if (fresh_) {
      epoch_ = system_.epoch = t;
      clock_ = 0.0;
      ode_.bind(island, epoch_);
      ode_.pack(states, sundials::data(y_.get()));
      CVodeReInit(memory_.get(), 0.0, y_.get());
      fresh_ = false;
      ode_.pack(states, packed_.data());
    }
    ode_.bind(island, epoch_);
    sundials::Real reached = clock_;
    const int status = CVode(memory_.get(), clock_ + 1.0, y_.get(), &reached, CV_ONE_STEP);
    const double h = reached - clock_;
    if (status < 0 || !(h > 0.0)) {
      return false;
    }
    copy_nordsieck(reached, h);
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      history_.tilt(n, packed_[n], h);
    }
    clock_ = reached;
    remaining_ = h;
    return true;
  }

  void copy_nordsieck(double reached, double h) {
    int order = 1;
    CVodeGetLastOrder(memory_.get(), &order);
    history_.set_degree(order);
    double factorial = 1.0;
    for (int k = 0; k <= order; ++k) {
      factorial *= k > 0 ? k : 1;
      CVodeGetDky(memory_.get(), reached, k, derivative_.get());
      for (std::size_t n = 0; n < ode_.size(); ++n) {
        history_.at(k, n) = sundials::data(derivative_.get())[n] / factorial;
      }
    }
    history_.shift(-h);
  }

  StepperInfo info_;
  int method_;
  StepperOptions options_;
  IslandOde ode_;
  sundials::Context context_;
  sundials::Vector y_, derivative_;
  sundials::Matrix matrix_;
  sundials::LinearSolver linear_;
  sundials::Owned<SUNNonlinearSolver, FreeNonlinear> nonlinear_;
  WatchedSystem system_;
  std::unique_ptr<void, FreeCvode> memory_;
  History history_;             ///< of the solver's step, from the end of the last piece on
  History current_;             ///< of the last piece
  std::vector<double> packed_;  ///< flat state at the end of the last piece
  std::vector<Quaternion> orientations_;
  Instant epoch_, start_;
  double clock_ = 0.0;      ///< the solver's time since `epoch_`, s
  double remaining_ = 0.0;  ///< of the solver's step, s
  double h_ = 0.0;
  bool fresh_ = true;
};

}  // namespace

std::unique_ptr<Stepper> make_cvode_adams(const StepperOptions& options) {
  return std::make_unique<Cvode>(cvode_adams_info, CV_ADAMS, options);
}
std::unique_ptr<Stepper> make_cvode_bdf(const StepperOptions& options) {
  return std::make_unique<Cvode>(cvode_bdf_info, CV_BDF, options);
}

}  // namespace kairos::integrators
