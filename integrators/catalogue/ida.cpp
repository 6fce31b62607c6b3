#include "integrators/catalogue/ida.hpp"

#ifdef KAIROS_WITH_IDA
#include "integrators/sundials/ida_stepper.hpp"
#endif

namespace kairos::integrators {

#ifdef KAIROS_WITH_IDA
std::unique_ptr<Stepper> make_ida(const StepperOptions& options) {
  return sundials::make_ida_stepper(options);
}
#else
std::unique_ptr<Stepper> make_ida(const StepperOptions& /*options*/) { return nullptr; }
#endif

}  // namespace kairos::integrators
