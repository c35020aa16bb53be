#include "host/stream/command.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "host/commands/options.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lcm_link.hpp"
#include "host/stream/foxglove_server.hpp"
#include "host/stream/live_topics.hpp"
#include "host/stream/udp_sender.hpp"

namespace ligature::host::stream {
namespace {

struct Options {
  FoxgloveOptions foxglove;
  std::string udp, lcm_url{lcm_tools::kDefaultUrl};
};

void run(const Options& options) {
  std::optional<UdpSender> udp;
  if (!options.udp.empty()) udp.emplace(options.udp);
  FoxgloveServer server(options.foxglove);
  LiveTopics topics;
  LcmLink link(options.lcm_url, "LIGATURE_.*", [&](const Message& message) {
    auto messages = topics.take(message);
    if (udp) udp->send(messages);
    if (!messages.empty()) server.publish(std::move(messages));
  });
  const bool is_v6 = options.foxglove.listen.find(':') != std::string::npos;
  std::printf("Foxglove WebSocket: ws://%s%s%s:%d\n", is_v6 ? "[" : "", options.foxglove.listen.c_str(),
              is_v6 ? "]" : "", server.port());
  std::fflush(stdout);
  while (!console::stop_requested()) link.receive(50);
}

}  // namespace

void add_stream(CLI::App& app) {
  auto* command = app.add_subcommand("stream", "Send the running rig to Foxglove and PlotJuggler");
  const auto options = std::make_shared<Options>();
  command->add_option("--port", options->foxglove.port, "TCP port for Foxglove; 0 takes any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--listen", options->foxglove.listen,
                   "address to listen on; 127.0.0.1 is seen by this machine alone")
      ->capture_default_str();
  command->add_option("--allow-origin", options->foxglove.allowed_origins,
                      "web site that may read, beside app.foxglove.dev; such as http://viewer.lab:8080");
  command->add_option("--udp", options->udp, "ADDRESS:PORT that gets each tick as a JSON datagram (PlotJuggler: 9870)");
  add_url(*command, options->lcm_url);
  command->footer(
      "Sends every tick, every shape of the thread and every event, as long as it runs. The topics are those of\n"
      "'export --mcap' (docs/analysis.md). Viewers can only look: nothing that they send reaches the rig.\n"
      "A viewer that reads too slowly misses messages, and is told how many.\n\n"
      "Example: in Foxglove choose Open connection, Foxglove WebSocket, and the address that this prints\n"
      "  ligature-host stream --udp 127.0.0.1:9870");
  command->callback([options] { run(*options); });
}

}  // namespace ligature::host::stream
