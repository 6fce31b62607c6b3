#include "integrators/sundials/ida_stepper.hpp"

#include "core/joint_system.hpp"
#include "integrators/dense_output.hpp"
#include "integrators/sundials/cvode.hpp"
#include "integrators/sundials/island_system.hpp"

#include <ida/ida.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <vector>

namespace kairos::integrators::sundials {
namespace {

struct FreeIda {
  void operator()(void* memory) const { IDAFree(&memory); }
};

void silence(void* solver) {
#if SUNDIALS_VERSION_MAJOR >= 7
  (void)solver;  // its context is silent
#else
  IDASetErrHandlerFn(solver, ignore_message, nullptr);
#endif
}

/// An island with joints as F(t, y, y') = 0; y is what an `IslandOde` has, then l, then m.
struct ConstrainedSystem {
  Island applied;  ///< all forces but those of the joints
  const JointSystem* joints = nullptr;
  IslandOde ode;
  Instant epoch;
  std::vector<BodyState> states;
  std::vector<Wrench> wrenches;
  std::vector<double> rate;

  void layout(const Island& island) {
    bind(island);
    ode.layout(island);
    states.assign(island.bodies.size(), {});
    wrenches.assign(island.bodies.size(), {});
    rate.assign(ode.size(), 0.0);
  }
  void bind(const Island& island) {
    applied = island;
    applied.forces.pop_back();
    joints = island.joints;
  }
  [[nodiscard]] std::size_t size() const { return ode.size() + 2 * joints->rows(); }

  /// y' of the differential part, for multipliers l and m.
  void differential_rate(Instant t, const double* y, std::span<const double> l,
                         std::span<const double> m) {
    applied.wrenches(t, states, wrenches);
    joints->react(t, states, l, wrenches);
    ode.rate(applied, states, wrenches, rate.data());
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    joints->react(t, states, m, wrenches);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const IslandOde::Slot& slot = ode.slots()[k];
      const BodyInertia& inertia = applied.inertia[k];
      Eigen::Map<Vector3>(rate.data() + slot.offset + IslandOde::position) +=
          wrenches[k].force / inertia.mass;
      if (slot.rotates) {
        const Vector3 turn = inertia.inverse(states[k].pose.orientation, wrenches[k].torque);
        // Linear in the quaternion as it is, not as normalised for the forces.
        const std::size_t at = slot.offset + IslandOde::quaternion;
        Eigen::Map<Vector4>(rate.data() + at) =
            quaternion_rate(states[k].twist.angular + turn, Eigen::Map<const Vector4>(y + at));
      }
    }
  }

  static int residual(Real t, N_Vector y_vector, N_Vector rate_vector, N_Vector out, void* self) {
    auto& system = *static_cast<ConstrainedSystem*>(self);
    const double* y = data(y_vector);
    const double* y_rate = data(rate_vector);
    double* F = data(out);
    const std::size_t n = system.ode.size();
    const std::size_t rows = system.joints->rows();
    const Instant now = system.epoch + t;
    system.ode.unpack(y, system.states);
    system.differential_rate(now, y, {y + n, rows}, {y + n + rows, rows});
    for (std::size_t k = 0; k < n; ++k) {
      F[k] = y_rate[k] - system.rate[k];
    }
    system.joints->residuals(now, system.states, {F + n + rows, rows}, {F + n, rows});
    return 0;
  }
};

class Ida final : public Stepper {
 public:
  explicit Ida(const StepperOptions& options) : options_(options) {}

  [[nodiscard]] StepperInfo info() const override {
    StepperInfo info = cvode_bdf_info;  // the same formulas, on a system with constraints
    info.name = "ida";
    return info;
  }
  [[nodiscard]] bool holds_joints() const override { return true; }
  [[nodiscard]] std::int64_t evaluations() const override { return evaluations_ + counted(); }

  [[nodiscard]] std::string refuses(const Island& island) const override {
    if (island.joints == nullptr) {
      return "ida is for islands with joints; without them its equations are those of cvode-bdf";
    }
    return controlled(options_) ? "" : "ida chooses its steps itself: it needs finite tolerances";
  }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    system_.layout(island);
    regular_ = island.joints->rank(t, states) == island.joints->rows();
    create();
    restart(island, t, states);
  }
  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {
    fresh_ = true;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    const auto failed = [](std::string_view reason) {
      return StepResult{.advanced = 0.0, .error = 0.0, .ok = false, .reason = reason};
    };
    if (!regular_) {
      return failed("ida: joints depend on each other, and its matrix is singular");
    }
    system_.bind(island);
    if (fresh_) {
      begin(island, t, states);
    }
    before_.assign(states.begin(), states.end());
    Real reached = clock_;
    IDASetStopTime(memory_.get(), clock_ + h);
    const int status =
        IDASolve(memory_.get(), clock_ + h, &reached, y_.get(), rate_.get(), IDA_ONE_STEP);
    h_ = reached - clock_;
    if (status < 0 || !(h_ > 0.0)) {
      return failed("ida: no step is short enough for the tolerance");
    }
    start_ = t;
    clock_ = reached;
    read_history(reached);
    system_.ode.unpack(data(y_.get()), states);
    return {.advanced = h_, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const IslandOde::Slot& slot = system_.ode.slots()[k];
      Motion& motion = motions[k];
      motion.start = start_;
      motion.duration = h_;
      motion.error_radius = 0.0;
      motion.position = polynomial<3>(slot.offset + IslandOde::position);
      motion.position[0] = before_[k].pose.position;
      motion.velocity = polynomial<3>(slot.offset + IslandOde::velocity);
      if (slot.rotates) {
        motion.rotation = RotationKind::polynomial;
        motion.quaternion = polynomial<4>(slot.offset + IslandOde::quaternion);
        motion.angular_velocity = polynomial<3>(slot.offset + IslandOde::angular);
      } else {
        fixed_rotation(motion, before_[k].pose.orientation);
      }
    }
  }

