#include "firmware/app/meter.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "firmware/app/bus_calls.hpp"
#include "firmware/app/cold_clock.hpp"
#include "firmware/app/drawn_knot.hpp"
#include "firmware/app/worst_case.hpp"
#include "firmware/control/controller.hpp"
#include "firmware/control/tick_report.hpp"
#include "protocol/scene/random.hpp"

namespace ligature::app {
namespace {

constexpr int kRepeats = 3;             // runs of the same tick; the smallest time counts
constexpr int kTicksPerShape = 4;       // the first tick finds the contacts, the next ones resolve them
constexpr long kMostWork = 16'000'000;  // instructions per tick; more helps no knot (docs/measurements/rod-knots.md)
constexpr long kLeastWork = 1'000'000;  // smallest budget, as with less no knot holds; longer ticks end at the deadline
constexpr long kLeastOfANode = 2'000;   // twice the cost of a contact search per node; with less the thread never moves
constexpr double kSpare = 0.95;         // share of the given time that is used; the rest is reserve for cases not tried
// Budgets are rounded to this number of instructions, so that repeated measurements on a machine give the same one
constexpr double kRound = 100'000.0;

/// Time left until a given CPU time of this thread, for physics::TimeLeft.
struct CpuTime {
  double until_us;
  static std::int64_t left_ns(void* self) noexcept {
    return std::llround(1e3 * (static_cast<CpuTime*>(self)->until_us - cpu_us()));
  }
};

/// CPU time in us of a tick without any contact, the least of several.
double own_cost_us(scene::Scene scene) {
  constexpr int kTicks = 10;
  scene.suture.initial = "hanging";
  scene.suture.initial_polyline_m.clear();
  auto thread = std::get<physics::Simulation>(physics::Simulation::make(scene));
  double least_us = 1e12;
  for (int k = 0; k < kTicks; ++k) {
    const double before = cpu_us();
    thread.tick({});
    least_us = std::min(least_us, cpu_us() - before);
  }
  return least_us;
}

/// Work budget, in instructions, that fits into the given time. It is computed from the time per instruction while a
/// knot is drawn tight. Each tick runs several times, and its shortest time counts. The budget is enough for 99 % of
/// the ticks. A long thread is shortened first, because contact costs arise only in the knot; so the measurement takes
/// at most about 1 s.
long work_that_fits(const scene::Scene& scene, double given_us) {
  constexpr double kSpeed_m_per_s = 0.25;
  constexpr long kCounts = 500'000;  // instructions; ticks with less work give no reliable cost per instruction
  constexpr int kMostNodes = 200;
  constexpr double kDear = 0.99;  // quantile of the ticks that must fit; costlier ones end at the deadline
  const scene::Scene knotted = with_loose_knot(no_longer_than(scene, kMostNodes));
  auto made = physics::Simulation::make(knotted);
  auto* const thread = std::get_if<physics::Simulation>(&made);
  if (thread == nullptr) return kLeastWork;
  thread->set_work(kMostWork);
  std::vector<double> least_us;
  std::vector<long> work;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::size_t at = 0;
    static_cast<void>(draw(*thread, knotted, kSpeed_m_per_s, [&](physics::Simulation& t, const auto& tools) {
      const double before = cpu_us();
      t.tick(tools);
      const double took_us = cpu_us() - before;
      if (repeat == 0) {
        least_us.push_back(took_us);
        work.push_back(t.diagnostics().work);
      } else {
        least_us[at] = std::min(least_us[at], took_us);
      }
      ++at;
    }));
  }
  const double own_us = *std::ranges::min_element(least_us);
  const long least = std::min(kMostWork, kLeastWork + kLeastOfANode * scene.suture.nodes);
  std::vector<double> prices_us;
  for (std::size_t i = 0; i < work.size(); ++i) {
    if (work[i] > kCounts) prices_us.push_back((least_us[i] - own_us) / static_cast<double>(work[i]));
  }
  if (prices_us.empty()) return kMostWork;
  const auto dear = prices_us.begin() + static_cast<std::ptrdiff_t>(kDear * static_cast<double>(prices_us.size() - 1));
  std::ranges::nth_element(prices_us, dear);
  const double bought = (kSpare * given_us - std::max(own_us, own_cost_us(scene))) / *dear;
  return std::clamp(static_cast<long>(kRound * std::floor(bought / kRound)), least, kMostWork);
}

class ThreadMeter {
 public:
  explicit ThreadMeter(const scene::Scene& scene)
      : scene_(scene),
        thread_(std::get<physics::Simulation>(physics::Simulation::make(scene))),
        shapes_(worst_shapes(scene)) {}

