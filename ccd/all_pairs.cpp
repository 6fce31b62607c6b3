#include "ccd/all_pairs.hpp"

namespace kairos::ccd {
namespace {

class AllPairs final : public BroadPhase {
 public:
  explicit AllPairs(std::size_t bodies) : registered_(bodies, false) {}

  [[nodiscard]] std::string_view name() const override { return "all-pairs"; }
  void update(BodyIndex body, const Aabb&) override { registered_[body] = true; }
  void candidates(BodyIndex body, std::vector<BodyIndex>& out) const override {
    for (BodyIndex other = 0; other < registered_.size(); ++other) {
      if (other != body && registered_[other]) {
        out.push_back(other);
      }
    }
  }

  void overlapping(const Aabb&, std::vector<BodyIndex>& out) const override {
    candidates(registered_.size(), out);
  }
  void remove(BodyIndex body) override { registered_[body] = false; }

 private:
  std::vector<bool> registered_;
};

}  // namespace

std::unique_ptr<BroadPhase> make_all_pairs(std::size_t bodies) {
  return std::make_unique<AllPairs>(bodies);
}

}  // namespace kairos::ccd
