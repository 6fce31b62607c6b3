#include "integrators/catalogue.hpp"

#include "integrators/closed_form.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/euler.hpp"
#ifdef KAIROS_WITH_GSL
#include "integrators/gsl/gsl_steppers.hpp"
#endif
#include "integrators/lie_group.hpp"
#include "integrators/runge_kutta_4.hpp"
#include "integrators/splitting.hpp"
#include "integrators/velocity_verlet.hpp"

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
  };
  return entries;
}

}  // namespace kairos::integrators
