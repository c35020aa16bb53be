#include "firmware/telemetry/lcm_link.hpp"

#include <arpa/inet.h>

#include <charconv>
#include <chrono>
#include <thread>
#include <utility>

#include "firmware/telemetry/messages.hpp"
#include "protocol/lcm/quiet_stderr.hpp"

namespace ligature::telemetry {
std::string objection_to_url(const std::string& url) {
  constexpr std::string_view kMulticast = "udpm://";
  std::string why = "found '" + url.substr(0, 80) + "', allowed udpm://224.0.0.0 .. 239.255.255.255:PORT[?ttl=N]";
  if (url == "memq://") return {};
  if (!url.starts_with(kMulticast)) return why;
  const std::string place = url.substr(kMulticast.size(), url.find('?') - kMulticast.size());
  if (place.empty()) return {};  // the LCM library's default address
  const auto colon = place.find(':');
  in_addr address{};
  if (inet_pton(AF_INET, place.substr(0, colon).c_str(), &address) != 1) return why;
  if ((ntohl(address.s_addr) >> 28) != 0xE) return why;
  if (colon == std::string::npos) return {};
  int port = 0;
  const char* const end = place.data() + place.size();
  const auto read = std::from_chars(place.data() + colon + 1, end, port);
  return read.ec == std::errc{} && read.ptr == end && port >= 1 && port <= 65535 ? std::string() : why;
}

LcmLink::LcmLink(const std::string& url, OnEvent on_event) : on_event_(std::move(on_event)) {
  const lcm_tools::QuietStderr one_line_is_enough;
  lcm_ = std::make_unique<lcm::LCM>(url);
  open_ = lcm_->good();
  // Subscribing is the first use of the network, so it shows whether the network works.
  listening_ = open_ && lcm_->subscribeFunction("LIGATURE_COMMAND", &LcmLink::receive, this) != nullptr;
  open_ = listening_;
}

void LcmLink::listen(OnCommand on_command) {
  while (listening_ && lcm_->handleTimeout(0) > 0) {
  }
  on_command_ = std::move(on_command);
}

void LcmLink::wait(std::int64_t at_most_ms) {
  if (!listening_ || lcm_->handleTimeout(static_cast<int>(at_most_ms)) < 0) {
    listening_ = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(at_most_ms));
  }
}

/// Decodes with our own checks, because the decoder that lcm-gen generates can throw on a malicious message.
void LcmLink::receive(const lcm::ReceiveBuffer* received, const std::string&, LcmLink* link) {
  if (!link->on_command_) return;
  const auto command = command_of({static_cast<const std::byte*>(received->data), received->data_size});
  if (!command) return;
  if (const auto ack = link->on_command_(*command)) link->answer(*ack);
}

}  // namespace ligature::telemetry
