// ligature-bridge: makes a haptic device on USB or on the network look like drives on a CAN bus, so that
// ligature-firmware can use it.

#include <poll.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <variant>

#include "bridge/drives.hpp"
#include "bridge/exchange.hpp"
#include "bridge/haply_device.hpp"
#include "bridge/plugin_device.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/event_loop.hpp"
#include "sim_device/port.hpp"
#include "sim_device/scheduling.hpp"

namespace {

using namespace ligature;
using namespace ligature::bridge;
constexpr int kBadInput = 2, kRunFailed = 3;
constexpr sim::Time kOwnerWithin = std::chrono::milliseconds(20);

volatile std::sig_atomic_t g_stop = 0;

struct Options {
  std::string bus, device, haply, backend, address, stats;
  HaplyChoice choice;
  double rate_Hz = 2000.0, silence_ms = 20.0;
  bool real_time = false;
  int cpu = -1;
};

constexpr const char* kAbout =
    "Shows a haptic device that is no CAN drive to ligature-firmware as three drives on a bus: its position as joint\n"
    "angles, its buttons, and the drives' torques as its force. docs/bridge.md";
constexpr const char* kExample =
    "One device is one hand. Examples:\n"
    "  ligature-bridge --bus local:/tmp/left --device scenes/devices/inverse3.toml --haply ws://127.0.0.1:10001 --id "
    "049D\n"
    "  ligature-bridge --bus local:/tmp/right --device my_device.toml --backend ./my_device.so --address 0\n"
    "Without the dead-man button of the device there is never a force. A device that is silent for --silence-ms looks "
    "to\n"
    "the firmware like drives without power: a fault, and no force.\n"
    "Exit: 0 ended (SIGINT, SIGTERM), 2 bad usage or input, 3 the run failed.";

CLI::Validator within(double low, double high) {
  return {[=](const std::string& word) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(word, value) && value >= low && value <= high;
            return good ? std::string()
                        : "found '" + word + "', allowed " + CLI::detail::to_string(low) + " .. " +
                              CLI::detail::to_string(high);
          },
          "FLOAT in [" + CLI::detail::to_string(low) + " - " + CLI::detail::to_string(high) + "]"};
}

std::variant<Options, int> parse(int argc, char** argv) {
  Options o;
  CLI::App app(kAbout, "ligature-bridge");
  app.footer(kExample);
  app.set_version_flag("--version", "ligature-bridge " LIGATURE_VERSION);
  app.add_option("--bus", o.bus, "local:/path/socket (made and served here) or socketcan:interface")->required();
  app.add_option("--device", o.device, "Device record with kinematics = \"cartesian\"; the firmware needs the same one")
      ->required();
  auto* const haply = app.add_option("--haply", o.haply, "Haply's Inverse Service: ws://HOST:PORT, usually port 10001");
  app.add_option("--id", o.choice.inverse3_id, "device_id of the Inverse3; without it the first one")->needs(haply);
  app.add_option("--grip-id", o.choice.grip_id,
                 "device_id of the VerseGrip; without it the only one. With several, none is used")
      ->needs(haply);
  app.add_option("--dead-man-button", o.choice.dead_man, "Button of the VerseGrip")
      ->needs(haply)
      ->capture_default_str();
  app.add_option("--grip-button", o.choice.grip, "Button of the VerseGrip")->needs(haply)->capture_default_str();
  app.add_option("--clutch-button", o.choice.clutch, "Button of the VerseGrip")->needs(haply)->capture_default_str();
  auto* const backend = app.add_option("--backend", o.backend, "Shared library for another device (bridge/backend.h)");
  app.add_option("--address", o.address, "What the library is told to open")->needs(backend);
  haply->excludes(backend);
  app.add_option("--rate", o.rate_Hz, "Exchanges with the device a second, at most")
      ->check(within(200.0, 20000.0))
      ->capture_default_str();
  app.add_option("--silence-ms", o.silence_ms, "After so long without a state the device counts as lost")
      ->check(within(2.0, 1000.0))
      ->capture_default_str();
  app.add_option("--stats", o.stats,
                 "At the end, write JSON: exchanges, age of the state at each SYNC, wait of each force");
  app.add_flag("--rt", o.real_time, "Ask for SCHED_FIFO and locked memory; runs on with a warning when refused");
  app.add_option("--cpu", o.cpu, "Stay on this CPU")->check(within(0, 1023));
  try {
    app.parse(argc, argv);
    if (o.haply.empty() && o.backend.empty()) throw CLI::RequiredError("--haply or --backend");
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::cerr << "ligature-bridge: " << e.what() << " (see --help)\n";
    return kBadInput;
  }
  return o;
}

int refuse(const std::string& why) {
  std::fprintf(stderr, "ligature-bridge: %s\n", why.c_str());
  return kBadInput;
}

