#include "tests/integration/virtual_rig/bad_bus.hpp"

#include <algorithm>
#include <stdexcept>

#include "tests/integration/virtual_rig/attack.hpp"

namespace ligature {
namespace {

scene::FaultScript wrong_bits(double share, std::uint64_t seed) {
  scene::FaultScript script;
  script.kind = scene::FaultKind::kCorrupt;
  script.from_s = 1e-3 * static_cast<double>(kBadBusOnset);
  script.share = share;
  script.seed = static_cast<int>(seed % 1'000'000'007U);
  return script;
}

}  // namespace

BadBusEnd end_of(const BadBus& bus, std::uint64_t seed) {
  AttackPlan plan = AttackPlan::pulls(seed);
  plan.jumps = false;  // jumps of 3 cm would cause velocity faults
  AttackedRig attacked(plan);
  lab::VirtualRig& rig = attacked.rig;
  lab::DeviceBus* const hands[] = {bus.left ? &rig.left : nullptr, bus.right ? &rig.right : nullptr};
  for (auto* hand : hands)
    if (hand != nullptr && bus.wrong > 0.0) hand->faults.emplace(wrong_bits(bus.wrong, ++seed));
  rig.each_tick = [&] {
    if (rig.cycle.periods() != kBadBusOnset) return;
    for (auto* hand : hands)
      if (hand != nullptr) hand->lose_frames(bus.lost, ++seed);
  };
  if (const auto why = rig.run(kBadBusOnset + bus.ticks)) throw std::runtime_error(*why);

  BadBusEnd end;
  for (const auto& r : rig.records) {
    if (r.tick >= kBadBusOnset + bus.ticks) break;  // the run is being shut down
    if (end.fault == 0 && r.fault != 0) end.fault = r.fault, end.to_fault = r.tick - kBadBusOnset;
    const bool sent = std::ranges::any_of(
        r.torque_permille, [](const auto& hand) { return std::ranges::any_of(hand, [](auto t) { return t != 0; }); });
    end.pushed_after = end.pushed_after || (end.fault != 0 && sent);
  }
  const std::size_t until = std::min(rig.drives_push.size(), static_cast<std::size_t>(kBadBusOnset + bus.ticks));
  for (auto tick = static_cast<std::size_t>(kBadBusOnset); tick < until; ++tick)
    if (rig.drives_push[tick]) end.to_zero = static_cast<std::int64_t>(tick) - kBadBusOnset;
  for (const auto& watch : rig.truth)
    for (auto i = static_cast<std::size_t>(kBadBusOnset); i < watch.tips().size(); ++i)
      end.peak_N = std::max(end.peak_N, watch.tips()[i].f_N.norm());
  return end;
}

WrongEncoderEnd end_of(const WrongEncoder& encoder, std::uint64_t seed) {
  constexpr std::size_t kFrom = 1000;  // both hands pull
  test::Random random(seed);
  AttackPlan plan = AttackPlan::pulls(random());
  plan.jumps = false;  // jumps of 3 cm would cause velocity faults
  scene::FaultScript script;
  script.kind = encoder.kind;
  script.node = encoder.node;
  script.counts = encoder.counts;
  script.from_s = random.in(1.1, 1.6);
  if (encoder.node > 0) plan.faults[0] = script;
  AttackedRig attacked(plan);
  if (const auto why = attacked.run()) throw std::runtime_error(*why);

  WrongEncoderEnd end;
  for (const auto& r : attacked.rig.records)
    if (end.fault == 0) end.fault = r.fault;
  const auto& tips = attacked.rig.truth[0].tips();
  for (std::size_t i = kFrom; i < tips.size(); ++i) {
    end.peak_N = std::max(end.peak_N, tips[i].f_N.norm());
    if (!tips[i].f_N.isZero(0.0)) end.step_N = std::max(end.step_N, tips[i].step_N);
  }
  return end;
}

std::int64_t ticks_to_zero_at(double frames_lost) {
  constexpr std::int64_t kWay =
      25;  // time until the torque is off: the next SYNC, or the drive's watchdog if it receives nothing
  if (frames_lost >= 0.5) return 65 + kWay;
  if (frames_lost >= 0.25) return 220 + kWay;
  if (frames_lost >= 0.2) return 430 + kWay;
  return frames_lost >= 0.15 ? 2100 + kWay : 0;
}

}  // namespace ligature
