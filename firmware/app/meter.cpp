#include "firmware/app/meter.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "firmware/app/bus_calls.hpp"
#include "firmware/app/cold_clock.hpp"
#include "firmware/app/worst_case.hpp"
#include "firmware/control/controller.hpp"
#include "firmware/control/tick_report.hpp"

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
  void try_shape(const Shape& shape) {
    auto start = shape.p_W;
    for (auto& p : start) p += 0.02 * scene_.suture.radius_m * random_vector();
    std::array<double, kTicksPerShape> least_us{};
    least_us.fill(1e12);
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      thread_.reset();
      if (!start.empty()) thread_.set_state(start, shape.v_W);
      for (double& least : least_us) {
        const auto tools = grips();
        cold_();
        const double before = cpu_us();
        thread_.tick(tools);
        least = std::min(least, cpu_us() - before);
        look_at(thread_.diagnostics());
      }
    }
    worst_.thread_us = std::max(worst_.thread_us, *std::ranges::max_element(least_us));
    worst_.ticks += kTicksPerShape;
  }

  void look_at(const physics::Diagnostics& d) noexcept {
    worst_.most_contacts = std::max(worst_.most_contacts, d.contacts);
    worst_.contact_cap_hit = worst_.contact_cap_hit || d.contact_cap_hit;
    worst_.gave_up = std::max(worst_.gave_up, d.degradation);
    worst_.time_lost = std::max(worst_.time_lost, d.time_lost);
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
        hand.valid = hand.enabled = hand.grip = true;
        hand.dead_man = tick >= control::DeadMan::kReleased;
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

}  // namespace

WorstCase measure_worst_case(const scene::Scene& scene, double seconds) { return Meter(scene).run(seconds); }

}  // namespace ligature::app
