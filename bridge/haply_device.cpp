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
constexpr auto kFarewellWithin = std::chrono::milliseconds(20);

class HaplyDevice final : public Device {
 public:
  HaplyDevice(std::string host, std::string port, HaplyChoice choice, std::chrono::nanoseconds answer_within)
      : host_(std::move(host)), port_(std::move(port)), choice_(std::move(choice)), answer_within_(answer_within) {}
  ~HaplyDevice() override { hang_up(); }
  HaplyDevice(const HaplyDevice&) = delete;
  HaplyDevice& operator=(const HaplyDevice&) = delete;

  std::optional<DeviceState> exchange(const Vec& force_D_N) override {
    if ((!socket_ || is_lost_) && !connect()) return std::nullopt;
    // The device's id comes with the first state, which the service sends unasked after the connection is made.
    if (known_.inverse3_id.empty()) return receive(kConnectWithin);
    const std::string command = haply_command(known_.inverse3_id, force_D_N, is_first_);
    Error error;
    run(
        answer_within_, [&](auto done) { socket_.value().async_write(asio::buffer(command), done); }, error);
    if (error) return lose("sending: " + error.message());
    is_first_ = false;
    return receive(answer_within_);
  }

  std::string problem() const override { return problem_; }

 private:
  using Socket = websocket::stream<beast::tcp_stream>;

  tcp::socket& tcp_socket() { return beast::get_lowest_layer(socket_.value()).socket(); }

  /// Runs one asynchronous operation to its end. If that takes longer than `at_most`, the connection is closed.
  template <class Start>
  void run(std::chrono::nanoseconds at_most, Start start, Error& error) {
    error = asio::error::timed_out;
    io_.restart();
    start([&error](Error result, auto&&...) { error = result; });
    io_.run_for(at_most);
    if (io_.stopped()) return;
    // Cancels the operation, whose handler must not outlive `error`, and a read that still goes on
    tcp_socket().close();
    io_.run();
    error = asio::error::timed_out;
  }

  bool connect() {
    const auto now = std::chrono::steady_clock::now();
    if (now < try_at_) {
      io_.restart();
      io_.poll();  // sends the rest of the message that lose() began
      return false;
    }
    try_at_ = now + kTryAgainAfter;
    hang_up();
    known_ = {};
    is_first_ = true;
    inbox_.clear();
    Error error;
    const auto found = tcp::resolver(io_).resolve(host_, port_, error);
    if (error) return fail(host_ + ": " + error.message());
    socket_.emplace(io_);
    run(
        kConnectWithin, [&](auto done) { beast::get_lowest_layer(socket_.value()).async_connect(found, done); }, error);
    if (!error) {
      Error ignored;
      (void)tcp_socket().set_option(tcp::no_delay(true), ignored);
      run(
          kConnectWithin, [&](auto done) { socket_.value().async_handshake(host_ + ":" + port_, "/", done); }, error);
    }
    if (!error) return true;
    socket_.reset();
    return fail("no service at ws://" + host_ + ":" + port_ + ": " + error.message());
  }

  /// Waits for a state. If none comes in time, the read is not cancelled: cancelling it would close the connection for
  /// sending too, and lose() has to send zero force.
  std::optional<DeviceState> receive(std::chrono::nanoseconds at_most) {
    read_error_.reset();
    io_.restart();
    socket_.value().async_read(inbox_, [this](Error error, std::size_t) { read_error_ = error; });
    io_.run_for(at_most);
    if (!read_error_) return lose("no state: " + Error(asio::error::timed_out).message());
    if (*read_error_) return lose("no state: " + read_error_->message());
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
  /// Gives the connection up: sends zero force, but keeps the connection open until the next attempt to connect, so
  /// that a slow service still reads this message. Closing the connection while an answer is on its way may reset it,
  /// and a reset discards the message.
  std::optional<DeviceState> lose(const std::string& why) {
    problem_ = why;
    is_lost_ = true;
    try_at_ = std::chrono::steady_clock::now() + kTryAgainAfter;
    if (known_.inverse3_id.empty() || !socket_ || !socket_->is_open()) return std::nullopt;
    farewell_ = haply_command(known_.inverse3_id, Vec{}, is_first_);
    io_.restart();
    socket_->async_write(asio::buffer(farewell_), [](Error, std::size_t) {});
    io_.run_for(kFarewellWithin);
    return std::nullopt;
  }

  /// Closes a connection that was given up, and lets its operations end.
  void hang_up() {
    is_lost_ = false;
    if (!socket_) return;
    Error ignored;
    (void)tcp_socket().close(ignored);
    io_.restart();
    io_.run();
    socket_.reset();
  }

  std::string host_, port_;
  HaplyChoice choice_;
  std::chrono::nanoseconds answer_within_;
  asio::io_context io_{1};
  std::optional<Socket> socket_;
  beast::flat_buffer inbox_{1U << 20U};
  HaplyState known_;
  bool is_first_ = true, is_lost_ = false;
  std::optional<Error> read_error_;  // of the last read; nothing while it goes on
  std::string farewell_;
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
