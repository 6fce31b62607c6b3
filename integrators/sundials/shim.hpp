#pragma once

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_version.h>

#include <memory>

/// What differs between versions of SUNDIALS, in one place: the type of a number and of a
/// communicator, how chatter on stderr is switched off, and a defect of ERKStep. The paths of 7
/// follow its release notes and are unverified where the distribution has no 7. To be included by
/// .cpp files only.
namespace kairos::integrators::sundials {

#if SUNDIALS_VERSION_MAJOR >= 7
using Real = sunrealtype;
#else
using Real = realtype;
#endif

template <typename Handle, typename Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

struct FreeContext {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
using Context = Owned<SUNContext, FreeContext>;

/// A context of one stepper's own: steppers of different threads share nothing.
inline Context make_context() {
  SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_Create(SUN_COMM_NULL, &context);
  SUNContext_ClearErrHandlers(context);
#else
  SUNContext_Create(nullptr, &context);
#endif
  return Context(context);
}

struct FreeVector {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
using Vector = Owned<N_Vector, FreeVector>;
struct FreeMatrix {
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
};
using Matrix = Owned<SUNMatrix, FreeMatrix>;
struct FreeLinearSolver {
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
using LinearSolver = Owned<SUNLinearSolver, FreeLinearSolver>;

inline Vector make_vector(std::size_t size, SUNContext context) {
  return Vector(N_VNew_Serial(static_cast<sunindextype>(size), context));
}
inline double* data(N_Vector vector) { return N_VGetArrayPointer(vector); }

/// Failures are told by return values: solvers say nothing on stderr (7: see `make_context`).
#if SUNDIALS_VERSION_MAJOR >= 7
inline void silence_cvode(void* /*solver*/) {}
inline void silence_erkstep(void* /*solver*/) {}
#else
inline void ignore_message(int, const char*, const char*, char*, void*) {}
inline void silence_cvode(void* solver) { CVodeSetErrHandlerFn(solver, ignore_message, nullptr); }
inline void silence_erkstep(void* solver) {
  ERKStepSetErrHandlerFn(solver, ignore_message, nullptr);
}
#endif

/// Before 6.6 ERKStep takes the last stage of every table that ends at c = 1 for y' at the end of
/// the step, which is true of first-same-as-last tables only. Cf. issue 311 of SUNDIALS.
inline constexpr bool erkstep_reuses_last_stage =
    SUNDIALS_VERSION_MAJOR < 6 || (SUNDIALS_VERSION_MAJOR == 6 && SUNDIALS_VERSION_MINOR < 6);

}  // namespace kairos::integrators::sundials
