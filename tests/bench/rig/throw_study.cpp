// A surgeon's first throw, of two turns, in the real suture: tied by fresh operators through the chain.
// Usage: throw_study [operators = 300] [first seed = 1]; prints each miss, and the share that has two turns.
// With one operator, its own seed and the word `moves` it prints the operator's moves: throw_study 1 982743442 moves
// Exit code 3 if fewer than 99 % have two turns.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/operator/knot_tier.hpp"
#include "tests/support/knot_in.hpp"
#include "tests/support/random.hpp"
#include "tests/support/share.hpp"

namespace ligature::lab {
namespace {

/// An operator until it draws its first throw.
class Throwing final : public SeeingOperator {
 public:
  Throwing(sim::KnotTier tier, bool tells) : tier_(std::move(tier)), tells_(tells) {
    start_W_ = {tier_.wish()[0].p_W, tier_.wish()[1].p_W};
  }
  [[nodiscard]] std::array<sim::Vec3, 2> start_W_m() const override { return start_W_; }
  [[nodiscard]] std::array<sim::HandWish, 2> act(const sim::Sight& sight) override {
    const auto& wish = tier_.tick(sight);
    if (const std::string before = std::exchange(move_, tier_.doing()); before != move_) {
      attempts += move_ == "over and through";
      if (tells_) std::printf("%6.2f s  %-18s %s\n", sight.t_s, move_.c_str(), test::knot_in(sight.thread_W).c_str());
      if (move_ == "draw through") knot = test::knot_in(sight.thread_W);
    }
    return wish;
  }
  [[nodiscard]] bool is_done() const override { return knot != "none" || tier_.is_done(); }

  std::string knot = "none";  ///< in the thread when the throw is drawn
  int attempts = 0;

 private:
  sim::KnotTier tier_;
  bool tells_;
  std::string move_;
  std::array<sim::Vec3, 2> start_W_{};
};

}  // namespace
}  // namespace ligature::lab

int main(int argc, char** argv) {
  using namespace ligature;
  using namespace ligature::lab;
  const int operators = argc > 1 ? std::max(1, std::atoi(argv[1])) : 300;
  const auto first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1ULL;
  const bool tells = argc > 3;
  RigSetup setup;
  setup.scene = std::get<scene::Scene>(scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/suture-3-0.toml", {}));
  test::Random random(first);
  int tied = 0, at_once = 0;
  for (int k = 1; k <= operators; ++k) {
    const auto seed = static_cast<std::uint32_t>(tells ? first : random());
    setup.seed = seed;
    Throwing person(std::get<sim::KnotTier>(sim::KnotTier::make(setup.scene, "surgeon", seed)), tells);
    VirtualRig rig(setup, person);
    if (const auto why = rig.run(120'000, true)) return std::printf("%s\n", why->c_str()), 2;
    const bool good = person.knot == "5_1 right";
    tied += good, at_once += good && person.attempts == 1;
    if (!good) std::printf("operator of seed %u: %s after %d attempts\n", seed, person.knot.c_str(), person.attempts);
    if (k % 20 == 0 || k == operators)
      std::printf("two turns: %d of %d, %s %%; %d at the first attempt\n", tied, k, test::share(tied, k).c_str(),
                  at_once);
    std::fflush(stdout);
  }
  return tied >= 0.99 * operators ? 0 : 3;
}
