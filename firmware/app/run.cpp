#include "firmware/app/run.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "firmware/app/admission.hpp"
#include "firmware/app/real_time_side.hpp"
#include "firmware/app/rig_setup.hpp"
#include "firmware/app/scene_desk.hpp"
#include "firmware/app/stop_signals.hpp"
#include "firmware/app/summary.hpp"
#include "firmware/platform/make_drives.hpp"
#include "firmware/telemetry/flight_recorder.hpp"
#include "firmware/telemetry/in_words.hpp"
#include "firmware/telemetry/lcm_link.hpp"
#include "protocol/can/hand_of_bus.hpp"

namespace ligature::app {
namespace {

constexpr double kAdmission_s = 0.3;

template <class ClockT>
std::int64_t microseconds_of() {
  return std::chrono::duration_cast<std::chrono::microseconds>(ClockT::now().time_since_epoch()).count();
}

telemetry::Moment now() {
  return {microseconds_of<std::chrono::steady_clock>(), microseconds_of<std::chrono::system_clock>()};
}

int fail(const Refusal& refusal) {
  std::fprintf(stderr, "ligature-firmware: %s\n", refusal.text.c_str());
  return refusal.exit_code;
}

void log(const ligature_msg::event_t& e) {
  if (e.kind == ligature_msg::event_t::KIND_FAULT) {
    spdlog::error("tick {}: {}", e.tick, e.text);
  } else if (e.kind == ligature_msg::event_t::KIND_REFUSED || e.kind == ligature_msg::event_t::KIND_WAITS ||
             (e.kind == ligature_msg::event_t::KIND_RECORDER && e.code == 0)) {
    spdlog::warn("tick {}: {}", e.tick, e.text);
  } else if (e.kind != ligature_msg::event_t::KIND_LIMIT) {
    spdlog::info("tick {}: {}", e.tick, e.text);
  }
}

constexpr telemetry::Names kNames{
    [](int s) { return control::name(static_cast<control::State>(s)); },
    [](int f) { return control::name(static_cast<control::Fault>(f)); },
    [](int f) { return control::needs_restart(static_cast<control::Fault>(f)); },
};

/// Opens the flight recorder. A failure is only a warning, because the rig is equally safe without a recorder.
std::unique_ptr<telemetry::FlightRecorder> open_recorder(const Plan& plan, const RunOptions& options,
                                                         std::int64_t session) {
  if (options.recorder == "none") return nullptr;
  const auto path = std::filesystem::absolute(options.recorder);
  std::error_code ignored;  // open() reports the error
  std::filesystem::create_directories(path.parent_path(), ignored);
  auto opened = telemetry::FlightRecorder::open(
      path.string(),
      {session, control::kPeriod_s, plan.scene.hands.max_force_N, LIGATURE_VERSION, options.scene, plan.toml},
      std::int64_t{1000} * options.recorder_s);
  if (const auto* why = std::get_if<std::string>(&opened)) {
    spdlog::warn("{}; running without", *why);
    return nullptr;
  }
  return std::move(std::get<0>(opened));
}

telemetry::Session session(const Plan& plan, const RunOptions& options, std::int64_t id, bool realtime, bool admitted,
                           const telemetry::FlightRecorder* recorder) {
  return {id,
          LIGATURE_VERSION,
          {options.scene, plan.toml, plan.scene.hands.max_force_N, plan.scene.suture.radius_m, admitted},
          control::kPeriod_s,
          realtime,
          recorder != nullptr ? recorder->path() : std::string()};
}

/// Reports the outcome of a change of scene or parameters to the flight recorder, to telemetry and to the command's
/// sender.
void tell_change(telemetry::LcmLink& link, telemetry::Telemetry& telemetry, SceneDesk& desk,
                 telemetry::FlightRecorder* recorder) {
  if (recorder != nullptr) recorder->expect_scene(desk.is_busy());  // before the loop can have taken it
  auto outcome = desk.poll();
  if (!outcome) return;
  const auto at = now();
  telemetry.stamp(outcome->ack, at);
  if (const auto& c = outcome->changed) {
    if (recorder != nullptr) recorder->scene_changed({c->first_tick, c->max_force_N, c->admitted, c->file, c->toml});
    telemetry.scene_changed({c->file, c->toml, c->max_force_N, c->radius_m, c->admitted, c->first_tick}, c->text, at);
    telemetry.set_offer(desk.offer());
  }
  if (recorder != nullptr) recorder->expect_scene(false);
  link.answer(outcome->ack);
}

/// Body of the telemetry thread: runs until `done`, then sends what is left.
void tell(telemetry::LcmLink& link, telemetry::Telemetry& telemetry, SceneDesk& desk,
          telemetry::FlightRecorder* recorder, const std::atomic<bool>& done) {
  while (!done) {
    link.wait(5);
    telemetry.step(now());
    tell_change(link, telemetry, desk, recorder);
  }
  telemetry.finish(now());
  if (link.failures() > 0) spdlog::warn("LCM: {} messages could not be sent", link.failures());
}

std::string no_telemetry(const std::string& url) {
  return "cannot open " + url +
         ": no multicast route, or the port is taken; remedy: run inside scripts/private-net, or "
         "'ip link set lo up; ip route add 224.0.0.0/4 dev lo' as root; --no-telemetry runs without anybody listening";
}

/// Logs which functions the drives lack, such as a watchdog. A line that is the same for both hands is logged once.
void log_lacks(const Buses& buses) {
  std::vector<std::string> told;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    for (const std::string& line : buses.drives[h]->lacks()) {
      if (std::ranges::find(told, line) != told.end()) continue;
      told.push_back(line);
      spdlog::warn("drives: {}", line);
    }
  }
}

Losses losses(const rt::Outlets& outlets, const telemetry::FlightRecorder* recorder) {
  if (recorder == nullptr) return {outlets.records.dropped(), false, 0, {}};
  return {outlets.records.dropped(), true, recorder->missing(), recorder->slowest_sync()};
}

/// Starts the loop, and runs telemetry beside it until the loop has ended, by itself or because of a signal. @return
/// the exit code.
int run_loop(RealTimeSide& side, telemetry::LcmLink& link, telemetry::Telemetry& telemetry, SceneDesk& desk,
             telemetry::FlightRecorder* recorder, const Buses& buses, rt::Outlets& outlets,
             const StopSignals& signals) {
  std::atomic<bool> done{false};
  std::thread teller([&] { tell(link, telemetry, desk, recorder, done); });
  for (const auto& drives : buses.drives) drives->start();
  side.start();
  while (side.is_beating()) {
    if (signals.wait()) outlets.stop = true;
  }
  side.end();
  if (recorder != nullptr) recorder->finish();  // telemetry still runs, because finish() may produce messages for it
  done = true;
  teller.join();
  const auto& cycle = side.cycle();
  std::fputs(summary(cycle.timing(), cycle.periods(), losses(outlets, recorder)).c_str(), stdout);
  const auto fault = side.fault();
  if (fault == control::Fault::kNone) return 0;
  return fail(
      {3, "ended in " + telemetry::fault_in_words(static_cast<int>(fault), control::name(fault), side.culprit())});
}

}  // namespace

