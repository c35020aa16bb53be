// Pulls a scene's loose knot tight and prints one line a run: the knot after the wait and whether it is the one of the
// start, guard events, worst penetration (diameters) in pull / hold / after, strain against T / EA, largest turn per
// node and longest contact segment in the hold, chatter of the hand force in the hold, thread-CPU time per tick.
//
// Also: chatter while the thread slides, wherever the force is above 5 % of what is pulled to (chatter.hpp).
//
// Usage: rod_pull_study SCENE [speed_m_per_s force_N [sudden(0|1) hands(1|2) [key=value ...]]]; without sudden and
// hands: the four runs of gentle, sudden x two, one; without speed: the 48 runs of two hands, one x 0.05, 0.2, 0.5, 1
// m/s x 1, 5, 10 N x gentle, sudden release. Exit 1 when a knot was lost. Environment: HOLD_S=60, a longer hold;
// WAIT_S, the wait after the release; WORK_K, the budget; SHAPES=FOLDER, where to write the thread at the start, in the
// hold and at the end.

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/knot/recognise.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/bench/rod/chatter.hpp"

using namespace ligature;
using physics::rod::RodSimulation;

namespace {

double cpu_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> v, double q) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0.0 : v[std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())))];
}

double seconds_of(const char* variable, double otherwise) {
  const char* const text = std::getenv(variable);
  return text != nullptr ? std::atof(text) : otherwise;
}

class Study {
 public:
  Study(const scene::Scene& scene, RodSimulation sim) : scene_(scene), sim_(std::move(sim)) {
    tools_[0].p_WT = sim_.nodes_W().front();
    tools_[1].p_WT = sim_.nodes_W().back();
    tools_[0].grip = tools_[1].grip = true;
    auto& numerics = sim_.rod().numerics();
    numerics.work = static_cast<long>(1000.0 * seconds_of("WORK_K", 1e-3 * static_cast<double>(numerics.work)));
  }

  /// @return whether the thread still has the knot it began with.
  bool run(double speed, double force_N, bool sudden, int hands) {
    save("start");
    const auto begun = knot();
    phase(0.1, 0.0, hands, 0.0);
    forces_.clear();
    phase(5.0, speed, hands, force_N);
    const double slide = bench::chatter(forces_, 0.05 * force_N).share(), pull = std::exchange(penetration_, 0.0);
    phase(0.3, 0.0, hands, 0.0);
    penetration_ = 0.0;
    forces_.clear();
    phase(seconds_of("HOLD_S", 0.7), 0.0, hands, 0.0);
    save("held");
    const double hold = std::exchange(penetration_, 0.0), strain = sim_.diagnostics().max_stretch, tension = force();
    const auto [turn, segment] = sharpness();
    const double rms = bench::chatter(forces_, 0.0).share();
    if (!sudden) phase(10.0, -0.02, 2, -0.02 * force_N);
    tools_[1].grip = false;
    phase(seconds_of("WAIT_S", 5.0), 0.0, hands, 0.0);
    save("end");
    const auto left = knot();
    const bool kept = left.type == begun.type && left.handedness == begun.handedness;
    std::printf(
        "%4.2f m/s %4.1f N %s %d hand(s): %s %s %s guard %d penetration %.2f %.3f %.2f strain %.2f%% (T/EA %.2f%%) "
        "turn "
        "%.2f segment %.2f d chatter %.4f%% sliding %.2f%% us %.0f %.0f %.0f work k %.0f %.0f %.0f\n",
        speed, force_N, sudden ? "sudden" : "gentle", hands, left.type.c_str(), left.handedness.c_str(),
        kept ? "kept" : ("LOST, was " + begun.type).c_str(), guard_, pull, hold, penetration_, 100.0 * strain,
        100.0 * tension / scene_.suture.rod.EA_N, turn, segment, 100.0 * rms, 100.0 * slide, quantile(us_, 0.5),
        quantile(us_, 0.99), quantile(us_, 1.0), quantile(work_, 0.5), quantile(work_, 0.99), quantile(work_, 1.0));
    std::fflush(stdout);
    return kept;
  }

 private:
  double force() const {
    return 0.5 * (sim_.hand(physics::Hand::kLeft).f_W.x() - sim_.hand(physics::Hand::kRight).f_W.x());
  }

  std::vector<std::array<double, 3>> points() const {
    std::vector<std::array<double, 3>> all;
    for (const auto& p : sim_.nodes_W()) all.push_back({p.x(), p.y(), p.z()});
    return all;
  }

