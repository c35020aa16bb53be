#include "host/view/server.hpp"

#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <deque>

#include "host/errors.hpp"
#include "host/view/http_connection.hpp"

namespace ligature::host::view {
namespace {

namespace asio = boost::asio;
using Clock = Picture::Clock;
constexpr std::size_t kMostConnections = 64;
// Limits on the number of pages that have not shown the token. Few, if the server writes the token into its page: then
// only foreign pages lack the token. Many, if users append the token to the address: then a page without the token may
// still look.
constexpr std::size_t kFewLookers = 16, kManyLookers = 48;
constexpr auto kFramePeriod = std::chrono::microseconds(16'667);

std::string own_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

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
  Shared shared;  // first member: must outlive the connections, which end with io
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
  Clock::time_point due = Clock::now();
  std::deque<std::weak_ptr<HttpConnection>> visitors{};  // HTTP connections that are no pages yet; oldest first

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && has_room()) {
        const auto peer = std::make_shared<HttpConnection>(std::move(socket), shared);
        visitors.push_back(peer);
        peer->read();
      }
      accept();
    });
  }

  /// Makes room for a new connection. At the limit the oldest HTTP connection is closed, then the oldest page without
  /// the token, so that idle clients cannot keep pages out. @return false when only pages with the token are left; the
  /// new socket is then refused.
  bool has_room() {
    std::erase_if(visitors, [](const auto& visitor) { return visitor.expired(); });
    while (shared.lookers > most_lookers() && end_oldest_looker()) {
    }
    if (shared.connections < kMostConnections) return true;
    if (visitors.empty()) return end_oldest_looker();
    if (const auto oldest = visitors.front().lock()) oldest->end();
    visitors.pop_front();
    return true;
  }

  /// When there is a token, most places are reserved for pages that have shown it.
  [[nodiscard]] std::size_t most_lookers() const {
    return shared.access.token.empty() ? kMostConnections : shared.access.gives_token ? kFewLookers : kManyLookers;
  }

  /// Closes the oldest page that has not shown the token. @return false when there is none.
  bool end_oldest_looker() {
    for (const auto& [id, weak] : shared.pages) {  // in order of connection
      const auto page = weak.lock();
      if (!page || page->is_known()) continue;
      page->close();
      shared.pages.erase(id);
      return true;
    }
    return false;
  }

  void tick() {
    due = std::max(due + kFramePeriod, Clock::now());  // late frames are skipped, not made up for
    timer.expires_at(due);
    timer.async_wait([this](beast::error_code error) {
      if (error) return;
      bool more = true;
      const auto answers = shared.hooks.on_tick(more);
      if (!more) return io.stop();
      const auto now = Clock::now();
      const auto pages = shared.pages;  // a copy: a page that ends removes itself from the list
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
    : parts_(new Parts{.shared = {access, picture, std::move(hooks), own_name(), options.token_within, 0, 0, {}, 0}}) {
  beast::error_code error;
  const auto address = asio::ip::make_address(options.listen, error);
  if (error)
    throw BadInput("--listen: found '" + options.listen + "', allowed an address such as 127.0.0.1 or 0.0.0.0");
  const tcp::endpoint endpoint(address, options.port);
  auto& acceptor = parts_->acceptor;
  (void)acceptor.open(endpoint.protocol(), error);
  if (!error) (void)acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) (void)acceptor.bind(endpoint, error);
  if (!error) (void)acceptor.listen(asio::socket_base::max_listen_connections, error);
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
