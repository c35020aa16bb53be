#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "host/view/page_connection.hpp"

namespace ligature::host::view {

/// One HTTP client. A page that upgrades to a WebSocket continues as a PageConnection. Time limit: 10 s for a request
/// or a write.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Shared& shared);
  ~HttpConnection() { --shared_.connections; }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void read();
  /// Closes the connection in any state, to make room for a new connection.
  void end() { stream_.close(); }

 private:
  void respond(http::request<http::string_body> request);
  void put_token(std::string& page) const;
  void send(http::status status, std::string_view type, std::string body);

  Shared& shared_;
  beast::tcp_stream stream_;
  beast::flat_static_buffer<10'240> buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace ligature::host::view
