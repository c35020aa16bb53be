#include "host/view/live.hpp"

#include <atomic>
#include <cstdio>
#include <exception>
#include <thread>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/lcm_link.hpp"
#include "host/view/command_desk.hpp"
#include "host/view/hand_desk.hpp"
#include "host/view/knot_watch.hpp"
#include "host/view/page_recorder.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {
namespace {

/// Passes the hands' states and the status to the hand desk.
void take(HandDesk& hands, const Message& message) {
  if (message.channel == kHandStateChannel) {
    if (const auto state = hand_state_of(message.data)) hands.take_state(*state, HandDesk::Clock::now());
  } else if (message.channel == kStatusChannel) {
    if (const auto status = decode<ligature_msg::status_t>(message.data)) hands.take_status(*status);
  }
}

}  // namespace

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
  HandDesk* hands_to_tell = nullptr;
  LcmLink link(options.lcm_url, "LIGATURE_.*", [&](const Message& message) {
    recorder.take(message);
    if (message.channel == kAckChannel) {
      if (const auto ack = decode<ligature_msg::ack_t>(message.data); ack && desk_for_acks)
        desk_for_acks->take_ack(*ack);
    } else {
      if (hands_to_tell) take(*hands_to_tell, message);
      picture.take(message.channel, message.data, Picture::Clock::now());
    }
  });
  CommandDesk desk(access, [&link](const auto& command) { link.publish(kCommandChannel, command); });
  desk_for_acks = &desk;
  HandDesk hands(access, [&link](const auto& wish) { link.publish(kHandWishChannel, wish); });
  hands_to_tell = &hands;

  std::exception_ptr failure;
  std::atomic<bool> is_deaf = false;
  const auto on_message = [&](std::uint64_t page, const nlohmann::json& message) {
    if (message.contains("record")) return recorder.request(message);
    if (message.contains("hand") || message.contains("wish"))
      return hands.request(page, message, HandDesk::Clock::now());
    return desk.request(page, message, CommandDesk::Clock::now());
  };
  nlohmann::json told_of_hands;
  const auto on_tick = [&](bool& more) {
    if (auto told = hands.told(HandDesk::Clock::now()); told != told_of_hands) {
      picture.set("hands", told);
      told_of_hands = std::move(told);
    }
    more = !console::stop_requested() && !is_deaf;
    return desk.answers(CommandDesk::Clock::now());
  };
  Server server(options.server, access, picture,
                {on_message, on_tick, [&hands](std::uint64_t page) { hands.end(page); }});
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
