#include "bridge/haply_device.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <regex>

namespace ligature::bridge {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr auto kConnectWithin = std::chrono::seconds(2);
constexpr auto kTryAgainAfter = std::chrono::milliseconds(200);

class HaplyDevice final : public Device {
 public:
  HaplyDevice(std::string host, std::string port, HaplyChoice choice, std::chrono::nanoseconds answer_within)
      : host_(std::move(host)), port_(std::move(port)), choice_(std::move(choice)), answer_within_(answer_within) {}

  std::optional<DeviceState> exchange(const Vec& force_D_N) override {
    if (!socket_ && !connect()) return std::nullopt;
    // Before the first state, the device's id is not known; the service sends that state by itself.
    if (known_.inverse3_id.empty()) return receive(kConnectWithin);
    const std::string command = haply_command(known_.inverse3_id, force_D_N, is_first_);
    Error error;
    run(
        answer_within_, [&](auto done) { socket_->async_write(asio::buffer(command), done); }, error);
    if (error) return lose("sending: " + error.message());
    is_first_ = false;
    return receive(answer_within_);
  }

  std::string problem() const override { return problem_; }

 private:
  using Socket = websocket::stream<beast::tcp_stream>;

  /// Runs one asynchronous operation to its end, at most for a given time.
  template <class Start>
  void run(std::chrono::nanoseconds at_most, Start start, Error& error) {
    error = asio::error::timed_out;
    io_.restart();
    start([&error](Error result, auto&&...) { error = result; });
    io_.run_for(at_most);
    if (io_.stopped()) return;
    beast::get_lowest_layer(*socket_)
        .socket()
        .close();  // cancels the operation, whose handler must not outlive `error`
    io_.run();
    error = asio::error::timed_out;
  }

  bool connect() {
    const auto now = std::chrono::steady_clock::now();
    if (now < try_at_) return false;
    try_at_ = now + kTryAgainAfter;
    known_ = {};
    is_first_ = true;
    inbox_.clear();
    Error error;
    const auto found = tcp::resolver(io_).resolve(host_, port_, error);
    if (error) return fail(host_ + ": " + error.message());
    socket_.emplace(io_);
    run(
        kConnectWithin, [&](auto done) { beast::get_lowest_layer(*socket_).async_connect(found, done); }, error);
    if (!error) {
      Error ignored;
      beast::get_lowest_layer(*socket_).socket().set_option(tcp::no_delay(true), ignored);
      run(
          kConnectWithin, [&](auto done) { socket_->async_handshake(host_ + ":" + port_, "/", done); }, error);
    }
    if (!error) return true;
    socket_.reset();
    return fail("no service at ws://" + host_ + ":" + port_ + ": " + error.message());
  }

  std::optional<DeviceState> receive(std::chrono::nanoseconds at_most) {
    Error error;
    run(
        at_most, [&](auto done) { socket_->async_read(inbox_, done); }, error);
    if (error) return lose("no state: " + error.message());
    const auto data = inbox_.data();
    const auto read = read_haply({static_cast<const char*>(data.data()), data.size()}, choice_, known_);
    inbox_.consume(inbox_.size());
    if (!read)
      return lose("the service has no Inverse3" + (choice_.inverse3_id.empty() ? "" : " " + choice_.inverse3_id));
    if (!read->problem.empty()) {
      problem_ = "Inverse3 " + read->inverse3_id + ": " + read->problem;
      return std::nullopt;
    }
    return read->state;
  }

  bool fail(const std::string& why) {
    problem_ = why;
    return false;
  }
  std::optional<DeviceState> lose(const std::string& why) {
    socket_.reset();
    problem_ = why;
    return std::nullopt;
  }

  std::string host_, port_;
  HaplyChoice choice_;
  std::chrono::nanoseconds answer_within_;
  asio::io_context io_{1};
  std::optional<Socket> socket_;
  beast::flat_buffer inbox_{1U << 20U};
  HaplyState known_;
  bool is_first_ = true;
  std::chrono::steady_clock::time_point try_at_{};
  std::string problem_ = "not connected yet";
};

}  // namespace

OpenedDevice open_haply(const std::string& url, const HaplyChoice& choice, std::chrono::nanoseconds answer_within) {
  static const std::regex form(R"(ws://([A-Za-z0-9.-]+):([0-9]{1,5})/?)");
  std::smatch parts;
  if (!std::regex_match(url, parts, form) || std::stoi(parts[2]) > 65535)
    return "--haply: found '" + url + "', allowed ws://HOST:PORT such as ws://127.0.0.1:10001";
  return std::unique_ptr<Device>(std::make_unique<HaplyDevice>(parts[1], parts[2], choice, answer_within));
}

}  // namespace ligature::bridge