int run(const RunOptions& options) {
  if (const auto why = telemetry::objection_to_url(options.lcm_url); !why.empty())
    return fail({2, "--lcm-url: " + why});
  auto planned = make_plan(options);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return fail(*refusal);
  Plan& plan = std::get<Plan>(planned);

  const StopSignals signals;
  const bool ask = options.rt != RtMode::kOff;
  const int core = platform::realtime_core();
  if (ask) platform::keep_off(core);
  if (ask && options.physics_core >= 0) platform::keep_off(options.physics_core);

  const Admission admission =
      admit(plan.scene, {kAdmission_s, core, options.budget_percent, options.no_loss_m_per_s > 0.0, plan.device});
  const auto excess = objection_of(admission, options.no_loss_m_per_s);
  if (excess && !options.force) return fail({3, options.scene + ": " + *excess});
  if (excess) {
    spdlog::warn("--force: {}", *excess);
    plan.toml += forced(*excess);
  }
  give_work(plan, admission.thread.work);

  for (const auto& [hand, bus] : {std::pair("left", &options.left), std::pair("right", &options.right)})
    if (const auto doubt = can::doubt_about_hand(hand, *bus); !doubt.empty()) spdlog::warn("{}", doubt);
  const auto outlets = std::make_unique<rt::Outlets>();
  telemetry::LcmLink link(options.no_telemetry ? "memq://" : options.lcm_url, [&](const ligature_msg::event_t& e) {
    log(e);
    if (options.exit_on_fault && e.kind == ligature_msg::event_t::KIND_FAULT) outlets->stop = true;
  });
  if (!link.is_open()) return fail({3, no_telemetry(options.lcm_url)});

  bool interrupted = false;
  auto opened = open_buses(options, plan.device, [&] { return interrupted = interrupted || signals.wait(); });
  if (interrupted) return 0;
  if (const auto* refusal = std::get_if<Refusal>(&opened)) return fail(*refusal);
  const Buses& buses = std::get<Buses>(opened);

  const std::int64_t id = now().utime;
  const auto recorder = open_recorder(plan, options, id);
  if (recorder) outlets->flight = &recorder->inlet();
  SceneDesk desk(options, plan, excess.value_or(""), !admission.fits());
  const auto side = std::make_unique<RealTimeSide>(options, plan, buses, *outlets, desk.handover());
  const auto refused = side->prepare(ask, core);
  if (options.rt == RtMode::kEnforce && !refused.empty()) return fail({3, "--rt=enforce: " + refused.front()});
  if (const auto refusal = configure(buses)) return fail(*refusal);
  log_lacks(buses);

  telemetry::Telemetry telemetry(session(plan, options, id, ask && refused.empty(), !excess, recorder.get()), kNames,
                                 *outlets, link, recorder.get());
  telemetry.set_offer(desk.offer());
  link.listen([&](const ligature_msg::command_t& c) -> std::optional<ligature_msg::ack_t> {
    if (auto turned_away = telemetry.turn_away(c, now())) return turned_away;
    if (!SceneDesk::is_for(c)) return telemetry.handle(c, now());
    const auto& last = telemetry.last();
    auto answer = desk.request(c, last.armed || control::may_push(static_cast<control::State>(last.state)));
    if (answer) telemetry.stamp(*answer, now());
    return answer;
  });
  return run_loop(*side, link, telemetry, desk, recorder.get(), buses, *outlets, signals);
}

}  // namespace ligature::app
