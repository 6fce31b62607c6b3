#include "integrators/catalogue/catalogue.hpp"

#include "integrators/closed_form.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/euler.hpp"
#ifdef KAIROS_WITH_GSL
#include "integrators/gsl/gsl_steppers.hpp"
#endif
#include "integrators/lie_group.hpp"
#include "integrators/runge_kutta_4.hpp"
#include "integrators/splitting.hpp"
#ifdef KAIROS_WITH_SUNDIALS
#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/cvode.hpp"
#endif
#include "integrators/velocity_verlet.hpp"

#ifdef KAIROS_WITH_GSL
#include <gsl/gsl_version.h>
#endif
#ifdef KAIROS_WITH_SUNDIALS
#include <sundials/sundials_version.h>
#endif

namespace kairos::integrators {

std::span<const CatalogueEntry> catalogue() {
  static const CatalogueEntry entries[] = {
      {thesis_euler_info, make_thesis_euler},
      {explicit_euler_info, make_explicit_euler},
      {symplectic_euler_info, make_symplectic_euler},
      {velocity_verlet_info, make_velocity_verlet},
      {rk4_info, make_rk4},
      {dopri5_info, make_dopri5},
      {forest_ruth_info, make_forest_ruth},
      {suzuki4_info, make_suzuki4},
      {rkmk4_info, make_rkmk4},
      {free_top_splitting_info, make_free_top_splitting},
      {closed_form_info, make_closed_form},
#ifdef KAIROS_WITH_GSL
      {gsl_rkf45_info, make_gsl_rkf45},
      {gsl_rkck_info, make_gsl_rkck},
      {gsl_rk8pd_info, make_gsl_rk8pd},
      {gsl_msadams_info, make_gsl_msadams},
      {gsl_bsimp_info, make_gsl_bsimp},
#endif
#ifdef KAIROS_WITH_SUNDIALS
      {cvode_adams_info, make_cvode_adams},
      {cvode_bdf_info, make_cvode_bdf},
      {arkode_info("arkode-2", 2), make_arkode_2},
      {arkode_info("arkode-3", 3), make_arkode_3},
      {arkode_info("arkode-4", 4), make_arkode_4},
      {arkode_info("arkode-5", 5), make_arkode_5},
      {arkode_info("arkode-6", 6), make_arkode_6},
      {arkode_info("arkode-8", 8), make_arkode_8},
#endif
  };
  return entries;
}

std::vector<std::pair<std::string, std::string>> solver_versions() {
  std::vector<std::pair<std::string, std::string>> versions;
#ifdef KAIROS_WITH_GSL
  versions.emplace_back("gsl", gsl_version);
#endif
#ifdef KAIROS_WITH_SUNDIALS
  char sundials[32] = "";
  SUNDIALSGetVersion(sundials, sizeof sundials);
  versions.emplace_back("sundials", sundials);
#endif
  return versions;
}

}  // namespace kairos::integrators
