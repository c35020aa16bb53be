#include "host/lab/tie/play_once.hpp"

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/lab/rehearsal.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "host/lab/tie/recordings.hpp"
#include "sim_device/operator/knot_tier.hpp"
#include "sim_device/unrest.hpp"

namespace ligature::lab {
namespace {

constexpr double kWatched_s = 5.0;  // duration of the run after the last key
constexpr double kLongestStall_ticks = 10.0;

/// Delays the motion of a hand by `late_s`.
class Late final : public sim::Intention {
 public:
  Late(std::unique_ptr<sim::Intention> hand, double late_s) : hand_(std::move(hand)), late_s_(late_s) {}
  [[nodiscard]] sim::Intent at(double t_s, const sim::Touch& touch) const noexcept override {
    return hand_->at(t_s - late_s_, touch);
  }
  [[nodiscard]] double end_s() const noexcept override { return hand_->end_s() + late_s_; }
  [[nodiscard]] sim::Vec3 start_D_m() const noexcept override { return hand_->start_D_m(); }

 private:
  std::unique_ptr<sim::Intention> hand_;
  double late_s_;
};

VirtualRig::Intentions troubled(VirtualRig::Intentions hands, const Trouble& t, sim::Dice& dice, std::uint32_t seed) {
  for (std::uint32_t h = 0; h < 2; ++h) {
    const double tremor_Hz = dice.between(8.0, 12.0);
    hands[h] = std::make_unique<sim::Trembling>(std::move(hands[h]), 1e-3 * t.tremor_mm, tremor_Hz, 2 * seed + h);
  }
  const std::size_t later = dice.between(0.0, 1.0) < 0.5 ? 0 : 1;
  hands[later] = std::make_unique<Late>(std::move(hands[later]), 1e-3 * t.late_ms * dice.between(0.0, 1.0));
  return hands;
}

}  // namespace

Played play_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
                 const scene::GripperScript& script, const Trouble& trouble, std::uint32_t seed,
                 const std::filesystem::path& recording) {
  sim::Dice dice(seed);
  RigSetup setup;
  setup.scene = scene;
  setup.seed = seed;
  setup.frame_loss = trouble.frame_loss;
  setup.scene_file = scene_file;
  setup.scene_toml = scene_toml + "\n# seed " + std::to_string(seed);
  std::optional<UnfinishedRecording> unfinished;
  VirtualRig rig(setup, troubled(scripted_hands(setup, script), trouble, dice, seed));
  if (rig.thread.work() > 0)
    rig.thread.set_work(static_cast<long>(trouble.work_share * static_cast<double>(rig.thread.work())));
  rig.each_tick = [&rig, &dice, share = trouble.lost_share] {
    const double mean_ticks = 0.5 * (1.0 + kLongestStall_ticks);
    if (dice.between(0.0, 1.0) >= share / mean_ticks) return;
    rig.stall_for = rt::kPeriod * (1 + static_cast<int>(dice.between(0.0, kLongestStall_ticks)));
  };
  if (!recording.empty()) {
    unfinished.emplace(recording);
    rig.record(unfinished->part());
  }
  const double end_s = scene::end_time_s(script) + kWatched_s;
  if (const auto why = rig.run(static_cast<std::int64_t>(1e3 * end_s)))
    throw std::runtime_error("the rig did not start: " + *why);
  if (unfinished) unfinished->finish();
  Played played;
  played.seconds = 1e-3 * static_cast<double>(rig.records.size());
  for (const rt::TickRecord& r : rig.records) {
    played.periods_lost += (r.flags & rt::kPeriodLost) != 0;
    played.stood_still_s += 1e-3 * static_cast<double>(r.time_lost);
    if (r.fault != 0) played.fault = r.fault;
  }
  const auto knot = knot_of(rig.thread);
  played.found = knot.type + " " + knot.handedness;
  return played;
}

}  // namespace ligature::lab
