#include "firmware/app/run.hpp"

#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <thread>

#include "firmware/app/rig_setup.hpp"
#include "firmware/app/summary.hpp"
#include "firmware/cycle.hpp"
#include "firmware/platform/can_master.hpp"
#include "firmware/platform/realtime.hpp"
#include "firmware/platform/rig_bus.hpp"
#include "firmware/telemetry/lcm_link.hpp"

namespace ligature::app {
namespace {

using RigCycle = Cycle<platform::RigBus, platform::MonotonicClock>;

std::int64_t utime_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// SIGINT and SIGTERM, taken by waiting for them in the main thread: no handler, nothing asynchronous anywhere.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);  // threads started later inherit this
  }
  /// @return true when one came, within at most 50 ms.
  bool wait() const {
    const timespec patience{0, 50'000'000};
    return sigtimedwait(&set_, nullptr, &patience) > 0;
  }

 private:
  sigset_t set_;
};

int fail(const Refusal& refusal) {
  std::fprintf(stderr, "ligature-firmware: %s\n", refusal.text.c_str());
  return refusal.exit_code;
}

void log(const ligature_msg::event_t& e) {
  if (e.kind == ligature_msg::event_t::KIND_FAULT) {
    spdlog::error("tick {}: {}", e.tick, e.text);
  } else if (e.kind != ligature_msg::event_t::KIND_LIMIT) {
    spdlog::info("tick {}: {}", e.tick, e.text);
  }
}

constexpr telemetry::Names kNames{
    [](int s) { return control::name(static_cast<control::State>(s)); },
    [](int f) { return control::name(static_cast<control::Fault>(f)); },
};

telemetry::Session session(const Plan& plan, const RunOptions& options, bool realtime) {
  return {utime_now(), LIGATURE_VERSION, options.scene, plan.toml, control::kPeriod_s, plan.scene.hands.max_force_N,
          plan.scene.suture.radius_m, realtime};
}

/// The telemetry thread: until `done`, then what is left.
void tell(telemetry::LcmLink& link, telemetry::Telemetry& telemetry, const std::atomic<bool>& done) {
  while (!done) {
    link.wait(5);
    telemetry.step(utime_now());
  }
  telemetry.finish(utime_now());
  if (link.failures() > 0) spdlog::warn("LCM: {} messages could not be sent", link.failures());
}

/// The real-time thread: asks for its rights, reports what was refused, and waits for the word to start.
void beat(RigCycle& cycle, bool ask, int core, std::promise<platform::Refusals>& rights, std::future<bool> go) {
  platform::flush_denormals();
  rights.set_value(ask ? platform::make_realtime(core) : platform::Refusals{});
  if (go.get()) cycle.run();
}

platform::Refusals report(platform::Refusals memory, const platform::Refusals& thread) {
  memory.insert(memory.end(), thread.begin(), thread.end());
  for (const auto& r : memory) spdlog::warn("real time: {}", r);
  return memory;
}

}  // namespace

int run(const RunOptions& options) {
  auto planned = make_plan(options);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return fail(*refusal);
  Plan& plan = std::get<Plan>(planned);

  const StopSignals signals;
  const int core = platform::realtime_core();
  if (options.rt != RtMode::kOff) platform::keep_off(core);

  const auto outlets = std::make_unique<rt::Outlets>();
  telemetry::LcmLink link(options.lcm_url, [&](const ligature_msg::event_t& e) {
    log(e);
    if (options.exit_on_fault && e.kind == ligature_msg::event_t::KIND_FAULT) outlets->stop = true;
  });
  if (!link.is_open()) spdlog::warn("LCM: cannot open {}; running without telemetry", options.lcm_url);

  bool interrupted = false;
  auto opened = open_buses(options, [&] { return interrupted = interrupted || signals.wait(); });
  if (interrupted) return 0;
  if (const auto* refusal = std::get_if<Refusal>(&opened)) return fail(*refusal);
  const Buses& buses = std::get<Buses>(opened);
  platform::PollWait wait(*buses.left, *buses.right);
  platform::RigBus bus(*buses.left, *buses.right, wait);
  platform::MonotonicClock clock;
  control::Controller controller(plan.scene.hands, {options.watchdog_ms, options.arm});
  const auto cycle = std::make_unique<RigCycle>(bus, clock, controller, plan.thread, *outlets);
  if (options.duration_s) cycle->end_after(std::llround(*options.duration_s / control::kPeriod_s));

  std::promise<platform::Refusals> rights;
  std::promise<bool> go;
  const bool ask = options.rt != RtMode::kOff;
  const auto memory = ask ? platform::lock_memory() : platform::Refusals{};
  std::atomic<bool> beating{true};
  std::thread real_time([&] {
    beat(*cycle, ask, core, rights, go.get_future());
    beating = false;
  });
  const auto refused = report(memory, rights.get_future().get());
  std::optional<Refusal> no_start = configure(buses, options);
  if (options.rt == RtMode::kEnforce && !refused.empty()) no_start = Refusal{3, "--rt=enforce: " + refused.front()};
  if (no_start) {
    go.set_value(false);
    real_time.join();
    return fail(*no_start);
  }

  telemetry::Telemetry telemetry(session(plan, options, ask && refused.empty()), kNames, *outlets, link);
  if (!link.listen([&](const auto& command) { return telemetry.handle(command, utime_now()); }) && link.is_open()) {
    spdlog::warn("LCM: cannot listen for commands on {}", options.lcm_url);
  }
  std::atomic<bool> done{false};
  std::thread teller([&] { tell(link, telemetry, done); });
  platform::start_drives(*buses.left);
  platform::start_drives(*buses.right);
  go.set_value(true);

  while (beating) {
    if (signals.wait()) outlets->stop = true;
  }
  real_time.join();
  done = true;
  teller.join();
  std::fputs(summary(cycle->timing(), cycle->periods(), outlets->records.dropped()).c_str(), stdout);
  if (controller.fault() == control::Fault::kNone) return 0;
  const auto fault = controller.fault();
  return fail({3, "ended in fault " + std::to_string(static_cast<int>(fault)) + ": " + control::name(fault)});
}

}  // namespace ligature::app
