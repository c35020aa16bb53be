// Experiment `extremes` for the rod.

#include <cmath>
#include <limits>

#include "host/console/progress.hpp"
#include "host/lab/experiments/extremes.hpp"

namespace ligature::lab {
namespace {

constexpr int kTicks = 300;
constexpr double kSteps_s[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};

/// The right hand pulls the free end aside and up, then back; the left hand holds the middle. The motion takes
/// `whole_s`.
scene::GripperScript tug(double whole_s, double reach_m) {
  scene::GripperScript s;
  s.keys[0] = {{0.0, {0, 0, 0.2}, true}, {0.5 * whole_s, {0.3 * reach_m, 0, 0.22}, true}};
  s.keys[1] = {{0.0, {0, 0, 0.05}, true}, {0.5 * whole_s, {reach_m, 0, 0.15}, true}, {whole_s, {0, 0, 0.1}, false}};
  return s;
}

/// The hands pull the two ends of the knotted thread apart, each at `speed_m_per_s`.
scene::GripperScript pull(const scene::Scene& s, double whole_s, double speed_m_per_s) {
  const auto& line = s.suture.initial_polyline_m;
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    auto from = h == 0 ? line.front() : line.back(), to = from;
    to[0] += (h == 0 ? -1.0 : 1.0) * speed_m_per_s * whole_s;
    script.keys[h] = {{0.0, from, true}, {whole_s, to, true}};
  }
  return script;
}

std::vector<Dial> dials() {
  return {
      {"EA_N", -6, 6, [](scene::Scene& s, double f) { s.suture.rod.EA_N *= f; }},
      {"EI_N_m2", -6, 6, [](scene::Scene& s, double f) { s.suture.rod.EI_N_m2 *= f; }},
      {"GJ_N_m2", -6, 6, [](scene::Scene& s, double f) { s.suture.rod.GJ_N_m2 *= f; }},
      {"density_kg_per_m", -6, 6, [](scene::Scene& s, double f) { s.suture.rod.density_kg_per_m *= f; }},
      {"all damping", -6, 6,
       [](scene::Scene& s, double f) {
         s.suture.rod.damping_s *= f;
         s.suture.rod.stretch_damping_s *= f;
         s.suture.rod.air_drag_per_s *= f;
         s.hands.coupling_N_s_per_m *= f;
       }},
      {"coupling_N_per_m", -6, 6, [](scene::Scene& s, double f) { s.hands.coupling_N_per_m *= f; }},
      {"friction", -4, 4, [](scene::Scene& s, double f) { s.contact.friction *= f; }},
      {"diameter", -4, 4, [](scene::Scene& s, double f) { s.suture.radius_m *= f; }},
      {"length (aspect)", -4, 4, [](scene::Scene& s, double f) { s.suture.length_m *= f; }},
  };
}

void add_odd_ones(ExtremesMap& result, const scene::Scene& base, const scene::Scene& knot) {
  const auto with = [&](const char* name, int ticks, const std::function<void(scene::Scene&)>& change) {
    auto s = base;
    change(s);
    result.add(name, trial(s, tug(ticks * s.time.tick_s, 0.25), ticks));
  };
  const auto place = [](scene::Scene& s, const std::function<scene::Vec(int)>& at) {
    s.suture.initial = "odd";
    s.suture.initial_polyline_m.clear();
    for (int k = 0; k < s.suture.nodes; ++k) s.suture.initial_polyline_m.push_back(at(k));
  };
  for (const int n : {2, 3, 4, 5, 20, 1000, 2000}) {
    with(("N = " + std::to_string(n)).c_str(), n > 500 ? 60 : kTicks, [&](scene::Scene& s) { s.suture.nodes = n; });
  }
  with("all nodes in one point", kTicks, [&](scene::Scene& s) {
    place(s, [](int) { return scene::Vec{0, 0, 0.35}; });
  });
  with("two nodes in one point", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 0.35 - 0.3 / 153 * (k == 20 ? 19 : k)}; });
  });
  with("folded back on itself", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 0.35 - 0.3 / 153 * (k < 77 ? k : 153 - k)}; });
  });
  with("folded at every node", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 0.35 - 0.3 / 153 * (k % 2)}; });
  });
  with("laid out three times too long", kTicks, [&](scene::Scene& s) {
    place(s, [](int k) { return scene::Vec{0, 0, 0.35 - 0.9 / 153 * k}; });
  });
  with("held at both ends, twice its length apart", kTicks, [](scene::Scene& s) {
    s.world.fixed.push_back({-1, {0.6, 0, 0.35}, std::nullopt});
  });
  with("held at both ends, in one point", kTicks, [](scene::Scene& s) {
    s.world.fixed.push_back({-1, {0, 0, 0.35}, std::nullopt});
  });
  with("clamped against its own direction", kTicks, [](scene::Scene& s) {
    s.world.fixed = {{0, {0, 0, 0.35}, scene::Vec{0, 0, 1}}};
  });
  with("desk above the thread", kTicks, [](scene::Scene& s) { s.world.desk_height_m = 0.5; });
  with("a peg through the thread", kTicks, [](scene::Scene& s) {
    s.world.pegs.push_back({{0, -1, 0.2}, {0, 1, 0.2}, 0.01});
  });
  with("gravity 1e4", kTicks, [](scene::Scene& s) { s.world.gravity_m_per_s2 = {0, 0, -1e4}; });
  with("friction 1000", kTicks, [](scene::Scene& s) { s.contact.friction = 1000; });
  with("diameter 2 cm", kTicks, [](scene::Scene& s) { s.suture.radius_m = 0.01; });
  with("no stiffness at all", kTicks,
       [](scene::Scene& s) { s.suture.rod.EA_N = s.suture.rod.EI_N_m2 = s.suture.rod.GJ_N_m2 = 0; });
  for (const double speed : {0.1, 1.0, 10.0, 100.0, 1e4}) {
    const double whole_s = kTicks * base.time.tick_s;
    result.add("tip drawn at " + digits(speed) + " m/s", trial(base, tug(whole_s, 0.5 * speed * whole_s), kTicks));
    result.add("knot pulled at " + digits(speed) + " m/s", trial(knot, pull(knot, whole_s, speed), kTicks));
  }
  auto thick = knot;
  thick.suture.radius_m *= 10.0;  // makes every crossing of the start shape overlap
  result.add("knot that starts overlapped", trial(thick, pull(thick, kTicks * 1e-3, 0.2), kTicks));
  scene::GripperScript jump;
  jump.keys[1] = {{0.0, {0, 0, 0.05}, true}, {0.1, {0, 0, 0.05}, true}, {0.1 + 1e-9, {1.0, 0, 0.05}, true}};
  result.add("hand jumps 1 m", trial(base, jump, kTicks));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  scene::GripperScript lost;
  lost.keys[1] = {{0.0, {0, 0, 0.05}, true}, {0.1, {kNan, 0, kNan}, true}, {0.2, {0, 0, 0.05}, true}};
  result.add("hand is not a number", trial(base, lost, kTicks));
}

}  // namespace

ExtremesMap rod_extremes(const std::filesystem::path& scenes) {
  const auto base = load_scene_or_refuse((scenes / "suture-3-0.toml").string(), {});
  const auto knot = load_scene_or_refuse((scenes / "suture-3-0-knot.toml").string(), {});
  ExtremesMap result;
  console::Progress progress("extremes, rod");
  const auto all = dials();
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (int decade = all[k].low; decade <= all[k].high; decade += 2) {
      progress.show(static_cast<double>(k) / static_cast<double>(all.size()),
                    std::string("rod, ") + all[k].name + " x 1e" + std::to_string(decade));
      for (const double step_s : kSteps_s) {
        auto s = base;
        all[k].turn(s, std::pow(10.0, decade));
        s.time.tick_s = step_s;
        result.add(all[k].name, std::pow(10.0, decade), step_s, trial(s, tug(kTicks * step_s, 0.25), kTicks));
      }
    }
  }
  add_odd_ones(result, base, knot);
  return result;
}

}  // namespace ligature::lab
