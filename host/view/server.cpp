#include "host/view/server.hpp"

#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <optional>

#include "host/errors.hpp"
#include "host/view/page_connection.hpp"
#include "host/view/page_files.hpp"

namespace ligature::host::view {
namespace {

namespace asio = boost::asio;
using Clock = Picture::Clock;
constexpr std::size_t kMostConnections = 64;
constexpr auto kRequestWithin = std::chrono::seconds(10);
constexpr auto kFramePeriod = std::chrono::microseconds(16'667);

std::string own_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Scripts, styles and sockets of this server only, and in no other site's frame: nobody else's page can borrow ours.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// One HTTP exchange; becomes a PageConnection when a page asks for the WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Shared& shared) : shared_(shared), stream_(std::move(socket)) {
    ++shared_.connections;
  }
  ~HttpConnection() { --shared_.connections; }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(8U << 10U);
    parser_->body_limit(1U << 10U);
    stream_.expires_after(kRequestWithin);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->respond(self->parser_->release());
    });
  }

 private:
  void respond(http::request<http::string_body> request) {
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

  void put_token(std::string& page) const {
    constexpr std::string_view kPlace = "LIGATURE_TOKEN";
    if (const auto at = page.find(kPlace); at != std::string::npos)
      page.replace(at, kPlace.size(), shared_.access.gives_token ? shared_.access.token : "");
  }

  void send(http::status status, std::string_view type, std::string body) {
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

  Shared& shared_;
  beast::tcp_stream stream_;
  beast::flat_static_buffer<10'240> buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

std::string url_of(const ServerOptions& options, std::uint16_t port) {
  const bool is_v6 = options.listen.find(':') != std::string::npos;
  return "http://" + (is_v6 ? "[" + options.listen + "]" : options.listen) + ":" + std::to_string(port) + "/";
}

bool is_loopback(const ServerOptions& options) {
  beast::error_code error;
  return asio::ip::make_address(options.listen, error).is_loopback() && !error;
}

struct Server::Parts {
  Shared shared;  // first, so that it outlives the connections, which end with io
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
  Clock::time_point due = Clock::now();

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      // Over the limit a connection is closed at once; its socket ends here.
      if (!error && shared.connections < kMostConnections)
        std::make_shared<HttpConnection>(std::move(socket), shared)->read();
      accept();
    });
  }

  void tick() {
    due = std::max(due + kFramePeriod, Clock::now());  // late frames are left out, not made up for
    timer.expires_at(due);
    timer.async_wait([this](beast::error_code error) {
      if (error) return;
      bool more = true;
      const auto answers = shared.hooks.on_tick(more);
      if (!more) return io.stop();
      const auto now = Clock::now();
      const auto pages = shared.pages;  // a page that goes takes itself off the list
      for (const auto& [id, weak] : pages) {
        const auto page = weak.lock();
        if (!page) continue;
        const auto [first, last] = answers.equal_range(id);
        for (auto it = first; it != last; ++it) page->add_answer(it->second);
        page->offer_frame(now);
      }
      tick();
    });
  }
};

Server::Server(const ServerOptions& options, const Access& access, const Picture& picture, ServerHooks hooks)
    : parts_(new Parts{.shared = {access, picture, std::move(hooks), own_name(), 0, {}, 0}}) {
  beast::error_code error;
  const auto address = asio::ip::make_address(options.listen, error);
  if (error)
    throw BadInput("--listen: found '" + options.listen + "', allowed an address such as 127.0.0.1 or 0.0.0.0");
  const tcp::endpoint endpoint(address, options.port);
  auto& acceptor = parts_->acceptor;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw RunFailed("cannot listen on " + options.listen + ":" + std::to_string(options.port) + ": " + error.message() +
                    (error == asio::error::address_in_use  ? "; remedy: another --port, or end the view that runs there"
                     : error == asio::error::access_denied ? "; remedy: a --port of 1024 or more"
                                                           : "; remedy: an address that this machine has (ip addr)"));
}

Server::~Server() = default;

std::uint16_t Server::port() const { return parts_->acceptor.local_endpoint().port(); }

void Server::run() {
  parts_->accept();
  parts_->tick();
  parts_->io.run();
}

}  // namespace ligature::host::view
