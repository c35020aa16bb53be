#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ligature::host::stream {

/// What every client needs to know; outlives the clients.
struct FoxgloveRules {
  std::string machine_name;                  // own_host check of the HTTP request
  std::vector<std::string> allowed_origins;  // web sites that may read beside Foxglove's own
  std::string session_id;
};

/// One viewer, from its HTTP request on. Messages that it does not read in time are left out and counted, so that a
/// slow viewer neither delays others nor uses memory without limit.
class FoxgloveClient : public std::enable_shared_from_this<FoxgloveClient> {
 public:
  static constexpr std::size_t kMostWaitingBytes = 8U << 20U;

  FoxgloveClient(boost::asio::ip::tcp::socket socket, const FoxgloveRules& rules);

  void start();
  /// Sends a message of a topic, when this viewer has subscribed to it.
  void offer(std::uint32_t channel, std::uint64_t time_ns, std::string_view message);
  void close();

 private:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;
  void answer(const Request& request);
  void refuse(boost::beast::http::status status, const char* why);
  void accept(const Request& request);
  void read();
  void take(std::string_view text);
  void queue(std::string bytes, bool is_text);
  void write();

  struct Waiting {
    std::string bytes;
    bool is_text;
  };
  const FoxgloveRules& rules_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_static_buffer<16'384> inbox_;
  std::unique_ptr<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
  boost::beast::http::response<boost::beast::http::string_body> refusal_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  // channel -> number of the subscription
  std::deque<Waiting> outbox_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t left_out_ = 0;
  bool is_open_ = false, is_writing_ = false;
};

}  // namespace ligature::host::stream
