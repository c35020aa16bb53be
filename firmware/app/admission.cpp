#include "firmware/app/admission.hpp"

#include <algorithm>
#include <cstdio>
#include <thread>

#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

constexpr double kNoLoss = 1e-3;  // share of the time: less than 1 ms lost in a second counts as none

double us(std::chrono::nanoseconds t) { return 1e-3 * static_cast<double>(t.count()); }

/// Shortest time that the physics gets in a period, us. It begins when the loop hands over the tools after the latest
/// possible samples. It ends shortly before the earliest possible samples of the next period.
double given_us(const rt::BusTime& bus, const LoopCost& loop) {
  const auto least = rt::kPeriod - (bus.samples_latest - bus.samples_earliest) - rt::ThreadDeadline::kMargin;
  return us(least) - loop.control_us - loop.calls_us;
}

std::vector<DrawnKnot> draw_knots(const scene::Scene& scene, const ThreadCost& cost) {
  const scene::Scene knotted = with_loose_knot(scene);
  auto made = physics::Simulation::make(knotted);
  auto* const thread = std::get_if<physics::Simulation>(&made);
  if (thread == nullptr) return {};
  if (cost.work > 0) thread->set_work(cost.work);
  const Tick tick = [&](physics::Simulation& t, const std::array<physics::ToolInput, 2>& tools) {
    tick_within(t, tools, cost.given_us);
  };
  std::vector<DrawnKnot> knots;
  knots.reserve(kHandSpeeds_m_per_s.size());
  for (const double speed : kHandSpeeds_m_per_s) knots.push_back(draw(*thread, knotted, speed, tick));
  return knots;
}

double lost(const DrawnKnot& knot) { return std::max(knot.pull_lost, knot.hold_lost); }

std::string knots_table(const std::vector<DrawnKnot>& knots) {
  if (knots.empty()) return {};
  std::string text = "  time lost by a knot drawn tight, each hand at so many m/s\n    m/s      drawn %   held %\n";
  char row[96];
  for (const auto& k : knots) {
    std::snprintf(row, sizeof row, "    %-8.2f %7.1f  %7.1f\n", k.speed_m_per_s, 100.0 * k.pull_lost,
                  100.0 * k.hold_lost);
    text += row;
  }
  return text;
}

std::string drivers_text(const DriverTime& driver) {
  if (driver.interfaces.empty()) return "a driver's own time not known (--can)";
  std::string names;
  for (const auto& name : driver.interfaces) names += (names.empty() ? "" : ", ") + name;
  char text[160];
  std::snprintf(text, sizeof text, "%.1f of them in the drivers of %s, whose delay of %.0f us counts twice",
                driver.calls_us, names.c_str(), driver.delay_us);
  return text;
}

}  // namespace

Admission admit(const scene::Scene& scene, const AdmissionSettings& settings) {
  Admission result;
  result.budget_percent = settings.budget_percent;
  result.bus = platform::bus_time_of(settings.device);
  result.driver = settings.driver;
  std::thread([&] {  // on the run's core, but without real-time priority: this computes for seconds
    if (settings.core != kAnyCore) platform::stay_on(settings.core);
    platform::flush_denormals();
    result.loop = measure_loop(scene, settings.device);
    result.loop.calls_us += settings.driver.calls_us;
    result.thread = measure_thread(scene, given_us(result.bus, result.loop), settings.seconds);
    if (settings.draw_knots) result.knots = draw_knots(scene, result.thread);
  })
      .join();
  return result;
}

std::string table(const Admission& a) {
  char text[1024];
  const auto share = [](double part_us) { return 0.1 * part_us; };
  const double bus_us = us(a.bus.samples_latest), torques_us = us(a.bus.torques_latest);
  std::snprintf(text, sizeof text,
                "period 1000 us\n"
                "  loop                        us    %% of period\n"
                "  SYNC to last TPDO       %7.1f  %8.1f   waiting, by the length of the frames\n"
                "  calls to both buses     %7.1f  %8.1f   on a local socket; %s\n"
                "  control law and record  %7.1f  %8.1f\n"
                "  computing               %7.1f  %8.1f   allowed %.1f us (--budget %.0f %%)\n"
                "  torques to next SYNC    %7.1f  %8.1f   on the bus\n"
                "  thread, also while the loop waits\n"
                "  has                     %7.1f  %8.1f\n"
                "  worst tick of %-5d     %7.1f  %8.1f   up to %d contacts%s%s\n",
                bus_us, share(bus_us), a.loop.calls_us, share(a.loop.calls_us), drivers_text(a.driver).c_str(),
                a.loop.control_us, share(a.loop.control_us), a.computing_us(), share(a.computing_us()), a.budget_us(),
                a.budget_percent, torques_us, share(torques_us), a.thread.given_us, share(a.thread.given_us),
                a.thread.ticks, a.thread.worst_us, share(a.thread.worst_us), a.thread.most_contacts,
                a.thread.contact_cap_hit ? ", not all of them solved" : "",
                a.thread.ended_by_clock ? "; ended by the clock" : "");
  std::string all = text;
  if (a.thread.work > 0) {
    std::snprintf(text, sizeof text, "  work for contact        %7.1f  million instructions a tick\n",
                  1e-6 * static_cast<double>(a.thread.work));
    all += text;
  }
  std::snprintf(text, sizeof text, "  time lost in the worst shape: %.1f %%\n", 100.0 * a.thread.time_lost);
  return all + text + knots_table(a.knots);
}

std::optional<std::string> objection_of(const Admission& a, double no_loss_m_per_s) {
  char text[256];
  if (!a.fits()) {
    std::snprintf(
        text, sizeof text,
        "the loop does not fit: found %.0f us of computing from SYNC to record, allowed %.0f; remedy: a faster core, "
        "or --budget up to %.0f",
        a.computing_us(), a.budget_us(), 1e-1 * us(a.bus.most_work()));
    return text;
  }
  for (const auto& knot : a.knots) {
    if (knot.speed_m_per_s > no_loss_m_per_s || lost(knot) < kNoLoss) continue;
    std::snprintf(
        text, sizeof text,
        "--no-loss %g: found %.1f %% of the time lost by a knot drawn at %g m/s a hand, allowed %.1f; remedy: "
        "suture.accuracy = \"fast\", or fewer suture.nodes",
        no_loss_m_per_s, 100.0 * lost(knot), knot.speed_m_per_s, 100.0 * kNoLoss);
    return text;
  }
  return std::nullopt;
}

}  // namespace ligature::app
