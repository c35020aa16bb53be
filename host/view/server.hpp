#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "host/view/access.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

struct ServerOptions {
  std::string listen = "127.0.0.1";
  std::uint16_t port = 8737;                       // 0: any free port
  std::chrono::milliseconds token_within{10'000};  // pages that carry the token must send it within this time
};

/// The address to open in a browser; IPv6 addresses are put in brackets.
[[nodiscard]] std::string url_of(const ServerOptions& options, std::uint16_t port);

/// Whether the server listens on a loopback address only.
[[nodiscard]] bool is_loopback(const ServerOptions& options);

/// Callbacks of the server, all called on its thread.
struct ServerHooks {
  /// A text message from a page. @return an answer, or null.
  std::function<nlohmann::json(std::uint64_t page, const nlohmann::json& message)> on_message;
  /// Called 60 times a second, before frames are sent. @return answers for pages; setting `more` to false ends the
  /// server.
  std::function<std::multimap<std::uint64_t, nlohmann::json>(bool& more)> on_tick;
  /// The page's connection has ended. May be empty, and may be called more than once for a page.
  std::function<void(std::uint64_t page)> on_gone = {};
};

/// HTTP and WebSocket on one port and one thread (Boost.Beast). Pages get a frame 60 times a second, unless their last
/// three are unacknowledged: a slow page gets fewer frames, and nothing is queued for it.
/// Limits: 64 connections; at the limit the oldest is closed (HTTP clients first, then pages without the token). Of
/// these, pages that have not shown the token: 16, for 10 s each, if the server writes the token into the page; 48 if
/// users append the token to the address. A page may send 300 messages a second of 4 KiB. 8 KiB of HTTP header, 10 s
/// for a request or a write.
class Server {
 public:
  /// @throws BadInput for an invalid address, RunFailed when it cannot be bound.
  Server(const ServerOptions& options, const Access& access, const Picture& picture, ServerHooks hooks);
  ~Server();

  [[nodiscard]] std::uint16_t port() const;
  /// Serves until on_tick sets `more` to false.
  void run();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ligature::host::view
