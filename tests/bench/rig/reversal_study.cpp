// One axis of a pulling hand starts to count backwards at a random moment: which check detects it, and the energy that
// the motors deliver until then. Usage: reversal_study [draws = 1000] [first seed = 1]; prints a table of
// docs/measurements/encoder-watch.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/integration/virtual_rig/attack.hpp"
#include "tests/support/share.hpp"

namespace ligature {
namespace {

constexpr std::int64_t kLookTicks = 500;

struct End {
  int fault = 0;
  double speed = 0.0;    ///< joint speed when it starts to count backwards, counts per period
  double given_J = 0.0;  ///< largest energy that the hand's motors have delivered since the onset
  double peak_N = 0.0;
};

End end_of(std::uint64_t seed, bool reverses) {
  test::Random random(seed);
  AttackPlan plan = AttackPlan::pulls(random());
  plan.jumps = false;
  scene::FaultScript fault;
  fault.kind = scene::FaultKind::kReverse;
  fault.node = static_cast<int>(random.any(1, 3));
  const std::int64_t onset = random.any(1000, 1600);
  fault.from_s = 1e-3 * static_cast<double>(onset);
  if (reverses) plan.faults[0] = fault;
  AttackedRig attacked(plan);
  lab::VirtualRig& rig = attacked.rig;
  End end;
  const auto joint = static_cast<Eigen::Index>(fault.node - 1);
  sim::Vec3 before_rad = sim::Vec3::Zero();
  double given_J = 0.0;
  rig.each_tick = [&] {
    const sim::Mechanics& arm = rig.left.device.mechanics();
    const sim::Vec3 q_rad = arm.plant().q_rad(), turned_rad = q_rad - before_rad;
    const std::int64_t tick = rig.cycle.periods();
    if (tick == onset) end.speed = std::abs(turned_rad[joint]) / rig.setup.device.rad_per_count();
    if (tick > onset) given_J += arm.made_Nm().dot(turned_rad);
    end.given_J = std::max(end.given_J, given_J);
    before_rad = q_rad;
  };
  if (rig.run(onset + kLookTicks)) return end;
  for (const auto& r : rig.records)
    if (end.fault == 0 && r.tick < onset + kLookTicks) end.fault = r.fault;
  const auto& tips = rig.truth[0].tips();
  for (auto i = static_cast<std::size_t>(onset); i < tips.size(); ++i)
    end.peak_N = std::max(end.peak_N, tips[i].f_N.norm());
  return end;
}

struct Row {
  const char* name;
  std::vector<double> given_J;
  double peak_N = 0.0;
  int reversed = 0, others = 0, none = 0;
  void take(const End& end) {
    given_J.push_back(end.given_J);
    peak_N = std::max(peak_N, end.peak_N);
    ++(end.fault == 23 ? reversed : end.fault != 0 ? others : none);
  }
  void print() {
    std::ranges::sort(given_J);
    const auto n = given_J.size();
    if (n == 0) return;
    const int draws = static_cast<int>(n);
    std::printf("| %s | %d | %s | %s | %s | %.2f | %.2f | %.2f | %.2f |\n", name, draws,
                test::share(reversed, draws).c_str(), test::share(others, draws).c_str(),
                test::share(none, draws).c_str(), 1e3 * given_J[n / 2], 1e3 * given_J[n - 1 - n / 100],
                1e3 * given_J.back(), peak_N);
  }
};

}  // namespace
}  // namespace ligature

int main(int argc, char** argv) {
  using namespace ligature;
  const int draws = argc > 1 ? std::atoi(argv[1]) : 1000;
  const auto seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1ULL;
  std::array<Row, 4> rows{
      {{"slower than 0.44", {}}, {"0.44 to 0.85", {}}, {"faster", {}}, {"none counts backwards", {}}}};
  for (int k = 0; k < draws; ++k) {
    const End end = end_of(seed + static_cast<std::uint64_t>(k), true);
    rows[end.speed < 0.44 ? 0 : end.speed < 0.85 ? 1 : 2].take(end);
    rows[3].take(end_of(seed + static_cast<std::uint64_t>(k), false));
  }
  std::printf(
      "| speed at the onset, counts a period | draws | 23, %% | other faults, %% | none, %% | given, median, mJ | 99 "
      "%% "
      "| most | true force, N |\n|---|---|---|---|---|---|---|---|---|\n");
  for (Row& row : rows) row.print();
}