  ThreadCost run(double given_us, double seconds) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    cost_.given_us = given_us;
    if (thread_.work() > 0 && scene_.suture.rod.work_instructions == 0)
      thread_.set_work(work_that_fits(scene_, given_us));
    cost_.work = thread_.work();
    do {
      for (const auto& shape : shapes_) try_shape(shape);
    } while (std::chrono::steady_clock::now() < give_up);
    return cost_;
  }

 private:
  /// Measures the first few ticks from this shape, several times from the same state.
  void try_shape(const Shape& shape) {
    auto start = shape.p_W;
    for (auto& p : start) p += 0.02 * scene_.suture.radius_m * random_vector();
    std::array<double, kTicksPerShape> least_us{};
    least_us.fill(1e12);
    double lost = 0.0;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      thread_.reset();
      if (!start.empty()) thread_.set_state(start, shape.v_W);
      for (std::size_t k = 0; k < least_us.size(); ++k) {
        const auto tools = grips();
        cold_();
        const double before = cpu_us();
        tick_within(thread_, tools, cost_.given_us);
        least_us[k] = std::min(least_us[k], cpu_us() - before);
        if (repeat == 0) lost += thread_.diagnostics().time_lost / kTicksPerShape;
        look_at(thread_.diagnostics());
      }
    }
    cost_.time_lost = std::max(cost_.time_lost, lost);
    cost_.worst_us = std::max(cost_.worst_us, *std::ranges::max_element(least_us));
    cost_.ticks += kTicksPerShape;
  }

  void look_at(const physics::Diagnostics& d) noexcept {
    cost_.most_contacts = std::max(cost_.most_contacts, d.contacts);
    cost_.contact_cap_hit = cost_.contact_cap_hit || d.contact_cap_hit;
    cost_.ended_by_clock = cost_.ended_by_clock || d.end == physics::TickEnd::kClock;
  }

  /// Tools of both hands, which grip the thread and pull: the left hand at a quarter of its length, the right at three
  /// quarters.
  std::array<physics::ToolInput, 2> grips() const {
    const auto nodes_W = thread_.nodes_W();
    const auto held = [&](std::size_t node, double pull_m) {
      return physics::ToolInput{nodes_W[node] + physics::Vec3(pull_m, 0.0, 0.0), physics::Vec3(pull_m, 0.0, 0.0), true};
    };
    return {held(nodes_W.size() / 4, -scene_.suture.radius_m), held(3 * nodes_W.size() / 4, scene_.suture.radius_m)};
  }

  physics::Vec3 random_vector() {
    physics::Vec3 v;
    for (auto& x : v) x = scene::between(random_, -1.0, 1.0);
    return v;
  }

  const scene::Scene& scene_;
  physics::Simulation thread_;
  std::vector<Shape> shapes_;
  ColdCaches cold_;
  std::mt19937 random_{1};
  ThreadCost cost_;
};

}  // namespace

void tick_within(physics::Simulation& thread, const std::array<physics::ToolInput, 2>& tools,
                 double given_us) noexcept {
  CpuTime clock{cpu_us() + given_us};
  thread.tick(tools, physics::TimeLeft(&CpuTime::left_ns, &clock));
}

ThreadCost measure_thread(const scene::Scene& scene, double given_us, double seconds) {
  return ThreadMeter(scene).run(given_us, seconds);
}

LoopCost measure_loop(const scene::Scene& scene, const device::Device& device) {
  constexpr int kTicks = 100;
  LoopCost cost;
  cost.calls_us = bus_calls_us(device);
  ColdCaches cold;
  rt::TickRecord record;
  // A Controller can be copied but not assigned (Ruckig has const members), so an optional is emplaced instead.
  std::optional<control::Controller> fresh(std::in_place, scene.hands, control::Settings{20, true, device});
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
      cold();
      const double before = cpu_us();
      (void)after->tick(in);
      record = {};
      control::report(*after, record);
      control::report(physics::Diagnostics{}, record);
      least_us = std::min(least_us, cpu_us() - before);
    }
    fresh.emplace(after.value());
    cost.control_us = std::max(cost.control_us, least_us);
  }
  return cost;
}

}  // namespace ligature::app
