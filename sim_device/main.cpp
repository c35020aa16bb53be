// ligature-device: reads its inputs, opens the bus, runs the simulated hand until it is told to stop, and reports.

#include <csignal>
#include <cstdio>
#include <iostream>
#include <string>

#include "protocol/can/hand_of_bus.hpp"
#include "protocol/device/device_file.hpp"
#include "protocol/scene/fault_script.hpp"
#include "sim_device/event_loop.hpp"
#include "sim_device/mover.hpp"
#include "sim_device/narrator.hpp"
#include "sim_device/options.hpp"
#include "sim_device/scheduling.hpp"
#include "sim_device/shelf_drives.hpp"
#include "sim_device/stats_file.hpp"

namespace {

using namespace ligature;
constexpr int kBadInput = 2, kRunFailed = 3;
constexpr sim::Time kLongestSleep = std::chrono::milliseconds(100);
// time for the controller to see the dead-man released before the bus closes
constexpr sim::Time kFarewell = std::chrono::milliseconds(200);

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

/// Blocks SIGINT and SIGTERM except while the process sleeps. @return the signal mask for sleeping.
sigset_t take_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGINT);
  sigaddset(&blocked, SIGTERM);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  return before;
}

/// Exit code of a successful run: checks that everything printed to stdout was written.
int done() {
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  std::fputs("ligature-device: standard output cannot be written\n", stderr);
  return kRunFailed;
}

int refuse(const std::string& why) {
  std::fprintf(stderr, "ligature-device: %s\n", why.c_str());
  return kBadInput;
}

std::variant<device::Device, std::string> read_record(const sim::Options& o) {
  if (o.device.empty()) return device::omni();
  auto read = device::load_device(o.device);
  if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
  return std::get<device::Device>(std::move(read));
}

sim::Body body_of(const sim::Options& o, const device::Device& record) {
  sim::Body body = sim::Body::of(record);
  body.hand = sim::hand_of(o.hold).value();
  if (o.links_bend) body.compliance = sim::Compliance::of_the_class();
  body.plant.gravity_compensation = 1.0 - o.gravity_share;
  return body;
}

/// The fault script as an injector; none if no script is given.
std::variant<std::optional<sim::FaultInjector>, std::string> read_faults(const sim::Options& o,
                                                                         const device::Device& record) {
  if (o.faults.empty()) return std::optional<sim::FaultInjector>();
  if (record.odrive || record.moteus)
    return "--faults: found a record of " + std::string(record.odrive ? "ODrives" : "moteus drives") +
           ", allowed CiA 402 drives, whose frames fault scripts change";
  const auto read = scene::load_fault_script(o.faults);
  if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
  const auto& script = std::get<scene::FaultScript>(read);
  if ((script.hand == 0) != o.is_left)
    return o.faults + ": key 'fault.hand': found the other hand, allowed " + o.hand() + " for --hand " + o.hand();
  return std::optional<sim::FaultInjector>(script);
}

void live(sim::HandDevice& device, sim::Port& port, sim::EventLoop& loop, sim::Narrator& narrator, sim::Link* link,
          bool exit_when_done, const sigset_t& during_sleep) {
  sim::Time end = sim::kNever;
  while (g_stop == 0) {
    loop.wait(kLongestSleep, during_sleep);
    const sim::Time now = sim::now_monotonic();
    loop.serve(now);
    if (link != nullptr) {
      link->look(device.mechanics(), now);
      for (const std::string& line : link->news()) narrator.say(line);
    }
    narrator.look(device, port.clients(), now);
    if (exit_when_done && end == sim::kNever && device.mechanics().is_done()) end = now + kFarewell;
    if (now >= end) return;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = sim::parse_options(argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code == 0 ? done() : *code;
  const auto& options = std::get<sim::Options>(parsed);

  if (const auto why = options.stats.empty() ? std::string() : sim::objection_to(options.stats); !why.empty())
    return refuse("--stats " + options.stats + ": " + why);
  const auto read = read_record(options);
  if (const auto* why = std::get_if<std::string>(&read)) return refuse(*why);
  const auto& record = std::get<device::Device>(read);
  const sim::Body body = body_of(options, record);
  const sigset_t during_sleep = take_signals();
  auto found =
      // Started here, so that its threads have the signals blocked and normal priority
      sim::mover_of(options, body.plant.linkage);
  if (const auto* why = std::get_if<std::string>(&found)) return refuse(*why);
  auto& mover = std::get<sim::Mover>(found);
  auto faults = read_faults(options, record);
  if (const auto* why = std::get_if<std::string>(&faults)) return refuse(*why);
  auto& injector = std::get<std::optional<sim::FaultInjector>>(faults);
  auto opened = sim::open_port(options.bus, sim::network_of(record));
  if (const auto* why = std::get_if<std::string>(&opened)) return refuse(*why);
  sim::Port& port = *std::get<std::unique_ptr<sim::Port>>(opened);

  sim::Narrator narrator(options.hand());
  for (const std::string& line : sim::ask_for_scheduling(options.real_time, options.cpu)) narrator.say(line);
  const sim::Time now = sim::now_monotonic();
  sim::HandDevice device(std::move(mover.will), now, body, !port.charges_bit_time(),
                         sim::drives_of(record, body.drives, now));
  sim::EventLoop loop(device, port, injector ? &*injector : nullptr);
  if (const auto doubt = can::doubt_about_hand(options.hand(), options.bus); !doubt.empty()) narrator.say(doubt);
  narrator.say("on " + options.bus + ", waiting for a controller");
  live(device, port, loop, narrator, mover.link.get(), options.exit_when_done, during_sleep);

  const std::string text = sim::stats_json(options.hand(), device, loop.stats(), port.dropped_frames());
  device.power_off();  // only now, because the statistics report the torques before power-off
  narrator.say("off");
  if (options.stats.empty()) return done();
  if (sim::write_file(options.stats, text)) return done();
  std::fprintf(stderr, "ligature-device: --stats %s: cannot be written\n", options.stats.c_str());
  return kRunFailed;
}
