#include "experiments/view/viewer_template.hpp"

#include <filesystem>
#include <system_error>

namespace kairos::experiments {

std::string viewer_template() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  // Installed, or in the build tree beside the folder of the program.
  for (const fs::path& folder : {program / KAIROS_INSTALLED_DATA, program / ".."}) {
    const fs::path page = (folder / "studio" / "viewer.html").lexically_normal();
    if (fs::is_regular_file(page, error)) {
      return page.string();
    }
  }
  return "";
}

}  // namespace kairos::experiments
