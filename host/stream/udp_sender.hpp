#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/stream/foxglove_server.hpp"

namespace ligature::host::stream {

/// One JSON object of a whole tick: {"timestamp": seconds, "rig": {..}, "left": {..}, "right": {..}}.
[[nodiscard]] std::string tick_datagram(const TopicMessage& rig, const TopicMessage& left, const TopicMessage& right);

/// Sends each tick as one UDP datagram, for PlotJuggler's "UDP Server". Nobody needs to listen.
class UdpSender {
 public:
  /// @param target ADDRESS:PORT. @throws BadInput for another form, RunFailed when no socket can be made.
  explicit UdpSender(const std::string& target);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// @param messages from LiveTopics. The three messages of a tick must follow each other; other messages are ignored.
  void send(const std::vector<TopicMessage>& messages);

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace ligature::host::stream