  knot::KnotResult knot() const { return knot::recognise(points(), false); }

  void save(const std::string& name) const {
    const char* const folder = std::getenv("SHAPES");
    if (folder == nullptr) return;
    std::ofstream out(std::string(folder) + "/" + name + ".csv");
    out << "x,y,z\n";
    for (const auto& p : points()) out << p[0] << ',' << p[1] << ',' << p[2] << '\n';
  }

  // until_N > 0: ends when pulled that hard; < 0: when eased below -until_N.
  void phase(double seconds, double speed, int hands, double until_N) {
    for (int k = 0; k < static_cast<int>(1000.0 * seconds); ++k) {
      if (until_N > 0.0 && force() >= until_N) return;
      if (until_N < 0.0 && force() <= -until_N) return;
      for (std::size_t h = 0; h < 2; ++h) {
        const double v = h == 1 ? speed : hands == 2 ? -speed : 0.0;
        tools_[h].v_WT.x() = v;
        tools_[h].p_WT.x() += 1e-3 * v;
      }
      const double before = cpu_us();
      sim_.tick(tools_);
      us_.push_back(cpu_us() - before);
      guard_ += sim_.rod().report().guard_events;
      work_.push_back(1e-3 * static_cast<double>(sim_.rod().report().work));
      penetration_ = std::max(penetration_, -sim_.diagnostics().min_gap_m / (2.0 * scene_.suture.radius_m));
      forces_.push_back(force());
    }
  }

  // Largest turn at a node in contact, rad, and longest segment in contact, diameters.
  std::pair<double, double> sharpness() const {
    double turn = 0.0, longest = 0.0;
    const auto& state = sim_.rod().state();
    for (const auto& c : sim_.rod().contact_set().contacts()) {
      if (c.count != 4 || dot(c.p, c.p) == 0.0) continue;
      for (const int k : {0, 2}) {
        const auto i = static_cast<std::size_t>(c.node[k]);
        if (i < 1 || i + 1 >= state.x.size()) continue;
        const auto a = state.x[i] - state.x[i - 1], b = state.x[i + 1] - state.x[i];
        turn = std::max(turn, std::atan2(norm(cross(a, b)), dot(a, b)));
        longest = std::max(longest, state.mesh.rest[i] / (2.0 * scene_.suture.radius_m));
      }
    }
    return {turn, longest};
  }

  scene::Scene scene_;
  RodSimulation sim_;
  std::array<physics::ToolInput, 2> tools_{};
  std::vector<double> us_, work_, forces_;
  double penetration_ = 0.0;
  int guard_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc == 3 || argc == 5)
    return std::fprintf(stderr, "usage: rod_pull_study SCENE [speed force [sudden hands [key=value ...]]]\n"), 2;
  const std::vector<std::string> overrides(argv + std::min(argc, 6), argv + argc);
  auto read = scene::load_scene(argv[1], overrides);
  if (auto* error = std::get_if<scene::Error>(&read)) return std::fprintf(stderr, "%s\n", error->text.c_str()), 2;
  const auto& scene = std::get<scene::Scene>(read);
  int runs = 0, kept = 0;
  const auto run = [&](double speed, double force_N, bool sudden, int hands) {
    auto made = RodSimulation::make(scene);
    if (auto* why = std::get_if<std::string>(&made)) std::fprintf(stderr, "%s\n", why->c_str()), std::exit(2);
    kept += Study(scene, std::get<RodSimulation>(std::move(made))).run(speed, force_N, sudden, hands);
    ++runs;
  };
  if (argc > 5) {
    run(std::atof(argv[2]), std::atof(argv[3]), std::atoi(argv[4]) != 0, std::atoi(argv[5]));
  } else if (argc == 4) {
    for (const int hands : {2, 1}) {
      for (const bool sudden : {false, true}) run(std::atof(argv[2]), std::atof(argv[3]), sudden, hands);
    }
  } else {
    for (const int hands : {2, 1}) {
      for (const double speed : {0.05, 0.2, 0.5, 1.0}) {
        for (const double force_N : {1.0, 5.0, 10.0}) {
          for (const bool sudden : {false, true}) run(speed, force_N, sudden, hands);
        }
      }
    }
  }
  std::printf("%d of %d kept\n", kept, runs);
  return kept == runs ? 0 : 1;
}
