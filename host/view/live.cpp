#include "host/view/live.hpp"

#include <atomic>
#include <cstdio>
#include <exception>
#include <thread>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/lcm_link.hpp"
#include "host/view/command_desk.hpp"
#include "host/view/knot_watch.hpp"
#include "host/view/page_recorder.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {
Access access_for(const ServerOptions& server, const std::string& token_file) {
  if (!token_file.empty()) return {read_token_file(token_file), false};
  return is_loopback(server) ? Access{make_token(), true} : Access{};
}

void announce(const Server& server, const ServerOptions& options, const Access& access) {
  std::printf("open %s\n", url_of(options, server.port()).c_str());
  if (access.token.empty())
    std::printf("listening beyond this machine without --token-file: pages may look, not command\n");
  else if (!access.gives_token)
    std::printf("commands need the token: add #token= and the first line of the token file to the address\n");
  std::fflush(stdout);
}

void view_live(const ViewOptions& options) {
  const Access access = access_for(options.server, options.token_file);
  Picture picture;
  picture.set("view", {{"mode", "live"},
                       {"version", LIGATURE_VERSION},
                       {"may_command", !access.token.empty()},
                       {"names", names_json()}});
  PageRecorder recorder(access, options.recordings, picture);
  CommandDesk* desk_for_acks = nullptr;
  LcmLink link(options.lcm_url, "LIGATURE_.*", [&](const Message& message) {
    recorder.take(message);
    if (message.channel == kAckChannel) {
      if (const auto ack = decode<ligature_msg::ack_t>(message.data); ack && desk_for_acks)
        desk_for_acks->take_ack(*ack);
    } else {
      picture.take(message.channel, message.data, Picture::Clock::now());
    }
  });
  CommandDesk desk(access, [&link](const auto& command) { link.publish(kCommandChannel, command); });
  desk_for_acks = &desk;

  std::exception_ptr failure;
  std::atomic<bool> is_deaf = false;
  const auto on_message = [&](std::uint64_t page, const nlohmann::json& message) {
    if (message.contains("record")) return recorder.request(message);
    return desk.request(page, message, CommandDesk::Clock::now());
  };
  const auto on_tick = [&](bool& more) {
    more = !console::stop_requested() && !is_deaf;
    return desk.answers(CommandDesk::Clock::now());
  };
  Server server(options.server, access, picture, {on_message, on_tick});
  announce(server, options.server, access);
  {
    const KnotWatch knots(picture);
    const std::jthread hearing([&](const std::stop_token& stop) {
      try {
        while (!stop.stop_requested()) link.receive(50);
      } catch (...) {
        failure = std::current_exception();
        is_deaf = true;
      }
    });
    server.run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ligature::host::view
