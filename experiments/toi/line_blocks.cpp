#include "experiments/toi/line_blocks.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace kairos::experiments {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;
constexpr std::size_t longest_line = std::size_t{1} << 24;

}  // namespace

LineBlocks::LineBlocks(const std::string& path)
    : name_(path == "-" ? "stdin" : path),
      file_(path == "-" ? stdin : std::fopen(path.c_str(), "rb")) {
  if (file_ == nullptr) {
    throw InputError(name_, 0, "", std::string("cannot be read: ") + std::strerror(errno));
  }
}

LineBlocks::~LineBlocks() {
  if (file_ != stdin) {
    std::fclose(file_);
  }
}

bool LineBlocks::fill(std::string& block) {
  const std::size_t before = block.size();
  block.resize(before + block_size);
  const std::size_t count = std::fread(block.data() + before, 1, block_size, file_);
  block.resize(before + count);
  if (std::ferror(file_) != 0) {
    throw InputError(name_, 0, "", std::string("cannot be read: ") + std::strerror(errno));
  }
  return count > 0;
}

bool LineBlocks::next(std::string& block, std::int64_t& first_line) {
  block.clear();
  std::swap(block, rest_);
  std::size_t end = std::string::npos;
  while (end == std::string::npos) {
    const std::size_t before = block.size();
    if (!fill(block)) {
      break;  // the last line may have no line break
    }
    end = block.rfind('\n');
    if (end != std::string::npos && end < before) {
      end = std::string::npos;
    }
    if (end == std::string::npos && block.size() > longest_line) {
      throw InputError(name_, static_cast<int>(line_), "", "is longer than 16 MiB");
    }
  }
  if (end != std::string::npos) {
    rest_.assign(block, end + 1);
    block.resize(end + 1);
  }
  first_line = line_;
  line_ += std::count(block.begin(), block.end(), '\n');
  return !block.empty();
}

}  // namespace kairos::experiments
