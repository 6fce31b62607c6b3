// A scene file: any text is either refused with a reason, or a model whose numbers are finite.
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/fuzz/model_check.hpp"

#include <string_view>

using namespace kairos;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    fuzz::check(Model(parse_scene(text, "scene.toml")));
  } catch (const InputError& error) {
    fuzz::require(!error.reason().empty(), "a scene is refused without a reason");
  }
  return 0;
}
