#include "host/stream/udp_sender.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <charconv>

#include "host/errors.hpp"
#include "host/viewer_topics.hpp"

namespace ligature::host::stream {
namespace {

using udp = boost::asio::ip::udp;

udp::endpoint endpoint_of(const std::string& target) {
  const auto colon = target.rfind(':');
  const std::string port_text = colon == std::string::npos ? "" : target.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, problem] = std::from_chars(port_text.data(), port_text.data() + port_text.size(), port);
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(target.substr(0, colon), error);
  if (error || problem != std::errc() || end != port_text.data() + port_text.size() || port == 0)
    throw BadInput("--udp: found '" + target + "', allowed ADDRESS:PORT such as 127.0.0.1:9870");
  return {address, port};
}

}  // namespace

std::string tick_datagram(const TopicMessage& rig, const TopicMessage& left, const TopicMessage& right) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const std::string fraction = std::to_string(kSecond + rig.time_ns % kSecond).substr(1);
  return R"({"timestamp":)" + std::to_string(rig.time_ns / kSecond) + '.' + fraction + R"(,"rig":)" + rig.text +
         R"(,"left":)" + left.text + R"(,"right":)" + right.text + '}';
}

struct UdpSender::Socket {
  explicit Socket(const std::string& target) : to(endpoint_of(target)) {
    boost::system::error_code error;
    (void)socket.open(to.protocol(), error);
    if (error) throw RunFailed("--udp: no socket: " + error.message());
    (void)socket.non_blocking(true, error);
  }
  boost::asio::io_context io{1};
  udp::endpoint to;
  udp::socket socket{io};
};

UdpSender::UdpSender(const std::string& target) : socket_(std::make_unique<Socket>(target)) {}
UdpSender::~UdpSender() = default;

void UdpSender::send(const std::vector<TopicMessage>& messages) {
  for (std::size_t i = 0; i + 2 < messages.size(); ++i) {
    if (messages[i].topic != kRigTopic) continue;
    const std::string text = tick_datagram(messages[i], messages[i + 1], messages[i + 2]);
    boost::system::error_code lost;  // UDP: what is not taken is lost
    socket_->socket.send_to(boost::asio::buffer(text), socket_->to, 0, lost);
  }
}

}  // namespace ligature::host::stream
