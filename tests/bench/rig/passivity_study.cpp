// Attacks the passivity controller with hand motions and frame losses, drawn at random or optimised, and checks the
// bounds on the account's error and on the energy that the motors give (docs/passivity.md). Prints the table of
// docs/measurements/passivity.md. Usage: passivity_study [draws = 10000] [optimised attacks = 200] [optimiser steps =
// 1000] [first seed = 1] Exit code 3 when a bound was broken.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "tests/support/share.hpp"
#include "tests/unit/control/passivity_hands.hpp"

namespace ligature::control {
namespace {

struct Case {
  const char* name;
  double wildness, count_m;
  bool loses;
};
constexpr std::array<Case, 8> kCases{{{"exact", 0.4, 0.0, false},
                                      {"exact", 1.0, 0.0, false},
                                      {"counts", 0.4, 5e-5, false},
                                      {"counts", 1.0, 5e-5, false},
                                      {"losses", 0.4, 0.0, true},
                                      {"losses", 1.0, 0.0, true},
                                      {"losses, counts", 0.4, 5e-5, true},
                                      {"losses, counts", 1.0, 5e-5, true}}};
constexpr int kDrawTicks = 1000, kClimbTicks = 200;

struct Worst {
  double above_J = -1.0, below_J = -1.0, work_below_J = -1.0;  // excess over each bound; positive: broken
  double above_ceiling_J = -1.0;
  double work_J = 0.0, its_bound_J = -Passivity::kFloor_J;  // lowest work of all runs, and its bound at that time
  double beyond_J = 0.0, its_ceiling_J = 0.0;
  double over_J = 0.0, of_bound = 0.0;
  int runs = 0, in_debt = 0, let_go = 0;
  void take(const Port& port) {
    const PassivityBounds& b = port.bounds;
    above_J = std::max(above_J, b.above_J), below_J = std::max(below_J, b.below_J);
    work_below_J = std::max(work_below_J, b.work_below_J);
    above_ceiling_J = std::max(above_ceiling_J, b.above_ceiling_J);
    if (b.lowest_work_J < work_J) work_J = b.lowest_work_J, its_bound_J = b.its_bound_J;
    if (b.most_beyond_J > beyond_J) beyond_J = b.most_beyond_J, its_ceiling_J = b.its_ceiling_J;
    over_J = std::max(over_J, port.largest_excess_J);
    of_bound = std::max(of_bound, port.largest_excess_J / std::max(b.hidden_J() + b.unseen_J(), 1e-6));
    ++runs, in_debt += port.lowest_work_J<-Passivity::kFloor_J, let_go += port.released> 0;
  }
  [[nodiscard]] bool broken() const { return std::max({above_J, below_J, work_below_J, above_ceiling_J}) > kExact_J; }
};

void print(const Case& c, const Worst& w) {
  std::printf("| %s | %.1f | %d | %s | %.2g | %.2g | %.2g | %.2g | %s | %.2g | %.2f | %s |\n", c.name, c.wildness,
              w.runs, w.broken() ? "BROKEN" : "none", 1e6 * w.work_J, 1e6 * w.its_bound_J, 1e6 * w.beyond_J,
              1e6 * w.its_ceiling_J, test::share(w.in_debt, w.runs).c_str(), 1e6 * w.over_J, w.of_bound,
              test::share(w.let_go, w.runs).c_str());
  std::fflush(stdout);
}
void print_head() {
  std::printf(
      "| chain | hand | runs | bounds broken | least work, uJ | its bound, uJ | most beyond, uJ | its ceiling, uJ | "
      "runs below -1 uJ, %% | account above work, uJ | share of its bound | let go, %% "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

bool draw(int draws, test::Random& random) {
  bool sound = true;
  print_head();
  for (const Case& c : kCases) {
    Worst w;
    for (int k = 0; k < draws / static_cast<int>(kCases.size()); ++k)
      w.take(Attacker::drawn(random, c.wildness, c.count_m, c.loses).run(kDrawTicks));
    print(c, w);
    sound = sound && !w.broken();
  }
  return sound;
}

/// Optimises attacks. Each quarter of the attacks seeks one maximum: the most energy from the motors, the largest
/// excess of the account over the true work, the largest violation of the account's lower bound, and the largest term
/// "beyond".
bool climb_all(int hands, int steps, test::Random& random) {
  bool sound = true;
  std::printf("\n");
  print_head();
  for (const Case& c : kCases) {
    Worst w;
    for (int k = 0; k < hands / static_cast<int>(kCases.size()); ++k) {
      const Attacker first = Attacker::drawn(random, c.wildness, c.count_m, c.loses);
      (void)climb(first, steps, kClimbTicks, random, [&](const Port& port) {
        w.take(port);
        return k % 4 == 0   ? -port.lowest_work_J
               : k % 4 == 1 ? port.largest_excess_J
               : k % 4 == 2 ? port.bounds.below_J
                            : port.bounds.most_beyond_J;
      });
    }
    print(c, w);
    sound = sound && !w.broken();
  }
  return sound;
}

}  // namespace
}  // namespace ligature::control

int main(int argc, char** argv) {
  using namespace ligature;
  const auto number = [&](int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; };
  test::Random random(static_cast<std::uint64_t>(number(4, 1)));
  const bool drawn = control::draw(number(1, 10'000), random);
  const bool climbed = control::climb_all(number(2, 200), number(3, 1000), random);
  return drawn && climbed ? 0 : 3;
}
