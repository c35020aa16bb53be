#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/messages.hpp"
#include "protocol/lcm/default_url.hpp"

namespace lcm {
class LCM;
}

namespace ligature::host {

/// One received message.
struct Message {
  std::int64_t received_us = 0;  // CLOCK_REALTIME
  std::string_view channel;
  Bytes data;
};

/// Subscribes and publishes on one LCM URL.
class LcmLink {
 public:
  using Handler = std::function<void(const Message&)>;

  /// @param channels regular expression of the channels to receive.
  /// @throws BadInput for an invalid URL, RunFailed when the network refuses (no multicast route).
  LcmLink(const std::string& url, const std::string& channels, Handler handler);
  ~LcmLink();

  /// Passes received messages to the handler; waits up to `timeout_ms` for the first one. Returns early on a signal.
  /// @return how many messages were passed on. @throws RunFailed, and what the handler threw.
  int receive(int timeout_ms);

  /// @param message an lcm-gen type. @throws RunFailed when it could not be sent.
  template <class M>
  void publish(std::string_view channel, const M& message) {
    std::vector<std::byte> bytes;
    encode(message, bytes);
    publish_bytes(channel, bytes);
  }

 private:
  void publish_bytes(std::string_view channel, Bytes bytes);

  struct Receiver;
  std::unique_ptr<lcm::LCM> lcm_;
  std::unique_ptr<Receiver> receiver_;
};

}  // namespace ligature::host