void say(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

std::string stats_json(const Drives& drives, const Exchange& exchange) {
  const auto us = [](Nanoseconds t) { return 1e-3 * static_cast<double>(t.count()); };
  const SampleAges& ages = drives.ages();
  const ForceWaits waits = exchange.force_waits();
  const auto fresh = std::max<std::int64_t>(1, ages.syncs - ages.stale);
  std::int64_t trips = 0;
  for (const auto& node : drives.nodes()) trips += node.stats().watchdog_trips;
  return nlohmann::ordered_json{
             {"exchanges", exchange.exchanges()},
             {"longest_exchange_us", us(exchange.longest_exchange())},
             {"syncs", ages.syncs},
             {"syncs_without_sample", ages.stale},
             {"syncs_while_silent", ages.silent},
             {"mean_state_age_us", us(ages.sum) / static_cast<double>(fresh)},
             {"worst_state_age_us", us(ages.worst)},
             {"forces", waits.forces},
             {"mean_force_wait_us", us(waits.sum) / static_cast<double>(std::max<std::int64_t>(1, waits.forces))},
             {"worst_force_wait_us", us(waits.worst)},
             {"watchdog_trips", trips}}
             .dump(1) +
         "\n";
}

/// One turn of the bridge's loop: takes the device's newest state, exchanges frames with the bus, and sets the device's
/// force.
class Turn {
 public:
  Turn(Drives& drives, Exchange& exchange, sim::Port& port) : drives_(drives), exchange_(exchange), port_(port) {}

  void wait() {
    fds_.assign(1, {exchange_.descriptor(), POLLIN, 0});
    port_.add_descriptors(fds_);
    const auto left =
        std::clamp<Nanoseconds>(drives_.wake_at() - sim::now_monotonic(), Nanoseconds(0), std::chrono::milliseconds(5));
    const timespec limit{0, left.count()};
    ppoll(fds_.data(), fds_.size(), &limit, nullptr);
  }

  void serve(Nanoseconds now) {
    exchange_.clear_event();
    if (const auto heard = exchange_.newest()) drives_.take(heard->state, heard->at);
    received_.clear();
    left_.clear();
    port_.receive(received_, left_);
    for (const auto& [frame, client] : received_) drives_.submit(frame, sim::HandDevice::kFirstClient + client, now);
    drives_.advance(now);
    exchange_.set_force(drives_.force_D_N(), now);
    auto& out = drives_.deliveries();
    std::size_t sent = 0;
    for (; sent < out.size() && out[sent].due <= now; ++sent)
      port_.send(out[sent].frame, out[sent].sender - sim::HandDevice::kFirstClient);
    out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(sent));
    for (const int client : left_) drives_.drop_client(sim::HandDevice::kFirstClient + client);
  }

 private:
  Drives& drives_;
  Exchange& exchange_;
  sim::Port& port_;
  std::vector<pollfd> fds_;
  std::vector<sim::Received> received_;
  std::vector<int> left_;
};

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = parse(argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const auto& options = std::get<Options>(parsed);
  const auto read = device::load_device(options.device);
  if (const auto* e = std::get_if<scene::Error>(&read)) return refuse(e->text);
  const auto& record = std::get<device::Device>(read);
  const Nanoseconds period(static_cast<std::int64_t>(1e9 / options.rate_Hz));
  if (const auto why = objection_to(record, period); !why.empty()) return refuse(why);
  const Nanoseconds silence(static_cast<std::int64_t>(1e6 * options.silence_ms));
  auto opened = options.haply.empty() ? open_plugin(options.backend, options.address)
                                      : open_haply(options.haply, options.choice, silence);
  if (const auto* why = std::get_if<std::string>(&opened)) return refuse(*why);
  auto port = sim::open_port(options.bus);
  if (const auto* why = std::get_if<std::string>(&port)) return refuse(*why);
  sim::Port& bus = *std::get<std::unique_ptr<sim::Port>>(port);

  struct sigaction action {};
  action.sa_handler = [](int) { g_stop = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  Exchange exchange(std::get<std::unique_ptr<Device>>(std::move(opened)), period, kOwnerWithin);
  for (const std::string& line : sim::ask_for_scheduling(options.real_time, options.cpu)) say(line);
  Drives drives(record, sim::now_monotonic(), silence, !bus.charges_bit_time());
  Turn turn(drives, exchange, bus);
  say("on " + options.bus + ", waiting for the device");
  bool was_heard = false;
  while (g_stop == 0) {
    turn.wait();
    turn.serve(sim::now_monotonic());
    if (drives.is_heard() != was_heard) {
      was_heard = !was_heard;
      const std::string why = exchange.problem();
      say(was_heard ? "the device answers"
                    : "the device is silent: drives off" + (why.empty() ? "" : " (" + why + ")"));
    }
  }
  exchange.set_force(Vec{}, sim::now_monotonic());
  if (options.stats.empty()) return 0;
  std::ofstream file(options.stats);
  file << stats_json(drives, exchange) << std::flush;
  if (file.good()) return 0;
  std::fprintf(stderr, "ligature-bridge: --stats %s: cannot be written\n", options.stats.c_str());
  return kRunFailed;
}
