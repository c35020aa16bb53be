#include "tests/bench/rod/panel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/rod/crumple.hpp"

namespace ligature::bench {
namespace {

using physics::rod::RodSimulation;

std::vector<std::string> nylon_5_0() {
  return {"suture.radius_m=6.25e-5", "suture.density_kg_per_m=1.4e-5", "suture.EA_N=42", "suture.EI_N_m2=4.1e-8",
          "suture.GJ_N_m2=2.93e-8"};
}

/// A crumpled thread thrown apart, without hands. It starts as a random walk whose strands keep 1.2 diameters apart.
Score run_ball(std::uint64_t seed) {
  using namespace physics::rod;
  Rod rod(Material{}, Numerics{}, Parts{.twist = true, .contact = true, .friction = true, .adaptive = true}, 154);
  test::crumple_apart(rod, static_cast<unsigned>(seed), 15.0, 1.0);
  Score s{};
  constexpr int kTicks = 150;
  double gap_m = 0.0, before_J = rod.all_J(rod.energy());
  for (int k = 0; k < kTicks; ++k) {
    rod.tick();
    const TickReport& r = rod.report();
    s[kGuard] += r.guard_events;
    s[kLostAfter] += 100.0 * r.time_lost / kTicks;
    s[kWork] += 1e-6 * static_cast<double>(r.work) / kTicks;
    s[kPeak] = std::max(s[kPeak], 1e-6 * static_cast<double>(r.work));
    if (k > 50) gap_m = std::min(gap_m, r.min_gap_m);
    const double now_J = rod.all_J(rod.energy());
    if (k > 0) s[kAfter] = std::max(s[kAfter], 1e6 * (now_J - before_J));
    before_J = now_J;
  }
  s[kOverlap] = -gap_m / (2.0 * rod.material().radius_m);
  s[kForce] = 100.0;
  return s;
}

}  // namespace

std::vector<Case> panel(std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Case> all;
  const auto speed = [&] { return 0.05 * std::pow(8.0, random.share()); };
  const auto add = [&](const char* name, const char* scene, double force_N, int hands,
                       std::vector<std::string> overrides = {}) -> Case& {
    Pull pull{speed(), force_N * (0.8 + 0.4 * random.share()), random.share() < 0.5, hands};
    if (hands == 1) pull.speed_m_per_s = std::min(0.4, 1.6 * pull.speed_m_per_s);
    overrides.emplace_back("contact.friction=" + std::to_string(0.3 + 0.1 * random.share()));
    return all.emplace_back(Case{name, std::string("suture-3-0-") + scene + ".toml", std::move(overrides), pull});
  };
  for (const int hands : {2, 2, 1}) add("overhand", "knot", 5.0, hands);
  for (const int hands : {2, 2, 2, 1}) add("square", "square", 5.0, hands);
  for (const int hands : {2, 1}) add("granny", "granny", 3.0, hands);
  for (const int hands : {2, 2, 2, 1}) add("surgeon's", "surgeons", 5.0, hands);
  for (const int hands : {2, 1}) add("figure-eight, set", "figure-eight", 4.0, hands);
  add("overhand, 350 nodes", "knot", 4.0, 2, {"suture.nodes=350"});
  add("overhand, fast", "knot", 4.0, 2, {"suture.accuracy=\"fast\""});
  add("overhand, 5-0", "knot", 1.0, 2, nylon_5_0());
  add("overhand, trembling", "knot", 2.0, 2).pull.tremble_m = 3e-4;
  add("overhand, slippery", "knot", 3.0, 2).overrides.back() = "contact.friction=0.05";
  all.back().opens = true;
  add("overhand, rough", "knot", 3.0, 2).overrides.back() = "contact.friction=0.6";
  add("overhand on a desk", "knot", 2.0, 2, {"world.desk_height_m=0.0484"});
  all.push_back({"ball", "", {}, {}, false});
  all.back().pull.speed_m_per_s = static_cast<double>(seed);
  add("overhand, 1 m/s", "knot", 5.0, 2).pull.speed_m_per_s = 1.0;  // last, so that the other draws stay as they are
  return all;
}

Score run(const Case& one) {
  if (one.scene.empty()) return run_ball(static_cast<std::uint64_t>(one.pull.speed_m_per_s));
  auto read = scene::load_scene(std::string(LIGATURE_SOURCE_DIR "/scenes/") + one.scene, one.overrides);
  if (auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
  const auto& scene = std::get<scene::Scene>(read);
  auto made = RodSimulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  PullOptions options;
  options.hold_s = 0.4, options.wait_s = 0.5;
  const PullResult r = Puller(scene, std::get<RodSimulation>(std::move(made)), options).run(one.pull);
  Score s{};
  s[kWrong] = (one.opens ? r.left.type != "0_1" : !r.kept()) ? 1.0 : 0.0;
  s[kGuard] = r.guard;
  s[kLostPull] = 100.0 * r.pull_lost, s[kLostHold] = 100.0 * r.hold_lost, s[kLostAfter] = 100.0 * r.after_lost;
  for (const auto& tick : r.ticks) {
    s[kWork] += 1e-6 * static_cast<double>(tick.work) / static_cast<double>(r.ticks.size());
    s[kPeak] = std::max(s[kPeak], 1e-6 * static_cast<double>(tick.work));
  }
  s[kOverlap] = r.pull_d, s[kDeepest] = r.hold_d;
  s[kForce] = 100.0 * r.tension_N / one.pull.force_N;
  s[kHold] = 100.0 * r.chatter, s[kSlide] = 100.0 * r.sliding;
  s[kHeld] = 1e6 * r.held_J, s[kAfter] = 1e6 * r.after_J;
  return s;
}

Score run(const std::vector<Case>& cases) {
  Score sum{};
  for (const auto& one : cases) {
    const Score s = run(one);
    for (std::size_t k = 0; k < kMeasures; ++k)
      sum[k] += k == kWrong || k == kGuard ? s[k] : s[k] / static_cast<double>(cases.size());
  }
  return sum;
}

}  // namespace ligature::bench
