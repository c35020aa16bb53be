#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/messages.hpp"

namespace lcm {
class LCM;
}

namespace ligature::host {

/// ttl 0: nothing leaves this machine. A large receive buffer, because a small one is what loses messages.
inline constexpr std::string_view kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// One message as it came from the network.
struct Message {
  std::int64_t received_us = 0;  // CLOCK_REALTIME
  std::string_view channel;
  Bytes data;
};

/// Subscription and publishing on one LCM URL.
class LcmLink {
 public:
  using Handler = std::function<void(const Message&)>;

  /// @param channels regular expression of the channels to hear.
  /// @throws BadInput for a URL that is none, RunFailed when the network refuses (no multicast route).
  LcmLink(const std::string& url, const std::string& channels, Handler handler);
  ~LcmLink();

  /// Hands over what has come; waits for at most `timeout_ms` when nothing has. Returns early at a signal.
  /// @return how many messages were handed over. @throws what the handler threw; RunFailed.
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
