#pragma once
// One open page: a WebSocket that receives frames and sends small JSON messages.

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>

#include "host/view/picture.hpp"
#include "host/view/server.hpp"

namespace ligature::host::view {

namespace beast = boost::beast;
namespace http = beast::http;
using tcp = boost::asio::ip::tcp;

/// Data shared by all connections; lives as long as the server.
struct Shared {
  const Access& access;
  const Picture& picture;
  ServerHooks hooks;
  std::string machine_name;
  // time within which a page must show the token, when the server has written it into the page
  Picture::Clock::duration token_within;
  std::size_t connections = 0, lookers = 0;  // all connections; pages that have not shown the token
  std::map<std::uint64_t, std::weak_ptr<class PageConnection>> pages;
  std::uint64_t last_page = 0;
};

class PageConnection : public std::enable_shared_from_this<PageConnection> {
 public:
  PageConnection(beast::tcp_stream stream, Shared& shared);
  ~PageConnection();
  PageConnection(const PageConnection&) = delete;
  PageConnection& operator=(const PageConnection&) = delete;

  void accept(const http::request<http::string_body>& upgrade);

  /// Sends a frame, unless the page has too many unacknowledged ones.
  void offer_frame(Picture::Clock::time_point now);
  void add_answer(const nlohmann::json& answer);
  /// Whether the page has shown the token; such a page is never displaced.
  [[nodiscard]] bool is_known() const { return is_known_; }
  /// Closes without the closing handshake: another connection needs the place, or the page breaks the rules or does not
  /// answer.
  void close();

 private:
  static constexpr std::uint32_t kMostUnseen = 3;
  static constexpr int kMessagesPerSecond = 300;
  static constexpr std::size_t kMostAnswers = 100;

  void read();
  /// @return false when the page breaks the rules and must be closed.
  bool on_message(std::string_view text);
  void look_at_token(const nlohmann::json& message);
  void give_place_back();
  /// Ends at once, without waiting for unsent data: ServerHooks::on_gone must be called at once.
  void end();

  Shared& shared_;
  std::uint64_t id_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::flat_static_buffer<4096> inbox_;
  std::vector<std::byte> outbox_;
  bool writing_ = false, open_ = false;
  Place place_;
  std::uint32_t seen_ = 0;
  nlohmann::json answers_ = nlohmann::json::array();
  Picture::Clock::time_point began_, second_began_, last_seen_;
  bool is_known_ = false, has_place_ = true;
  int messages_this_second_ = 0;
};

}  // namespace ligature::host::view
