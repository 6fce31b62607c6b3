// A mesh as OBJ.
#include "tests/fuzz/mesh_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kairos::fuzz::check_mesh_file({reinterpret_cast<const char*>(data), size}, "model.obj");
  return 0;
}
