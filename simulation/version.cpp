#include "simulation/version.hpp"

#include "integrators/catalogue/catalogue.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

namespace kairos {
inline namespace simulation {

std::string_view version() { return KAIROS_VERSION; }

std::vector<std::pair<std::string, std::string>> versions() {
#ifdef __clang__
  constexpr std::string_view compiler = "clang";
#else
  constexpr std::string_view compiler = "gcc";
#endif
  std::vector<std::pair<std::string, std::string>> versions{
      {"kairos", std::string(version())},
      {std::string(compiler), __VERSION__},
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
  const auto solvers = integrators::solver_versions();
  versions.insert(versions.end(), solvers.begin(), solvers.end());
  return versions;
}

}  // namespace simulation
}  // namespace kairos
