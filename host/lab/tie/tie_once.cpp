#include "host/lab/tie/tie_once.hpp"

#include <stdexcept>
#include <utility>

#include "host/knot/recognise.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "host/lab/tie/recordings.hpp"
#include "host/polyline_file.hpp"
#include "sim_device/operator/knot_tier.hpp"

namespace ligature::lab {
namespace {

constexpr std::int64_t kMost_ticks = 300'000;

class Person final : public SeeingOperator {
 public:
  Person(sim::KnotTier tier, HandRecord* hands)
      : tier_(std::move(tier)), hands_(hands), start_W_{tier_.wish()[0].p_W, tier_.wish()[1].p_W} {}

  [[nodiscard]] std::array<sim::Vec3, 2> start_W_m() const override { return start_W_; }
  [[nodiscard]] std::array<sim::HandWish, 2> act(const sim::Sight& sight) override {
    const auto& wish = tier_.tick(sight);
    if (hands_ != nullptr) hands_->add(sight.t_s, tier_.calm_wish());
    return wish;
  }
  [[nodiscard]] bool is_done() const override { return tier_.is_done(); }
  [[nodiscard]] const sim::KnotTier& tier() const noexcept { return tier_; }

 private:
  sim::KnotTier tier_;
  HandRecord* hands_;
  std::array<sim::Vec3, 2> start_W_;
};

}  // namespace

void check_tick(const scene::Scene& scene, const std::string& scene_file) {
  if (scene.time.tick_s != rt::kPeriod_s)
    throw Refusal(scene_file + ": key 'time.tick_s': found " + digits(scene.time.tick_s) +
                  ", allowed 0.001 when hands are connected");
}

Tied tie_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
              const std::string& knot, std::uint32_t seed, const std::filesystem::path& recording, HandRecord* hands) {
  auto made = sim::KnotTier::make(scene, knot, seed);
  if (const auto* why = std::get_if<std::string>(&made)) throw Refusal(scene_file + ": " + *why);
  Person person(std::get<sim::KnotTier>(std::move(made)), hands);
  Tied tied;
  tied.wanted = std::string(person.tier().knot().type) + " " + std::string(person.tier().knot().handedness);
  UnfinishedRecording unfinished(recording);
  RigSetup setup;
  setup.scene = scene;
  setup.seed = seed;
  setup.scene_file = scene_file;
  setup.scene_toml = scene_toml + "\n# tie " + knot + "\n# seed " + std::to_string(seed);
  VirtualRig rig(setup, person);
  rig.record(unfinished.part());
  if (const auto why = rig.run(kMost_ticks, true)) throw std::runtime_error("the rig did not start: " + *why);
  tied.seconds = 1e-3 * static_cast<double>(rig.records.size());
  tied.missed = person.tier().missed();
  if (!person.is_done()) tied.missed.push_back("time");
  const auto shape = host::read_polyline_log(unfinished.part(), std::nullopt);
  unfinished.finish();
  const auto found = knot::recognise(shape.points, false);
  tied.found = found.type + " " + found.handedness;
  return tied;
}

}  // namespace ligature::lab
