#include "firmware/app/admission.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "firmware/app/bus_calls.hpp"
#include "firmware/app/cold_clock.hpp"
#include "firmware/app/worst_case.hpp"
#include "firmware/control/controller.hpp"
#include "firmware/control/tick_report.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/platform/realtime.hpp"
#include "protocol/can/bit_time.hpp"
#include "protocol/scene/polyline.hpp"

namespace ligature::app {
namespace {

constexpr int kRepeats = 3;        // of the same tick; the least disturbed one counts
constexpr int kTicksPerShape = 4;  // the first finds contacts, the next ones have to resolve them

class Meter {
 public:
  explicit Meter(const scene::Scene& scene)
      : scene_(scene), thread_(std::get<physics::Simulation>(physics::Simulation::make(scene))) {}

  WorstCase run(double seconds) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    measure_control();
    worst_.calls_us = bus_calls_us();
    const auto shapes = worst_shapes(scene_);
    do {
      for (const auto& shape : shapes) try_shape(shape);
    } while (std::chrono::steady_clock::now() < give_up);
    return worst_;
  }

 private:
  /// A few ticks from the same state, several times over.
  void try_shape(const std::vector<physics::Vec3>& shape) {
    auto start = shape;
    for (auto& p : start) p += 0.02 * scene_.suture.radius_m * random_vector();
    std::array<double, kTicksPerShape> least_us{};
    least_us.fill(1e12);
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      thread_.reset();
      if (!start.empty()) thread_.set_state(start, {});
      for (double& least : least_us) {
        const auto tools = grips();
        cold_();
        const double before = cpu_us();
        thread_.tick(tools);
        least = std::min(least, cpu_us() - before);
        worst_.most_contacts = std::max(worst_.most_contacts, thread_.diagnostics().contacts);
        worst_.contact_cap_hit = worst_.contact_cap_hit || thread_.diagnostics().contact_cap_hit;
      }
    }
    worst_.thread_us = std::max(worst_.thread_us, *std::ranges::max_element(least_us));
    worst_.ticks += kTicksPerShape;
  }

  /// Both hands hold and pull: the left one a quarter along the thread, the right one at three quarters.
  std::array<physics::ToolInput, 2> grips() const {
    const auto nodes_W = thread_.nodes_W();
    const auto held = [&](std::size_t node, double pull_m) {
      return physics::ToolInput{nodes_W[node] + physics::Vec3(pull_m, 0.0, 0.0), physics::Vec3(pull_m, 0.0, 0.0), true};
    };
    return {held(nodes_W.size() / 4, -scene_.suture.radius_m), held(3 * nodes_W.size() / 4, scene_.suture.radius_m)};
  }

  void measure_control() {
    constexpr int kTicks = 100;
    // Controllers can be copied but not assigned: they plan with Ruckig, whose members are constants.
    std::optional<control::Controller> fresh(std::in_place, scene_.hands, control::Settings{20, true});
    for (std::int64_t tick = 0; tick < kTicks; ++tick) {
      control::TickInput in;
      in.tick = tick;
      for (auto& hand : in.reading.hand) {
        hand.q_rad = {0.0, 0.5, 0.6 + 1e-4 * static_cast<double>(tick)};
        hand.valid = hand.enabled = hand.dead_man = hand.grip = true;
      }
      double least_us = 1e12;
      std::optional<control::Controller> after;
      for (int repeat = 0; repeat < kRepeats; ++repeat) {
        after.emplace(*fresh);
        cold_();
        const double before = cpu_us();
        (void)after->tick(in);
        record_ = {};
        control::report(*after, record_);
        control::report(thread_.diagnostics(), record_);
        least_us = std::min(least_us, cpu_us() - before);
      }
      fresh.emplace(*after);
      worst_.control_us = std::max(worst_.control_us, least_us);
    }
  }

  physics::Vec3 random_vector() {
    std::uniform_real_distribution<double> d(-1.0, 1.0);
    const double x = d(random_), y = d(random_), z = d(random_);
    return {x, y, z};
  }

  const scene::Scene& scene_;
  physics::Simulation thread_;
  ColdCaches cold_;
  std::mt19937 random_{1};
  rt::TickRecord record_;
  WorstCase worst_;
};

constexpr double kBus_us =
    1e-3 * static_cast<double>(can::bits_to_ns(can::max_frame_bits(0) + 3 * can::max_frame_bits(8)));

}  // namespace

Admission admit(const scene::Scene& scene, double seconds, int core, double budget_percent) {
  Admission result;
  result.budget_percent = budget_percent;
  result.bus_us = kBus_us;
  std::thread([&] {  // on the core, but without its priority: this computes for seconds on end
    platform::stay_on(core);
    platform::flush_denormals();
    result.worst = Meter(scene).run(seconds);
  })
      .join();
  return result;
}

std::optional<int> largest_nodes(scene::Scene scene, double seconds, int core, double budget_percent) {
  int fits = 0, too_many = scene.suture.nodes;
  const auto shape = scene.suture.initial_polyline_m;  // empty: hanging
  const double rounds = std::ceil(std::log2(std::max(2, too_many)));
  while (too_many - fits > 1) {
    scene.suture.nodes = fits + (too_many - fits) / 2;
    if (scene.suture.nodes < 2) break;
    if (!shape.empty()) {
      scene.suture.initial_polyline_m =
          scene::lay_out(shape, scene.suture.nodes, scene.suture.length_m / (scene.suture.nodes - 1));
    }
    const bool good = std::holds_alternative<physics::Simulation>(physics::Simulation::make(scene)) &&
                      admit(scene, seconds / rounds, core, budget_percent).fits();
    (good ? fits : too_many) = scene.suture.nodes;
  }
  return fits >= 2 ? std::optional(fits) : std::nullopt;
}

std::string table(const Admission& a) {
  char text[1024];
  const auto share = [](double us) { return 0.1 * us; };
  std::snprintf(text, sizeof text,
                "worst case of a tick, %d ticks tried; period 1000 us\n"
                "  phase                      us    %% of period\n"
                "  bus, SYNC to last TPDO %7.1f  %8.1f   waiting, by the length of the frames\n"
                "  calls to both buses    %7.1f  %8.1f   on a local socket; a driver's own time not known\n"
                "  control law and record %7.1f  %8.1f\n"
                "  thread                 %7.1f  %8.1f   up to %d contacts%s\n"
                "  computing              %7.1f  %8.1f   allowed %.1f us (budget %.0f %%)\n"
                "  in all                 %7.1f  %8.1f   allowed 1000.0 us\n",
                a.worst.ticks, a.bus_us, share(a.bus_us), a.worst.calls_us, share(a.worst.calls_us), a.worst.control_us,
                share(a.worst.control_us), a.worst.thread_us, share(a.worst.thread_us), a.worst.most_contacts,
                a.worst.contact_cap_hit ? ", contact list full" : "", a.computing_us(), share(a.computing_us()),
                a.budget_us(), a.budget_percent, a.bus_us + a.computing_us(), share(a.bus_us + a.computing_us()));
  return text;
}

}  // namespace ligature::app