 private:
  void create() {
    evaluations_ += counted();
    memory_.reset();
    linear_.reset();
    matrix_.reset();
    context_ = make_context();
    const std::size_t size = system_.size();
    y_ = make_vector(size, context_.get());
    rate_ = make_vector(size, context_.get());
    kind_ = make_vector(size, context_.get());
    derivative_ = make_vector(size, context_.get());
    N_VConst(0.0, y_.get());
    N_VConst(0.0, rate_.get());
    for (std::size_t k = 0; k < size; ++k) {
      data(kind_.get())[k] = k < system_.ode.size() ? 1.0 : 0.0;
    }
    memory_.reset(IDACreate(context_.get()));
    silence(memory_.get());
    IDAInit(memory_.get(), ConstrainedSystem::residual, 0.0, y_.get(), rate_.get());
    IDASetUserData(memory_.get(), &system_);
    const Tolerances tolerances(options_, system_.ode.size());
    IDASStolerances(memory_.get(), tolerances.relative, tolerances.absolute);
    const auto n = static_cast<sunindextype>(size);
    matrix_.reset(SUNDenseMatrix(n, n, context_.get()));
    linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_.get()));
    IDASetLinearSolver(memory_.get(), linear_.get(), matrix_.get());
    IDASetId(memory_.get(), kind_.get());
    IDASetSuppressAlg(memory_.get(), 1);  // multipliers of index 2 are no part of the error test
  }

  /// Consistent values: the multipliers that the index-reduced equations have, and no m.
  void begin(const Island& island, Instant t, std::span<const BodyState> states) {
    system_.epoch = t;
    clock_ = 0.0;
    double* y = data(y_.get());
    const std::size_t n = system_.ode.size();
    const std::size_t rows = system_.joints->rows();
    N_VConst(0.0, y_.get());
    N_VConst(0.0, rate_.get());
    system_.ode.pack(states, y);
    system_.applied.wrenches(t, states, system_.wrenches);
    island.joints->multipliers(t, states, system_.wrenches, {y + n, rows});
    std::copy(states.begin(), states.end(), system_.states.begin());
    system_.differential_rate(t, y, {y + n, rows}, {y + n + rows, rows});
    std::copy(system_.rate.begin(), system_.rate.end(), data(rate_.get()));
    evaluations_ += counted();
    IDAReInit(memory_.get(), 0.0, y_.get(), rate_.get());
    fresh_ = false;
  }

  /// The solver's interpolant of its last step, in powers of the time since the step began.
  void read_history(double reached) {
    int order = 1;
    IDAGetLastOrder(memory_.get(), &order);
    degree_ = order;
    history_.assign(static_cast<std::size_t>(order + 1), std::vector<double>(system_.ode.size()));
    double factorial = 1.0;
    for (int k = 0; k <= order; ++k) {
      factorial *= k > 0 ? k : 1;
      IDAGetDky(memory_.get(), reached, k, derivative_.get());
      for (std::size_t n = 0; n < system_.ode.size(); ++n) {
        history_[static_cast<std::size_t>(k)][n] = data(derivative_.get())[n] / factorial;
      }
    }
    for (int i = 0; i < order; ++i) {
      for (int k = order - 1; k >= i; --k) {
        auto& lower = history_[static_cast<std::size_t>(k)];
        const auto& upper = history_[static_cast<std::size_t>(k + 1)];
        for (std::size_t n = 0; n < lower.size(); ++n) {
          lower[n] -= upper[n] * h_;
        }
      }
    }
  }

  template <int Dim>
  [[nodiscard]] Polynomial<Dim> polynomial(std::size_t offset) const {
    Polynomial<Dim> result;
    result.resize(degree_);
    for (int k = 0; k <= degree_; ++k) {
      for (int axis = 0; axis < Dim; ++axis) {
        result[k][axis] =
            history_[static_cast<std::size_t>(k)][offset + static_cast<std::size_t>(axis)];
      }
    }
    return result;
  }

  [[nodiscard]] std::int64_t counted() const {
    long residuals = 0;
    long of_jacobians = 0;
    if (memory_ != nullptr) {
      IDAGetNumResEvals(memory_.get(), &residuals);
      IDAGetNumLinResEvals(memory_.get(), &of_jacobians);
    }
    return residuals + of_jacobians;
  }

  StepperOptions options_;
  ConstrainedSystem system_;
  Context context_;
  Vector y_, rate_, kind_, derivative_;
  Matrix matrix_;
  LinearSolver linear_;
  std::unique_ptr<void, FreeIda> memory_;
  std::vector<std::vector<double>> history_;
  std::vector<BodyState> before_;
  int degree_ = 0;
  Instant start_;
  double clock_ = 0.0;  ///< the solver's time since `epoch`, s
  double h_ = 0.0;
  std::int64_t evaluations_ = 0;  ///< of solvers that are gone
  bool fresh_ = true;
  bool regular_ = true;
};

}  // namespace

std::unique_ptr<Stepper> make_ida_stepper(const StepperOptions& options) {
  return std::make_unique<Ida>(options);
}

}  // namespace kairos::integrators::sundials
