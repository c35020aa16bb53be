#include "firmware/app/admission.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "firmware/platform/realtime.hpp"
#include "protocol/can/bit_time.hpp"
#include "protocol/scene/polyline.hpp"

namespace ligature::app {
namespace {

constexpr double kBus_us =
    1e-3 * static_cast<double>(can::bits_to_ns(can::max_frame_bits(0) + 3 * can::max_frame_bits(8)));

/// What the worst ticks did instead of running longer; empty: nothing.
std::string given_up(const WorstCase& worst) {
  char text[128] = "";
  switch (worst.gave_up) {
    case physics::Degradation::kNone:
      break;
    case physics::Degradation::kIterations:
      return "  gives up then: contacts settle less\n";
    case physics::Degradation::kContacts:
      return "  gives up then: the shallowest contacts feel no impulse\n";
    case physics::Degradation::kMotion:
      std::snprintf(text, sizeof text, "  gives up then: the thread stands still for up to %.0f %% of a tick\n",
                    100.0 * worst.time_lost);
      break;
  }
  return text;
}

}  // namespace

Admission admit(const scene::Scene& scene, double seconds, int core, double budget_percent) {
  Admission result;
  result.budget_percent = budget_percent;
  result.bus_us = kBus_us;
  std::thread([&] {  // on the core, but without its priority: this computes for seconds on end
    if (core != kAnyCore) platform::stay_on(core);
    platform::flush_denormals();
    result.worst = measure_worst_case(scene, seconds);
  })
      .join();
  return result;
}

Measure measure_on(int core, double budget_percent) {
  return [=](const scene::Scene& scene, double seconds) { return admit(scene, seconds, core, budget_percent); };
}

std::optional<int> largest_nodes(scene::Scene scene, double seconds, const Measure& measure) {
  int fits = 0, too_many = scene.suture.nodes;
  const auto shape = scene.suture.initial_polyline_m;  // empty: hanging
  const double rounds = std::ceil(std::log2(std::max(2, too_many)));
  const auto good = [&](int nodes) {
    scene.suture.nodes = nodes;
    if (!shape.empty())
      scene.suture.initial_polyline_m = scene::lay_out(shape, nodes, scene.suture.length_m / (nodes - 1));
    return std::holds_alternative<physics::Simulation>(physics::Simulation::make(scene)) &&
           measure(scene, seconds / rounds).fits();
  };
  while (too_many - fits > 1) {
    const int nodes = fits + (too_many - fits) / 2;
    if (nodes < 2) break;
    (good(nodes) ? fits : too_many) = nodes;
  }
  constexpr double kLess = 0.9;  // what is named has been measured twice, or it is a tenth less
  while (fits >= 2 && !good(fits)) fits = static_cast<int>(kLess * fits);
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
  return text + given_up(a.worst);
}

}  // namespace ligature::app
