#include "host/view/http_connection.hpp"

#include "host/view/page_files.hpp"

namespace ligature::host::view {
namespace {

constexpr auto kRequestWithin = std::chrono::seconds(10);

/// Content security policy: scripts, styles and sockets from this server only, and no embedding in frames of other
/// sites.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

HttpConnection::HttpConnection(tcp::socket socket, Shared& shared) : shared_(shared), stream_(std::move(socket)) {
  ++shared_.connections;
}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(8U << 10U);
  parser_->body_limit(1U << 10U);
  stream_.expires_after(kRequestWithin);
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->respond(self->parser_->release());
  });
}

void HttpConnection::respond(http::request<http::string_body> request) {
  const auto text = [&request](http::field field) {
    const auto value = request[field];
    return std::string_view(value.data(), value.size());
  };
  const auto host = text(http::field::host);
  if (!is_own_host(host, shared_.machine_name)) return send(http::status::forbidden, "text/plain", "not this host\n");
  if (beast::websocket::is_upgrade(request)) {
    if (!is_own_origin(text(http::field::origin), host))
      return send(http::status::forbidden, "text/plain", "a page of another site may not connect\n");
    stream_.expires_never();
    return std::make_shared<PageConnection>(std::move(stream_), shared_)->accept(request);
  }
  if (request.method() != http::verb::get) return send(http::status::method_not_allowed, "text/plain", "only GET\n");
  const std::string_view target(request.target().data(), request.target().size());
  const PageFile* file = find_page_file(target.substr(0, target.find('?')));
  if (!file) return send(http::status::not_found, "text/plain", "no such file\n");
  std::string body(file->body);
  if (file->path == "/index.html") put_token(body);
  send(http::status::ok, file->type, std::move(body));
}

void HttpConnection::put_token(std::string& page) const {
  constexpr std::string_view kPlace = "LIGATURE_TOKEN";
  if (const auto at = page.find(kPlace); at != std::string::npos)
    page.replace(at, kPlace.size(), shared_.access.gives_token ? shared_.access.token : "");
}

void HttpConnection::send(http::status status, std::string_view type, std::string body) {
  response_ = {status, 11};
  response_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  response_.set(http::field::cache_control, "no-store");
  response_.set(http::field::x_frame_options, "DENY");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Content-Security-Policy", kPolicy);
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.set("Referrer-Policy", "no-referrer");
  response_.body() = std::move(body);
  response_.keep_alive(status == http::status::ok);
  response_.prepare_payload();
  stream_.expires_after(kRequestWithin);
  http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error && self->response_.keep_alive()) self->read();
  });
}

}  // namespace ligature::host::view
